// Nacre: the tree of triangles against all triangles one by one.
#include "compute/raycast/triangle_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "compute/device/random.hpp"
#include "compute/embedding/triangle.hpp"

namespace nacre {
namespace {

struct Soup {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
};

double random(std::uint32_t index, std::uint32_t which) { return uniform_random(7, index, which); }

Vec3d random_place(std::uint32_t index, std::uint32_t which) {
  return {random(index, which), random(index, which + 1), random(index, which + 2)};
}

/// Small triangles anywhere in the unit cube, some flat, some without area.
Soup soup(std::uint32_t count) {
  Soup s;
  for (std::uint32_t k = 0; k < count; ++k) {
    const Vec3d middle = random_place(k, 0);
    for (std::uint32_t c = 0; c < 3; ++c) s.points.push_back(middle + (random_place(k, 3 + 3 * c) - Vec3d(0.5)) * 0.2);
    if (k % 50 == 25) s.points.back() = s.points[s.points.size() - 2];
    s.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  }
  return s;
}

/// The distance to a triangle by its plane and three edges; infinite: it is missed.
double distance_to(const Soup& s, const Triangle& t, const Vec3d& from, const Vec3d& along) {
  const Vec3d a = s.points[t.a], b = s.points[t.b], c = s.points[t.c], n = cross(b - a, c - a);
  const double rate = dot(n, along);
  if (rate == 0) return INFINITY;
  const double distance = dot(n, a - from) / rate;
  const Vec3d p = from + along * distance;
  const bool inside =
      dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 && dot(cross(a - c, p - c), n) >= 0;
  return inside && distance >= 0 ? distance : INFINITY;
}

TEST(TriangleTree, FindsWhatAllTrianglesFind) {
  for (const std::uint32_t count : {1u, 3u, 17u, 1000u}) {
    const Soup s = soup(count);
    const TriangleTree tree(s.points, s.triangles);
    int hits = 0;
    for (std::uint32_t k = 0; k < 400; ++k) {
      const Vec3d from = random_place(k, 20) * 3.0 - Vec3d(1);
      const Triangle& aim = s.triangles[k % count];  // inside: what an edge says is up to rounding
      const Vec3d inside = s.points[aim.a] * 0.5 + s.points[aim.b] * 0.3 + s.points[aim.c] * 0.2;
      const Vec3d at = k % 2 ? random_place(k, 30) : inside;
      const Vec3d along = normalized(at - from);
      double nearest = INFINITY;
      for (const Triangle& t : s.triangles) nearest = std::min(nearest, distance_to(s, t, from, along));
      const auto hit = tree.first(from, along);
      ASSERT_EQ(hit.has_value(), std::isfinite(nearest)) << count << " " << k;
      if (!hit) continue;
      ++hits;
      EXPECT_NEAR(hit->distance, nearest, 1e-9);
      const Triangle& t = s.triangles[hit->triangle];
      const Vec3d by_weights =
          s.points[t.a] * hit->weights.x + s.points[t.b] * hit->weights.y + s.points[t.c] * hit->weights.z;
      EXPECT_LT(length(by_weights - hit->position), 1e-9);
    }
    EXPECT_GT(hits, count < 10 ? 5 : 100) << count;
  }
}

TEST(TriangleTree, RaysAlongAxesAndBetweenBounds) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}};
  const TriangleTree tree(points, std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
  const Vec3d from(0.2, 0.2, 5), down(0, 0, -1);
  EXPECT_EQ(tree.first(from, down)->triangle, 1u);
  EXPECT_EQ(tree.first(from, down, 3.5)->triangle, 0u);  // behind a plane that cuts the first one off
  EXPECT_FALSE(tree.first(from, down, 3.5, 4.5));
  EXPECT_FALSE(tree.first(from, down * -1.0));
  EXPECT_FALSE(tree.first({0.8, 0.8, 5}, down));
}

TEST(TriangleTree, RaysAlongEdgesDoNotSlipBetweenTriangles) {
  // Fans around points at odd coordinates; every ray goes through an edge that two triangles share.
  int missed = 0;
  for (std::uint32_t k = 0; k < 300; ++k) {
    const Vec3d middle = random_place(k, 0), a = random_place(k, 3), b = random_place(k, 6), c = random_place(k, 9),
                d = (a + b) * 0.7 - c;
    const Soup s{{a, b, c, d}, {{0, 1, 2}, {1, 0, 3}}};
    const TriangleTree tree(s.points, s.triangles);
    for (std::uint32_t i = 1; i < 50; ++i) {
      const Vec3d on_edge = a + (b - a) * (i / 50.0), from = on_edge + (middle - on_edge) * 10.0;
      missed += !tree.first(from, normalized(on_edge - from)).has_value();
    }
  }
  EXPECT_EQ(missed, 0);
}

TEST(TriangleTree, OfNothingFindsNothing) {
  EXPECT_FALSE(TriangleTree().first({0, 0, 0}, {1, 0, 0}));
  EXPECT_FALSE(TriangleTree({}, {}).first({0, 0, 0}, {1, 0, 0}));
}

