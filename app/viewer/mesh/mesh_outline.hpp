// Nacre: where triangles are cut by a plane. No OpenGL here.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"
#include "engine/render/segment_pass.hpp"

namespace nacre {

/// Segments from `origin`, world axes and lengths, of each material: a triangle counts for the higher one of its two.
/// `drawn`: per material; triangles between two that are not drawn are left out.
std::map<std::size_t, std::vector<LineSegment>> mesh_outline(const SurfaceMesh& mesh, const Vec3d& normal,
                                                             const Vec3d& origin, const std::vector<bool>& drawn);

}  // namespace nacre
