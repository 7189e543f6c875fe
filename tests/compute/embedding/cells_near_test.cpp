// Nacre: the cells near a triangle against all cells.
#include "compute/embedding/cells_near.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/compute/meshes.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test {
namespace {

/// Visits per cell, x fastest.
std::vector<int> visits_of(const Corners& t, double margin, Int3 dims) {
  std::vector<int> visits(std::size_t(dims.x) * dims.y * dims.z);
  for_cells_near(t, margin, dims, [&](const Int3& c) {
    ASSERT_TRUE(c.x >= 0 && c.y >= 0 && c.z >= 0 && c.x < dims.x && c.y < dims.y && c.z < dims.z);
    ++visits[(std::size_t(c.z) * dims.y + c.y) * dims.x + c.x];
  });
  return visits;
}

double distance(const Corners& t, const Vec3d& p) { return length(closest_point(t, p) - p); }

/// A lower bound of the distance between the triangle and the cell is enough to say that a visit was missed only where
/// some point of the cell is surely near: the cell's point closest to the triangle, found by alternating projections.
double distance_to_cell(const Corners& t, const Vec3d& centre) {
  const Vec3d low = centre - Vec3d(0.5), high = centre + Vec3d(0.5);
  Vec3d p = centre;
  for (int k = 0; k < 200; ++k) p = max(low, min(high, closest_point(t, p)));
  return distance(t, p);
}

void check(const Corners& t, double margin, Int3 dims) {
  const std::vector<int> visits = visits_of(t, margin, dims);
  std::size_t at = 0, wrong = 0;
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x, ++at) {
        const Vec3d centre{x + 0.5, y + 0.5, z + 0.5};
        ASSERT_LE(visits[at], 1);
        if (margin == 0) {
          wrong += touches_cube(t, centre, 0.5 + 1e-7) != (visits[at] == 1);
          continue;
        }
        const double d = distance(t, centre);
        if (visits[at])
          wrong += d > margin + 0.8661;
        else if (d < margin + 0.8661)
          wrong += d <= margin || distance_to_cell(t, centre) <= margin;
      }
  EXPECT_EQ(wrong, 0u) << "margin " << margin << ", a " << t.a.x << " " << t.a.y << " " << t.a.z << ", b " << t.b.x
                       << " " << t.b.y << " " << t.b.z << ", c " << t.c.x << " " << t.c.y << " " << t.c.z;
}

void check_margins(const Corners& t, Int3 dims) {
  for (const double margin : {0.0, 0.7, 4.47}) check(t, margin, dims);
}

TEST(CellsNear, OneSmallTriangleByHand) {
  const std::vector<int> visits = visits_of({{1.2, 1.2, 1.5}, {2.4, 1.2, 1.5}, {1.2, 1.4, 1.5}}, 0, {4, 4, 4});
  std::vector<int> expected(64);
  expected[(1 * 4 + 1) * 4 + 1] = expected[(1 * 4 + 1) * 4 + 2] = 1;
  EXPECT_EQ(visits, expected);
}

TEST(CellsNear, RandomTriangles) {
  Random random(11);
  for (int k = 0; k < 60; ++k) {
    const double size = k % 2 ? 3 : 10;
    const Vec3d p = random.point(0, 16);
    check_margins({p, p + random.point(-size, size), p + random.point(-size, size)}, {17, 15, 16});
  }
}

TEST(CellsNear, FiftyCellsWide) {
  check_margins({{2.3, 1.1, 4.9}, {52.8, 3.2, 9.1}, {20.4, 51.7, 2.2}}, {56, 54, 14});
  check_margins({{4.9, 2.3, 1.1}, {9.1, 52.8, 3.2}, {2.2, 20.4, 51.7}}, {14, 56, 54});
  check({{1, 1, 1}, {50, 49, 48}, {3, 50, 20}}, 0, {54, 54, 54});
}

TEST(CellsNear, AxisAlignedOnFacesAndCentres) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double height : {5.0, 5.5, 5.25}) {
      Corners t{{2, 2, 2}, {9, 2, 2}, {2, 9, 2}};
      const Vec3d in[3] = {{2, 3, height}, {9, 3, height}, {4, 9, height}};
      Vec3d* out[3] = {&t.a, &t.b, &t.c};
      for (int k = 0; k < 3; ++k) *out[k] = {in[k][axis], in[k][(axis + 1) % 3], in[k][(axis + 2) % 3]};
      check_margins(t, {12, 12, 12});
    }
}

TEST(CellsNear, WithoutArea) {
  check_margins({{3.3, 4.4, 5.5}, {3.3, 4.4, 5.5}, {3.3, 4.4, 5.5}}, {10, 10, 10});
  check_margins({{4, 4, 4}, {4, 4, 4}, {4, 4, 4}}, {10, 10, 10});
  check_margins({{1.1, 1.2, 1.3}, {12.3, 9.1, 14.7}, {12.3, 9.1, 14.7}}, {16, 16, 16});
  Random random(12);
  for (int k = 0; k < 40; ++k) {
    const Vec3d a = random.point(0, 20), b = random.point(0, 20);
    const Vec3d side = random.point(-1, 1) * (k % 2 ? 1e-9 : 0.0);
    check({a, b, a + (b - a) * random() + side}, 0, {20, 20, 20});
  }
}

TEST(CellsNear, EveryCellAlongANeedleIsFound) {
  Random random(14);
  const Int3 dims{50, 50, 50};
  for (int k = 0; k < 200; ++k) {
    const Vec3d a = random.point(0, 50), b = random.point(0, 50);
    const std::vector<int> visits = visits_of({a, b, a + (b - a) * random()}, 0, dims);
    for (int i = 0; i <= 1000; ++i) {
      const Vec3d p = a + (b - a) * (i / 1000.0);
      ASSERT_EQ(visits[(std::size_t(p.z) * 50 + std::size_t(p.y)) * 50 + std::size_t(p.x)], 1) << k;
    }
  }
}

TEST(CellsNear, OutsideOfTheGrid) {
  const Int3 dims{8, 8, 8};
  const std::vector<int> far = visits_of({{20, 20, 20}, {21, 20, 20}, {20, 21, 20}}, 3, dims);
  EXPECT_EQ(std::count(far.begin(), far.end(), 0), 8 * 8 * 8);
  check_margins({{-5, -5, -5}, {-4, -5, -5}, {-5, -4, -4}}, dims);
  check_margins({{-30, 4, 3}, {40, 5, 4}, {3, 60, 5}}, dims);
  check_margins({{8, 1, 1}, {12, 1, 1}, {12, 3, 5}}, dims);
  check_margins({{-1, -1, 0}, {-1, 9, 0}, {9, -1, 0}}, dims);
  check_margins({{-3, 2, 2}, {-0.5, 3, 2}, {-2, 2, 5}}, dims);
}

TEST(CellsNear, CostsItsAreaNotItsBox) {  // 1000 cells wide: the box holds 1e9 cells
  std::size_t cells = 0;
  for_cells_near({{1, 1, 1}, {1000, 5, 1000}, {975, 1000, 25}}, 0, {1024, 1024, 1024}, [&](const Int3&) { ++cells; });
  EXPECT_GT(cells, 500'000u);
  EXPECT_LT(cells, 4'000'000u);
}

}  // namespace
}  // namespace nacre::test
