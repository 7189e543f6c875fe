// Nacre: the view of a frame, and the placement of models in the world.
#pragma once

#include <array>
#include <cstddef>
#include <glm/mat4x4.hpp>
#include <span>

#include "compute/raycast/camera.hpp"
#include "engine/gl/shader.hpp"

namespace nacre {

/// Nothing is drawn where dot(normal, p) < offset; world coordinates.
struct ClipPlane {
  Vec3d normal{1, 0, 0};
  double offset = 0;

  bool cuts(const Vec3d& p) const { return dot(normal, p) < offset; }
};

/// The planes of a frame. Nothing is drawn where one of them cuts.
class ClipPlanes {
 public:
  static constexpr std::size_t most = 7;  ///< as in shaders/view.glsl

  ClipPlanes() = default;
  explicit ClipPlanes(const ClipPlane& plane) { add(plane); }

  /// One more; beyond `most` it has no effect.
  void add(const ClipPlane& plane) {
    if (count_ < most) planes_[count_++] = plane;
  }
  void clear() { count_ = 0; }
  bool empty() const { return count_ == 0; }
  std::span<const ClipPlane> all() const { return {planes_.data(), count_}; }
  bool cut(const Vec3d& p) const {
    for (const ClipPlane& plane : all())
      if (plane.cuts(p)) return true;
    return false;
  }

 private:
  std::array<ClipPlane, most> planes_{};
  std::size_t count_ = 0;
};

/// What all passes of one frame share.
struct View {
  Camera camera;
  int width = 1024, height = 768;
  Vec3d light{0, 0, 1};  ///< unit, towards the light
  float ambient = 0.3f;
  double extent = 0;  ///< radius of a ball around the eye that contains the scene, for orthographic cameras
  ClipPlanes clip;
  BackFaces back_faces = BackFaces::shown;

  /// From world coordinates relative to the eye to the clip space of a Framebuffer: depth 1 near, 0 infinitely far (0
  /// at the far end of an orthographic camera).
  glm::dmat4 clip_from_seen() const;
};

/// The light of FlowPipeline's pictures, beside the camera.
Vec3d flow_light(const Camera& camera);
/// The light of mesh_picture.
Vec3d mesh_light(const Camera& camera);
/// A light (unit, towards it) rotated by `azimuth` about the camera's up direction, to the right, and raised by
/// `height`, at most to straight above or below; degrees.
Vec3d turned_light(const Vec3d& light, const Camera& camera, double azimuth, double height);

/// By how much lines and marks are drawn nearer, so that the triangles that they lie on do not hide them: the uniform
/// `lift` of their shaders.
inline float lift_of(const View& view) { return view.camera.orthographic ? 1e-5f : 8e-4f; }

/// Where model coordinates (grid cells, voxels, world) are in the world: an affine map.
using Placement = glm::dmat4;

/// Coordinates in cells of edge `size` from `origin`.
Placement place_grid(const Vec3d& origin, double size);

/// Sets the uniforms of shaders/view.glsl for a model with this placement.
void set_view(const Program& program, const View& view, const Placement& world_from_model);

}  // namespace nacre
