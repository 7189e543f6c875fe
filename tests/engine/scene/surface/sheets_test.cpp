// Nacre: two sheets in one place are kept, and told apart by the points that they use.
#include "engine/scene/surface/sheets.hpp"

#include <gtest/gtest.h>

#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/surface_part.hpp"
#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre {
namespace {

using test::cube;

constexpr int n = 4;  // quads along a side of a wall

/// A wall in the plane x = `x`, both sides of which have points and triangles of their own. The quads of one are
/// divided along the other diagonal. `shared_rim`: points on the rim are those of the first side.
void add_wall(Surface& surface, double x, bool shared_rim, bool interleaved) {
  const auto base = std::uint32_t(surface.points.size());
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < (n + 1) * (n + 1); ++k)
      surface.points.push_back({x, 3.0 * (k % (n + 1)) / n, 3.0 * double(k / (n + 1)) / n});
  const auto point = [&](int side, int i, int j) {
    const bool rim = i == 0 || j == 0 || i == n || j == n;
    return base + std::uint32_t((side && !(rim && shared_rim) ? (n + 1) * (n + 1) : 0) + j * (n + 1) + i);
  };
  const auto quad = [&](int side, int i, int j) {
    const std::uint32_t a = point(side, i, j), b = point(side, i + 1, j), c = point(side, i + 1, j + 1),
                        d = point(side, i, j + 1);
    if (side == 0) surface.triangles.insert(surface.triangles.end(), {{a, b, c}, {a, c, d}});
    if (side == 1) surface.triangles.insert(surface.triangles.end(), {{a, d, b}, {b, d, c}});
  };
  for (int k = 0; k < 2 * n * n; ++k) {
    const int cell = interleaved ? k / 2 : k % (n * n), side = interleaved ? (k + k / 2) % 2 : k / (n * n);
    quad(side, cell % n, cell / n);
  }
  surface.arrays = {{"v", 3, std::vector<float>(3 * surface.points.size(), 1.0f)}};
}

/// +1 or -1: along x.
double facing(const PreparedSurface& s, std::size_t t) {
  const Triangle& v = s.triangles[t];
  return normalized(cross(s.points[v.b] - s.points[v.a], s.points[v.c] - s.points[v.a])).x;
}

class Walls : public ::testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(Walls, BothSidesStayAndFaceOppositeWays) {
  Surface in;
  add_wall(in, 0, std::get<0>(GetParam()), std::get<1>(GetParam()));
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(in, 40, &warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(s.triangles.size(), in.triangles.size());
  ASSERT_EQ(s.second_sheet.size(), s.triangles.size());
  for (std::size_t t = 0; t < s.triangles.size(); ++t) {
    const bool second = t >= s.triangles.size() / 2;
    EXPECT_EQ(s.second_sheet[t] != 0, second) << t;
    EXPECT_NEAR(facing(s, t), second ? -1 : 1, 1e-9) << t;
    EXPECT_NEAR(s.corner_normals[3 * t].x, second ? -1 : 1, 1e-6) << "not smoothed with the other side's";
    bool of_second = false, of_first = false;  // by points inside of the rim
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t p = s.triangles[t][k], on_side = p % ((n + 1) * (n + 1));
      const bool rim = on_side % (n + 1) == 0 || on_side % (n + 1) == n || on_side < n + 1 || on_side >= n * (n + 1);
      if (!rim) (p < (n + 1) * (n + 1) ? of_first : of_second) = true;
    }
    EXPECT_FALSE(second ? of_first : of_second) << "sides do not mix";
  }
}

INSTANTIATE_TEST_SUITE_P(With, Walls, ::testing::Combine(::testing::Bool(), ::testing::Bool()));

TEST(Sheets, WhatHasNoPointsOfItsOwnIsADuplicate) {
  Surface in = cube();
  const std::size_t triangles = in.triangles.size();
  for (std::size_t t = 0; t < triangles; ++t)
    in.triangles.push_back({in.triangles[t].a, in.triangles[t].c, in.triangles[t].b});
  in.arrays = {{"v", 3, std::vector<float>(24, 1.0f)}};
  const PreparedSurface s = prepare(in);
  EXPECT_EQ(s.triangles.size(), triangles);
  EXPECT_TRUE(s.second_sheet.empty());
}

TEST(Sheets, WithoutArraysThereIsNothingElseToShow) {
  Surface in;
  add_wall(in, 0, false, false);
  in.arrays.clear();
  const PreparedSurface s = prepare(in);
  EXPECT_TRUE(s.second_sheet.empty());
}

/// A seam, where points are double but nothing lies on anything, and a body that touches itself from the other side.
TEST(Sheets, SeamsAreNoSheets) {
  Surface in = cube();
  const std::vector<Triangle> triangles = in.triangles;
  in.triangles.clear();
  const std::vector<Vec3d> points = std::exchange(in.points, {});
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) in.points.push_back(points[t[k]]);
    const auto p = std::uint32_t(in.points.size());
    in.triangles.push_back({p - 3, p - 2, p - 1});
  }
  in.arrays = {{"v", 3, std::vector<float>(3 * in.points.size(), 1.0f)}};
  const PreparedSurface s = prepare(in);
  EXPECT_EQ(s.triangles.size(), 12u);
  EXPECT_TRUE(s.second_sheet.empty());
}

/// Where the file's closed parts face inwards, so do its walls.
TEST(Sheets, WallsFaceTheWayOfClosedParts) {
  for (const bool inwards : {false, true}) {
    Surface in = cube();
    if (inwards)
      for (Triangle& t : in.triangles) std::swap(t.b, t.c);
    add_wall(in, 5, false, false);
    const PreparedSurface s = prepare(in);
    ASSERT_EQ(s.triangles.size(), in.triangles.size());
    EXPECT_GT(test::six_volumes(s.points, std::vector<Triangle>(s.triangles.begin(), s.triangles.begin() + 12)), 0);
    for (std::size_t t = 12; t < s.triangles.size(); ++t)
      EXPECT_NEAR(facing(s, t), (s.second_sheet[t] != 0) == inwards ? 1 : -1, 1e-9) << t;
  }
}

TEST(Sheets, PartsKeepThem) {
  Surface in;
  add_wall(in, 0, false, false);
  const PreparedSurface s = prepare(in);
  const HalfSpace half{{0, 1, 0}, 1.1};
  const SurfacePart part = cut_surface(s, {&half, 1});
  ASSERT_EQ(part.surface.second_sheet.size(), part.surface.triangles.size());
  double area[2] = {};
  for (std::size_t t = 0; t < part.surface.triangles.size(); ++t) {
    const Triangle& v = part.surface.triangles[t];
    const Vec3d& a = part.surface.points[v.a];
    area[part.surface.second_sheet[t]] += 0.5 * cross(part.surface.points[v.b] - a, part.surface.points[v.c] - a).x;
  }
  EXPECT_NEAR(area[0], 3.3, 1e-9);
  EXPECT_NEAR(area[1], -3.3, 1e-9);
}

}  // namespace
}  // namespace nacre
