// Nacre: a surface that is cut along planes stays the same surface.
#include "engine/scene/surface/surface_part.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre::test {
namespace {

double area_of(const PreparedSurface& surface) {
  double area = 0;
  for (const Triangle& t : surface.triangles)
    area += 0.5 * length(cross(surface.points[t.b] - surface.points[t.a], surface.points[t.c] - surface.points[t.a]));
  return area;
}

/// What a vector field that is linear in space has at the points.
std::vector<Vec3f> linear_field(const PreparedSurface& surface) {
  std::vector<Vec3f> vectors;
  for (const Vec3d& p : surface.points) vectors.push_back(Vec3f(Vec3d(p.x + 2 * p.y, 3 * p.z, p.x - p.y + 1)));
  return vectors;
}

const HalfSpace below_a_third{{0, 0, 1}, 1.0 / 3};

TEST(SurfacePart, OfACubeHasTheAreaThatIsLeft) {
  const PreparedSurface whole = prepare(cube());
  const SurfacePart part = cut_surface(whole, std::span(&below_a_third, 1));
  EXPECT_NEAR(area_of(part.surface), 4 + 4 * 2 * 4.0 / 3, 1e-12) << "the bottom, and two thirds of four sides";
  EXPECT_EQ(part.whole_triangles, 2u) << "the bottom";
  EXPECT_GT(part.cut_triangles, 8u);
  EXPECT_EQ(part.surface.corner_normals.size(), 3 * part.surface.triangles.size());
}

TEST(SurfacePart, TrianglesKeepTheirSide) {
  const PreparedSurface whole = prepare(icosphere(3));
  const HalfSpace slanted{normalized(Vec3d(1, 2, 3)), 0.2};
  const SurfacePart part = cut_surface(whole, std::span(&slanted, 1));
  ASSERT_GT(part.cut_triangles, 10u);
  for (std::size_t t = 0; t < part.surface.triangles.size(); ++t) {
    const Triangle& c = part.surface.triangles[t];
    const Vec3d a = part.surface.points[c.a];
    EXPECT_GT(dot(cross(part.surface.points[c.b] - a, part.surface.points[c.c] - a), a), 0) << "outward";
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(dot(slanted.normal, part.surface.points[c[k]]), slanted.offset + 1e-12);
      EXPECT_NEAR(length(part.surface.corner_normals[3 * t + k]), 1, 1e-6);
    }
  }
}

TEST(SurfacePart, TakesALinearFieldAlong) {
  const PreparedSurface whole = prepare(icosphere(2));
  const HalfSpace sides[] = {{{1, 0, 0}, 0.3}, {{0, -1, 0}, 0.1}, below_a_third};
  const SurfacePart part = cut_surface(whole, sides);
  ASSERT_GT(part.cut_triangles, 5u);
  std::vector<Vec3f> taken(part.surface.points.size());
  part.take(linear_field(whole), taken);
  const std::vector<Vec3f> expected = linear_field(part.surface);
  for (std::size_t i = 0; i < taken.size(); ++i) EXPECT_LT(length(taken[i] - expected[i]), 1e-5f);
}

TEST(SurfacePart, ANumberThatIsMissingSpoilsOnlyTheTrianglesThatWereCut) {
  const PreparedSurface whole = prepare(cube());
  std::vector<float> values(whole.points.size(), 1.0f);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (whole.points[i].z > 0) values[i] = std::numeric_limits<float>::quiet_NaN();
  const SurfacePart part = cut_surface(whole, std::span(&below_a_third, 1));
  const std::vector<float> taken = part.take(values);
  for (std::size_t t = 0; t < part.whole_triangles; ++t)
    for (int k = 0; k < 3; ++k) EXPECT_EQ(taken[part.surface.triangles[t][k]], 1.0f);
}

TEST(SurfacePart, NothingInsideAndAllInside) {
  const PreparedSurface whole = prepare(cube());
  const HalfSpace nowhere{{0, 0, 1}, -5}, everywhere{{0, 0, 1}, 5}, touching{{0, 0, 1}, -1};
  EXPECT_TRUE(cut_surface(whole, std::span(&nowhere, 1)).surface.triangles.empty());
  const SurfacePart all = cut_surface(whole, std::span(&everywhere, 1));
  EXPECT_EQ(all.whole_triangles, whole.triangles.size());
  EXPECT_EQ(all.cut_triangles, 0u);
  EXPECT_NEAR(area_of(cut_surface(whole, std::span(&touching, 1)).surface), 4, 1e-12) << "the face in the plane";
}

}  // namespace
}  // namespace nacre::test
