// Nacre: legend, time stamp and axes are where they should be and leave the rest of the picture alone.
#include "engine/picture/legend.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/engine/picture/test_images.hpp"

namespace nacre {
namespace {

constexpr Rgba white{255, 255, 255, 255}, dark{20, 20, 26, 255};

bool is_near(const std::uint8_t* pixel, const std::array<float, 3>& color) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(float(pixel[k]) - 255 * color[k]) > 2) return false;
  return true;
}

TEST(Legend, ShowsTheWholeMapInTheRightQuarter) {
  const Colormap& map = colormap("sea");
  for (const auto& [width, height] : {std::pair{320, 240}, {1024, 768}, {1920, 1080}, {600, 900}})
    for (const Rgba background : {white, dark}) {
      const Image blank = plain_image(width, height, background);
      Image image = blank;
      draw_legend(image, map, 0, 47.3, "speed");
      EXPECT_EQ(changed_pixels(blank, image, 0, 0, width - width / 4, height), 0);
      int top = height, bottom = -1;
      for (int y = 0; y < height; ++y)
        for (int x = width - width / 4; x < width; ++x) {
          if (is_near(image.at(x, y), map.table[255])) top = std::min(top, y);
          if (is_near(image.at(x, y), map.table[0])) bottom = std::max(bottom, y);
        }
      EXPECT_GT(bottom - top, height / 3) << width << " x " << height << ": high values are at the top";
      EXPECT_LE(bottom - top, height / 2);
    }
}

TEST(Legend, LetteringStandsOutFromLightAndDark) {
  for (const Rgba background : {white, dark}) {
    Image image = plain_image(800, 600, background);
    draw_legend(image, colormap("gray"), 0, 1, "W");
    int most = 0;
    for (int y = 0; y < 600; ++y)
      for (int x = 780; x < 800; ++x) most = std::max(most, std::abs(int(image.at(x, y)[0]) - background.r));
    EXPECT_GT(most, 150) << "labels end at the right margin";
  }
}

TEST(Legend, TitleIsCutToTheQuarter) {
  const Image blank = plain_image(640, 480, white);
  Image image = blank;
  draw_legend(image, colormap("sea"), -1e-7, 3e-7, std::string(3000, 'W') + "\xff\n");
  EXPECT_GT(changed_pixels(blank, image), 100);
  EXPECT_EQ(changed_pixels(blank, image, 0, 0, 640 - 160 - 4, 480), 0) << "but for the letters' halo";
}

TEST(Legend, IsLeftOutWhereItCannotBeRead) {
  for (const auto& [width, height] : {std::pair{1, 1}, {64, 48}, {120, 600}, {600, 60}}) {
    const Image blank = plain_image(width, height, white);
    Image image = blank;
    draw_legend(image, colormap("sea"), -12345, 47.3, "speed");
    EXPECT_EQ(changed_pixels(blank, image), 0) << width << " x " << height;
  }
}

TEST(Legend, StrangeRanges) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const auto& [min, max] : {std::pair{0.0, 0.0}, {nan, nan}, {-inf, inf}, {5.0, -5.0}, {1e300, 1.1e300}}) {
    const Image blank = plain_image(640, 480, white);
    Image image = blank;
    draw_legend(image, colormap("blue-red"), min, max, "");
    EXPECT_GT(changed_pixels(blank, image), 100) << min << " " << max;
  }
}

TEST(Legend, StaysInItsRoom) {
  for (const auto& [width, height] :
       {std::pair{240, 180}, {320, 240}, {640, 480}, {1024, 768}, {1920, 1080}, {600, 900}})
    for (const auto& [min, max] :
         {std::pair{0.0, 47.3}, {-0.004, 0.009}, {-12345.0, 99999.0}, {0.0, 3e-7}, {0.99, 1.01}}) {
      const KeptFree room = legend_room(width, height);
      const Image blank = plain_image(width, height, white);
      Image image = blank;
      draw_legend(image, colormap("sea"), min, max, "W");
      const int bottom = int(std::ceil(room.bottom * height)), left = int(room.left * width);
      const int top = int(room.top * height) - 1;  // letters reach a row higher where rounding differs
      EXPECT_EQ(changed_pixels(blank, image, 0, 0, left, height), 0) << width << " x " << height << ": " << max;
      EXPECT_EQ(changed_pixels(blank, image, 0, 0, width, top), 0) << width << " x " << height << ": " << max;
      EXPECT_EQ(changed_pixels(blank, image, 0, bottom, width, height), 0) << width << " x " << height;
      EXPECT_TRUE(width <= 600 || room.left > 0.85) << room.left << ": no larger than it need be";
    }
  EXPECT_EQ(legend_room(120, 600).left, 1) << "where there is none";
}

TEST(TimeStamp, IsAtTheBottomLeft) {
  const Image blank = plain_image(640, 480, white);
  Image image = blank;
  draw_time(image, 0.125, "s");
  const int all = changed_pixels(blank, image);
  EXPECT_GT(all, 50);
  EXPECT_EQ(changed_pixels(blank, image, 0, 440, 200, 480), all);
  Image none = blank;
  draw_time(none, std::nan(""), "s");
  EXPECT_EQ(changed_pixels(blank, none), 0);
}

TEST(TimeStamp, StepFixesTheDecimals) {
  Image a = plain_image(640, 480, white), b = a, c = a;
  draw_time(a, 0.5, "s", 0.25);
  draw_time(b, 0.5004, "s", 0.25);
  draw_time(c, 0.5, "s");
  EXPECT_EQ(changed_pixels(a, b), 0) << "both are 0.50";
  EXPECT_GT(changed_pixels(a, c), 0) << "0.50 and 0.5";
}

TEST(Orientation, AxesPointAsTheCameraSeesThem) {
  const Image blank = plain_image(800, 600, white);
  Image image = blank;
  draw_orientation(image, {1, 0, 0}, {0, 0, 1}, {0, 1, 0});
  EXPECT_EQ(changed_pixels(blank, image), changed_pixels(blank, image, 640, 460, 800, 600)) << "bottom right";
  double red_x = 0, red_y = 0, blue_x = 0, blue_y = 0;
  int red = 0, blue = 0;
  for (int y = 460; y < 600; ++y)
    for (int x = 640; x < 800; ++x) {
      const std::uint8_t* p = image.at(x, y);
      if (p[0] > p[2] + 100) red_x += x, red_y += y, ++red;
      if (p[2] > p[0] + 100) blue_x += x, blue_y += y, ++blue;
    }
  ASSERT_GT(red, 10);
  ASSERT_GT(blue, 10);
  EXPECT_GT(red_x / red, blue_x / blue + 10) << "x goes right";
  EXPECT_LT(blue_y / blue, red_y / red - 10) << "z goes up";
}

TEST(Orientation, SurvivesAnyCameraAndSize) {
  const float nan = std::nanf("");
  for (const int size : {0, 1, 50, 130, 400}) {
    Image image(size, size);
    draw_orientation(image, {1, 0, 0}, {0, 1, 0}, {0, 0, -1});
    draw_orientation(image, {0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    draw_orientation(image, {nan, 0, 0}, {0, 1, 0}, {0, 0, -1});
  }
}

}  // namespace
}  // namespace nacre
