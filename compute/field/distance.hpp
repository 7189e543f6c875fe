// Nacre: closest interface points of the voxels around, and the signed distance that follows from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/device/team.hpp"
#include "compute/field/build_material_bricks.hpp"
#include "compute/field/interface.hpp"

namespace nacre {

/// A point of an interface.
struct InterfacePoint {
  Float4 position;  ///< position in voxels; w: 0, or -1 where there is none
  Float4 normal;    ///< unit, towards the lower of the two materials; w: the larger principal curvature, per voxel
  Junction surface;
};

/// The cells that distances and sizes are known on: as large as the voxels, or larger where particles will be far
/// apart.
struct Lattice {
  Int3 cells{};
  Vec3f spacing{1, 1, 1};  ///< voxels

  NACRE_HD std::int64_t count() const { return std::int64_t(cells.x) * cells.y * cells.z; }
  NACRE_HD std::int64_t number(int x, int y, int z) const { return (std::int64_t(z) * cells.y + y) * cells.x + x; }
  NACRE_HD Int3 cell(std::int64_t i) const {
    return {int(i % cells.x), int(i / cells.x % cells.y), int(i / cells.x / cells.y)};
  }
  NACRE_HD Vec3f centre(const Int3& c) const { return Vec3f(c.x + 0.5f, c.y + 0.5f, c.z + 0.5f) * spacing; }
  NACRE_HD bool holds(const Int3& c) const { return is_within(c, cells); }
  bool operator==(const Lattice&) const = default;

  /// Tiles of 8^3 cells, for work that much of the lattice does without.
  static constexpr int tile = 8;
  NACRE_HD Int3 tiles() const {
    return {(cells.x + tile - 1) / tile, (cells.y + tile - 1) / tile, (cells.z + tile - 1) / tile};
  }
  NACRE_HD std::int64_t tile_count() const { return std::int64_t(tiles().x) * tiles().y * tiles().z; }
  NACRE_HD Int3 tile_at(std::int64_t t) const {
    const Int3 n = tiles();
    return {int(t % n.x), int(t / n.x % n.y), int(t / n.x / n.y)};
  }
  /// body(cell, number of the cell) for the cells of tile `t`, shared out among the team.
  template <class Body>
  NACRE_HD void each_in_tile(Team& team, std::int64_t t, const Body& body) const {
    const Int3 low = tile_at(t) * Int3(tile);
    team.each(tile * tile * tile, [&](int k) {
      const Int3 c = low + Int3(k % tile, k / tile % tile, k / (tile * tile));
      if (holds(c)) body(c, number(c.x, c.y, c.z));
    });
  }
};

/// For each cell of a lattice within `reach` voxels of an interface: which interface point is the closest to its
/// centre.
struct DistanceFieldView {
  Lattice lattice;
  const std::uint32_t* nearest = nullptr;  ///< per cell: number of an interface point, or `none`
  const InterfacePoint* point = nullptr;
  float reach = 0;

  NACRE_HD Vec3f position(std::uint32_t q) const {
    return {point[q].position.x, point[q].position.y, point[q].position.z};
  }

  /// The closest of the points that the eight cells around `p` know (outside of the lattice: the cells nearest to it);
  /// `none` where they know none.
  NACRE_HD std::uint32_t closest(const Vec3f& p, float& distance) const {
    const Int3 first{int(std::floor(p.x / lattice.spacing.x - 0.5f)), int(std::floor(p.y / lattice.spacing.y - 0.5f)),
                     int(std::floor(p.z / lattice.spacing.z - 0.5f))};
    std::uint32_t best = none;
    float least = 3e38f;
    for (int k = 0; k < 8; ++k) {
      const Int3 c = max(Int3(0), min(first + Int3(k & 1, k >> 1 & 1, k >> 2), lattice.cells - Int3(1)));
      const std::uint32_t q = nearest[lattice.number(c.x, c.y, c.z)];
      if (q == none || q == best) continue;
      const Vec3f r = position(q) - p;
      if (dot(r, r) < least) least = dot(r, r), best = q;
    }
    distance = std::sqrt(least);
    return best;
  }
};

namespace detail {

/// For a lattice cell: the voxel in it, nearest to its middle, that has a neighbour of another material.
struct BoundaryVoxel {
  MaterialBricksView field;
  Lattice lattice;

