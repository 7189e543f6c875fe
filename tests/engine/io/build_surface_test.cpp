// Nacre: tests of the way from a raw mesh to a surface.
#include "engine/io/build_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "compute/device/error.hpp"
#include "engine/io/triangulate.hpp"

namespace nacre {
namespace {

void add(RawMesh& mesh, std::initializer_list<int> corners) {
  for (const int corner : corners) mesh.add_corner(corner);
  mesh.close_polygon();
}

double signed_area(const std::vector<Triangle>& triangles, const std::vector<Vec3d>& points) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += cross(points[t.b] - points[t.a], points[t.c] - points[t.a]).z / 2;
  return sum;
}

TEST(Triangulate, ConcaveQuadIsCutInside) {
  const std::vector<Vec3d> points = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}};
  std::vector<Triangle> triangles;
  triangulate(std::array<std::uint32_t, 4>{0, 1, 2, 3}, points, triangles);
  ASSERT_EQ(triangles.size(), 2u);
  for (const Triangle& t : triangles) EXPECT_GT(signed_area({t}, points), 0);
  EXPECT_DOUBLE_EQ(signed_area(triangles, points), 1.5);
}

TEST(Triangulate, QuadTakesTheShorterDiagonal) {
  const std::vector<Vec3d> points = {{0, 0, 0}, {2, -0.5, 0}, {4, 0, 0}, {2, 0.5, 0}};
  std::vector<Triangle> triangles;
  triangulate(std::array<std::uint32_t, 4>{0, 1, 2, 3}, points, triangles);
  EXPECT_EQ(triangles[0], (Triangle{0, 1, 3}));
}

TEST(Triangulate, StarKeepsItsArea) {
  // Ten corners, alternately at radius 1 and 0.3: area n r1 r2 sin(pi / n) for n = 5 points.
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> corners;
  for (int i = 0; i < 10; ++i) {
    const double angle = i * std::numbers::pi / 5, radius = i % 2 ? 0.3 : 1.0;
    points.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    corners.push_back(std::uint32_t(i));
  }
  std::vector<Triangle> triangles;
  triangulate(corners, points, triangles);
  ASSERT_EQ(triangles.size(), 8u);
  for (const Triangle& t : triangles) EXPECT_GT(signed_area({t}, points), 0);
  EXPECT_NEAR(signed_area(triangles, points), 5 * 0.3 * std::sin(std::numbers::pi / 5), 1e-12);
}

TEST(Triangulate, APolygonIsTheSameFromWhicheverCornerItBegins) {
  // Without its first triangle, the fan of the first corner is the wrong way round.
  const std::vector<Vec3d> points = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1.2, 0}, {0.8, 1, 0}};
  for (std::uint32_t first = 0; first < 5; ++first) {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t i = 0; i < 5; ++i) corners.push_back((first + i) % 5);
    std::vector<Triangle> triangles;
    triangulate(corners, points, triangles);
    ASSERT_EQ(triangles.size(), 3u);
    for (const Triangle& t : triangles) EXPECT_GT(signed_area({t}, points), 0) << first;
    EXPECT_NEAR(signed_area(triangles, points), 6.02, 1e-12) << first;
  }
}

TEST(Triangulate, LargePolygonsEnd) {
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> corners;
  for (std::uint32_t i = 0; i < 50000; ++i) {
    points.push_back({double(i * 7919 % 1000), double(i * 104729 % 997), 0});
    corners.push_back(i);
  }
  std::vector<Triangle> triangles;
  triangulate(corners, points, triangles);
  EXPECT_EQ(triangles.size(), 49998u);
}

/// The cap of a cylinder, in the precision of files: a fan of it would be 60,000 slivers as long as it is wide.
TEST(Triangulate, RoundFacesHaveFewLongTriangles) {
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> corners;
  constexpr std::uint32_t n = 60000;
  for (std::uint32_t i = 0; i < n; ++i) {
    const double angle = i * 2 * std::numbers::pi / n;
    points.push_back(Vec3d(Vec3f(Vec3d(std::cos(angle), std::sin(angle), 0))));
    corners.push_back(i);
  }
  std::vector<Triangle> triangles;
  triangulate(corners, points, triangles);
  ASSERT_EQ(triangles.size(), n - 2);
  EXPECT_NEAR(signed_area(triangles, points), std::numbers::pi, 1e-6);
  double lengths = 0;
  for (const Triangle& t : triangles) lengths += length(points[t.c] - points[t.a]);
  EXPECT_LT(lengths, 120) << "a fan's are 76,000";
  std::vector<Triangle> square;
  std::vector<Vec3d> rim;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const double along = (i % 100) / 100.0;
    rim.push_back(i < 100   ? Vec3d(along, 0, 0)
                  : i < 200 ? Vec3d(1, along, 0)
                  : i < 300 ? Vec3d(1 - along, 1, 0)
                            : Vec3d(0, 1 - along, 0));
  }
  triangulate(std::span(corners).first(400), rim, square);
  std::vector<char> used(400, 0);
  for (const Triangle& t : square)
    if (signed_area({t}, rim) > 1e-12)
      for (int k = 0; k < 3; ++k) used[t[k]] = 1;
  EXPECT_GT(std::count(used.begin(), used.end(), 1), 200) << "corners on straight sides keep triangles";
}

