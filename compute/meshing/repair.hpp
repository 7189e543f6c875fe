// Nacre: labels of Delaunay cells changed where the surface between them would touch itself.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/delaunay.hpp"

namespace nacre {

/// What `repair_labels` did.
struct LabelRepair {
  std::int64_t changed = 0;                           ///< cells that got another label
  std::int64_t pockets = 0;                           ///< of these, flat cells that were all of their component
  std::int64_t left = 0;                              ///< edges and vertices that still touch themselves
  std::vector<std::array<std::uint32_t, 2>> defects;  ///< these: ends of an edge, or a vertex twice; ascending
};

/// Changes labels of cells until every material meets an edge in one wedge, so that no edge off the junctions has more
/// than two facets, and until the surface of a material passes through each vertex once. Each change, alone or with up
/// to three more, lowers the number of such edges and vertices around it and takes the smallest cells that do. None
/// removes a connected component of a material, unless that is one flat cell, or a crumb that touches more of its
/// material at an edge or a vertex. Looks at facets between labels only. The result depends on its arguments alone.
/// Interrupted soon after `*stop` is set.
LabelRepair repair_labels(std::span<const Vec3d> points, const DelaunayCells& cells, std::vector<std::uint16_t>& label,
                          const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
