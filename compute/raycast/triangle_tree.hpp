// Nacre: a tree of triangles for single rays and closest points on the host.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

struct TriangleHit {
  std::uint32_t triangle = 0;
  double distance = 0;  ///< from the ray's origin
  Vec3d position;       ///< world
  Vec3d weights;        ///< of the three corners
};

/// Boxes over runs of triangles in Morton order, combined in pairs to an implicit binary tree. It keeps copies of its
/// input. A ray through a million triangles takes some microseconds.
class TriangleTree {
 public:
  TriangleTree() = default;
  /// Triangles with indices in range.
  TriangleTree(std::span<const Vec3d> points, std::span<const Triangle> triangles);

  /// The nearest triangle, from either side, on the ray `from` + t `along` (unit) with t in `near`..`far`.
  std::optional<TriangleHit> first(const Vec3d& from, const Vec3d& along, double near = 0,
                                   double far = std::numeric_limits<double>::infinity()) const;

  /// The triangle nearest to `from` (of several the first), its point closest to `from` and the distance, exact up to
  /// rounding; none where there are no triangles. `weights` is not filled. A `guess`, a triangle that may be near,
  /// saves time and changes nothing else.
  std::optional<TriangleHit> closest(const Vec3d& from, std::optional<std::uint32_t> guess = {}) const;

  /// Of the corners of a triangle, for a point of it.
  Vec3d weights_at(std::uint32_t triangle, const Vec3d& position) const;

  std::span<const Vec3d> points() const { return points_; }
  std::span<const Triangle> triangles() const { return triangles_; }

 private:
  struct Box {
    Vec3d low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  };

  void sort();
  void make_boxes();
  double distance_to_box(std::size_t node, const Vec3d& from) const;
  void try_closest(std::uint32_t triangle, const Vec3d& from, double& nearest, std::optional<TriangleHit>& hit) const;
  void hit_leaf(std::size_t leaf, const Vec3d& from, const Vec3d& along, double near, double& far,
                std::optional<TriangleHit>& hit) const;

  std::vector<Vec3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> order_;  ///< triangles along the Morton curve
  std::size_t leaves_ = 0;            ///< a power of two
  std::vector<Box> boxes_;            ///< node k over 2 k and 2 k + 1, from 1; the leaves come last
};

/// Between the values of the corners of a triangle.
template <class Value>
Value interpolate(std::span<const Value> values, const Triangle& t, const Vec3d& weights) {
  return values[t.a] * float(weights.x) + values[t.b] * float(weights.y) + values[t.c] * float(weights.z);
}

}  // namespace nacre
