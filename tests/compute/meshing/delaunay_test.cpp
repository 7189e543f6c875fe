// Nacre: tests of the Delaunay triangulation of points.
#include "compute/meshing/delaunay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "compute/device/error.hpp"
#include "compute/meshing/circumcentre.hpp"
#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

std::vector<Vec3d> random_points(int count, std::uint32_t seed = 1) {
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    std::uint64_t state = seed * 7919ull + std::uint64_t(i) * 2654435761ull;
    const auto next = [&] {
      state = state * 6364136223846793005ull + 1442695040888963407ull;
      return double(state >> 11) * 0x1p-53;
    };
    next();
    const double x = next(), y = next(), z = next();
    points.push_back({x, y, z});
  }
  return points;
}

double volume(std::span<const Vec3d> points, const std::array<std::uint32_t, 4>& v) {
  const Vec3d a = points[v[0]];
  return dot(points[v[1]] - a, cross(points[v[2]] - a, points[v[3]] - a)) / 6;
}

TEST(Circumcentre, OfACornerOfACubeIsTheCubesCentre) {
  const Vec3d c = circumcentre({1, 1, 1}, {3, 1, 1}, {1, 3, 1}, {1, 1, 3});
  EXPECT_EQ(c, Vec3d(2, 2, 2));
}

TEST(Circumcentre, OfFlatCellsIsFiniteAndOnTheRightSide) {
  // Four points on a flat cap: the centre is far below, at -1 / (2 bulge), until that is out of reach.
  for (const double bulge : {1e-1, 1e-6, 1e-17, 0.0}) {
    const auto on_cap = [&](double x, double y) { return Vec3d(x, y, -bulge * (x * x + y * y)); };
    const Vec3d c = circumcentre(on_cap(0, 0), on_cap(1, 1), on_cap(1, 0), on_cap(0, 1.5));
    ASSERT_TRUE(is_finite(c)) << bulge;
    EXPECT_LE(length(c), circumcentre_reach * 2.0);
    if (bulge > 1e-10) {
      EXPECT_LT(c.z, 0) << bulge;
    }
  }
  EXPECT_TRUE(is_finite(circumcentre({1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3})));
}

TEST(Delaunay, FiveCellsOrFewerOfACube) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 8; ++i) points.push_back({double(i & 1), double(i >> 1 & 1), double(i >> 2)});
  const DelaunayCells cells = delaunay(points);  // all eight on one sphere
  double total = 0;
  for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
    EXPECT_GT(volume(points, cells.vertices[i]), 0);
    total += volume(points, cells.vertices[i]);
    EXPECT_NEAR(length(cells.circumcentres[i] - Vec3d(0.5)), 0, 1e-12);
  }
  EXPECT_NEAR(total, 1, 1e-12);
  EXPECT_TRUE(cells.vertices.size() == 5 || cells.vertices.size() == 6) << cells.vertices.size();
}

TEST(Delaunay, FourPointsAreOneCell) {
  const std::vector<Vec3d> points{{0, 0, 0}, {0, 2, 0}, {2, 0, 0}, {0, 0, 2}};
  Delaunay delaunay;
  const DelaunayCells cells = delaunay.cells(points);
  EXPECT_EQ(cells.vertices, (std::vector<std::array<std::uint32_t, 4>>{{0, 1, 3, 2}}));
  EXPECT_EQ(cells.neighbours, (std::vector<std::array<std::int32_t, 4>>{{-1, -1, -1, -1}}));
  ASSERT_EQ(cells.circumcentres.size(), 1u);
  EXPECT_NEAR(length(cells.circumcentres[0] - Vec3d(1, 1, 1)), 0, 1e-12);
}

TEST(Delaunay, SpheresAreEmptyAndNeighboursAgree) {
  const std::vector<Vec3d> points = random_points(300);
  const DelaunayCells cells = delaunay(points);
  double total = 0;
  for (std::size_t i = 0; i < cells.vertices.size(); ++i) {
    const auto& v = cells.vertices[i];
    total += volume(points, v);
    ASSERT_GT(volume(points, v), 0);
    ASSERT_TRUE(v[0] < v[1] && v[1] < v[2] && v[1] < v[3]);
    const double radius = length(points[v[0]] - cells.circumcentres[i]);
    for (const Vec3d& p : points) ASSERT_GE(length(p - cells.circumcentres[i]), std::min(radius, 10.0) * (1 - 1e-9));
    for (int k = 0; k < 4; ++k) {
      const std::int32_t n = cells.neighbours[i][k];
      if (n < 0) continue;
      const auto& back = cells.neighbours[n];
      const auto side = std::find(back.begin(), back.end(), std::int32_t(i)) - back.begin();
      ASSERT_LT(side, 4);
      for (int j = 0; j < 4; ++j)  // they share all corners but the two opposite of the facet
        ASSERT_EQ(std::count(cells.vertices[n].begin(), cells.vertices[n].end(), v[j]), j != k);
    }
  }
  EXPECT_GT(total, 0.7);  // the hull of 300 points in a unit cube
  EXPECT_LT(total, 1);
}

