// Nacre: a tetrahedron between triangles of a mesh goes from one material to another.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// A triangle and the materials on its sides, as in SurfaceMesh.
struct MaterialFacet {
  Triangle corners;
  std::array<std::uint16_t, 2> materials;
  friend bool operator==(const MaterialFacet&, const MaterialFacet&) = default;
};

/// The faces of a tetrahedron after it has gone to the material beyond its faces (u, v, c) and (u, v, d), which the
/// mesh has: both vanish, and what the mesh has at (u, c, d) and (v, c, d) gets that material inside; where it has only
/// one of these, the other one appears. `faces` are those of the mesh, three or four. None where they do not show which
/// of the two materials is inside, or where nothing would be left.
std::optional<std::vector<MaterialFacet>> give_away(std::uint32_t u, std::uint32_t v, std::uint32_t c, std::uint32_t d,
                                                    std::span<const MaterialFacet> faces);

}  // namespace nacre
