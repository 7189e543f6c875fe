// Nacre: images as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "engine/picture/image.hpp"

namespace nacre {

/// Throws Error if a picture of so many pixels is too large for the PNG encoder, which counts bytes in 31 bits.
void check_png_size(int width, int height);

/// The bytes of a PNG file: RGB if every pixel is opaque, otherwise RGBA. The image has at least one pixel. Throws
/// Error as `check_png_size` does.
std::vector<std::uint8_t> encode_png(const Image& image);

/// Writes beside `file`, then renames, so that there is a complete picture or none. Throws Error (with the name of the
/// file and the reason) if it cannot be written or the disk is full.
void write_png(const std::filesystem::path& file, const Image& image);

/// Any PNG, as RGBA with 8 bits a channel. Throws Error if the file cannot be read or is not a complete PNG.
Image read_png(const std::filesystem::path& file);

}  // namespace nacre
