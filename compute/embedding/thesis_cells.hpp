// Nacre: the band's cells and their closest points as the thesis finds them: sub-grid by sub-grid (sec. 6.1.1,
// Alg. 6.1).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/band.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/closest_point_grid.hpp"
#include "compute/math/morton.hpp"

namespace nacre {

/// How the domain is cut up while the thesis octree is built. The result does not depend on it.
struct ThesisSubgrids {
  int edge = 0;                  ///< cells per axis, a power of two from 8 to 256; 0: what memory and speed ask for
  std::uint64_t list_limit = 0;  ///< a sub-grid with more entries in its triangle lists is cut in eight; 0: by memory

  static constexpr int most_bits = 8, least_bits = 3;  ///< log2 of the edges
  /// Of 2^5 to 2^7, which take the same time on a CPU (15M cells at 1024^3: 6.3, 6.4, 6.6 s), the middle; 2^8 is slower
  /// wherever triangles are small, since its lists leave the cache.
  static constexpr int fast_bits = 6;
  /// What the thesis counts per cell of a sub-grid, if all are in the band: code, closest point, vector, counter.
  static constexpr std::uint64_t bytes_per_cell = 8 + 12 + 12 + 4;
};

/// Cells of the band in Morton order. The arrays are permanent in the arena.
struct ThesisCells {
  std::uint64_t count = 0, touched_count = 0;
  Array<std::uint64_t> code;
  Array<CellPoint> point;
  Array<std::uint32_t> touched;  ///< a bit per cell: a triangle touches it
};

namespace detail {

// Both passes over triangles and cells, that which counts and that which writes, run the same compiled kernel: of two
// instantiations the compiler may round one differently, and one pass would find a cell that the other did not.

/// Which sub-grids a triangle comes near; counts them where `keys` is null.
struct TriangleSubgrids {
  MeshView mesh;
  double scale, margin;  // 1 / edge, radius / edge
  int subgrids;          // per axis
  std::uint64_t* count;  // later: where the triangle's keys begin
  std::uint64_t* keys;   // Morton code of the sub-grid
  std::uint32_t* triangle;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t at = keys ? count[i] : 0;
    for_cells_near(mesh.corners(std::uint32_t(i)) * scale, margin, Int3(subgrids), [&](const Int3& s) {
      if (keys) {
        keys[at] = morton(s);
        triangle[at] = std::uint32_t(i);
      }
      ++at;
    });
    if (!keys) count[i] = at;
  }
};

struct SubgridHead {
  const std::uint64_t* keys;
  std::uint32_t* head;
  NACRE_HD void operator()(std::int64_t i) const { head[i] = i == 0 || keys[i] != keys[i - 1] ? 1 : 0; }
};

struct SubgridStart {
  const std::uint64_t* keys;
  const std::uint32_t* number;  // exclusive scan of the heads
  std::uint64_t* code;
  std::uint64_t* start;
  NACRE_HD void operator()(std::int64_t i) const {
    if (i > 0 && keys[i] == keys[i - 1]) return;
    code[number[i]] = keys[i];
    start[number[i]] = std::uint64_t(i);
  }
};

/// A cube of cells and the triangles near it: a range of TrianglesNear::triangle.
struct Subgrid {
  std::uint64_t code;  // Morton code of its position among cubes of its size
  int bits;            // log2 of its edge
  std::uint64_t first, last;

  Int3 low() const { return morton_cell(code << 3 * bits); }
  std::int64_t cells() const { return std::int64_t(1) << 3 * bits; }
};

/// Counts triangles per cell of a sub-grid, or, with `list`, writes them: at the cell's start plus its running count. A
/// triangle counts where its closest point lies within the radius; the thesis's listing leaves that test out.
struct ListTriangles {
  MeshView mesh;
  const std::uint32_t* triangle;
  Int3 low;
  int edge;
  double radius;
  std::uint32_t* count;  // per cell, in Morton order
  const std::uint32_t* start;
  std::uint32_t* list;

