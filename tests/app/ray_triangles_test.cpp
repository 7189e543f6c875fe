// Nacre: the first triangle that a ray meets, against all of them tried one by one.
#if NACRE_HAS_VIEWER

#include "app/viewer/ray_triangles.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace nacre {
namespace {

struct Soup {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
};

/// Small triangles anywhere in a box that is long in x.
Soup soup(int count, double size) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> in(0, 1);
  Soup s;
  for (int t = 0; t < count; ++t) {
    const Vec3d p(5 * in(random), in(random), in(random));
    const std::uint32_t n = std::uint32_t(s.points.size());
    for (int k = 0; k < 3; ++k) s.points.push_back(p + Vec3d(in(random), in(random), in(random)) * size);
    s.triangles.push_back({n, n + 1, n + 2});
  }
  return s;
}

const auto any = [](const TriangleHit&) { return true; };

TEST(RayTriangles, FindsWhatTryingAllFinds) {
  const Soup s = soup(3000, 0.2);
  const RayTriangles rays(s.points, s.triangles);
  std::mt19937 random(8);
  std::uniform_real_distribution<double> in(-1, 2);
  int hits = 0;
  for (int k = 0; k < 300; ++k) {
    const Vec3d from(5 * in(random), in(random), -3), to(2.5 + in(random), 0.5, 0.5);
    const Vec3d along = k % 10 == 0 ? Vec3d(0, 0, 1) : normalized(to - from);
    std::optional<TriangleHit> nearest;
    for (std::size_t t = 0; t < s.triangles.size(); ++t) {
      const RayTriangles one(s.points, std::span(s.triangles).subspan(t, 1));
      const std::optional<TriangleHit> hit = one.first_hit(from, along, any);
      if (hit && (!nearest || hit->distance < nearest->distance)) nearest = hit, nearest->triangle = std::uint32_t(t);
    }
    const std::optional<TriangleHit> found = rays.first_hit(from, along, any);
    ASSERT_EQ(found.has_value(), nearest.has_value()) << k;
    if (!found) continue;
    ++hits;
    EXPECT_EQ(found->triangle, nearest->triangle) << k;
    const Triangle& t = s.triangles[found->triangle];
    const Vec3d p = s.points[t.a] * (1 - found->u - found->v) + s.points[t.b] * found->u + s.points[t.c] * found->v;
    EXPECT_LT(length(p - found->place), 1e-9);
  }
  EXPECT_GT(hits, 100);
}

TEST(RayTriangles, PassesOverWhatDoesNotCount) {
  const Soup s{{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}}, {{0, 1, 2}, {3, 4, 5}}};
  const RayTriangles rays(s.points, s.triangles);
  const Vec3d from(0.2, 0.2, 0), along(0, 0, 1);
  EXPECT_EQ(rays.first_hit(from, along, any)->triangle, 0u);
  EXPECT_EQ(rays.first_hit(from, along, [](const TriangleHit& h) { return h.triangle == 1; })->triangle, 1u);
  EXPECT_FALSE(rays.first_hit(from, along * -1.0, any));
  EXPECT_FALSE(RayTriangles().first_hit(from, along, any));
}

TEST(RayTriangles, AMillionTakeNoTimeToSpeakOf) {
  const Soup s = soup(1000000, 0.01);
  const RayTriangles rays(s.points, s.triangles);
  const auto start = std::chrono::steady_clock::now();
  int hits = 0;
  for (int k = 0; k < 20; ++k)
    hits += rays.first_hit({-1, 0.05 * k, 0.3}, normalized(Vec3d(1, 0.01, 0.02)), any).has_value();
  const double ms = 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 20;
  RecordProperty("ms", std::to_string(ms));
  EXPECT_GT(hits, 10);
  EXPECT_LT(ms, 100);  // 1 ms on a quiet machine
}

}  // namespace
}  // namespace nacre

#endif
