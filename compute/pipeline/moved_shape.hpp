// Nacre: where the triangles of an embedded surface are now, on the host and on the device.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/raycast/build_triangle_boxes.hpp"

namespace nacre {

/// The present shape of a mesh, in cells of the domain of the shape that is embedded. Nothing is stored for a surface
/// that does not move.
template <class Backend>
class MovedShape {
 public:
  /// Memory for the shapes to come, permanent in the arena; the first is `rest`, which has these points.
  void make(Executor<Backend>& exec, const MeshView& rest, std::vector<Vec3d> points,
            std::span<const Triangle> triangles, std::span<const Vec3f> corner_normals) {
    Arena& arena = exec.arena();
    triangles_.assign(triangles.begin(), triangles.end());
    device_points_ = arena.permanent<Vec3d>(points.size());
    device_normals_ = arena.permanent<Vec3f>(corner_normals.size());
    Vec3d farthest(1);
    for (const Vec3d& p : points) farthest = max(farthest, p);
    boxes_ = build_triangle_boxes(exec, rest, std::uint32_t(triangles.size()), farthest);
    move_to(exec, rest.triangles, std::move(points), corner_normals, {});
    moved_ = false;
  }

  void move_to(Executor<Backend>& exec, const Triangle* device_triangles, std::vector<Vec3d> points,
               std::span<const Vec3f> corner_normals, std::span<const Vec3f> vectors) {
    points_ = std::move(points);
    normals_.assign(corner_normals.begin(), corner_normals.end());
    vectors_.assign(vectors.begin(), vectors.end());
    device_points_.upload(points_);
    device_normals_.upload(normals_);
    bound_triangles(exec, mesh(device_triangles), boxes_);
    moved_ = true;
  }

  bool made() const { return boxes_.leaves > 0; }
  bool moved() const { return moved_; }  ///< `move_to` has been called
  const std::vector<Vec3d>& points() const { return points_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  const std::vector<Vec3f>& normals() const { return normals_; }
  const std::vector<Vec3f>& vectors() const { return vectors_; }

  MeshView mesh(const Triangle* device_triangles) const {
    return {device_points_.data(), device_triangles, device_normals_.data()};
  }
  TriangleBoxesView tree() const { return boxes_.view(); }

 private:
  bool moved_ = false;
  std::vector<Vec3d> points_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3f> normals_, vectors_;
  Array<Vec3d> device_points_;
  Array<Vec3f> device_normals_;
  TriangleBoxes boxes_;
};

}  // namespace nacre
