// Nacre: points of all interfaces, one near each boundary voxel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/lattice.hpp"

namespace nacre {

/// A point of an interface.
struct InterfacePoint {
  Float4 position;  ///< position in voxels; w: 0, or -1 where there is none
  Float4 normal;    ///< unit, towards the lower of the two materials; w: the larger principal curvature, per voxel
  Junction surface;

  /// An interface point lies no farther from its boundary voxel, in voxels.
  static constexpr float farthest = 2.5f;
};

namespace detail {

/// For a lattice cell: the voxel in it, nearest to its middle, that has a neighbour of another material.
struct BoundaryVoxel {
  MaterialBricksView field;
  Lattice lattice;

  NACRE_HD bool operator()(const Int3& c, Int3& voxel) const {
    const Int3 n = field.voxels();
    Int3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const float scale = lattice.spacing[axis] * field.cells_per_unit[axis];
      low[axis] = int(std::ceil(float(c[axis]) * scale - 0.501f));
      high[axis] = int(std::ceil(float(c[axis] + 1) * scale - 0.501f));
      low[axis] = low[axis] < 1 ? 1 : low[axis];
      high[axis] = high[axis] > n[axis] - 1 ? n[axis] - 1 : high[axis];
    }
    if (low.x >= high.x || low.y >= high.y || low.z >= high.z) return false;
    // Blocks list what lies within 4 voxels of them: without a list, there is no boundary in a small cell that begins
    // here.
    const std::int64_t block = field.block_number(low.x / block_size, low.y / block_size, low.z / block_size);
    const bool small = high.x - low.x <= 4 && high.y - low.y <= 4 && high.z - low.z <= 4;
    if (small && !field.is_listed(block)) return false;
    int best = 1 << 30;
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x) {
          const int away =
              abs1(2 * x + 1 - low.x - high.x) + abs1(2 * y + 1 - low.y - high.y) + abs1(2 * z + 1 - low.z - high.z);
          if (away < best && on_boundary({x, y, z})) best = away, voxel = {x, y, z};
        }
    return best < 1 << 30;
  }

 private:
  NACRE_HD static int abs1(int v) { return v < 0 ? -v : v; }
  NACRE_HD bool on_boundary(const Int3& v) const {
    const std::int64_t block = field.block_number(v.x / block_size, v.y / block_size, v.z / block_size);
    if (!field.is_listed(block)) return false;
    const BlockVoxels material(field, block);
    const std::uint16_t own = material(v);
    return material(v - Int3(1, 0, 0)) != own || material(v + Int3(1, 0, 0)) != own ||
           material(v - Int3(0, 1, 0)) != own || material(v + Int3(0, 1, 0)) != own ||
           material(v - Int3(0, 0, 1)) != own || material(v + Int3(0, 0, 1)) != own;
  }
};

struct CountBoundaryCells {
  BoundaryVoxel boundary;
  TilesView tiles;
  std::uint32_t* count;  ///< per slot
  NACRE_HD void operator()(std::int64_t i) const {
    const Int3 c = tiles.cell(i);
    Int3 voxel;
    count[i] = tiles.lattice.holds(c) && boundary(c, voxel) ? 1 : 0;
  }
};

/// The slots of boundary cells.
struct ListBoundaryCells {
  const std::uint32_t* start;  ///< per slot
  std::int64_t slots;
  std::uint32_t count;
  std::uint64_t* slot;
  NACRE_HD void operator()(std::int64_t i) const {
    if (start[i] != (i + 1 < slots ? start[i + 1] : count)) slot[start[i]] = std::uint64_t(i);
  }
};

