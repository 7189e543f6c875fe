// Nacre: closest interface points of the voxels around, and the signed distance that follows from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/device/team.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/lattice.hpp"

namespace nacre {

/// A point of an interface.
struct InterfacePoint {
  Float4 position;  ///< position in voxels; w: 0, or -1 where there is none
  Float4 normal;    ///< unit, towards the lower of the two materials; w: the larger principal curvature, per voxel
  Junction surface;
};

/// For each cell of a lattice within `reach` voxels of an interface: which interface point is the closest to its
/// centre.
struct DistanceFieldView {
  TilesView tiles;
  const std::uint32_t* nearest = nullptr;  ///< per slot of the tiles: number of an interface point, or `none`
  const InterfacePoint* point = nullptr;
  float reach = 0;

  NACRE_HD const Lattice& lattice() const { return tiles.lattice; }
  NACRE_HD Vec3f position(std::uint32_t q) const {
    return {point[q].position.x, point[q].position.y, point[q].position.z};
  }
  /// What a cell knows.
  NACRE_HD std::uint32_t at(const Int3& cell) const {
    const std::int64_t slot = tiles.slot(cell);
    return slot < 0 ? none : nearest[slot];
  }

  /// The closest of the points that the eight cells around `p` know (outside of the lattice: the cells nearest to it);
  /// `none` where they know none.
  NACRE_HD std::uint32_t closest(const Vec3f& p, float& distance) const {
    const Lattice& l = lattice();
    const Int3 first{int(std::floor(p.x / l.spacing.x - 0.5f)), int(std::floor(p.y / l.spacing.y - 0.5f)),
                     int(std::floor(p.z / l.spacing.z - 0.5f))};
    std::uint32_t best = none;
    float least = 3e38f;
    for (int k = 0; k < 8; ++k) {
      const std::uint32_t q = at(max(Int3(0), min(first + Int3(k & 1, k >> 1 & 1, k >> 2), l.cells - Int3(1))));
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

/// The numbers of the boundary cells in the lattice.
struct ListBoundaryCells {
  TilesView tiles;
  const std::uint32_t* start;  ///< per slot
  std::int64_t slots;
  std::uint32_t count;
  std::uint64_t* cell;
  NACRE_HD void operator()(std::int64_t i) const {
    if (start[i] == (i + 1 < slots ? start[i + 1] : count)) return;
    const Int3 c = tiles.cell(i);
    cell[start[i]] = std::uint64_t(tiles.lattice.number(c.x, c.y, c.z));
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
  const std::uint64_t* cell;
  std::uint32_t* nearest;
  std::uint32_t* known;
  InterfacePoint* point;

  NACRE_HD void operator()(std::int64_t i) const {
    const Int3 c = tiles.lattice.cell(std::int64_t(cell[i]));
    Int3 v;
    boundary(c, v);
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
    const std::int64_t slot = tiles.slot(c);
    nearest[slot] = std::uint32_t(i);
    relaxed_store(known + slot / Lattice::tile_cells, 1);
  }
};

struct CopyPosition {
  const InterfacePoint* point;
  Float4* position;
  NACRE_HD void operator()(std::int64_t i) const { position[i] = point[i].position; }
};

/// One round of jump flooding (Rong & Tan 2006): look `jump` cells away, a power of two, for a closer point.
struct JumpFlood {
  DistanceFieldView from;
  const Float4* position;  ///< of the interface points, without all else
  int jump;
  std::uint32_t* to;
  const std::uint32_t* known;  ///< per tile: whether a cell knows a point
  std::uint32_t* known_now;

  static constexpr std::size_t scratch_bytes() { return 27 * sizeof(std::uint32_t); }

  NACRE_HD void operator()(Team& team, std::int64_t s) const {
    auto* around = reinterpret_cast<std::uint32_t*>(team.scratch());
    const Int3 at = from.lattice().tile_at(from.tiles.tile[s]);
    const int stride = jump < Lattice::tile ? 1 : jump / Lattice::tile;
    team.each(27, [&](int k) {
      const std::uint32_t tile = from.tiles.beside(at, Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1) * Int3(stride));
      around[k] = tile != none && known[tile] ? tile : none;
    });
    bool any = false;
    for (int k = 0; k < 27; ++k) any = any || around[k] != none;
    if (!any) return;  // none here either, then and now
    const Int3 low = at * Int3(n);
    team.each(n * n, [&](int k) { search_row(around, s, low + Int3(0, k % n, k / n)); });
  }

 private:
  static constexpr int n = Lattice::tile;

  /// Along one axis: the three places that are looked at, and in which of the tiles around they are.
  struct Places {
    int tile[3], place[3];
    NACRE_HD Places(int place_in_tile, int jump) {
      for (int k = 0; k < 3; ++k) {
        const int p = place_in_tile + (k - 1) * (jump < n ? jump : n);
        tile[k] = p < 0 ? 0 : p < n ? 1 : 2;
        place[k] = p & (n - 1);
      }
    }
  };

  /// A row of cells, and what each one has found so far.
  struct Row {
    float x[n], y, z;
    std::uint32_t best[n];
    float least[n];

    /// Looks at the points `q`, one for each cell. Nothing branches on them, so that a CPU does all cells at once.
    NACRE_HD_INLINE void look_at(const std::uint32_t* q, const Float4* position) {
#if !defined(__CUDACC__)
#pragma omp simd
#endif
      for (int k = 0; k < n; ++k) {
        const std::uint32_t known = q[k] == none ? 0 : q[k];
        const float rx = position[known].x - x[k], ry = position[known].y - y, rz = position[known].z - z;
        const float square = rx * rx + ry * ry + rz * rz, d = q[k] == none ? 3e38f : square;
        const bool nearer = (d < least[k]) | ((d == least[k]) & (q[k] < best[k]));
        least[k] = nearer ? d : least[k];
        best[k] = nearer ? q[k] : best[k];
      }
    }
  };

  /// The cells from `first` on, along x, of stored tile `s`.
  NACRE_HD void search_row(const std::uint32_t* around, std::int64_t s, const Int3& first) const {
    const Lattice& lattice = from.lattice();
    if (!lattice.holds(first)) return;
    const int local_y = first.y % n, local_z = first.z % n, shift = jump < n ? jump : n;
    const Places y(local_y, jump), z(local_z, jump);
    Row row;
    row.y = lattice.centre(first).y, row.z = lattice.centre(first).z;
    for (int k = 0; k < n; ++k) {
      row.x[k] = lattice.centre(first + Int3(k, 0, 0)).x;
      row.best[k] = none;
      row.least[k] = from.reach * from.reach;
    }
    for (int c = 0; c < 3; ++c)
      for (int b = 0; b < 3; ++b) {
        std::uint32_t q[3 * n];  // what is known along x, in this tile and the two beside it
        if (!read_rows(around + (z.tile[c] * 3 + y.tile[b]) * 3, Lattice::place(0, y.place[b], z.place[c]), q))
          continue;
        for (int a = 0; a < 3; ++a) row.look_at(q + n + (a - 1) * shift, position);
      }
    std::uint32_t* result = to + s * Lattice::tile_cells + Lattice::place(0, local_y, local_z);
    const int end = lattice.cells.x - first.x < n ? lattice.cells.x - first.x : n;
    bool any = false;
    for (int k = 0; k < end; ++k) {
      result[k] = row.best[k];
      any = any || row.best[k] != none;
    }
    if (any) relaxed_store(known_now + s, 1);
  }

  /// The rows at one place of three tiles; false where none of these knows a point.
  NACRE_HD bool read_rows(const std::uint32_t* tiles, int place, std::uint32_t* q) const {
    bool any = false;
    for (int a = 0; a < 3; ++a) {
      const std::uint32_t* row = from.nearest + std::int64_t(tiles[a]) * Lattice::tile_cells + place;
      for (int k = 0; k < n; ++k) q[a * n + k] = tiles[a] == none ? none : row[k];
      any = any || tiles[a] != none;
    }
    return any;
  }
};

}  // namespace detail

/// Interface points and which of them is the closest to each cell of a lattice, in permanent memory.
struct DistanceField {
  LatticeTiles tiles;
  Array<std::uint32_t> nearest;  ///< per slot of the tiles
  Array<InterfacePoint> point;   ///< in the order of their cells
  float reach = 0;
  const Lattice& lattice() const { return tiles.lattice; }
  DistanceFieldView view() const { return {tiles.view(), nearest.data(), point.data(), reach}; }
  std::int64_t bytes() const { return tiles.bytes() + std::int64_t(nearest.bytes() + point.bytes()); }
};

namespace detail {

/// Finds the points, numbered as their cells are in the lattice, and notes them there. `other` is room per slot.
template <class Backend>
void find_interface_points(Executor<Backend>& exec, const MaterialBricks& b, DistanceField& d,
                           const Array<std::uint32_t>& other, const Array<std::uint32_t>& known) {
  Arena& arena = exec.arena();
  const TilesView tiles = d.tiles.view();
  const std::int64_t n = d.tiles.slots();
  const BoundaryVoxel boundary{b.view(), tiles.lattice};
  exec.for_each(n, CountBoundaryCells{boundary, tiles, other.data()});
  const std::uint32_t points = exec.exclusive_scan(other.data(), other.data(), n);
  d.point = arena.permanent<InterfacePoint>(std::max<std::uint32_t>(points, 1));
  Arena::Scope scope(arena);
  Array<std::uint64_t> cell = arena.temporary<std::uint64_t>(points);
  exec.for_each(n, ListBoundaryCells{tiles, other.data(), n, points, cell.data()});
  exec.sort(cell.data(), points);
  d.nearest.fill_bytes(0xff);  // `none`
  exec.for_each(points,
                FindInterfacePoints{boundary, tiles, cell.data(), d.nearest.data(), known.data(), d.point.data()});
}

}  // namespace detail

/// Points of all interfaces, at least one per boundary cell of `lattice_over`, flooded out to `reach` voxels. The
/// points are exact; the distances are those to the nearest of them.
template <class Backend>
DistanceField distance_field(Executor<Backend>& exec, const MaterialBricks& b, float spacing, float reach) {
  Arena& arena = exec.arena();
  DistanceField d;
  const Lattice lattice = lattice_over(b, spacing);
  d.tiles = tiles_near(exec, b, lattice, reach);
  d.reach = reach;
  d.nearest = arena.permanent<std::uint32_t>(d.tiles.slots());
  Arena::Scope scope(arena);
  Array<std::uint32_t> other = arena.temporary<std::uint32_t>(d.tiles.slots());
  Array<std::uint32_t> known[2] = {arena.temporary<std::uint32_t>(d.tiles.count()),
                                   arena.temporary<std::uint32_t>(d.tiles.count())};
  for (Array<std::uint32_t>& each : known) each.fill_bytes(0);
  detail::find_interface_points(exec, b, d, other, known[0]);
  Array<Float4> position = arena.temporary<Float4>(d.point.size());
  exec.for_each(std::int64_t(d.point.size()), detail::CopyPosition{d.point.data(), position.data()});
  int jump = 1;
  while (2 * jump * std::min({lattice.spacing.x, lattice.spacing.y, lattice.spacing.z}) < reach) jump *= 2;
  other.fill_bytes(0xff);  // `none`, where nothing is known and where the lattice does not hold a tile's cells
  std::uint32_t *from = d.nearest.data(), *to = other.data();
  const auto flood = [&](int distance) {
    DistanceFieldView view = d.view();
    view.nearest = from;
    exec.for_each_team(d.tiles.count(),
                       detail::JumpFlood{view, position.data(), distance, to, known[0].data(), known[1].data()});
    std::swap(from, to);
    std::swap(known[0], known[1]);
  };
  for (; jump >= 1; jump /= 2) flood(jump);
  flood(1);
  if (from != d.nearest.data()) flood(1);
  return d;
}

}  // namespace nacre
