// Nacre: closest points of every interface and junction curve, in one two-level grid (sec. 4.1.1, 4.2).
#pragma once

#include "compute/embedding/closest_point_grid.hpp"
#include "compute/field/interface.hpp"

namespace nacre {

/// A coarse grid over the volume whose cells list bricks of 4^3 cells, one per interface that is near. Lengths are in cells,
/// `cells_per_voxel` to a voxel; cell (i, j, k) has its centre at (i, j, k) + 0.5.
struct InterfaceGridView {
  static constexpr int sub = 4;
  Int3 coarse{};  ///< extent of the coarse grid
  float cells_per_voxel = 2;
  const std::uint32_t* brick_start = nullptr;      ///< per coarse cell, x fastest, and one more
  const std::uint32_t* brick_interface = nullptr;  ///< ascending within a coarse cell
  const Float4* offset =
      nullptr;  ///< per cell: closest point minus centre; by how much (voxels) the interface's materials
                ///< are ahead of all others there: negative beyond the interface's rim
  const Float4* direction = nullptr;  ///< per cell: normal or tangent there; sizing field, voxels

  NACRE_HD Int3 dims() const { return coarse * Int3(sub); }
  NACRE_HD std::int64_t coarse_number(const Int3& c) const {
    return (std::int64_t(c.z) * coarse.y + c.y) * coarse.x + c.x;
  }
};

/// The bricks of one interface, as Stencil and LinearCells want to see them.
struct InterfaceBricks {
  const InterfaceGridView& grid;
  std::uint32_t interface;
  static constexpr int sub = InterfaceGridView::sub;
  const Float4* offset = grid.offset;

  NACRE_HD static int divide(int i) { return i >> 2; }
  NACRE_HD static int cells_per_brick() { return sub * sub * sub; }
  NACRE_HD Int3 dims() const { return grid.dims(); }
  NACRE_HD bool inside(const Int3& cell) const {
    const Int3 d = dims();
    return unsigned(cell.x) < unsigned(d.x) && unsigned(cell.y) < unsigned(d.y) && unsigned(cell.z) < unsigned(d.z);
  }
  NACRE_HD std::uint32_t brick(int bx, int by, int bz) const {
    const std::int64_t c = grid.coarse_number({bx, by, bz});
    for (std::uint32_t k = grid.brick_start[c]; k < grid.brick_start[c + 1]; ++k)
      if (grid.brick_interface[k] == interface) return k;
    return none;
  }
};

/// A particle's place on its interface.
struct EmbeddedPoint {
  Vec3f p;          ///< voxels
  Vec3f direction;  ///< unit normal or tangent
  float h;          ///< sizing field, voxels
  float margin;     ///< voxels; negative beyond the rim
};

/// Puts `p` (voxels) onto the interface by WENO4 of the closest points around it (sec. 4.2.1); direction and size are
/// interpolated linearly at the result. False where the interface is too far away.
NACRE_HD inline bool project(const InterfaceGridView& grid, std::uint32_t interface, const Vec3f& p,
                             EmbeddedPoint& on) {
  const InterfaceBricks bricks{grid, interface};
  const Vec3f cell = p * grid.cells_per_voxel;
  const Int3 lower = floor_cell(cell - Vec3f(0.5f));
  Stencil<4> stencil;
  if (!stencil.find(bricks, lower - Int3(1))) return false;
  const Vec3f base = cell_centre(lower);
  const Float4 offset = store(weno4_stencil(bricks, stencil, cell - base));
  const Vec3f surface = base + Vec3f(offset.x, offset.y, offset.z);
  LinearCells around;
  if (!around.find(bricks, surface)) return false;
  const Float4 d = store(around.interpolate(grid.direction));
  on.margin = store(around.interpolate(grid.offset)).w;
  on.p = surface / grid.cells_per_voxel;
  on.direction = normalized(Vec3f(d.x, d.y, d.z));
  on.h = d.w;
  return is_finite(on.p) && dot(on.direction, on.direction) > 0.5f;
}

}  // namespace nacre
