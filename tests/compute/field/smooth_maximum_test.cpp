// Nacre: the smooth maximum against the true one, its gradient against finite differences, and what is made of it.
#include "compute/field/smooth_maximum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "compute/device/random.hpp"

namespace nacre {
namespace {

float number(std::uint32_t a, std::uint32_t b) { return 2 * uniform_random(5, a, b) - 1; }

/// `m` curved functions of the position: value and exact gradient at p.
std::vector<FieldSample> functions_at(int m, std::uint32_t seed, const Vec3f& p) {
  std::vector<FieldSample> f;
  for (int i = 0; i < m; ++i) {
    const std::uint32_t k = seed * 100 + i;
    const Vec3f slope(number(k, 0), number(k, 1), number(k, 2)), bend(number(k, 3), number(k, 4), number(k, 5));
    f.push_back({0.01f * number(k, 6) + dot(slope, p) + dot(bend, p * p), slope + bend * p * 2.0f});
  }
  return f;
}

float largest(const std::vector<FieldSample>& f) {
  return std::max_element(f.begin(), f.end(), [](auto& a, auto& b) { return a.value < b.value; })->value;
}

TEST(SmoothMaximum, IsTheMaximumOfRandomValues) {
  for (int m = 2; m <= 6; ++m)
    for (std::uint32_t seed = 0; seed < 500; ++seed) {
      std::vector<FieldSample> f(m);
      for (int i = 0; i < m; ++i) f[i].value = 10 * number(seed * 10 + m, i);
      const float smooth = smooth_maximum(f.data(), m).value;
      EXPECT_LE(smooth, largest(f) + 1e-5f);
      EXPECT_GE(smooth, largest(f) - 0.15f * float(m - 1) * maximum_smoothing);
    }
}

TEST(SmoothMaximum, IsExactWhereValuesTie) {  // as printed, without the division, three equal values give 3/4 of it
  for (int m = 2; m <= 6; ++m)
    for (int equal = 2; equal <= m; ++equal)
      for (const float value : {-7.0f, 0.0f, 3.0f}) {
        std::vector<FieldSample> f(m);
        for (int i = 0; i < m; ++i) f[i].value = i < equal ? value : value - 5;
        const float left = 5e-6f * float(m - equal);  // what the lower ones leave: smoothing^2 / (4 * 5) each
        EXPECT_NEAR(smooth_maximum(f.data(), m).value, value, 2e-6f + left) << m << " " << equal;
        std::reverse(f.begin(), f.end());
        EXPECT_NEAR(smooth_maximum(f.data(), m).value, value, 2e-6f + left);
      }
}

TEST(SmoothMaximum, TheGradientOfATieIsTheMean) {
  std::vector<FieldSample> f(3);
  for (int i = 0; i < 3; ++i) f[i] = {1, Vec3f(i == 0, i == 1, i == 2)};
  const Vec3f g = smooth_maximum(f.data(), 3).gradient;
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(g[axis], 1.0f / 3, 1e-5f);
}

/// Largest difference of a gradient from central differences, over random functions that are close to each other.
template <class Value>
void expect_gradient(const Value& value_at, float tolerance) {
  const float step = 2e-3f;
  for (int m = 2; m <= 6; ++m)
    for (std::uint32_t seed = 0; seed < 60; ++seed) {
      const Vec3f p = Vec3f(number(seed, 20), number(seed, 21), number(seed, 22)) * 0.02f;
      const FieldSample at = value_at(functions_at(m, seed, p));
      for (int axis = 0; axis < 3; ++axis) {
        Vec3f low = p, high = p;
        low[axis] -= step, high[axis] += step;
        // Fourth order, so that what is left is rounding.
        Vec3f lower = p, higher = p;
        lower[axis] -= 2 * step, higher[axis] += 2 * step;
        const auto value = [&](const Vec3f& q) { return double(value_at(functions_at(m, seed, q)).value); };
        const double slope = (8 * (value(high) - value(low)) - (value(higher) - value(lower))) / (12 * double(step));
        EXPECT_NEAR(at.gradient[axis], slope, tolerance * (1 + std::fabs(slope))) << m << " functions, seed " << seed;
      }
    }
}

TEST(SmoothMaximum, TheGradientIsThatOfTheValue) {
  expect_gradient([](const std::vector<FieldSample>& f) { return smooth_maximum(f.data(), int(f.size())); }, 0.02f);
}

TEST(SmoothMaximum, TheCellIndicatorsGradientIsThatOfItsValue) {
  expect_gradient(
      [](const std::vector<FieldSample>& f) {
        const int m = int(f.size());
        const FieldSample inside[2] = {inside_outside(f.data(), m, 0), inside_outside(f.data(), m, 1)};
        return cell_indicator(inside, 2);
      },
      0.01f);
}

TEST(SmoothMaximum, LeavingOneOutIsTheMaximumOfTheRest) {
  const std::vector<FieldSample> f{{4, {}}, {1, {}}, {2, {}}, {-3, {}}};
  EXPECT_NEAR(smooth_maximum(f.data(), 4, 0).value, 2, 1e-4f);
  EXPECT_NEAR(smooth_maximum(f.data(), 4, 1).value, 4, 1e-4f);
  EXPECT_NEAR(smooth_maximum(f.data(), 2, 0).value, 1, 1e-6f);
}

TEST(SmoothMaximum, InsideIsPositiveInOneMaterialOnly) {
  const std::vector<FieldSample> f{{0.5f, {}}, {2, {}}, {-1, {}}};
  EXPECT_LT(inside_outside(f.data(), 3, 0).value, 0);
  EXPECT_NEAR(inside_outside(f.data(), 3, 1).value, 1.5f, 1e-4f);
  EXPECT_LT(inside_outside(f.data(), 3, 2).value, 0);
}

TEST(SmoothMaximum, ValuesFarApartDoNotOverflow) {
  const std::vector<FieldSample> f{{1e6f, Vec3f(1, 0, 0)}, {-1e6f, Vec3f(0, 1, 0)}, {-1e6f, {}}, {0, {}}, {-5e5f, {}}};
  const FieldSample s = smooth_maximum(f.data(), 5);
  EXPECT_NEAR(s.value, 1e6f, 1);
  EXPECT_NEAR(s.gradient.x, 1, 1e-5f);
  EXPECT_TRUE(is_finite(s.gradient));
}

}  // namespace
}  // namespace nacre