  std::size_t scratch_bytes() const { return 0; }

  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    const std::uint32_t t = triangle[i];
    const Corners c = mesh.corners(t);
    const Vec3d lowest = min(c.a, min(c.b, c.c)) - Vec3d(low), highest = max(c.a, max(c.b, c.c)) - Vec3d(low);
    const double grown = radius + 1e-6;  // a cell at just the radius must not fall to rounding here
    Int3 first, size;
    for (int axis = 0; axis < 3; ++axis) {
      const double from = std::ceil(lowest[axis] - grown - 0.5), to = std::floor(highest[axis] + grown - 0.5);
      if (from >= edge || to < 0) return;
      first[axis] = from > 0 ? int(from) : 0;
      size[axis] = (to < edge ? int(to) : edge - 1) - first[axis] + 1;
    }
    if (size.x <= 0 || size.y <= 0 || size.z <= 0) return;
    team.each(size.y * size.z, [&](int row) {
      const Int3 begin = first + Int3(0, row % size.y, row / size.y);
      for (int x = 0; x < size.x; ++x) {
        const Int3 cell = begin + Int3(x, 0, 0);
        const Vec3d centre = Vec3d(low + cell) + Vec3d(0.5);
        const Vec3d d = closest_point(c, centre) - centre;
        if (!(dot(d, d) <= radius * radius)) continue;
        const std::uint64_t at = morton(cell);
        const std::uint32_t slot = atomic_add(count + at, 1u);
        if (list) list[start[at] + slot] = t;
      }
    });
  }
};

struct SubgridTotals {
  std::uint64_t entries = 0, cells = 0;
};

struct TotalsOfCell {
  const std::uint32_t* count;
  NACRE_HD SubgridTotals operator()(std::int64_t i) const { return {count[i], count[i] ? 1u : 0u}; }
};

struct AddTotals {
  NACRE_HD SubgridTotals operator()(const SubgridTotals& a, const SubgridTotals& b) const {
    return {a.entries + b.entries, a.cells + b.cells};
  }
};

struct HasTriangles {
  const std::uint32_t* count;
  std::uint32_t* flag;
  NACRE_HD void operator()(std::int64_t i) const { flag[i] = count[i] ? 1 : 0; }
};

struct WriteCells {
  const std::uint32_t* count;
  const std::uint32_t* number;  // exclusive scan of the flags
  std::uint32_t* local;
  NACRE_HD void operator()(std::int64_t i) const {
    if (count[i]) local[number[i]] = std::uint32_t(i);
  }
};

/// The closest point of a cell over its list, the lower triangle of equals, and whether a triangle touches the cell.
struct ClosestOfList {
  static constexpr std::uint32_t touched = 1u << 31;

  MeshView mesh;
  Int3 low;
  float quantum;
  const std::uint32_t* count;
  const std::uint32_t* start;
  const std::uint32_t* list;
  std::uint32_t* local;  // Morton code in the sub-grid; takes the flag
  CellPoint* point;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = local[i];
    const Vec3d x = Vec3d(low + morton_cell(at)) + Vec3d(0.5);
    double best = 1e300;
    Vec3d offset{};
    std::uint32_t winner = none;
    bool touches = false;
    for (std::uint32_t k = 0; k < count[at]; ++k) {
      const std::uint32_t t = list[start[at] + k];
      const Corners c = mesh.corners(t);
      const Vec3d d = closest_point(c, x) - x;
      const double dd = dot(d, d);
      if (!touches && dd <= 0.7501) touches = touches_cube(c, x, 0.5 + 1e-7);  // 3/4: half the diagonal, squared
      if (dd > best || (dd == best && t > winner)) continue;
      best = dd;
      offset = d;
      winner = t;
    }
    point[i] = CellPoint::pack(offset, quantum, winner);
    if (touches) local[i] = at | touched;
  }
};

/// The cells of one sub-grid, until all are known.
struct CellChunk {
  std::uint64_t base;   // Morton code of the sub-grid's first cell
  std::uint64_t first;  // number of its first band cell
  Array<std::uint32_t> local;
};

struct GatherCells {
  std::uint64_t base, first;
  const std::uint32_t* local;
  std::uint64_t* code;
  std::uint32_t* touched;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint64_t cell = first + std::uint64_t(i);
    code[cell] = base | (local[i] & ~ClosestOfList::touched);
    if (local[i] & ClosestOfList::touched) atomic_add(touched + (cell >> 5), 1u << (cell & 31));
  }
};

struct IsTouched {
  const std::uint32_t* touched;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return touched[i >> 5] >> (i & 31) & 1; }
};

