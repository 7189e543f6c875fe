// Nacre: a tree of triangles for single rays and closest points on the host.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
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

/// Triangles with indices in range.
struct TriangleSoup {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
};

/// Boxes around triangles that are divided at medians, combined eight by eight to an implicit tree. A ray through a
/// million triangles takes some microseconds.
class TriangleTree {
 public:
  TriangleTree() = default;
  /// It keeps copies of its input: triangles with indices in range.
  TriangleTree(std::span<const Vec3d> points, std::span<const Triangle> triangles);
  /// Of `some` of the triangles, which keep their numbers.
  static TriangleTree of_some(std::shared_ptr<const TriangleSoup> soup, std::vector<std::uint32_t> some);

  /// The nearest triangle (of several the first), from either side, on the ray `from` + t `along` (unit) with t from
  /// `near` to below `far`.
  std::optional<TriangleHit> first(const Vec3d& from, const Vec3d& along, double near = 0,
                                   double far = std::numeric_limits<double>::infinity()) const;

  /// The triangle nearest to `from` (of several the first), its point closest to `from` and the distance, exact up to
  /// rounding; none where there are no triangles. `weights` is not filled. A `guess`, a triangle that may be near,
  /// saves time and changes nothing else.
  std::optional<TriangleHit> closest(const Vec3d& from, std::optional<std::uint32_t> guess = {}) const;

  /// The same among the triangles that `counts`, which a `guess` must, if they are not more than `most` away.
  std::optional<TriangleHit> closest_of(const Vec3d& from, double most,
                                        const std::function<bool(std::uint32_t)>& counts,
                                        std::optional<std::uint32_t> guess = {}) const;

  /// Of the corners of a triangle, for a point of it.
  Vec3d weights_at(std::uint32_t triangle, const Vec3d& position) const;

  bool empty() const { return order_.empty(); }
  std::span<const Vec3d> points() const { return soup_->points; }
  std::span<const Triangle> triangles() const { return soup_->triangles; }

 private:
  static constexpr std::size_t width = 8;  ///< children of a node
  /// Those of a node's children side by side, rounded outwards; with low > high where there is no child.
  struct alignas(32) Boxes {
    std::array<std::array<float, width>, 3> low, high;  ///< by axis
  };

  void build(std::shared_ptr<const TriangleSoup> soup, std::vector<std::uint32_t> some);
  void sort();
  void make_boxes();
  static Boxes no_boxes();
  Boxes boxes_of_triangles(std::size_t first) const;
  Boxes boxes_of_nodes(std::size_t first, std::size_t count) const;
  template <class Away, class Visit>
  void search(const double& most, const Away& away, const Visit& visit) const;
  template <class Counts>
  std::optional<TriangleHit> closest_within(const Vec3d& from, double squared, const Counts& counts,
                                            std::optional<std::uint32_t> guess) const;
  void try_closest(std::uint32_t triangle, const Vec3d& from, double& nearest, std::optional<TriangleHit>& hit) const;
  void try_hit(std::uint32_t triangle, const Vec3d& from, const Vec3d& along, double near, double& far,
               std::optional<TriangleHit>& hit) const;

  const Vec3d& corner(std::uint32_t triangle, int k) const { return soup_->points[soup_->triangles[triangle][k]]; }

  std::shared_ptr<const TriangleSoup> soup_ = std::make_shared<TriangleSoup>();
  std::vector<std::uint32_t> order_;  ///< triangles, those of each node one after the other
  std::vector<Boxes> boxes_;        ///< level by level, the root last: of a level, node k is over 8 k ... of that below
  std::vector<std::size_t> level_;  ///< where its nodes begin; the lowest is over triangles
};

/// Between the values of the corners of a triangle.
template <class Value>
Value interpolate(std::span<const Value> values, const Triangle& t, const Vec3d& weights) {
  return values[t.a] * float(weights.x) + values[t.b] * float(weights.y) + values[t.c] * float(weights.z);
}

}  // namespace nacre