/// The larger of the two principal curvatures of the surface f_a = f_b, by absolute value.
NACRE_HD inline float largest_curvature(const FieldCurvature& a, const FieldCurvature& b) {
  const Vec3f g = a.gradient - b.gradient;
  const float size = length(g);
  if (!(size > 1e-6f)) return 0;
  const Vec3f n = g / size;
  // The Hessian in an orthonormal basis of the tangent plane, divided by the gradient's length.
  const Vec3f helper = std::fabs(n.x) < 0.6f ? Vec3f(1, 0, 0) : Vec3f(0, 1, 0);
  const Vec3f s = normalized(cross(n, helper)), t = cross(n, s);
  const auto apply = [&](const Vec3f& v) {
    const float xx = a.xx - b.xx, yy = a.yy - b.yy, zz = a.zz - b.zz, xy = a.xy - b.xy, yz = a.yz - b.yz,
                zx = a.zx - b.zx;
    return Vec3f(xx * v.x + xy * v.y + zx * v.z, xy * v.x + yy * v.y + yz * v.z, zx * v.x + yz * v.y + zz * v.z);
  };
  const Vec3f hs = apply(s), ht = apply(t);
  const float ss = dot(s, hs) / size, tt = dot(t, ht) / size, st = dot(s, ht) / size;
  const float middle = 0.5f * (ss + tt), spread = std::sqrt(0.25f * (ss - tt) * (ss - tt) + st * st);
  return std::fabs(middle) + spread;
}

/// Projects a voxel of each boundary cell onto the nearest interface of its material.
struct FindInterfacePoints {
  BoundaryVoxel boundary;
  TilesView tiles;
  const std::uint64_t* slot;
  InterfacePoint* point;

  NACRE_HD void operator()(std::int64_t i) const {
    Int3 v;
    boundary(tiles.cell(std::int64_t(slot[i])), v);
    const MaterialBricksView& field = boundary.field;
    const Vec3f u = field.cells_per_unit, p{(v.x + 0.5f) / u.x, (v.y + 0.5f) / u.y, (v.z + 0.5f) / u.z};
    InterfacePoint& result = point[i];
    result.position = {0, 0, 0, -1};
    if (!field.inside(p, 3)) return;
    const std::int64_t block = field.block_at(p);
    const std::uint32_t own = field.material(v);
    const CubicStencil stencil(field, p);
    const FieldSample mine = stencil.sample(field, own);
    std::uint32_t other = none;
    float least = InterfacePoint::farthest;
    for (std::uint32_t k = field.block_start[block]; k < field.block_start[block + 1]; ++k) {
      const std::uint32_t m = field.brick_material[k];
      if (m == own) continue;
      const FieldSample s = stencil.sample(field, m);
      const float d = (mine.value - s.value) / max(length(mine.gradient - s.gradient), 1e-6f);
      if (d < least) least = d, other = m;
    }
    if (other == none) return;
    const Junction surface(own < other ? own : other, own < other ? other : own);
    JunctionPoint found;
    if (!project(field, surface, p, InterfacePoint::farthest, found)) return;
    if (junction_margin(field, surface, found.p, found.steepness) < -0.25f) return;
    const CubicStencil there(field, found.p);
    const float curvature =
        largest_curvature(there.curvature(field, surface.material(0)), there.curvature(field, surface.material(1)));
    result.position = {found.p.x, found.p.y, found.p.z, 0};
    result.normal = {found.direction.x, found.direction.y, found.direction.z, curvature};
    result.surface = surface;
  }
};

}  // namespace detail

/// At least one point per cell of `tiles` that an interface passes through, in the order of the cells' slots and in
/// permanent memory; some have no position. `start`, per slot, receives how many come before that of the cell.
template <class Backend>
Array<InterfacePoint> find_interface_points(Executor<Backend>& exec, const MaterialBricks& b, const LatticeTiles& tiles,
                                            const Array<std::uint32_t>& start) {
  Arena& arena = exec.arena();
  const std::int64_t slots = tiles.slots();
  const detail::BoundaryVoxel boundary{b.view(), tiles.lattice};
  exec.for_each(slots, detail::CountBoundaryCells{boundary, tiles.view(), start.data()});
  const std::uint32_t count = exec.exclusive_scan(start.data(), start.data(), slots);
  const auto point = arena.permanent<InterfacePoint>(count);
  Arena::Scope scope(arena);
  const auto slot = arena.temporary<std::uint64_t>(count);
  exec.for_each(slots, detail::ListBoundaryCells{start.data(), slots, count, slot.data()});
  exec.for_each(count, detail::FindInterfacePoints{boundary, tiles.view(), slot.data(), point.data()});
  return point;
}

}  // namespace nacre
