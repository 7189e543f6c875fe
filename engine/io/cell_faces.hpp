// Nacre: the faces of tetrahedra, and which cells they belong to.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace nacre {

inline constexpr std::uint32_t no_cell = std::numeric_limits<std::uint32_t>::max();

/// Face k of a tetrahedron: these of its corners, counter-clockwise as seen from outside. The numbers are those that
/// Abaqus gives to the faces, less one.
inline constexpr std::array<std::array<int, 3>, 4> tetrahedron_faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

struct CellFace {
  std::array<std::uint32_t, 3> corners;  ///< the normal points out of the owner
  std::uint32_t owner;                   ///< the cell with the lower number
  std::uint32_t neighbour;               ///< the other cell; no_cell at the boundary
  std::uint8_t owner_face, neighbour_face;
};

/// Each face of the cells once: first those between two cells, by owner and then by neighbour (the upper-triangular
/// order of OpenFOAM), then those of the boundary by owner. Corners are valid and different; a face has at most two
/// cells.
std::vector<CellFace> cell_faces(std::span<const std::array<std::uint32_t, 4>> cells);

}  // namespace nacre