TEST(BuildSurface, CellArraysBecomeMeansWeightedByArea) {
  RawMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -3, 0}};
  add(mesh, {0, 1, 2});  // area 0.5
  add(mesh, {0, 3, 1});  // area 1.5
  mesh.cell_arrays = {{"c", 1, {4, 8}}};
  std::vector<std::string> warnings;
  const Surface surface = build_surface(mesh, "test", warnings);
  EXPECT_EQ(surface.find("c")->values, (std::vector<float>{7, 7, 4, 8}));
  EXPECT_TRUE(warnings.empty());
}

TEST(BuildSurface, UnusedPointsGoWithTheirValues) {
  RawMesh mesh;
  mesh.points = {{9, 9, 9}, {0, 0, 0}, {8, 8, 8}, {1, 0, 0}, {0, 1, 0}};
  add(mesh, {1, 3, 4});
  mesh.point_arrays = {{"a", 1, {0, 1, 2, 3, 4}}, {"b", 3, std::vector<float>(15, 2)}};
  std::vector<std::string> warnings;
  const Surface surface = build_surface(mesh, "test", warnings);
  ASSERT_EQ(surface.points.size(), 3u);
  EXPECT_EQ(surface.points[1], Vec3d(1, 0, 0));
  EXPECT_EQ(surface.triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(surface.find("a")->values, (std::vector<float>{1, 3, 4}));
  EXPECT_EQ(surface.find("b")->size(), 3u);
  EXPECT_TRUE(warnings.empty());
}

TEST(BuildSurface, BadValuesBecomeZeroAndAreCounted) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  RawMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  add(mesh, {0, 1, 2});
  mesh.point_arrays = {{"u", 3, {nan, inf, 1, 2, 2, 2, 3, 3, -inf}}, {"short", 1, {1, 2}}};
  std::vector<std::string> warnings;
  const Surface surface = build_surface(mesh, "test", warnings);
  EXPECT_EQ(surface.find("u")->values, (std::vector<float>{0, 0, 1, 2, 2, 2, 3, 3, 0}));
  EXPECT_EQ(surface.find("short"), nullptr);
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0], "test: array 'short' dropped: it has 2 entries where 3 belong.");
  EXPECT_EQ(warnings[1], "test: array 'u' is NaN or infinite at 2 of 3 positions, set to 0.");
}

TEST(BuildSurface, WhatOnlyColoursKeepsItsGaps) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  RawMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  add(mesh, {0, 1, 2});
  mesh.point_arrays = {{"p", 1, {nan, 2, inf}}};
  std::vector<std::string> warnings;
  const Surface surface = build_surface(mesh, "test", warnings);
  const std::vector<float>& values = surface.find("p")->values;
  EXPECT_TRUE(std::isnan(values[0]) && std::isnan(values[2]));
  EXPECT_EQ(values[1], 2);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "test: array 'p' is NaN or infinite at 2 of 3 positions, drawn in the colour of NaN.");
}

TEST(BuildSurface, NothingLeftIsAnErrorThatSaysWhy) {
  RawMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  add(mesh, {0, 1, 2});
  std::vector<std::string> warnings;
  try {
    build_surface(mesh, "flat", warnings);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("1 of 1 triangles dropped: zero area"), std::string::npos);
  }
}

TEST(BuildSurface, ThinTrianglesStay) {
  RawMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}};
  add(mesh, {0, 1, 2});
  std::vector<std::string> warnings;
  EXPECT_EQ(build_surface(mesh, "thin", warnings).triangles.size(), 1u);
}

TEST(BuildSurface, CommasGroupThousands) {
  EXPECT_EQ(with_commas(7), "7");
  EXPECT_EQ(with_commas(1000), "1,000");
  EXPECT_EQ(with_commas(1234567), "1,234,567");
}

}  // namespace
}  // namespace nacre