/// Log2 of the sub-grids' edge: the wish, or the fast one; smaller where memory or the domain is.
inline int subgrid_bits(const Arena& arena, int levels, int edge) {
  int bits = ThesisSubgrids::fast_bits;
  if (edge) {
    bits = ThesisSubgrids::least_bits;
    while (bits < ThesisSubgrids::most_bits && 1 << bits < edge) ++bits;
  }
  bits = std::min(bits, levels + 3);
  while (bits > ThesisSubgrids::least_bits && ThesisSubgrids::bytes_per_cell << 3 * bits > arena.room_bytes() / 8)
    --bits;
  return bits;
}

/// The sub-grids of 2^bits cells per axis near triangles, in Morton order. The thesis goes over all sub-grids,
/// which at 4096^3 would write 825 GB of counters; those that no triangle comes near are never visited here.
/// `triangle` becomes the list that their ranges are in, temporary.
template <class Backend>
std::vector<Subgrid> subgrids_near(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                                   double radius, int bits, Array<std::uint32_t>& triangle) {
  Arena& arena = exec.arena();
  const double scale = 1.0 / (1 << bits);
  Array<std::uint64_t> start = arena.temporary<std::uint64_t>(triangles);
  TriangleSubgrids near{mesh, scale, radius * scale, (8 << levels) >> bits, start.data(), nullptr, nullptr};
  exec.for_each(triangles, near);
  const std::uint64_t pairs = exec.exclusive_scan(start.data(), start.data(), triangles);
  if (pairs >= none)
    throw Error("the mesh is too large", "over 2^32 pairs of triangle and sub-grid", "use `octree` brick");
  triangle = arena.temporary<std::uint32_t>(pairs);

  Arena::Scope scope(arena);
  Array<std::uint64_t> keys = arena.temporary<std::uint64_t>(pairs);
  near.keys = keys.data();
  near.triangle = triangle.data();
  exec.for_each(triangles, near);
  exec.sort_pairs(keys.data(), triangle.data(), pairs);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(pairs);
  exec.for_each(pairs, SubgridHead{keys.data(), number.data()});
  const std::uint32_t count = exec.exclusive_scan(number.data(), number.data(), pairs);
  Array<std::uint64_t> code = arena.temporary<std::uint64_t>(count), first = arena.temporary<std::uint64_t>(count);
  exec.for_each(pairs, SubgridStart{keys.data(), number.data(), code.data(), first.data()});

  const std::vector<std::uint64_t> codes = code.download(), firsts = first.download();
  std::vector<Subgrid> subgrids(count);
  for (std::uint32_t s = 0; s < count; ++s)
    subgrids[s] = {codes[s], bits, firsts[s], s + 1 < count ? firsts[s + 1] : pairs};
  return subgrids;
}

/// Works through sub-grids, which share dense counters as large as one of them.
template <class Backend>
class SubgridBuilder {
 public:
  SubgridBuilder(Executor<Backend>& exec, const MeshView& mesh, double radius, int bits,
                 const Array<std::uint32_t>& triangle, std::uint64_t list_limit)
      : exec_(exec),
        mesh_(mesh),
        radius_(radius),
        triangle_(triangle),
        list_limit_(list_limit ? list_limit : ~std::uint64_t(0)),
        point_(exec.arena().template permanent<CellPoint>(0)) {
    const std::size_t dense = std::size_t(1) << 3 * bits;
    count_ = exec.arena().template temporary<std::uint32_t>(dense);
    start_ = exec.arena().template temporary<std::uint32_t>(dense);
    number_ = exec.arena().template temporary<std::uint32_t>(dense);
  }

  /// Adds the band cells of a sub-grid, which must come in Morton order; in eight pieces where its lists are too long.
  void add(const Subgrid& sub) {
    const SubgridTotals totals = count(sub);
    if (totals.cells == 0) return;
    if (!fits(totals)) {
      if (sub.bits == 0)
        throw Error("not enough memory for the triangles around one cell", std::to_string(totals.entries) + " of them",
                    "use `octree` brick, which keeps no such lists");
      for (std::uint64_t k = 0; k < 8; ++k) add({sub.code << 3 | k, sub.bits - 1, sub.first, sub.last});
      return;
    }
    find(sub, totals);
  }

