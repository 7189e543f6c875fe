// Nacre: tests of the graded lattice.
#include "compute/meshing/lattice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

double nearest(const std::vector<Vec3d>& points, const Vec3d& p) {
  double best = std::numeric_limits<double>::max();
  for (const Vec3d& q : points)
    if (!(q == p)) best = std::min(best, length(q - p));
  return best;
}

TEST(Lattice, IsBodyCentredWhereSizesAreEven) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 1000; ++i) points.push_back({double(i % 10), double(i / 10 % 10), double(i / 100)});
  const std::vector<Vec3d> lattice = graded_lattice(points, std::vector<double>(points.size(), 1.0), {});
  EXPECT_TRUE(
      std::is_sorted(lattice.begin(), lattice.end(), [](const Vec3d& p, const Vec3d& q) { return p.z < q.z - 1e-2; }));
  int inner = 0;
  for (const Vec3d& p : lattice) {
    if (std::min({p.x, p.y, p.z}) < 2 || std::max({p.x, p.y, p.z}) > 7) continue;
    ++inner;
    EXPECT_NEAR(nearest(lattice, p), std::sqrt(0.75), 2e-3);
  }
  EXPECT_NEAR(inner, 250, 60);  // two per cube
}

TEST(Lattice, GrowsWithTheDistanceAndNotTooFast) {
  const std::vector<Vec3d> points = test::points_on_sphere(700, 1);
  const std::vector<double> size(points.size(), 0.14);
  const std::vector<Vec3d> lattice = graded_lattice(points, size, {});
  double centre = 0, rim = 1e9;
  for (const Vec3d& p : lattice) {
    const double edge = nearest(lattice, p);
    if (length(p) < 0.3) centre = std::max(centre, edge);
    if (length(p) < 1 && length(p) > 0.9) {
      rim = std::min(rim, edge);
      EXPECT_LE(edge, 0.22);
    }
  }
  EXPECT_GE(rim, 0.05);
  EXPECT_GE(centre, 1.5 * 0.14);
  EXPECT_LE(centre, 8 * 0.14);
  EXPECT_TRUE(lattice == graded_lattice(points, size, {}));
  const EdgeLength even = [](std::span<const Vec3d> positions) { return std::vector<float>(positions.size(), 0.14f); };
  EXPECT_GT(graded_lattice(points, size, even).size(), lattice.size() * 3 / 2);
}

TEST(Lattice, TakesSizesOfAnyRange) {
  const std::vector<Vec3d> points = {{0, 0, 0}, {1, 1, 1}, {1000, 0, 0}};
  const std::vector<Vec3d> lattice = graded_lattice(points, std::vector<double>{1e-4, 1e-3, 100}, {});
  EXPECT_LT(lattice.size(), 100'000u);
  double closest = 1e9;
  for (const Vec3d& p : lattice) closest = std::min(closest, length(p));
  EXPECT_LT(closest, 2e-3);  // as deep as the tree goes
  EXPECT_TRUE(graded_lattice({}, {}, {}).empty());
}

}  // namespace
}  // namespace nacre
