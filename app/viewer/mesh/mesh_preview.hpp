// Nacre: a quick surface of the materials, shown until there are particles and triangles. No OpenGL here.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "app/viewer/mesh/viewed_volume.hpp"
#include "engine/render/geometry.hpp"

namespace nacre {

/// Surface nets, as the passes take them.
struct MeshPreview {
  SurfaceGeometry geometry;                             ///< without edges
  std::vector<std::array<std::uint16_t, 2>> materials;  ///< of its triangles
  int stride = 1;                                       ///< every so many voxels along each axis are seen in it
};

/// Of a large volume, only some voxels are looked at, so that it takes a second or less. Throws Interrupted soon after
/// `*stop` is set.
MeshPreview make_mesh_preview(const ViewedVolume& volume, const std::atomic<bool>* stop);

}  // namespace nacre
