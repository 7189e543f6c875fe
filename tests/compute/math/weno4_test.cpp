// Nacre: WENO4 interpolation in one dimension.
#include "compute/math/weno4.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "compute/math/lanes.hpp"

namespace nacre {
namespace {

template <class F>
double weno4_of(const F& f, double at, double h, double x) {
  return weno4(float(f(at - h)), float(f(at)), float(f(at + h)), float(f(at + 2 * h)), float(x));
}

TEST(Weno4, ParabolasAreReproduced) {
  auto f = [](double x) { return 0.7 - 1.3 * x + 0.4 * x * x; };
  for (int i = 0; i <= 20; ++i) EXPECT_NEAR(weno4_of(f, 2, 1, i / 20.0), f(2 + i / 20.0), 2e-6);
}

TEST(Weno4, PassesThroughItsMiddleSamples) {
  EXPECT_NEAR(weno4(3.0f, -1.0f, 7.0f, 2.0f, 0.0f), -1, 1e-6);
  EXPECT_NEAR(weno4(3.0f, -1.0f, 7.0f, 2.0f, 1.0f), 7, 1e-6);
}

TEST(Weno4, TheIdealWeightsReproduceCubics) {  // the two parabolas that weno4 weighs, with (2 - x) / 3 and (1 + x) / 3
  auto f = [](double x) { return 1 + x - 2 * x * x + 0.5 * x * x * x; };
  const double f1 = f(-1), f2 = f(0), f3 = f(1), f4 = f(2);
  for (int i = 0; i <= 20; ++i) {
    const double x = i / 20.0, y = 1 - x;
    const double left = f2 + (0.5 * (f3 - f1) + 0.5 * (f1 - 2 * f2 + f3) * x) * x;
    const double right = f3 + (0.5 * (f2 - f4) + 0.5 * (f4 - 2 * f3 + f2) * y) * y;
    EXPECT_NEAR((2 - x) / 3 * left + (1 + x) / 3 * right, f(x), 1e-12);
  }
}

/// Largest error over the unit interval with `n` samples per unit.
double error_at(int n) {
  auto f = [](double x) { return std::sin(2 * x + 0.3); };
  double worst = 0;
  for (int i = 1; i + 2 <= n; ++i)
    for (int k = 0; k <= 10; ++k) {
      const double h = 1.0 / n, x = k / 10.0;
      worst = std::max(worst, std::fabs(weno4_of(f, i * h, h, x) - f((i + x) * h)));
    }
  return worst;
}

TEST(Weno4, TheErrorOnSmoothDataFallsWithOrderThree) {
  const double e[] = {error_at(6), error_at(12), error_at(24)};
  for (int k = 0; k < 2; ++k) EXPECT_GE(std::log2(e[k] / e[k + 1]), 3.0) << e[k] << " " << e[k + 1];
}

TEST(Weno4, DoesNotOvershootAStep) {
  for (int i = 0; i <= 100; ++i) {
    const float x = float(i) / 100;
    for (const float v :
         {weno4(0.0f, 0.0f, 0.0f, 1.0f, x), weno4(0.0f, 0.0f, 1.0f, 1.0f, x), weno4(0.0f, 1.0f, 1.0f, 1.0f, x)}) {
      EXPECT_GT(v, -1e-3f) << x;
      EXPECT_LT(v, 1 + 1e-3f) << x;
    }
  }
}

TEST(Weno4, IsSymmetric) {
  for (int i = 0; i <= 10; ++i) {
    const float x = float(i) / 10;
    EXPECT_NEAR(weno4(1.0f, -2.0f, 4.0f, 3.0f, x), weno4(3.0f, 4.0f, -2.0f, 1.0f, 1 - x), 1e-5);
  }
}

TEST(Weno4, LanesAgreeWithFloats) {
  const Float4 f[4] = {{1, 0, 5, -1}, {2, 0, 3, -2}, {4, 1, 1, 0.5f}, {3, 1, 2, 7}};
  for (int i = 0; i <= 10; ++i) {
    const float x = float(i) / 10;
    const Float4 v = store(weno4(load(f[0]), load(f[1]), load(f[2]), load(f[3]), x));
    EXPECT_NEAR(v.x, weno4(f[0].x, f[1].x, f[2].x, f[3].x, x), 1e-5);
    EXPECT_NEAR(v.y, weno4(f[0].y, f[1].y, f[2].y, f[3].y, x), 1e-5);
    EXPECT_NEAR(v.z, weno4(f[0].z, f[1].z, f[2].z, f[3].z, x), 1e-5);
    EXPECT_NEAR(v.w, weno4(f[0].w, f[1].w, f[2].w, f[3].w, x), 1e-5);
  }
}

#if !defined(__CUDACC__)
TEST(Lanes, RowsKeepTheirNodesInOrder) {
  const Float4 f[4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}, {12, 13, 14, 15}};
  const Row r = row(f[0], f[1], f[2], f[3]);
  for (int k = 0; k < 16; ++k) EXPECT_EQ(r[k], float(k));
  EXPECT_EQ(store(node<2>(r)).y, 9.0f);
  EXPECT_EQ(xyz(node<3>(r)), Vec3f(12, 13, 14));
}
#endif

}  // namespace
}  // namespace nacre
