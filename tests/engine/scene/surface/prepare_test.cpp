// Nacre: tests of surface preparation: winding, clean-up, corner normals.
#include "engine/scene/surface/prepare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "compute/device/error.hpp"
#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre {
namespace {

using test::cube;
using test::icosphere;
using test::six_volumes;

bool mentions(const std::vector<std::string>& warnings, const std::string& text) {
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const auto& w) { return w.find(text) != std::string::npos; });
}

/// Edges met twice in the same direction.
std::size_t inconsistent_edges(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
  std::size_t twice = 0;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) twice += ++directed[{t[k], t[(k + 1) % 3]}] == 2;
  return twice;
}

Vec3d face_normal(const PreparedSurface& s, std::size_t t) {
  const Triangle& v = s.triangles[t];
  return normalized(cross(s.points[v.b] - s.points[v.a], s.points[v.c] - s.points[v.a]));
}

TEST(Prepare, CubeKeepsItsFacesFlat) {
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(cube(), 40, &warnings);
  EXPECT_TRUE(warnings.empty());
  ASSERT_EQ(s.triangles.size(), 12u);
  ASSERT_EQ(s.corner_normals.size(), 36u);
  for (std::size_t c = 0; c < 36; ++c) EXPECT_NEAR(dot(Vec3d(s.corner_normals[c]), face_normal(s, c / 3)), 1, 1e-6);
}

TEST(Prepare, CubeIsSmoothWhereTheCreaseAllowsIt) {
  const PreparedSurface s = prepare(cube(), 100);
  for (std::size_t c = 0; c < 36; ++c) {
    const Vec3d radial = normalized(s.points[s.triangles[c / 3][int(c % 3)]]);
    EXPECT_NEAR(dot(Vec3d(s.corner_normals[c]), radial), 1, 1e-6);  // angle weights: each face counts 90 degrees
  }
}

TEST(Prepare, SphereNormalsAreRadial) {
  const PreparedSurface s = prepare(icosphere(3));
  double worst = 1;
  for (std::size_t c = 0; c < s.corner_normals.size(); ++c)
    worst = std::min(worst, dot(Vec3d(s.corner_normals[c]), s.points[s.triangles[c / 3][int(c % 3)]]));
  EXPECT_GT(worst, std::cos(0.5 * 3.14159 / 180));
}

TEST(Prepare, OneFlippedTriangleIsTurnedBack) {
  Surface in = icosphere(2);
  const Surface good = in;
  std::swap(in.triangles[17].b, in.triangles[17].c);
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(in, 40, &warnings);
  EXPECT_EQ(inconsistent_edges(s.triangles), 0u);
  EXPECT_NEAR(six_volumes(s.points, s.triangles), six_volumes(good.points, good.triangles), 1e-12);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], "1 triangle was turned over to be wound like their neighbours.");
}

TEST(Prepare, InwardPartsAreTurnedOutwardsEachOnItsOwn) {
  Surface in = cube();
  const Surface other = icosphere(1);
  for (const Vec3d& p : other.points) in.points.push_back(p + Vec3d(1e5, 0, 0));  // far away: precision of the volume
  for (const Triangle& t : other.triangles) in.triangles.push_back({t.a + 8, t.c + 8, t.b + 8});
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(in, 40, &warnings);
  EXPECT_TRUE(mentions(warnings, "1 closed part was"));
  for (std::size_t t = 12; t < s.triangles.size(); ++t)
    EXPECT_GT(dot(face_normal(s, t), s.points[s.triangles[t].a] - Vec3d(1e5, 0, 0)), 0);
  for (std::size_t t = 0; t < 12; ++t) EXPECT_GT(dot(face_normal(s, t), s.points[s.triangles[t].a]), 0);
}

TEST(Prepare, OpenPartsKeepTheMajority) {
  Surface in = cube();
  in.triangles.resize(10);  // without the last face
  for (Triangle& t : in.triangles) std::swap(t.b, t.c);
  std::swap(in.triangles[3].b, in.triangles[3].c);
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(in, 40, &warnings);
  EXPECT_EQ(inconsistent_edges(s.triangles), 0u);
  EXPECT_TRUE(mentions(warnings, "1 triangle was turned over"));
  EXPECT_LT(dot(face_normal(s, 0), s.points[s.triangles[0].a]), 0);
}

TEST(Prepare, SeamsOfEqualPointsDoNotShow) {
  const Surface sphere = icosphere(2);
  Surface soup;  // every triangle with its own points, every other one turned over
  for (const Triangle& t : sphere.triangles) {
    const auto first = std::uint32_t(soup.points.size());
    for (int k = 0; k < 3; ++k) soup.points.push_back(sphere.points[t[k]]);
    soup.triangles.push_back(first % 2 ? Triangle{first, first + 1, first + 2} : Triangle{first, first + 2, first + 1});
  }
  const PreparedSurface s = prepare(soup);
  EXPECT_EQ(s.points.size(), soup.points.size());
  for (std::size_t c = 0; c < s.corner_normals.size(); ++c)
    EXPECT_GT(dot(Vec3d(s.corner_normals[c]), s.points[s.triangles[c / 3][int(c % 3)]]), 0.999);
}