  NACRE_HD bool operator()(std::int64_t i, Int3& voxel) const {
    const Int3 c = lattice.cell(i), n = field.voxels();
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
    if (small && field.block_start[block] == field.block_start[block + 1]) return false;
    int best = 1 << 30;
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x) {
          const int away =
              abs1(2 * x + 1 - low.x - high.x) + abs1(2 * y + 1 - low.y - high.y) + abs1(2 * z + 1 - low.z - high.z);
          if (away < best && on_boundary(x, y, z)) best = away, voxel = {x, y, z};
        }
    return best < 1 << 30;
  }

 private:
  NACRE_HD static int abs1(int v) { return v < 0 ? -v : v; }
  NACRE_HD bool on_boundary(int x, int y, int z) const {
    const std::uint16_t* at = field.voxel_material + field.voxel_number(x, y, z);
    const std::int64_t row = std::int64_t(field.blocks.x) * block_size, slab = row * field.blocks.y * block_size;
    return at[-1] != *at || at[1] != *at || at[-row] != *at || at[row] != *at || at[-slab] != *at || at[slab] != *at;
  }
};

struct CountBoundaryCells {
  BoundaryVoxel boundary;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    Int3 voxel;
    count[i] = boundary(i, voxel) ? 1 : 0;
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
  const std::uint32_t* start;
  std::uint32_t* nearest;
  InterfacePoint* point;

  NACRE_HD void operator()(std::int64_t i) const {
    nearest[i] = none;
    Int3 v;
    if (!boundary(i, v)) return;
    const MaterialBricksView& field = boundary.field;
    const Vec3f u = field.cells_per_unit, p{(v.x + 0.5f) / u.x, (v.y + 0.5f) / u.y, (v.z + 0.5f) / u.z};
    InterfacePoint& result = point[start[i]];
    result.position = {0, 0, 0, -1};
    if (!field.inside(p, 3)) return;
    const std::int64_t block = field.block_at(p);
    const std::uint32_t own = field.voxel_material[field.voxel_number(v.x, v.y, v.z)];
    const CubicStencil stencil(field, p);
    const FieldSample mine = stencil.sample(field, own);
    std::uint32_t other = none;
    float least = 2.5f;
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
    if (!project(field, surface, p, 2.5f, found)) return;
    if (junction_margin(field, surface, found.p, found.steepness) < -0.25f) return;
    const CubicStencil there(field, found.p);
    const float curvature =
        largest_curvature(there.curvature(field, surface.material(0)), there.curvature(field, surface.material(1)));
    result.position = {found.p.x, found.p.y, found.p.z, 0};
    result.normal = {found.direction.x, found.direction.y, found.direction.z, curvature};
    result.surface = surface;
    nearest[i] = start[i];
  }
};

/// Tiles that can be within reach of an interface: those with a block that lists materials not farther away than
/// `margin`.
struct MarkNearTiles {
  MaterialBricksView field;
  Lattice lattice;
  float margin;  ///< voxels
  std::uint8_t* near;

  NACRE_HD void operator()(std::int64_t t) const {
    const Int3 tile = lattice.tile_at(t);
    Int3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const float wide = Lattice::tile * lattice.spacing[axis], per_block = field.cells_per_unit[axis] / block_size;
      low[axis] = int(max((float(tile[axis]) * wide - margin) * per_block, 0.0f));
      high[axis] = int((float(tile[axis] + 1) * wide + margin) * per_block);
    }
    high = min(high, field.blocks - Int3(1));
    near[t] = 0;
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::int64_t k = field.block_number(x, y, z);
          if (field.block_start[k] != field.block_start[k + 1]) near[t] = 1;
        }
  }
};

/// One round of jump flooding (Rong & Tan 2006): look `jump` cells away for a closer point.
struct JumpFlood {
  const std::uint8_t* near;  ///< per tile; the others keep what they have
  DistanceFieldView from;
  int jump;
  std::uint32_t* to;

  static constexpr std::size_t scratch_bytes() { return 0; }

  NACRE_HD void operator()(Team& team, std::int64_t t) const {
    if (!near[t]) return;
    from.lattice.each_in_tile(team, t, [&](const Int3& v, std::int64_t i) { to[i] = closest(v); });
  }

