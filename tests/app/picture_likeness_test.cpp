// Nacre: the comparison of pictures of particles lets pass what nobody would see, and nothing else.
#include "tests/app/picture_likeness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "engine/picture/colormap.hpp"
#include "engine/picture/lettering.hpp"

namespace nacre::test {
namespace {

/// A crowd of discs on white, as particles on a ball are seen; what is drawn of it can be changed.
struct Crowd {
  double moved = 0;        ///< how far each disc may be from its position, in radii
  double other_value = 0;  ///< how much each colour may differ, of the whole map
  double radius = 2.5;
  bool lines = true;
  std::function<double(double value)> colour = [](double value) { return value; };
  std::function<bool(double x, double y)> left_out = [](double, double) { return false; };

  Image draw() const {
    std::mt19937 first(1), second(2);  // what they have in common, and what not
    std::uniform_real_distribution<double> any(-1, 1);
    const Colormap& map = colormap("sea");
    Image image(240, 180);
    for (double y = -75; y < 75; y += 4.4)
      for (double x = -75 + std::fmod(std::abs(y), 2.5); x < 75; x += 5) {
        const double at_x = 120 + x + any(first) + moved * 2.5 * any(second);
        const double at_y = 90 + y + any(first) + moved * 2.5 * any(second);
        const double value = 0.5 + 0.3 * std::sin(x / 30) + 0.2 * any(first) + other_value * any(second);
        if (std::hypot(x, y) > 75 || left_out(x, y)) continue;
        const auto& c = map.table[std::size_t(std::clamp(colour(value), 0.0, 1.0) * double(map.table.size() - 1))];
        const auto byte = [](float v) { return std::uint8_t(255 * v); };
        draw_stroke(image, float(at_x), float(at_y), float(radius), float(at_x), float(at_y), float(radius),
                    {byte(c[0]), byte(c[1]), byte(c[2])});
      }
    for (int at = 10; lines && at < 180; at += 20) {
      fill_box(image, 20, at, 200, 1, {26, 64, 128, 64});
      fill_box(image, at + 30, 5, 1, 170, {26, 64, 128, 64});
    }
    return image;
  }
};

TEST(PicturesOfParticles, AreAlikeWhereEveryDiscMovesALittle) {
  const Image usual = Crowd().draw();
  EXPECT_TRUE(are_alike(usual, usual));
  for (const double moved : {0.1, 0.3, 0.6}) {
    Crowd crowd;
    crowd.moved = moved;
    crowd.other_value = 0.1;
    const Image now = crowd.draw();
    EXPECT_TRUE(are_alike(usual, now)) << moved;
    EXPECT_TRUE(are_alike(now, usual)) << moved;
    EXPECT_FALSE(are_same(usual, now)) << "pixel by pixel";
  }
}

class OtherPicture : public testing::Test {
 protected:
  /// Also where every disc has moved.
  void expect_unlike(Crowd crowd) const {
    for (const double moved : {0.0, 0.3}) {
      crowd.moved = moved;
      EXPECT_FALSE(are_alike(usual_, crowd.draw())) << moved;
      EXPECT_FALSE(are_alike(crowd.draw(), usual_)) << moved;
    }
  }
  const Image usual_ = Crowd().draw();
};

TEST_F(OtherPicture, DiscsAreMissingInARegion) {
  Crowd crowd;
  crowd.left_out = [](double x, double y) { return std::hypot(x - 20, y) < 20; };
  expect_unlike(crowd);
}

TEST_F(OtherPicture, OneOfTwoDiscsIsMissing) {
  Crowd crowd;
  crowd.left_out = [](double x, double) { return std::fmod(std::floor((x + 200) / 5), 2) == 0; };
  expect_unlike(crowd);
}

TEST_F(OtherPicture, ColoursAreThoseOfOtherValues) {
  Crowd turned, flat;
  turned.colour = [](double value) { return 1 - value; };
  flat.colour = [](double) { return 0.5; };
  expect_unlike(turned);
  expect_unlike(flat);
}

TEST_F(OtherPicture, DiscsAreLargerOrSmaller) {
  for (const double radius : {1.7, 3.6}) {
    Crowd crowd;
    crowd.radius = radius;
    SCOPED_TRACE(radius);
    expect_unlike(crowd);
  }
}

TEST_F(OtherPicture, TheLinesOverThemAreMissing) {
  Crowd crowd;
  crowd.lines = false;
  expect_unlike(crowd);
}

}  // namespace
}  // namespace nacre::test
