// Nacre: the measures of flow textures, on textures whose answer is known.
#include <gtest/gtest.h>

#include "tests/evidence/crispness.hpp"
#include "tests/evidence/legibility.hpp"
#include "tests/evidence/surface_lic.hpp"

namespace nacre {
namespace {

constexpr int side = 160;
const double turned = 0.4;  // of the flow against the lattice, radians
const Vec3d along(std::cos(turned), std::sin(turned), 0), across(-along.y, along.x, 0);

/// A square plane of cells of width 1 in a steady flow, with the texture that `value` gives to positions.
FlowValues plane(const std::function<double(const Vec3d&)>& value) {
  FlowValues plane(std::size_t(side) * side);
  for (int i = 0; i < side * side; ++i) {
    plane.centre[i] = plane.closest_point[i] = Vec3d(i % side, i / side, 0);
    plane.normal[i] = Vec3f(0, 0, 1);
    plane.velocity[i] = Vec3f(along);
    plane.value[i] = float(value(plane.centre[i]));
  }
  return plane;
}

double white(const Vec3d& p) { return uniform_random(5, std::uint32_t(p.y * side + p.x), 0); }

TEST(FlowMeasures, WhiteNoiseHasNoDirectionAndNoLength) {
  const Legibility seen = legibility(plane(white), 1);
  EXPECT_GT(seen.positions, 1000);
  EXPECT_NEAR(seen.width, 0.72, 0.03);
  EXPECT_NEAR(seen.length, 0.72, 0.03);
  EXPECT_NEAR(seen.within, 0.13, 0.06) << "15 degrees of 90, but for the lattice's own bias";
}

TEST(FlowMeasures, StripesAlongTheFlowAreReadAndMeasured) {
  const double period = 9;
  const auto stripes = [&](double off) {
    const Vec3d normal = across * std::cos(off) - along * std::sin(off);
    return plane([=](const Vec3d& p) { return std::sin(2 * std::numbers::pi / period * dot(p, normal)); });
  };
  const Legibility straight = legibility(stripes(0), 1);
  EXPECT_EQ(straight.within, 1);
  EXPECT_NEAR(straight.width, period / 6, 0.1) << "where a cosine is one half";
  EXPECT_EQ(straight.length, FlowWindow::reach);
  const double degree = std::numbers::pi / 180;
  EXPECT_GT(legibility(stripes(10 * degree), 1).within, 0.99);
  EXPECT_LT(legibility(stripes(20 * degree), 1).within, 0.01);
}

/// The faster half is striped, the rest is noise.
TEST(FlowMeasures, TheSlowestAreCountedByThemselves) {
  FlowValues half = plane([](const Vec3d& p) { return p.x > side / 2 ? std::sin(0.7 * dot(p, across)) : white(p); });
  for (std::size_t i = 0; i < half.value.size(); ++i)
    half.velocity[i] = Vec3f(along) * float(half.centre[i].x > side / 2 ? 1 : 0.1 + 0.001 * half.centre[i].x);
  const Legibility seen = legibility(half, 1);
  EXPECT_NEAR(seen.within, 0.55, 0.1);
  EXPECT_LT(seen.slowest_within, 0.25);
}

TEST(FlowMeasures, ConvolutionOfNoiseIsAsLongAsItsReach) {
  FlowValues values = plane(white);
  values.value = SurfaceLic(values, 1).convolve(10);
  const Legibility seen = legibility(values, 1);
  EXPECT_GT(seen.within, 0.99);
  EXPECT_NEAR(seen.width, 0.95, 0.15);
  EXPECT_NEAR(seen.length, 9, 1.5);
  double sum = 0, squares = 0;
  for (const float v : values.value) sum += v, squares += double(v) * v;
  EXPECT_NEAR(sum / (side * side), 0.5, 0.01);
  EXPECT_LT(std::sqrt(squares / (side * side) - 0.25), 0.1) << "a mean of 21 values";
}

/// Where the flow turns back the convolution stops: beyond there is other noise.
TEST(FlowMeasures, ConvolutionStopsWhereTheFlowTurnsBack) {
  FlowValues values = plane(white);
  for (std::size_t i = 0; i < values.value.size(); ++i)
    values.velocity[i] = values.centre[i].x < side / 2 ? Vec3f(1, 0, 0) : Vec3f(-1, 0, 0);
  const std::vector<float> lic = SurfaceLic(values, 1).convolve(40);
  const std::size_t row = std::size_t(side) * 70;
  EXPECT_NE(lic[row + side / 2 - 4], lic[row + side / 2 + 4]);
  EXPECT_GT(std::fabs(lic[row + side / 2 - 4] - lic[row + side / 2 + 4]), 1e-3);
}

/// A picture of a grey square with waves of a period of 10 pixels across and 60 along, on white.
TEST(FlowMeasures, CrispnessOfWaves) {
  const int width = 400, height = 300;
  const double pi = std::numbers::pi, angle = 0.5, strength = 0.3;
  std::vector<std::uint8_t> rgba(std::size_t(4) * width * height, 255);
  for (int y = 40; y < height - 40; ++y)
    for (int x = 40; x < width - 40; ++x) {
      const double s = x * std::cos(angle) + y * std::sin(angle), t = y * std::cos(angle) - x * std::sin(angle);
      const double v = 120 * (1 + strength * 2 * std::cos(2 * pi / 60 * s) * std::cos(2 * pi / 10 * t));
      for (int c = 0; c < 3; ++c) rgba[4 * (std::size_t(y) * width + x) + c] = std::uint8_t(v + 0.5);
    }
  const Crispness seen = crispness(rgba, width, height);
  EXPECT_NEAR(seen.across, 10 / 6.0, 0.1);
  EXPECT_NEAR(seen.along, 60 / 6.0, 1.5);
  EXPECT_NEAR(seen.contrast, strength, 0.05);
}

}  // namespace
}  // namespace nacre
