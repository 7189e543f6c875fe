// Nacre: badly shaped tetrahedra improved by flips and by moving points.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/delaunay.hpp"

namespace nacre {

/// Cells with positive volume and what they are made of; neighbours as in DelaunayCells, circumcentres empty.
struct MaterialCells {
  DelaunayCells cells;
  std::vector<std::uint16_t> material;
};

/// Shape of a cell by its dihedral angles: the smallest of their sines, that of an obtuse one halved, so that 0.17
/// stands for both 10 and 160 degrees; 0.94 in a regular cell, negative where the volume is.
double cell_shape(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);

/// What `improve_cells` did.
struct CellImprovement {
  std::int64_t flips = 0, moves = 0;
  std::int64_t bad_before = 0, bad_after = 0;  ///< cells with an angle outside of 14.5 .. 150 degrees
};

/// Replaces the cells around edges and facets by others where the worst of them becomes better, and moves points for
/// the same reason; each step is local to one material, so that facets between materials and on the hull stay. The
/// first `fixed` points do not move. Works on bad cells only. Interrupted soon after `*stop` is set.
CellImprovement improve_cells(std::vector<Vec3d>& points, std::size_t fixed, MaterialCells& cells,
                              const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
