// Nacre: a picture of triangles with their edges, without OpenGL. Host only.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/raycast/camera.hpp"

namespace nacre {

struct MeshPictureOptions {
  Camera camera;
  int width = 1024, height = 768;
  int samples = 2;  ///< per pixel and axis
  std::array<float, 3> background{1, 1, 1};
  bool transparent = false;
  bool edges = true;  ///< drawn where triangles are larger than some pixels
};

/// Draws `triangles` with flat shading, lit from beside the camera, both sides alike, each in its colour (encoded sRGB,
/// 0..1; one per triangle). Whatever is behind the eye is left out. The bytes do not depend on the number of threads.
/// Returns RGBA, 8 bits a channel, row 0 at the top.
std::vector<std::uint8_t> mesh_picture(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                                       std::span<const std::array<float, 3>> colours,
                                       const MeshPictureOptions& options);

}  // namespace nacre
