// Nacre: a tangential vector field on triangles, with the rotation of the vectors from point to point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/topology/plane.hpp"

namespace nacre {

/// The tangential part of one vector per point. Half-edge h = 3 t + k goes from corner k of triangle t to corner k + 1;
/// corners have the same numbers. A *vertex* is a fan of triangles around a point that edges of exactly two triangles,
/// wound alike, hold together; so the surface is a manifold, and every other edge belongs to a rim.
///
/// Angles around a vertex are scaled to 2 pi (at a rim to pi), and vectors are carried along edges by these angles, as
/// in E. Zhang, K. Mischaikow and G. Turk, Vector field design on surfaces (2006), and F. Knoeppel et al., Globally
/// optimal direction fields (2013), sec. 3. The turning of the vectors around a triangle, and that of the frame, then
/// add up to 2 pi times a whole number: the index. Over a closed surface, the indices sum to the Euler characteristic.
class TangentField {
 public:
  /// World units; `vectors`: one per point. What is not finite, or below 1e-7 of the largest, counts as zero. Points at
  /// one position must have one index.
  TangentField(std::span<const Vec3d> points, std::span<const Triangle> triangles, std::span<const Vec3f> vectors);

  struct Rim {
    std::uint32_t half_edge;  ///< its first
    int index;                ///< that of the hole, if it were closed by one polygon
  };

  std::size_t triangles() const { return triangles_.size(); }
  const Triangle& triangle(std::size_t t) const { return triangles_[t]; }
  const Vec3d& corner_point(std::uint32_t corner) const { return points_[triangles_[corner / 3][int(corner % 3)]]; }
  std::uint32_t twin(std::uint32_t h) const { return twin_[h]; }  ///< the half-edge across; none at a rim
  std::uint32_t vertex(std::uint32_t corner) const { return vertex_[corner]; }
  std::size_t vertices() const { return value_.size(); }
  const Vec3d& vertex_point(std::size_t v) const { return points_[point_[v]]; }
  const Vec3d& normal(std::size_t v) const { return normal_[v]; }  ///< unit
  const Vec3d& value(std::size_t v) const { return value_[v]; }    ///< tangential
  double speed(std::size_t v) const { return length(value_[v]); }
  int index(std::size_t t) const { return index_[t]; }
  const std::vector<Rim>& rims() const { return rims_; }
  double diagonal() const;                             ///< of the bounds of its vertices, world units; 0 without any
  int euler_characteristic() const { return euler_; }  ///< vertices - edges + triangles

  /// The least speed along the edge of a half-edge, between its two ends linearly.
  double least_speed(std::uint32_t h) const;
  /// Unit vectors that span the plane of a triangle: along its first edge, across it, and the normal.
  std::array<Vec3d, 3> frame(std::size_t t) const;
  /// The vectors at the corners of a triangle in its frame, turned so that their linear interpolation has a zero inside
  /// where the index is not 0.
  std::array<Vec2d, 3> corner_vectors(std::size_t t) const;

  static std::uint32_t next(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static std::uint32_t previous(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

 private:
  void find_twins();
  void find_vertices(std::span<const Vec3f> vectors);
  void measure_fan(std::uint32_t first, std::uint32_t v);
  double polar_angle(std::uint32_t first, std::uint32_t v) const;
  void rotate();
  void walk_rims();

  std::span<const Vec3d> points_;
  std::span<const Triangle> triangles_;
  std::vector<std::uint32_t> twin_, vertex_;
  std::vector<std::uint32_t> point_, first_;  ///< of each vertex: point, first corner (at a rim the rim's)
  std::vector<Vec3d> normal_, value_;
  std::vector<double> angle_;              ///< of each vertex: of its vector
  std::vector<double> direction_, inner_;  ///< of each half-edge: its angle at its start; of each corner: scaled
  std::vector<double> rotation_;           ///< of each half-edge: of the vectors, less that of the frame; -pi..pi
  std::vector<int> index_;
  std::vector<Rim> rims_;
  int euler_ = 0;
};

/// `v` turned as the shortest way turns the unit vector `from` to `to`.
Vec3d turned(const Vec3d& v, const Vec3d& from, const Vec3d& to);

}  // namespace nacre
