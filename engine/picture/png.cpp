// Nacre: images as PNG files.
#include "engine/picture/png.hpp"

#include <fmt/format.h>

#include <cassert>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "compute/device/error.hpp"
#include "engine/system/output_file.hpp"

/// stb does not ask whether it gets the memory that it asks for.
static void* checked_memory(void* pointer) {
  if (!pointer) throw std::bad_alloc();
  return pointer;
}

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#define STBIW_MALLOC(size) checked_memory(std::malloc(size))
#define STBIW_REALLOC(pointer, size) checked_memory(std::realloc(pointer, size))
#define STBIW_FREE(pointer) std::free(pointer)
#include <stb_image_write.h>

namespace nacre {
namespace fs = std::filesystem;
namespace {

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

void add_png_text(std::vector<std::uint8_t>& png, const std::string& keyword, const std::string& text) {
  constexpr std::size_t after_header = 8 + 25;  // the signature, and IHDR with its length, type and check sum
  std::string chunk = "tEXt" + keyword + '\0' + text;
  const auto number = [](std::size_t value) {
    return std::string{char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
  };
  const std::string length = number(chunk.size() - 4);
  const unsigned sum = stbiw__crc32(reinterpret_cast<unsigned char*>(chunk.data()), int(chunk.size()));
  chunk = length + chunk + number(sum);
  png.insert(png.begin() + after_header, chunk.begin(), chunk.end());
}

void write_png(const fs::path& file, const Image& image, const std::string& origin) {
  std::vector<std::uint8_t> bytes = encode_png(image);
  if (!origin.empty()) add_png_text(bytes, "Source", origin);
  OutputFile output(file, OutputFile::Devices::refused);
  output.write(bytes.data(), bytes.size());
  output.commit();
}

}  // namespace nacre
