// Nacre: dye on planes and spheres, whose mass and shape are known.
#include "compute/transport/dye.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "compute/device/error.hpp"
#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

std::vector<std::uint32_t> points_where(const Shape& shape, const std::function<bool(const Vec3d&)>& is) {
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < shape.points.size(); ++i)
    if (is(shape.points[i])) points.push_back(i);
  return points;
}

/// The part of a sphere within 0.6 radii of the point x.
std::vector<std::uint32_t> dyed_cap(const Shape& sphere) {
  return points_where(sphere, [](const Vec3d& p) { return length(p - Vec3d(1, 0, 0)) < 0.6; });
}

Vec3d about_z(const Vec3d& p) { return {-p.y, p.x, 0}; }

TEST(Dye, KeepsItsMassOnAClosedSurface) {
  const Shape sphere = divided_sphere(4);
  const std::vector<Vec3f> to_a_pole = vectors_on(sphere, [](const Vec3d& p) { return on_sphere({0.3, 0.2, 1}, p); });
  Dye dye(sphere.points.size(), sphere.triangles, 0.01);
  dye.release(sphere.points, dyed_cap(sphere));
  const double begun = dye.mass();
  EXPECT_DOUBLE_EQ(begun, dye.released());
  EXPECT_NEAR(begun, std::numbers::pi * 0.6 * 0.6, 0.05);
  for (int k = 0; k < 500; ++k) dye.step(sphere.points, 0.02, to_a_pole, to_a_pole);
  EXPECT_NEAR(dye.mass(), begun, 1e-10 * begun) << "most of it near a sink";
  EXPECT_EQ(dye.left(), 0);
  const std::vector<float> c = dye.concentration(sphere.points);
  EXPECT_GT(*std::max_element(c.begin(), c.end()), 5) << "it gathers there";
}

/// After one turn of a cap of dye: how wide its edge has become, in edges of triangles, and how far concentrations are
/// off in the mean, as a share of the cap's area.
struct DyeTurned {
  double width = 0, difference = 0, low = 0, high = 0;
};
DyeTurned after_a_turn(int levels) {
  const Shape sphere = divided_sphere(levels);
  const std::vector<Vec3f> spinning = vectors_on(sphere, about_z);
  Dye dye(sphere.points.size(), sphere.triangles, 0);
  dye.release(sphere.points, dyed_cap(sphere));
  const std::vector<float> before = dye.concentration(sphere.points);
  for (int k = 0; k < 20; ++k) dye.step(sphere.points, 2 * std::numbers::pi / 20, spinning, spinning);
  const std::vector<float> after = dye.concentration(sphere.points);
  double between = 0, difference = 0, whole = 0;
  DyeTurned result;
  for (std::size_t i = 0; i < after.size(); ++i) {
    between += after[i] > 0.1 && after[i] < 0.9;
    difference += std::fabs(after[i] - before[i]);
    whole += before[i];
  }
  const double area = 4 * std::numbers::pi / double(after.size());  // of a point
  const double rim = 2 * std::numbers::pi * 0.6 * std::sqrt(1 - 0.09);
  result.width =
      between * area / rim / std::sqrt(4 * std::numbers::pi / double(sphere.triangles.size()) * 4 / std::sqrt(3.0));
  result.difference = difference / whole;
  result.low = *std::min_element(after.begin(), after.end());
  result.high = *std::max_element(after.begin(), after.end());
  return result;
}

TEST(Dye, KeepsASharpEdge) {
  const DyeTurned coarse = after_a_turn(4), fine = after_a_turn(5);
  for (const DyeTurned& each : {coarse, fine}) {
    EXPECT_GE(each.low, 0);
    EXPECT_LT(each.high, 1.15);
    EXPECT_LT(each.width, 5) << "edges, from a tenth to nine tenths";
  }
  EXPECT_LT(fine.difference, 0.7 * coarse.difference);
}