  /// Everything that was added.
  ThesisCells finish() {
    Arena& arena = exec_.arena();
    if (total_ == 0)
      throw Error("no cell lies near the surface", "no triangle is inside of the grid's domain", "give a surface");
    ThesisCells cells;
    cells.count = total_;
    cells.point = point_;
    cells.code = arena.permanent<std::uint64_t>(total_);
    cells.touched = arena.permanent<std::uint32_t>((total_ + 31) / 32);
    cells.touched.fill_bytes(0);
    for (const CellChunk& c : chunks_)
      exec_.for_each(c.local.size(),
                     GatherCells{c.base, c.first, c.local.data(), cells.code.data(), cells.touched.data()});
    cells.touched_count = exec_.reduce(std::int64_t(total_), std::uint64_t(0), IsTouched{cells.touched.data()}, Add{});
    return cells;
  }

 private:
  void list(const Subgrid& sub, std::uint32_t* to) {
    exec_.device().fill(count_.data(), 0, sub.cells() * sizeof(std::uint32_t));
    exec_.for_each_team(std::int64_t(sub.last - sub.first),
                        ListTriangles{mesh_, triangle_.data() + sub.first, sub.low(), 1 << sub.bits, radius_,
                                      count_.data(), start_.data(), to});
  }

  SubgridTotals count(const Subgrid& sub) {
    list(sub, nullptr);
    return exec_.reduce(sub.cells(), SubgridTotals{}, TotalsOfCell{count_.data()}, AddTotals{});
  }

  /// Half of what is free may go into lists; numbers in them have 32 bits.
  bool fits(const SubgridTotals& totals) const {
    return totals.entries < none && totals.entries <= list_limit_ &&
           totals.entries <= exec_.arena().free_bytes() / 2 / sizeof(std::uint32_t);
  }

  void find(const Subgrid& sub, const SubgridTotals& totals) {
    if (total_ + totals.cells >= none)
      throw Error("the grid is too fine for `octree` source", "over 2^32 cells",
                  "lower `resolution`, or use `octree` brick");
    Arena& arena = exec_.arena();
    CellChunk chunk{sub.code << 3 * sub.bits, total_, arena.temporary<std::uint32_t>(totals.cells)};
    arena.resize_last(point_, total_ + totals.cells);
    exec_.for_each(sub.cells(), HasTriangles{count_.data(), number_.data()});
    exec_.exclusive_scan(number_.data(), number_.data(), sub.cells());
    exec_.for_each(sub.cells(), WriteCells{count_.data(), number_.data(), chunk.local.data()});
    exec_.exclusive_scan(count_.data(), start_.data(), sub.cells());

    Arena::Scope scope(arena);
    Array<std::uint32_t> lists = arena.temporary<std::uint32_t>(totals.entries);
    list(sub, lists.data());
    exec_.for_each(std::int64_t(totals.cells),
                   ClosestOfList{mesh_, sub.low(), CellPoint::quantum(radius_), count_.data(), start_.data(),
                                 lists.data(), chunk.local.data(), point_.data() + total_});
    total_ += totals.cells;
    chunks_.push_back(chunk);
  }

  Executor<Backend>& exec_;
  MeshView mesh_;
  double radius_;
  Array<std::uint32_t> triangle_;
  std::uint64_t list_limit_;
  Array<std::uint32_t> count_, start_, number_;  // per cell of a sub-grid
  Array<CellPoint> point_;
  std::vector<CellChunk> chunks_;
  std::uint64_t total_ = 0;
};

}  // namespace detail

/// All cells of a domain of 8 << levels cells per axis that lie within `radius` cells of one of `triangles` triangles
/// (points in cells), with their closest points. Follows Alg. 6.1: sub-grids that fit into memory; per sub-grid counts
/// of near triangles, an exclusive scan, lists, the closest point over each cell's list. Sub-grids come in Morton order
/// and so do the cells within each, so that the keys need no sorting. Throws Error when the arrays do not fit, or no
/// cell is in the band.
template <class Backend>
ThesisCells find_thesis_cells(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                              double radius, const ThesisSubgrids& subgrids = {}) {
  Arena::Scope scope(exec.arena());
  const int bits = detail::subgrid_bits(exec.arena(), levels, subgrids.edge);
  Array<std::uint32_t> triangle;
  const std::vector<detail::Subgrid> near =
      detail::subgrids_near(exec, mesh, triangles, levels, radius, bits, triangle);
  detail::SubgridBuilder<Backend> builder(exec, mesh, radius, bits, triangle, subgrids.list_limit);
  for (const detail::Subgrid& sub : near) builder.add(sub);
  return builder.finish();
}

}  // namespace nacre
