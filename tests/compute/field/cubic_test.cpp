// Nacre: weights of cubic reconstruction: what they reproduce, and that derivatives are those of the values.
#include "compute/field/cubic.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace nacre {
namespace {

struct Weights {
  double value[4], slope[4], curve[4];
  Weights(CubicKernel kernel, float f) {
    const CubicWeights w(kernel, f);
    const Float4 v = store(w.value), s = store(w.slope), c = store(w.curve);
    const float rows[3][4] = {{v.x, v.y, v.z, v.w}, {s.x, s.y, s.z, s.w}, {c.x, c.y, c.z, c.w}};
    for (int k = 0; k < 4; ++k) value[k] = rows[0][k], slope[k] = rows[1][k], curve[k] = rows[2][k];
  }
};

double apply(const double* w, const std::function<double(double)>& f) {
  return w[0] * f(-1) + w[1] * f(0) + w[2] * f(1) + w[3] * f(2);
}

const CubicKernel both[] = {CubicKernel::catmull_rom, CubicKernel::b_spline};

TEST(Cubic, StraightLinesAreReproduced) {
  for (const CubicKernel kernel : both)
    for (int i = 0; i <= 16; ++i) {
      const double x = i / 16.0;
      const Weights w(kernel, float(x));
      const auto line = [](double t) { return 0.3 - 1.7 * t; };
      EXPECT_NEAR(apply(w.value, line), line(x), 1e-6);
      EXPECT_NEAR(apply(w.slope, line), -1.7, 1e-6);
      EXPECT_NEAR(apply(w.curve, line), 0, 2e-6);
    }
}

TEST(Cubic, CatmullRomGoesThroughSamplesAndParabolas) {
  const auto parabola = [](double t) { return 1 + t - 2 * t * t; };
  for (int i = 0; i <= 16; ++i) {
    const double x = i / 16.0;
    const Weights w(CubicKernel::catmull_rom, float(x));
    EXPECT_NEAR(apply(w.value, parabola), parabola(x), 2e-6);
    EXPECT_NEAR(apply(w.slope, parabola), 1 - 4 * x, 4e-6);
    EXPECT_NEAR(apply(w.curve, parabola), -4, 1e-5);
  }
  const Weights at(CubicKernel::catmull_rom, 0);
  EXPECT_EQ(at.value[0], 0);
  EXPECT_EQ(at.value[1], 1);
  EXPECT_EQ(at.value[2], 0);
}

TEST(Cubic, TheBSplineLiftsAParabolaByAThird) {  // of its second derivative's half
  const auto parabola = [](double t) { return t * t; };
  for (int i = 0; i <= 16; ++i) {
    const double x = i / 16.0;
    const Weights w(CubicKernel::b_spline, float(x));
    EXPECT_NEAR(apply(w.value, parabola), x * x + 1.0 / 3, 2e-6);
    EXPECT_NEAR(apply(w.curve, parabola), 2, 4e-6);
  }
}

TEST(Cubic, DerivativesAreThoseOfTheWeights) {
  const double step = 1.0 / 64;
  for (const CubicKernel kernel : both)
    for (int i = 1; i < 16; ++i) {
      const double x = i / 16.0;
      const Weights w(kernel, float(x)), low(kernel, float(x - step)), high(kernel, float(x + step));
      for (int k = 0; k < 4; ++k) {
        // Cubics: the differences are off by a sixth of the third derivative (at most 9) times step^2.
        EXPECT_NEAR((high.value[k] - low.value[k]) / (2 * step), w.slope[k], 1.5 * step * step + 1e-5);
        EXPECT_NEAR((high.slope[k] - low.slope[k]) / (2 * step), w.curve[k], 2e-5);
      }
    }
}

TEST(Cubic, ValuesAndSlopesMeetAtTheSamples) {  // the B-spline's second derivatives do, too
  const double samples[5] = {0.4, -1.0, 2.0, 0.1, 0.7};
  for (const CubicKernel kernel : both) {
    const Weights end(kernel, 1), begin(kernel, 0);
    double left[3] = {}, right[3] = {};
    for (int k = 0; k < 4; ++k) {
      const double* l[3] = {end.value, end.slope, end.curve};
      const double* r[3] = {begin.value, begin.slope, begin.curve};
      for (int d = 0; d < 3; ++d) left[d] += l[d][k] * samples[k], right[d] += r[d][k] * samples[k + 1];
    }
    EXPECT_NEAR(left[0], right[0], 1e-6);
    EXPECT_NEAR(left[1], right[1], 1e-6);
    if (kernel == CubicKernel::b_spline) {
      EXPECT_NEAR(left[2], right[2], 1e-6);
    }
  }
}

}  // namespace
}  // namespace nacre
