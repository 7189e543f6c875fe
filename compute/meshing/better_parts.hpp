// Nacre: where two meshes of the same surfaces differ, the better of the two in each place.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/defects.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// A mesh, and what its triangles are judged by.
struct JudgedMesh {
  const SurfaceMesh& mesh;
  std::span<const std::uint8_t> order;                     ///< per point: of its junction
  std::span<const std::array<std::uint32_t, 2>> touching;  ///< points where it touches itself
};

/// Triangles that are to stand in place of others.
struct BetterParts {
  std::vector<std::uint32_t> gone;   ///< triangles of the first mesh, ascending
  std::vector<std::uint32_t> taken;  ///< of the second in their place, ascending
  std::int64_t specks = 0;           ///< bodies of the first that the second does not have there
};

/// Compares two meshes part by part: a part is what hangs together, by common points, of the triangles that only one
/// of the two has. So both meshes have the same edges around it, and either of them can be taken there. A part is taken
/// from `second` if its least fitness by `rule` is higher there, or if it touches itself in `first` alone, and if it
/// has none of the points that `stays` marks (per point of `first`). It must have the same materials; only a body of 20
/// facets or fewer may be gone, if its material is elsewhere, too. `same` has for each point of `second` the point of
/// `first` that is in the same position, or `none`; `facets` is the number of each material's in the whole mesh that
/// `first` is of.
BetterParts better_parts(const JudgedMesh& first, const JudgedMesh& second, std::span<const std::uint32_t> same,
                         std::span<const std::uint8_t> stays, std::vector<std::int64_t> facets, const DefectRule& rule);

}  // namespace nacre
