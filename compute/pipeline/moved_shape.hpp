// Nacre: where the triangles of an embedded surface are now, on the host and on the device.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/raycast/box_tree.hpp"

namespace nacre {

/// The present shape of a mesh, in cells of the domain of the shape that is embedded. Nothing is stored for a surface
/// that does not move.
template <class Backend>
class MovedShape {
 public:
  /// Memory for the shapes to come, permanent in the arena; the first is that at rest.
  void make(Executor<Backend>& exec, std::vector<Vec3d> points, std::span<const Triangle> triangles,
            std::span<const Vec3f> corner_normals) {
    Arena& arena = exec.arena();
    triangles_.assign(triangles.begin(), triangles.end());
    order_ = order_along_curve(points, triangles);
    device_points_ = arena.permanent<Vec3d>(points.size());
    device_normals_ = arena.permanent<Vec3f>(corner_normals.size());
    device_order_ = arena.permanent_copy<std::uint32_t>(order_);
    device_boxes_ = arena.permanent<TriangleBox>(2 * std::size_t(box_leaves(triangles.size())));
    place(std::move(points), corner_normals, {});
    moved_ = false;
  }

  void place(std::vector<Vec3d> points, std::span<const Vec3f> corner_normals, std::span<const Vec3f> vectors) {
    points_ = std::move(points);
    normals_.assign(corner_normals.begin(), corner_normals.end());
    vectors_.assign(vectors.begin(), vectors.end());
    device_points_.upload(points_);
    device_normals_.upload(normals_);
    device_boxes_.upload(boxes_over(points_, triangles_, order_));
    moved_ = true;
  }

  bool made() const { return !order_.empty(); }
  bool moved() const { return moved_; }  ///< `place` has been called
  const std::vector<Vec3d>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Vec3f>& normals() const { return normals_; }
  const std::vector<Vec3f>& vectors() const { return vectors_; }

  MeshView mesh(const Triangle* device_triangles) const {
    return {device_points_.data(), device_triangles, device_normals_.data()};
  }
  BoxTreeView tree() const {
    return {box_leaves(order_.size()), std::uint32_t(order_.size()), device_order_.data(), device_boxes_.data()};
  }

 private:
  bool moved_ = false;
  std::vector<Vec3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3f> normals_, vectors_;
  std::vector<std::uint32_t> order_;
  Array<Vec3d> device_points_;
  Array<Vec3f> device_normals_;
  Array<std::uint32_t> device_order_;
  Array<TriangleBox> device_boxes_;
};

}  // namespace nacre
