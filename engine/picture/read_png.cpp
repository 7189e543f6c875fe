// Nacre: reads PNG files.
#include <algorithm>

#include "compute/device/error.hpp"
#include "engine/picture/png.hpp"

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>

nacre::Image nacre::read_png(const std::filesystem::path& file) {
  int width = 0, height = 0, channels = 0;
  stbi_uc* const pixels = stbi_load(file.c_str(), &width, &height, &channels, 4);
  if (!pixels) throw Error("cannot read " + file.string(), stbi_failure_reason());
  Image image(width, height);
  std::copy_n(pixels, image.pixels.size(), image.pixels.begin());
  stbi_image_free(pixels);
  return image;
}
