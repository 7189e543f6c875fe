// Nacre: images as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/picture/image.hpp"

namespace nacre {

/// Throws Error where a picture of so many pixels is too large for the PNG encoder, which counts bytes in 31 bits.
void check_png_size(int width, int height);

/// The bytes of a PNG file: RGB where every pixel is opaque, else RGBA. The image has at least one pixel. Throws Error
/// as `check_png_size` does.
std::vector<std::uint8_t> encode_png(const Image& image);

/// Writes beside `file`, then renames, so that there is a whole picture or none. Throws Error (with the file's name and
/// the reason) where it cannot be written or the disk is full. `origin` says how the picture came about
/// (engine/run/origin.hpp); it becomes its text "Source".
void write_png(const std::filesystem::path& file, const Image& image, const std::string& origin = "");

/// Adds a text chunk (tEXt) behind the header of a PNG. Both are ASCII, the keyword has 1 to 79 characters.
void add_png_text(std::vector<std::uint8_t>& png, const std::string& keyword, const std::string& text);

/// Any PNG, as RGBA with 8 bits a channel. Throws Error where the file is not a whole PNG.
Image read_png(const std::filesystem::path& file);

}  // namespace nacre
