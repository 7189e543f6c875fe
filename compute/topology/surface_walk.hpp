// Nacre: straight ways over the triangles of a surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compute/topology/tangent_field.hpp"

namespace nacre {

/// A point of a triangle and a unit direction, both in the triangle's frame (TangentField::frame), from its first
/// corner.
struct SurfacePosition {
  std::uint32_t triangle = none;
  Vec2d x, along;
};

/// World units, on the surface: edges are crossed at a point of the path. `triangles`: that of each point.
struct SurfacePath {
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> triangles;
};

/// Unfolds the triangles that a way crosses into a plane, as K. Polthier and M. Schmies (Straightest geodesics on
/// polyhedral surfaces, 1998) do. The field, of which only the triangles count, must outlive it.
class SurfaceWalk {
 public:
  explicit SurfaceWalk(const TangentField& field);

  /// What remains of a way that has met a rim, at this half-edge.
  struct Rest {
    double distance = 0;
    std::uint32_t rim = none;
  };
  /// Moves `at` straight on by `distance`, or to a rim; its direction turns as triangles are unfolded. `path`: gets the
  /// points where edges are crossed, and the last. The way does not begin across the half-edge `not_across`.
  Rest go(SurfacePosition& at, double distance, SurfacePath* path = nullptr, std::uint32_t not_across = none) const;

  /// Corners of a triangle in its frame.
  std::array<Vec2d, 3> corners(std::uint32_t t) const { return {Vec2d{0, 0}, second_[t], third_[t]}; }
  Vec3d in_space(std::uint32_t t, const Vec2d& x) const;
  Vec2d in_plane(std::uint32_t t, const Vec3d& p) const;
  /// At the corners, none below 0.
  Vec3d weights(std::uint32_t t, const Vec2d& x) const;
  /// A length by which the vectors of a triangle change little: 0.4 edges.
  double step_in(std::uint32_t t) const { return step_[t]; }
  const std::array<Vec3d, 3>& frame(std::uint32_t t) const { return frame_[t]; }

 private:
  const TangentField& field_;
  std::vector<std::array<Vec3d, 3>> frame_;
  std::vector<Vec2d> second_, third_;
  std::vector<double> step_;
};

}  // namespace nacre
