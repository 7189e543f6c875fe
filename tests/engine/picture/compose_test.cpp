// Nacre: blending against values computed by hand.
#include "engine/picture/compose.hpp"

#include <gtest/gtest.h>

#include "tests/engine/picture/test_images.hpp"

namespace nacre {
namespace {

TEST(BlendOver, OpaqueCoversClearDoesNot) {
  Image bottom = plain_image(4, 3, {10, 20, 30, 255});
  Image top = plain_image(4, 3, {200, 100, 50, 0});
  for (int k = 0; k < 4; ++k) top.at(1, 2)[k] = std::uint8_t(k == 3 ? 255 : 7);
  blend_over(bottom, top);
  EXPECT_EQ(bottom.at(0, 0)[0], 10);
  EXPECT_EQ(bottom.at(1, 2)[0], 7);
  EXPECT_EQ(bottom.at(1, 2)[3], 255);
}

TEST(BlendOver, HalfAlphaIsTheMean) {
  Image bottom = plain_image(1, 1, {0, 100, 200, 255});
  blend_over(bottom, plain_image(1, 1, {100, 100, 100, 128}));
  EXPECT_NEAR(bottom.pixels[0], 50, 1);
  EXPECT_EQ(bottom.pixels[1], 100);
  EXPECT_NEAR(bottom.pixels[2], 150, 1);
  EXPECT_EQ(bottom.pixels[3], 255);
}

TEST(BlendOver, OverATransparentPixelTheTopKeepsItsColour) {
  Image bottom = plain_image(1, 1, {255, 255, 255, 0});
  blend_over(bottom, plain_image(1, 1, {40, 50, 60, 128}));
  EXPECT_EQ(bottom.pixels[0], 40);
  EXPECT_EQ(bottom.pixels[3], 128);
}

TEST(BlendOver, IsCutAtTheBorders) {
  for (const auto& [x, y, expected] : {std::tuple{-2, -2, 1}, {2, 2, 1}, {-1, 1, 4}, {5, 0, 0}, {-9, 0, 0}}) {
    Image bottom = plain_image(3, 3, {0, 0, 0, 255});
    const Image before = bottom;
    blend_over(bottom, plain_image(3, 3, {9, 9, 9, 255}), x, y);
    EXPECT_EQ(changed_pixels(before, bottom), expected) << x << " " << y;
  }
}

TEST(OnCanvas, CutsOffAndFrames) {
  Image image = plain_image(3, 2, {9, 8, 7, 255});
  image.at(1, 1)[0] = 200;
  EXPECT_EQ(on_canvas(image, 3, 2).pixels, image.pixels);
  const Image wide = on_canvas(image, 7, 4);
  ASSERT_EQ(wide.width, 7);
  ASSERT_EQ(wide.height, 4);
  EXPECT_EQ(wide.at(3, 2)[0], 200);
  EXPECT_EQ(wide.at(0, 0)[0], 9);
  EXPECT_EQ(wide.at(6, 3)[2], 7);
  const Image narrow = on_canvas(image, 1, 1);
  EXPECT_EQ(narrow.pixels, (std::vector<std::uint8_t>{9, 8, 7, 255}));
  EXPECT_EQ(on_canvas(image, 1, 4).at(0, 2)[0], 200);
}

}  // namespace
}  // namespace nacre
