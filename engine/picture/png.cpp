// Nacre: images as PNG files.
#include "engine/picture/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/system/output_file.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace nacre {
namespace fs = std::filesystem;
namespace {

using Handle = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Pixels without their alpha, three bytes each.
std::vector<std::uint8_t> opaque_pixels(const Image& image) {
  std::vector<std::uint8_t> rgb(image.pixels.size() / 4 * 3);
  for (std::size_t i = 0; i < image.pixels.size() / 4; ++i) std::memcpy(&rgb[i * 3], &image.pixels[i * 4], 3);
  return rgb;
}

bool is_opaque(const Image& image) {
  for (std::size_t i = 3; i < image.pixels.size(); i += 4)
    if (image.pixels[i] != 255) return false;
  return true;
}

std::vector<std::uint8_t> read_all(const fs::path& file) {
  std::error_code failed;
  const auto status = fs::status(file, failed);
  if (!fs::exists(status)) throw Error("cannot read " + file.string(), "there is no such file");
  if (!fs::is_regular_file(status)) throw Error("cannot read " + file.string(), "it is not a plain file");
  const auto size = fs::file_size(file, failed);
  const Handle handle(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (failed || !handle) throw Error("cannot read " + file.string(), std::strerror(errno));
  if (size > std::size_t(std::numeric_limits<int>::max())) throw Error(file.string() + " is too large for a picture");
  std::vector<std::uint8_t> bytes(size);
  bytes.resize(std::fread(bytes.data(), 1, bytes.size(), handle.get()));
  return bytes;
}

/// Whether so many bytes of a PNG can hold so many pixels: deflate makes at most 1032 bytes of one.
bool can_hold(std::size_t bytes, int width, int height) {
  constexpr std::size_t best_ratio = 1032, fewest_bits = 1;
  return std::size_t(width) * std::size_t(height) * fewest_bits / 8 <= bytes * best_ratio;
}

}  // namespace

void check_png_size(int width, int height) {
  constexpr std::int64_t most = std::numeric_limits<int>::max() / 2 / 4;
  if (std::int64_t(width) * height > most)
    throw Error(fmt::format("a picture of {} x {} pixels is too large for a PNG file", width, height),
                fmt::format("it may have {} pixels in all", most), "choose a smaller size");
}

std::vector<std::uint8_t> encode_png(const Image& image) {
  assert(image.width > 0 && image.height > 0);
  assert(image.pixels.size() == std::size_t(image.width) * std::size_t(image.height) * 4);
  check_png_size(image.width, image.height);
  const int channels = is_opaque(image) ? 3 : 4;
  const std::vector<std::uint8_t> rgb = channels == 3 ? opaque_pixels(image) : std::vector<std::uint8_t>();
  int size = 0;
  const std::unique_ptr<unsigned char, void (*)(void*)> png(
      stbi_write_png_to_mem(channels == 3 ? rgb.data() : image.pixels.data(), image.width * channels, image.width,
                            image.height, channels, &size),
      &std::free);
  if (!png) throw std::bad_alloc();
  return {png.get(), png.get() + size};
}

void write_png(const fs::path& file, const Image& image) {
  const std::vector<std::uint8_t> bytes = encode_png(image);
  OutputFile output(file, OutputFile::Devices::refused);
  output.write(bytes.data(), bytes.size());
  output.commit();
}

Image read_png(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = read_all(file);
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels))
    throw Error("cannot read " + file.string(), "it is not a PNG file");
  if (!can_hold(bytes.size(), width, height))
    throw Error("cannot read " + file.string(), "the file is too short for the size that it states");
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(bytes.data(), int(bytes.size()), &width, &height, &channels, 4), &std::free);
  if (!pixels)
    throw Error("cannot read " + file.string(), "the PNG file is damaged: " + std::string(stbi_failure_reason()));
  Image image(width, height);
  std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size());
  return image;
}

}  // namespace nacre
