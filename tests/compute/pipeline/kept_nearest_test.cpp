// Nacre: positions on junctions that are kept from one mesh to the next.
#include "compute/pipeline/kept_nearest.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace nacre {
namespace {

TEST(KeptNearest, AsksOnlyForWhatIsNew) {
  std::vector<std::size_t> asked;
  KeptNearest nearest([&](std::span<const Vec3d> points, std::span<const Junction> junctions) {
    asked.push_back(points.size());
    std::vector<Vec3d> on;
    for (std::size_t i = 0; i < points.size(); ++i) on.push_back(points[i] + Vec3d(junctions[i].material(1), 0, 0));
    return on;
  });
  std::vector<Vec3d> points;
  std::vector<Junction> junctions;
  for (int i = 0; i < 100; ++i) points.push_back({0.1 * i, -0.0, 1.0 / 3}), junctions.push_back({0, 1});
  const auto expect_right = [&] {
    const std::vector<Vec3d>& on = nearest(points, junctions);
    ASSERT_EQ(on.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_EQ(on[i], points[i] + Vec3d(junctions[i].material(1), 0, 0)) << i;
  };
  expect_right();
  expect_right();
  points[7].x += 1e-12, junctions[50] = {0, 2};
  points.erase(points.begin()), junctions.erase(junctions.begin());
  points.push_back({5, 5, 5}), junctions.push_back({1, 2});
  expect_right();
  expect_right();
  EXPECT_EQ(asked, (std::vector<std::size_t>{100, 3}));
}

}  // namespace
}  // namespace nacre