TEST(TriangleTree, FindsTheClosestPointOfAllTriangles) {
  const Soup s = soup(400);
  const TriangleTree tree(s.points, s.triangles);
  for (std::uint32_t k = 0; k < 200; ++k) {
    const Vec3d from = (random_place(k, 40) - Vec3d(0.25)) * 2.0;  // inside and outside of the cube
    std::uint32_t nearest = 0;
    double least = INFINITY;
    for (std::uint32_t t = 0; t < s.triangles.size(); ++t) {
      const Triangle& c = s.triangles[t];
      const double distance = length(closest_point(Corners{s.points[c.a], s.points[c.b], s.points[c.c]}, from) - from);
      if (distance < least) least = distance, nearest = t;
    }
    const auto hit = tree.closest(from);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->triangle, nearest);
    EXPECT_NEAR(hit->distance, least, 1e-12);  // compiled apart: the last bit may differ
    EXPECT_NEAR(length(hit->position - from), least, 1e-12);
    for (const std::uint32_t guess : {nearest, 0u, 399u}) {
      const auto guessed = tree.closest(from, guess);
      EXPECT_EQ(guessed->triangle, nearest) << "a guess only saves time";
      EXPECT_EQ(guessed->distance, hit->distance);
    }
  }
}

TEST(TriangleTree, OfTrianglesThatAreEquallyCloseTheFirst) {
  Soup s = soup(30);
  const std::vector<Triangle> once = s.triangles;
  s.triangles.insert(s.triangles.end(), once.begin(), once.end());
  const TriangleTree tree(s.points, s.triangles);
  for (std::uint32_t k = 0; k < 50; ++k) {
    EXPECT_LT(tree.closest(random_place(k, 50))->triangle, once.size());
    const auto hit = tree.first(random_place(k, 60) * 2.0, normalized(random_place(k, 70) - Vec3d(0.5)));
    EXPECT_LT(hit ? hit->triangle : 0, once.size());
  }
  EXPECT_FALSE(TriangleTree().closest(Vec3d(0)));
}

TEST(TriangleTree, OfManyTrianglesAsOfFew) {
  const Soup s = soup(30000);  // sorted in parallel
  const TriangleTree tree(s.points, s.triangles);
  for (std::uint32_t k = 0; k < 20; ++k) {
    const Vec3d from = random_place(k, 80);
    double least = INFINITY;
    for (const Triangle& c : s.triangles)
      least = std::min(least, length(closest_point(Corners{s.points[c.a], s.points[c.b], s.points[c.c]}, from) - from));
    EXPECT_NEAR(tree.closest(from)->distance, least, 1e-12);
  }
}

TEST(TriangleTree, OfSomeTrianglesFindsOnlyTheseByTheirNumbers) {
  const Soup s = soup(400);
  std::vector<std::uint32_t> some;
  std::vector<Triangle> alone;
  for (std::uint32_t t = 5; t < 400; t += 3) some.push_back(t), alone.push_back(s.triangles[t]);
  const auto all = std::make_shared<TriangleSoup>(TriangleSoup{s.points, s.triangles});
  const TriangleTree tree = TriangleTree::of_some(all, some);
  const TriangleTree other(s.points, alone);
  for (std::uint32_t k = 0; k < 100; ++k) {
    const Vec3d from = random_place(k, 90);
    EXPECT_EQ(tree.closest(from)->triangle, some[other.closest(from)->triangle]);
    EXPECT_EQ(tree.closest(from)->distance, other.closest(from)->distance);
  }
}

TEST(TriangleTree, AmongTrianglesThatCountFindsWhatATreeOfThemFinds) {
  const Soup s = soup(400);
  const auto counts = [](std::uint32_t t) { return t % 5 == 2; };
  std::vector<std::uint32_t> some;
  for (std::uint32_t t = 2; t < 400; t += 5) some.push_back(t);
  const TriangleTree tree(s.points, s.triangles);
  const TriangleTree own =
      TriangleTree::of_some(std::make_shared<TriangleSoup>(TriangleSoup{s.points, s.triangles}), some);
  for (std::uint32_t k = 0; k < 100; ++k) {
    const Vec3d from = random_place(k, 90);
    const TriangleHit nearest = *own.closest(from);
    for (const std::optional<std::uint32_t> guess : {std::optional<std::uint32_t>(), std::optional(some[k % 80])}) {
      const auto hit = tree.closest_of(from, nearest.distance * 1.01, counts, guess);
      ASSERT_TRUE(hit) << k;
      EXPECT_EQ(hit->triangle, nearest.triangle) << k;
      EXPECT_EQ(hit->distance, nearest.distance) << k;
    }
    EXPECT_FALSE(tree.closest_of(from, nearest.distance * 0.99, counts)) << k;
  }
}

}  // namespace
}  // namespace nacre