/// 8,000 at random, 512 on a lattice, full of ties, and 1,000 of them a second time.
std::vector<Vec3d> awkward_points() {
  std::vector<Vec3d> points = random_points(8000);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 8; ++k) points.push_back({2 + i / 8., j / 8., k / 8.});
  for (int i = 0; i < 1000; ++i) points.push_back(points[std::size_t(i) * 7 + 1000]);
  return points;
}

void expect_same(const DelaunayCells& a, const DelaunayCells& b, const std::string& what) {
  EXPECT_TRUE(a.vertices == b.vertices) << what;
  EXPECT_TRUE(a.neighbours == b.neighbours) << what;
  EXPECT_TRUE(a.circumcentres == b.circumcentres) << what;
}

TEST(Delaunay, ThreadsAndDoublesChangeNothing) {
  const std::vector<Vec3d> points = awkward_points();
  const DelaunayCells one = delaunay(points, 1);
  for (const int threads : {2, 0}) expect_same(one, delaunay(points, threads), std::to_string(threads));
  for (const auto& cell : one.vertices)
    for (const std::uint32_t v : cell) ASSERT_LT(v, 8000u + 8 * 8 * 8);
}

TEST(Delaunay, FollowsPointsThatGoAndCome) {
  std::vector<Vec3d> points = awkward_points();
  Delaunay followed(2);
  expect_same(followed.cells(points), delaunay(points), "at first");
  expect_same(followed.cells(points), delaunay(points), "unchanged");
  const auto take_out = [&](std::size_t first, std::size_t step, std::size_t count) {
    for (std::size_t k = count; k-- > 0;) points.erase(points.begin() + std::ptrdiff_t(first + k * step));
  };
  take_out(8000, 5, 100);  // of the lattice
  expect_same(followed.cells(points), delaunay(points), "without some of the lattice");
  take_out(1000, 7, 20);  // one of two that coincide
  expect_same(followed.cells(points), delaunay(points), "without some doubles");
  points.push_back(points[2000]);
  for (const Vec3d& p : random_points(50, 2)) points.push_back(p);
  take_out(0, 3, 10);
  expect_same(followed.cells(points), delaunay(points), "some gone, some new");
  for (std::size_t i = 100; i < 200; i += 2) points[i] += Vec3d(0.01);
  expect_same(followed.cells(points), delaunay(points), "a few moved where they stand");
  std::swap(points[50], points[7000]);
  expect_same(followed.cells(points), delaunay(points), "two have changed their numbers");
  for (const Vec3d& p : random_points(9000, 3)) points.push_back(p * 2.0);
  expect_same(followed.cells(points), delaunay(points), "twice as many, on threads");
  for (std::size_t i = 0; i < points.size(); i += 2) points[i] += Vec3d(0.01);
  expect_same(followed.cells(points), delaunay(points), "many moved");
  const std::atomic<bool> stop = true;
  points.push_back({5, 5, 5});
  EXPECT_THROW(followed.cells(points, &stop), Interrupted);
  expect_same(followed.cells(points), delaunay(points), "after an interruption");
  const std::vector<Vec3d> three = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(followed.cells(three), Error);
  expect_same(followed.cells(points), delaunay(points), "after an error");
}

TEST(Delaunay, RefusesWhatHasNoCells) {
  const std::vector<Vec3d> three = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(delaunay(three), Error);
  EXPECT_THROW(delaunay({}), Error);
  std::vector<Vec3d> flat = random_points(100), same(10, Vec3d(1, 2, 3));
  EXPECT_THROW(delaunay(same), Error);
  for (Vec3d& p : flat) p.z = 0.25;
  EXPECT_THROW(delaunay(flat), Error);
  flat = random_points(6000);
  for (Vec3d& p : flat) p.x = 0;
  EXPECT_THROW(delaunay(flat), Error);  // on many threads
  std::vector<Vec3d> broken = random_points(100);
  broken[50].y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(delaunay(broken), Error);
  broken[50].y = std::numeric_limits<double>::infinity();
  EXPECT_THROW(delaunay(broken), Error);
}

TEST(Delaunay, StopsWhenTold) {
  const std::atomic<bool> stop = true;
  EXPECT_THROW(delaunay(random_points(100), 1, &stop), Interrupted);
  EXPECT_THROW(delaunay(random_points(20000), 2, &stop), Interrupted);
}

}  // namespace
}  // namespace nacre
