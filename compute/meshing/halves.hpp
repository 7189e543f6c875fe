// Nacre: points of a mesh divided in two, where parts of it do not hang together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// The marked points, ascending within each part, in two lists of as many parts as can be: points that hang together by
/// triangles are in the same one. No lists where all of them hang together, or none is marked.
std::vector<std::vector<std::uint32_t>> halves(const SurfaceMesh& mesh, std::span<const std::uint8_t> marked);

}  // namespace nacre
