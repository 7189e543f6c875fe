// Nacre: images over a frame: the same pixels as when they are put over an image on the host.
#include <cstdlib>

#include "engine/gl/framebuffer.hpp"
#include "engine/picture/compose.hpp"
#include "engine/picture/legend.hpp"
#include "engine/render/overlay_pass.hpp"
#include "tests/engine/gl/offscreen.hpp"

namespace nacre {
namespace {

using Overlay = test::Offscreen;

View square(int size) {
  View view;
  view.width = view.height = size;
  return view;
}

Image drawn_over(const std::array<float, 4>& background, const Image& sheet, int size, int samples = 1) {
  const Framebuffer frame(size, size, samples);
  frame.bind();
  frame.clear(background);
  OverlayPass pass;
  pass.set_image(sheet);
  pass.draw(square(size));
  return frame.read();
}

int largest_difference(const Image& a, const Image& b) {
  int most = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (b.pixels[i | 3] > 40) most = std::max(most, std::abs(int(a.pixels[i]) - int(b.pixels[i])));
  return most;
}

/// Opaque, half transparent and clear parts, none of them symmetric.
Image patches(int size) {
  Image sheet = clear_sheet(size, size, {255, 255, 255, 255});
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      if (x < size / 3 && y < size / 2)
        blend_pixel(sheet.at(x, y), {200, 30, 10, 255});
      else if (y > 3 * size / 4)
        blend_pixel(sheet.at(x, y), {10, 90, 220, 128});
  return sheet;
}

TEST_F(Overlay, PixelsAreThoseOfTheHost) {
  const Image sheet = patches(64);
  for (const int samples : {1, 4}) {
    Image host(64, 64);
    blend_over(host, sheet);
    EXPECT_LE(largest_difference(drawn_over({1, 1, 1, 1}, sheet, 64, samples), host), 1) << samples;
  }
}

TEST_F(Overlay, NothingBehindLeavesTheImageAsItIs) {
  const Image sheet = patches(64);
  const Image image = drawn_over({0, 0, 0, 0}, sheet, 64);
  EXPECT_LE(largest_difference(image, sheet), 1);
  EXPECT_EQ(image.at(50, 20)[3], 0);
  EXPECT_NEAR(image.at(50, 60)[3], 128, 1);
}

TEST_F(Overlay, SmallImagesGoIntoTheRightLowerCorner) {
  const Image small = patches(16);
  Image host(64, 64);
  blend_over(host, small, 48, 48);
  EXPECT_LE(largest_difference(drawn_over({1, 1, 1, 1}, small, 64), host), 1);
  EXPECT_EQ(drawn_over({1, 1, 1, 1}, Image(), 64).pixels, Image(64, 64).pixels);
}

TEST_F(Overlay, AxesAreThoseOfPicturesWithoutOpenGl) {
  const Vec3f right(0.8f, 0.6f, 0), up(0, 0, 1), forward(-0.6f, 0.8f, 0);
  Image host(400, 400);
  draw_orientation(host, right, up, forward);
  const Image sheet = orientation_sheet(400, 400, {255, 255, 255, 255}, right, up, forward);
  EXPECT_LT(sheet.width, 120);
  const Image image = drawn_over({1, 1, 1, 1}, sheet, 400);
  EXPECT_NE(host.pixels, Image(400, 400).pixels);
  EXPECT_LE(largest_difference(image, host), 3);
  EXPECT_TRUE(orientation_sheet(80, 80, {255, 255, 255, 255}, right, up, forward).pixels.empty());
}

}  // namespace
}  // namespace nacre
