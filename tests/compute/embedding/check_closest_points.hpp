// Nacre: compares a closest-point grid with brute force over all triangles.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/compute/embedding/host_grid.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test {

/// What is wrong with a grid. Tolerances are 1e-5 of a cell.
struct GridFaults {
  std::size_t looked_at = 0;       ///< stored cells within the radius
  std::size_t wrong_distance = 0;  ///< not the distance of the closest point
  std::size_t wrong_point = 0;     ///< another point although the closest one is unique
  std::size_t wrong_triangle = 0;  ///< the point does not lie on the triangle that is named
  std::size_t missing = 0;         ///< cells within the radius that are not stored, or not as such
  std::size_t wrong_touch = 0;     ///< cells whose list of touching triangles is another
  double worst = 0;                ///< error of the distance, cells

  void expect_none(const std::string& what) const {
    EXPECT_GT(looked_at, 0u) << what;
    EXPECT_EQ(wrong_distance, 0u) << what << ", worst " << worst;
    EXPECT_EQ(wrong_point, 0u) << what;
    EXPECT_EQ(wrong_triangle, 0u) << what;
    EXPECT_EQ(missing, 0u) << what;
    EXPECT_EQ(wrong_touch, 0u) << what;
  }
};

inline void check_stored(const HostGrid& grid, const BruteForce& brute, std::uint32_t at, GridFaults& faults) {
  const Vec3d x = grid.centre(at), p = grid.closest(at);
  const std::uint32_t t = grid.triangle[at];
  if (t >= brute.size()) {
    ++faults.wrong_triangle;
    return;
  }
  const auto nearest = brute(x, 1e300, t);
  const double error =
      std::max(std::fabs(length(p - x) - nearest.distance), std::fabs(double(grid.offset[at].w) - nearest.distance));
  faults.worst = std::max(faults.worst, error);
  ++faults.looked_at;
  faults.wrong_distance += error > 1e-5;
  faults.wrong_point += nearest.unique && length(p - nearest.point) > 1e-5;
  faults.wrong_triangle += length(reference_closest_point(brute.corners(t), p) - p) > 1e-5;
}

inline bool right_touches(const HostGrid& grid, const BruteForce& brute, std::uint32_t at) {
  std::vector<std::uint32_t> expected;
  for (std::uint32_t t = 0; t < brute.size(); ++t)
    if (touches_cube(brute.corners(t), grid.centre(at), 0.5 + 1e-7)) expected.push_back(t);
  return std::equal(expected.begin(), expected.end(), grid.touch_triangle.begin() + grid.touch_start[at],
                    grid.touch_triangle.begin() + grid.touch_start[at + 1]);
}

/// Looks at every `stride`-th cell of the whole box.
inline GridFaults find_faults(const HostGrid& grid, const BruteForce& brute, int stride = 1) {
  GridFaults faults;
  const Int3 dims = grid.view.dims();
  const double radius = grid.view.radius;
  std::int64_t count = 0;
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x) {
        if (count++ % stride != 0) continue;
        const std::uint32_t at = grid.view.address({x, y, z});
        if (at != none && grid.offset[at].w <= radius) {
          check_stored(grid, brute, at, faults);
        } else {
          const Vec3d centre{x + 0.5, y + 0.5, z + 0.5};
          faults.missing += brute(centre, radius - 1e-5, at == none ? none : grid.triangle[at]).triangle != none;
        }
        if (at != none && count % (7 * stride) == 1) faults.wrong_touch += !right_touches(grid, brute, at);
      }
  return faults;
}

}  // namespace nacre::test