 private:
  NACRE_HD std::uint32_t closest(const Int3& v) const {
    const Lattice& lattice = from.lattice;
    const Vec3f p = lattice.centre(v);
    std::uint32_t best = none;
    float least = from.reach * from.reach;
    for (int z = v.z - jump; z <= v.z + jump; z += jump)
      for (int y = v.y - jump; y <= v.y + jump; y += jump) {
        if (unsigned(y) >= unsigned(lattice.cells.y) || unsigned(z) >= unsigned(lattice.cells.z)) continue;
        const std::uint32_t* row = from.nearest + lattice.number(0, y, z);
        for (int x = v.x - jump; x <= v.x + jump; x += jump) {
          if (unsigned(x) >= unsigned(lattice.cells.x)) continue;
          const std::uint32_t q = row[x];
          if (q == none || q == best) continue;
          const Vec3f r = from.position(q) - p;
          const float d = dot(r, r);
          if (d < least || (d == least && q < best)) least = d, best = q;
        }
      }
    return best;
  }
};

}  // namespace detail

/// Interface points and which of them is the closest to each cell of a lattice, in permanent memory.
struct DistanceField {
  Lattice lattice;
  Array<std::uint32_t> nearest;
  Array<InterfacePoint> point;
  float reach = 0;
  DistanceFieldView view() const { return {lattice, nearest.data(), point.data(), reach}; }
  std::int64_t bytes() const { return std::int64_t(nearest.bytes() + point.bytes()); }
};

/// The lattice of about `spacing` voxels over a volume, never finer than its voxels.
inline Lattice lattice_over(const MaterialBricks& b, float spacing) {
  Lattice lattice;
  for (int axis = 0; axis < 3; ++axis) {
    lattice.spacing[axis] = std::max(spacing, 1 / b.cells_per_unit[axis]);
    const double extent = double(b.blocks[axis] * block_size) / b.cells_per_unit[axis];
    lattice.cells[axis] = std::max(2, int(std::ceil(extent / lattice.spacing[axis] - 1e-3)));  // for interpolation
  }
  return lattice;
}

/// Points of all interfaces, at least one per boundary cell of `lattice_over`, flooded out to `reach` voxels. The
/// points are exact; the distances are those to the nearest of them.
template <class Backend>
DistanceField distance_field(Executor<Backend>& exec, const MaterialBricks& b, float spacing, float reach) {
  Arena& arena = exec.arena();
  DistanceField d;
  d.lattice = lattice_over(b, spacing);
  d.reach = reach;
  const std::int64_t n = d.lattice.count();
  d.nearest = arena.permanent<std::uint32_t>(n);
  Arena::Scope scope(arena);
  Array<std::uint32_t> other = arena.temporary<std::uint32_t>(n);
  const detail::BoundaryVoxel boundary{b.view(), d.lattice};
  exec.for_each(n, detail::CountBoundaryCells{boundary, other.data()});
  const std::uint32_t points = exec.exclusive_scan(other.data(), other.data(), n);
  d.point = arena.permanent<InterfacePoint>(std::max<std::uint32_t>(points, 1));
  exec.for_each(n, detail::FindInterfacePoints{boundary, other.data(), d.nearest.data(), d.point.data()});
  int jump = 1;
  while (2 * jump * std::min({d.lattice.spacing.x, d.lattice.spacing.y, d.lattice.spacing.z}) < reach) jump *= 2;
  // A list says what is within 4 voxels of its block, and an interface point lies up to 2.5 from its boundary voxel.
  const float margin = std::max(reach + 3.5f - 4, 0.0f);
  const std::int64_t tiles = d.lattice.tile_count();
  Array<std::uint8_t> near = arena.temporary<std::uint8_t>(tiles);
  exec.for_each(tiles, detail::MarkNearTiles{b.view(), d.lattice, margin, near.data()});
  other.fill_bytes(0xff);  // `none`, as in the first
  std::uint32_t *from = d.nearest.data(), *to = other.data();
  const auto flood = [&](int distance) {
    DistanceFieldView view = d.view();
    view.nearest = from;
    exec.for_each_team(tiles, detail::JumpFlood{near.data(), view, distance, to});
    std::swap(from, to);
  };
  for (; jump >= 1; jump /= 2) flood(jump);
  flood(1);
  if (from != d.nearest.data()) flood(1);
  return d;
}

}  // namespace nacre
