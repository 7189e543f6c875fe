// Nacre: the first triangle that a ray meets.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "compute/grid/vec.hpp"

namespace nacre {

struct TriangleHit {
  std::uint32_t triangle = 0;
  double distance = 0;  ///< along the ray
  Vec3d place;          ///< world
  double u = 0, v = 0;  ///< weights of the second and the third corner
};

/// Triangles in groups of neighbours with a box each. It looks at points and triangles of others, which must outlive it.
class RayTriangles {
 public:
  RayTriangles() = default;
  RayTriangles(std::span<const Vec3d> points, std::span<const Triangle> triangles);

  /// The nearest hit that `counts` accepts; `along` is unit.
  std::optional<TriangleHit> first_hit(const Vec3d& from, const Vec3d& along,
                                       const std::function<bool(const TriangleHit&)>& counts) const;

 private:
  struct Group {
    Vec3d low, high;
    std::uint32_t first, last;  ///< of order_
  };

  void meet(const Group& group, const Vec3d& from, const Vec3d& along,
            const std::function<bool(const TriangleHit&)>& counts, std::optional<TriangleHit>& nearest) const;

  std::span<const Vec3d> points_;
  std::span<const Triangle> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Group> groups_;
};

}  // namespace nacre
