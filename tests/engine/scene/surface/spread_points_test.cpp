// Nacre: positions for arrows: even, by area, the same for one seed.
#include "engine/scene/surface/spread_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/scene/samples/samples.hpp"

namespace nacre {
namespace {

Vec3d point_at(const Surface& s, const SurfacePoint& position) {
  const Triangle& t = s.triangles[position.triangle];
  return s.points[t.a] * double(position.weights.x) + s.points[t.b] * double(position.weights.y) +
         s.points[t.c] * double(position.weights.z);
}

TEST(SpreadPlaces, KeepTheirDistance) {
  const Surface sphere = make_sample("sphere", 24).load(0);
  const int count = 400;
  const auto positions = spread_points(sphere.points, sphere.triangles, count, 1);
  ASSERT_EQ(positions.size(), std::size_t(count));
  const double room = std::sqrt(surface_area(sphere.points, sphere.triangles) / count);
  double nearest = 1e300;
  for (std::size_t a = 0; a < positions.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      nearest = std::min(nearest, length(point_at(sphere, positions[a]) - point_at(sphere, positions[b])));
  EXPECT_GT(nearest, 0.5 * room);  // uniform ones would be at 0.03 of it
}

TEST(SpreadPlaces, CountByAreaNotByTriangles) {
  // A large triangle, and many small ones with half of its area together.
  std::vector<Vec3d> points{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  std::vector<Triangle> triangles{{0, 1, 2}};
  for (std::uint32_t k = 0; k < 50; ++k) {
    const double x = 3 + 0.02 * k;
    const auto n = std::uint32_t(points.size());
    points.insert(points.end(), {{x, 0, 0}, {x + 0.02, 0, 0}, {x, 1, 0}, {x + 0.02, 1, 0}});
    triangles.push_back({n, n + 1, n + 2});
    triangles.push_back({n + 2, n + 1, n + 3});
  }
  const auto positions = spread_points(points, triangles, 500, 3);
  ASSERT_EQ(positions.size(), 500u);
  const auto large =
      std::count_if(positions.begin(), positions.end(), [](const SurfacePoint& p) { return p.triangle == 0; });
  EXPECT_NEAR(double(large), 500 * 2 / 3.0, 25);
}

TEST(SpreadPlaces, OneSeedOneResult) {
  const Surface torus = make_sample("torus", 24).load(0);
  const auto at = [&](std::uint32_t seed) {
    std::vector<std::uint32_t> triangles;
    for (const SurfacePoint& p : spread_points(torus.points, torus.triangles, 100, seed))
      triangles.push_back(p.triangle);
    return triangles;
  };
  EXPECT_EQ(at(5), at(5));
  EXPECT_NE(at(5), at(6));
}

TEST(SpreadPlaces, NothingToStandOn) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_TRUE(spread_points(points, std::vector<Triangle>{{0, 1, 2}}, 10, 1).empty());
  EXPECT_TRUE(spread_points({}, {}, 10, 1).empty());
}

}  // namespace
}  // namespace nacre
