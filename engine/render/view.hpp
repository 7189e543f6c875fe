// Nacre: where a frame is seen from, and how what is drawn lies in the world.
#pragma once

#include <glm/mat4x4.hpp>
#include <optional>

#include "compute/raycast/camera.hpp"
#include "engine/gl/shader.hpp"

namespace nacre {

/// Nothing is drawn where dot(normal, p) < offset; world coordinates.
struct ClipPlane {
  Vec3d normal{1, 0, 0};
  double offset = 0;
};

/// What all passes of one frame share.
struct View {
  Camera camera;
  int width = 1024, height = 768;
  Vec3d light{0, 0, 1};  ///< unit, towards the light
  float ambient = 0.3f;
  double extent = 0;  ///< radius of a ball around the eye that holds the scene, for orthographic cameras
  std::optional<ClipPlane> clip;

  /// From the world, less the eye, to the clip space of a Framebuffer: depth 1 near, 0 infinitely far (0 where an
  /// orthographic camera ends).
  glm::dmat4 clip_from_seen() const;
};

/// The light of FlowPipeline's pictures, beside the camera.
Vec3d flow_light(const Camera& camera);
/// The light of mesh_picture.
Vec3d mesh_light(const Camera& camera);
/// A light (unit, towards it) turned by `azimuth` about the camera's up, to the right, and raised by `height`, to
/// straight above or below at most; degrees.
Vec3d turned_light(const Vec3d& light, const Camera& camera, double azimuth, double height);

/// Where a model's coordinates (grid cells, voxels, the world's) are in the world: an affine map.
using Placement = glm::dmat4;

/// Coordinates in cells of edge `size` from `origin`.
Placement place_grid(const Vec3d& origin, double size);

/// Sets the uniforms of shaders/view.glsl for a model that lies in the world like this.
void set_view(const Program& program, const View& view, const Placement& world_from_model);

}  // namespace nacre