TEST(Dye, LeavesOverARimAndIsCounted) {
  const Shape plate = square(40);
  const std::vector<Vec3f> along = vectors_on(plate, [](const Vec3d&) { return Vec3d(1, 0, 0); });
  Dye dye(plate.points.size(), plate.triangles, 0);
  dye.release(plate.points, points_where(plate, [](const Vec3d& p) { return std::fabs(p.x) < 0.2; }));
  const double begun = dye.mass();
  EXPECT_NEAR(begun, 0.4, 0.02);
  double before = 0;
  for (int k = 0; k < 40; ++k) {
    dye.step(plate.points, 0.025, along, along);
    EXPECT_NEAR(dye.mass() + dye.left(), begun, 1e-12);
    EXPECT_GE(dye.left(), before);
    before = dye.left();
    if (k == 9) {
      EXPECT_LT(dye.left(), 0.01 * begun) << "its front is 0.04 from the rim";
    }
    if (k == 19) {
      EXPECT_NEAR(dye.left(), 0.5 * begun, 0.1 * begun);
    }
  }
  EXPECT_NEAR(dye.left(), begun, 1e-3 * begun);
}

TEST(Dye, DiffusesAsTheHeatEquation) {
  // On the unit sphere z is an eigenfunction: 1 + z becomes 1 + z exp(-2 D t).
  double errors[2];
  for (const int levels : {3, 4}) {
    const Shape sphere = divided_sphere(levels);
    const std::vector<Vec3f> nothing(sphere.points.size());
    Dye dye(sphere.points.size(), sphere.triangles, 0.5);
    std::vector<std::uint32_t> half = points_where(sphere, [](const Vec3d& p) { return p.z > 0; });
    dye.release(sphere.points, half);
    // The part along z of a hemisphere of dye: 3/4 at first.
    const auto part = [&] {
      const std::vector<float> c = dye.concentration(sphere.points);
      double along = 0, norm = 0;
      for (std::size_t i = 0; i < c.size(); ++i) {
        along += c[i] * sphere.points[i].z;
        norm += sphere.points[i].z * sphere.points[i].z;
      }
      return along / norm;
    };
    const double begun = part();
    EXPECT_NEAR(begun, 0.75, 0.06);
    EXPECT_GT(dye.step(sphere.points, 0.5, nothing, nothing), 3) << "sub-steps";
    errors[levels - 3] = std::fabs(part() / begun - std::exp(-0.5));
  }
  for (const double each : errors) EXPECT_LT(each, 0.003);
}

TEST(Dye, StaysWithAShapeThatGrows) {
  const Shape sphere = divided_sphere(3);
  const std::vector<Vec3f> nothing(sphere.points.size());
  Dye dye(sphere.points.size(), sphere.triangles, 0);
  dye.release(sphere.points, dyed_cap(sphere));
  std::vector<Vec3d> larger = sphere.points;
  for (Vec3d& p : larger) p *= 2;
  const double begun = dye.mass();
  dye.step(larger, 1, nothing, nothing);
  EXPECT_DOUBLE_EQ(dye.mass(), begun);
  const std::vector<float> thin = dye.concentration(larger);
  EXPECT_FLOAT_EQ(*std::max_element(thin.begin(), thin.end()), 0.25f);
}

TEST(Dye, BytesDoNotDependOnThreads) {
  const auto run = [] {
    const Shape sphere = divided_sphere(4);
    const std::vector<Vec3f> spinning = vectors_on(sphere, about_z);
    Dye dye(sphere.points.size(), sphere.triangles, 0.001);
    dye.release(sphere.points, dyed_cap(sphere));
    dye.step(sphere.points, 1, spinning, spinning);
    return dye.concentration(sphere.points);
  };
  const std::vector<float> many = run();
  tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(many, run());
}

TEST(Dye, SaysWhatIsTooMuch) {
  const Shape plate = square(10);
  const std::vector<Vec3f> nothing(plate.points.size());
  Dye dye(plate.points.size(), plate.triangles, 1e9);
  EXPECT_THROW(dye.step(plate.points, 1, nothing, nothing), Error);
  const std::atomic<bool> stop = true;
  Dye other(plate.points.size(), plate.triangles, 1);
  EXPECT_THROW(other.step(plate.points, 1, nothing, nothing, &stop), Interrupted);
}

}  // namespace
}  // namespace nacre::test