TEST(Prepare, FoldedWedgeIsACrease) {
  Surface in;  // two faces that enclose 2 degrees at the edge 0-1
  in.points = {{0, 0, 0}, {0, 1, 0}, {1, 0.5, 0.0175}, {1, 0.5, -0.0175}};
  in.triangles = {{0, 2, 1}, {0, 1, 3}};
  const PreparedSurface s = prepare(in);
  for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(dot(Vec3d(s.corner_normals[c]), face_normal(s, c / 3)), 1, 1e-6);
}

TEST(Prepare, NonManifoldEdgeIsSurvived) {
  Surface in = cube();  // a fin on the edge 0-1, which then has three triangles
  in.points.emplace_back(0, -3, -3);
  in.triangles.push_back({0, 1, 8});
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(in, 40, &warnings);
  EXPECT_EQ(s.triangles.size(), 13u);
  EXPECT_TRUE(warnings.empty());
  EXPECT_NEAR(length(s.corner_normals[38]), 1, 1e-6);
}

TEST(Prepare, MoebiusStripIsCalledOneSided) {
  Surface in;
  const int n = 12;
  for (int i = 0; i < n; ++i) {
    const double a = 2 * 3.14159265358979 * i / n;
    for (const double side : {-0.3, 0.3})
      in.points.emplace_back((1 + side * std::cos(a / 2)) * std::cos(a), (1 + side * std::cos(a / 2)) * std::sin(a),
                             side * std::sin(a / 2));
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const std::uint32_t c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
    in.triangles.push_back({a, c, b});
    in.triangles.push_back({b, c, d});
  }
  std::vector<std::string> warnings;
  prepare(in, 40, &warnings);
  EXPECT_TRUE(mentions(warnings, "1 edge was left with contradicting"));
}

TEST(Prepare, BadTrianglesAreDroppedAndCounted) {
  Surface in = cube();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  in.points.emplace_back(nan, 0, 0);
  in.points.emplace_back(0, -1, -1);  // on the edge 0-1
  in.triangles.push_back({0, 1, 99});
  in.triangles.push_back({0, 1, 8});
  in.triangles.push_back({2, 2, 3});
  in.triangles.push_back({0, 9, 1});
  in.triangles.push_back(Triangle{3, 0, 2});  // the first one again
  std::vector<std::string> warnings;
  const PreparedSurface s = prepare(in, 40, &warnings);
  EXPECT_EQ(s.triangles, cube().triangles);
  EXPECT_TRUE(mentions(warnings, "1 triangle was dropped because they refer"));
  EXPECT_TRUE(mentions(warnings, "1 triangle was dropped because their coordinates"));
  EXPECT_TRUE(mentions(warnings, "2 triangles were dropped because they have no area"));
  EXPECT_TRUE(mentions(warnings, "1 triangle was dropped because an earlier one"));
  ASSERT_EQ(s.points.size(), 10u);
  for (const Vec3d& p : s.points) EXPECT_TRUE(is_finite(p));
}

TEST(Prepare, SliversTakeTheirNeighboursNormal) {
  Surface in;  // a flat square whose diagonal is split by a sliver that stands on its edge
  in.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1e-9}};
  in.triangles = {{0, 1, 2}, {0, 2, 4}, {0, 4, 3}, {4, 2, 3}};
  const PreparedSurface s = prepare(in);
  ASSERT_EQ(s.triangles.size(), 4u);
  for (const Vec3f& n : s.corner_normals) EXPECT_NEAR(n.z, 1, 1e-6);
}

TEST(Prepare, HubOfManyTrianglesIsFast) {
  Surface in;
  const std::uint32_t n = 200000;
  in.points.emplace_back(0, 0, 0);
  for (std::uint32_t i = 0; i < n; ++i) in.points.emplace_back(std::cos(2e-5 * i), std::sin(2e-5 * i), 0.0);
  for (std::uint32_t i = 1; i < n; ++i) in.triangles.push_back({0, i, i + 1});
  const PreparedSurface s = prepare(in);
  for (const Vec3f& normal : s.corner_normals) ASSERT_NEAR(normal.z, 1, 1e-5);
}

TEST(Prepare, NothingLeftIsAnError) {
  EXPECT_THROW(prepare(Surface{}), Error);
  Surface in;
  in.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  in.triangles = {{0, 1, 2}};
  EXPECT_THROW(prepare(in), Error);
}

}  // namespace
}  // namespace nacre
