// Nacre: Selling's decomposition against the tensor that it is of.
#include "compute/math/selling.hpp"

#include <gtest/gtest.h>

#include "tests/compute/meshes.hpp"

namespace nacre::test {
namespace {

TEST(Selling, StepsAndTheirOppositesAreOneDirection) {
  int along_axes = 0;
  for (int n = 0; n <= GridSteps::neighbours; ++n) {
    EXPECT_EQ(GridSteps::number(GridSteps::step(n)), n);
    if (n == GridSteps::middle) continue;
    EXPECT_EQ(GridSteps::direction(n), GridSteps::direction(GridSteps::neighbours - n));
    EXPECT_GE(GridSteps::direction(n), 0);
    EXPECT_LT(GridSteps::direction(n), GridSteps::directions);
    const Int3 step = GridSteps::step(n);
    const bool along = dot(step, step) == 1;
    EXPECT_EQ(GridSteps::is_along_axis(n), along) << n;
    along_axes += along;
  }
  EXPECT_EQ(along_axes, 6);
}

/// Sum of w e e^T, entry (i, j).
double entry(const float* weight, int i, int j) {
  double sum = 0;
  for (int d = 0; d < GridSteps::directions; ++d) {
    const Int3 e = GridSteps::step(GridSteps::middle + 1 + d);
    sum += double(weight[d]) * e[i] * e[j];
  }
  return sum;
}

void expect_tensor(const Vec3f& t, float extra) {
  float weight[GridSteps::directions];
  selling_weights(t, extra, weight);
  double sum = 0;
  for (const float w : weight) {
    EXPECT_GE(w, 0);
    sum += w;
  }
  EXPECT_LE(sum, 3 + extra + 1e-4) << "the bound of the step";
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(entry(weight, i, j), (i == j) + double(extra) * t[i] * t[j], 2e-5) << t.x << " " << t.y << " " << t.z;
}

TEST(Selling, WeightsAreNotNegativeAndMakeTheTensor) {
  Random random(3);
  for (int k = 0; k < 3000; ++k) {
    const Vec3f t(normalized(random.point(-1, 1)));
    const double stretch = random.between(1, most_stretch);
    expect_tensor(t, float(stretch * stretch - 1));
    expect_tensor(t, float(most_stretch * most_stretch - 1));
  }
}

TEST(Selling, DirectionsOfTheGridToo) {
  for (int n = 0; n <= GridSteps::neighbours; ++n)
    expect_tensor(Vec3f(normalized(Vec3d(GridSteps::step(n)))), n == GridSteps::middle ? 0 : 4.76f);
}

TEST(Selling, WithoutAVectorTheSixNeighboursCountAlike) {
  float weight[GridSteps::directions];
  selling_weights({}, 0, weight);
  for (int n = GridSteps::middle + 1; n <= GridSteps::neighbours; ++n)
    EXPECT_EQ(weight[GridSteps::direction(n)], GridSteps::is_along_axis(n) ? 1.0f : 0.0f);
}

}  // namespace
}  // namespace nacre::test
