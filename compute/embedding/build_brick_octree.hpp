// Nacre: builds the brick octree: bricks found from the triangles, cells brick by brick, the tree bottom-up.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/brick_ranges.hpp"
#include "compute/embedding/bricks_near.hpp"
#include "compute/embedding/closest_in_brick.hpp"
#include "compute/embedding/code_lists.hpp"
#include "compute/embedding/octree_nodes.hpp"
#include "compute/math/bisection.hpp"

namespace nacre {

/// A brick octree, and the owner of its arrays.
struct BrickOctree {
  int levels = 0;
  float radius = 0, quantum = 0;
  std::uint32_t brick_count = 0;
  CellIndex cells = 0, surface_cells = 0;
  Array<std::uint64_t> brick_code;
  Array<OctreeBrick> brick;
  Array<std::uint32_t> neighbour;
  OctreeNodes nodes;
  Array<CellPoint> point;
  Array<std::uint64_t> list_start;
  Array<std::uint32_t> list;

  BrickOctreeView view() const {
    return {levels,
            radius,
            quantum,
            brick_count,
            cells,
            surface_cells,
            brick_code.data(),
            brick.data(),
            neighbour.data(),
            nodes.node.data(),
            nodes.level_start.data(),
            point.data(),
            list_start.data(),
            list.data()};
  }

  std::uint64_t bytes() const {
    return brick_code.bytes() + brick.bytes() + neighbour.bytes() + nodes.node.bytes() + nodes.level_start.bytes() +
           point.bytes() + list_start.bytes() + list.bytes();
  }
};

namespace detail {

NACRE_HD_INLINE std::uint32_t cells_of(const CellMask& mask) {
  int n = 0;
  for (int z = 0; z < 8; ++z) n += count_bits(mask.word[z]);
  return std::uint32_t(n);
}

struct CountCells {
  const OctreeBrick* brick;
  std::uint32_t* band;
  std::uint32_t* surface;
  NACRE_HD void operator()(std::int64_t i) const {
    band[i] = cells_of(brick[i].band);
    surface[i] = cells_of(brick[i].surface);
  }
};

struct NumberCells {
  OctreeBrick* brick;
  const std::uint32_t* band;  // exclusive scans
  const std::uint32_t* surface;
  CellIndex first_cell, first_surface_cell;
  NACRE_HD void operator()(std::int64_t i) const {
    brick[i].band.number(first_cell + band[i]);
    brick[i].surface.number(first_surface_cell + surface[i]);
  }
};

/// Compacts the points of bricks, which have room for all cells.
struct GatherPoints {
  const OctreeBrick* brick;
  const CellPoint* from;
  CellPoint* to;
  std::size_t scratch_bytes() const { return 0; }
  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    each_masked(team, brick[i].band, [&](CellIndex cell, int x, int y, int z) {
      to[cell] = from[i * ClosestInBrick::cells + 64 * z + 8 * y + x];
    });
  }
};

struct FlagFilled {
  const OctreeBrick* brick;
  std::uint32_t* flag;
  NACRE_HD void operator()(std::int64_t i) const { flag[i] = brick[i].band.count() ? 1 : 0; }
};

struct GatherBricks {
  const OctreeBrick* from;
  const std::uint64_t* code;
  const std::uint32_t* number;
  OctreeBrick* to;
  std::uint64_t* to_code;
  NACRE_HD void operator()(std::int64_t i) const {
    if (from[i].band.count() == 0) return;
    to[number[i]] = from[i];
    to_code[number[i]] = code[i];
  }
};

/// The Morton codes of the bricks that a triangle touches.
struct BricksTouched {
  MeshView mesh;
  int levels;
  WantedBricks wanted{};
  template <class Visit>
  NACRE_HD void operator()(std::int64_t t, Visit&& visit) const {
    for_cells_near(mesh.corners(std::uint32_t(t)) * (1.0 / BrickOctreeView::width), 0.0, Int3(1 << levels),
                   [&](const Int3& b) {
                     const std::uint64_t code = morton(b);
                     if (wanted.contains(code)) visit(code);
                   });
  }
};

/// Where the list of a brick begins among those of all bricks; entry `bricks` is the end of the last.
struct FindList {
  const std::uint64_t* brick_code;
  std::uint32_t bricks, runs;
  std::uint64_t items;
  const std::uint64_t* position;  // ascending
  const std::uint64_t* run_start;
  std::uint64_t* start;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t run = i < bricks ? first_not_below(position, 0u, runs, brick_code[i]) : runs;
    start[i] = run < runs ? run_start[run] : items;
  }
};

struct CopyItems {
  const std::uint32_t* from;
  std::uint32_t* to;
  NACRE_HD void operator()(std::int64_t i) const { to[i] = from[i]; }
};

/// About how many bricks a cluster touches.
struct BricksUnder {
  ClusterView clusters;
  int levels;
  NACRE_HD std::uint64_t operator()(std::int64_t k) const {
    if (clusters.bound[k].radius < BrickOctreeView::width) return 1;
    return columns_under(clusters.corners[clusters.start[k]] * (1.0 / BrickOctreeView::width), Int3(1 << levels));
  }
};

}  // namespace detail

/// A part of an octree: the bricks of a range of Morton codes, and what lies within `depth` bricks of those.
struct OctreePart {
  std::uint64_t first = 0, last = 0;  ///< the range, without `last`
  int depth = 0;
};

namespace detail {

/// Fills a BrickOctree step by step.
template <class Backend>
class BrickOctreeBuilder {
 public:
  BrickOctreeBuilder(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels, double radius)
      : exec_(exec), mesh_(mesh), triangles_(triangles), radius_(radius) {
    tree_.levels = levels;
    tree_.radius = float(radius);
    tree_.quantum = CellPoint::quantum(radius);
  }

  BrickOctree build(const OctreePart* part) {
    Arena& arena = exec_.arena();
    std::vector<std::uint64_t> codes;
    {
      Arena::Scope scope(arena);
      const int size = BrickOctreeView::width << tree_.levels;
      const Clusters clusters = make_clusters(exec_, mesh_, triangles_, Int3(size));
      Array<TriangleFrame> frame = arena.temporary<TriangleFrame>(triangles_);
      exec_.for_each(triangles_, FrameTriangle{clusters.corners.data(), frame.data()});
      const ClusterView view{clusters.order.data(),   clusters.start.data(), clusters.bound.data(),
                             clusters.corners.data(), frame.data(),          float(size) * 1.1e-7f};
      // The centres of a brick's cells are half a cell inside of it.
      BricksNearCluster near{clusters.corners.data(), clusters.start.data(),          clusters.bound.data(),
                             Int3(1 << tree_.levels), double(BrickOctreeView::width), radius_ - 0.499};
      if (part) {
        near.wanted = {part->first, part->last};
        {
          Arena::Scope first(arena);
          codes = code_lists(exec_, clusters.count, near).runs.code.download();
        }
        codes = codes_around(codes, part->depth, tree_.levels);
        near.wanted = wanted_ = listed(codes);
      } else {
        require_room(view, clusters.count);
      }
      const CodeLists lists = code_lists(exec_, clusters.count, near);
      find_cells(view, lists);
    }
    if (tree_.cells == 0 && !part)
      throw Error("no cell lies near the surface", "no triangle is inside of the grid's domain", "give a surface");
    tree_.nodes = build_octree_nodes(exec_, tree_.brick_code, tree_.levels);
    tree_.neighbour = find_brick_neighbours(exec_, tree_.brick_code, tree_.levels);
    {
      Arena::Scope scope(arena);
      if (part) wanted_ = listed(codes);
      list_triangles();
    }
    return tree_;
  }

 private:
  /// In temporary memory of the caller's scope.
  WantedBricks listed(const std::vector<std::uint64_t>& codes) {
    Array<std::uint64_t> list = exec_.arena().template temporary<std::uint64_t>(std::max<std::size_t>(1, codes.size()));
    list.upload(codes);
    return {0, 0, list.data(), codes.size()};
  }

  static constexpr std::uint32_t bricks_at_once = 2048;  // 13 MB of points at most

  /// For triangles of millions of cells squared, it would take hours to find that they do not fit.
  void require_room(const ClusterView& clusters, std::uint32_t count) {
    const std::uint64_t bricks = exec_.reduce(count, std::uint64_t(0), BricksUnder{clusters, tree_.levels}, Add{});
    const std::uint64_t needed = 12 * bricks;  // a pair of brick and cluster
    const std::size_t room = exec_.arena().room_bytes();
    if (needed > room)
      throw Error("the band around the surface does not fit into memory",
                  "over " + std::to_string(needed >> 30) + " GiB needed, " + std::to_string(room >> 30) + " GiB free",
                  exec_.device().too_small("lower the resolution"));
  }

  void find_cells(const ClusterView& clusters, const CodeLists& lists) {
    Arena& arena = exec_.arena();
    const std::uint32_t count = lists.runs.count, most = std::min(count, bricks_at_once);
    Array<OctreeBrick> found = arena.temporary<OctreeBrick>(count);
    {
      Arena::Scope scope(arena);
      Array<CellPoint> point = arena.temporary<CellPoint>(std::size_t(most) * ClosestInBrick::cells);
      Array<std::uint32_t> band = arena.temporary<std::uint32_t>(most), surface = arena.temporary<std::uint32_t>(most);
      tree_.point = arena.permanent<CellPoint>(0);
      for (std::uint64_t first = 0; first < count; first += most) {
        const auto n = std::int64_t(std::min<std::uint64_t>(most, count - first));
        OctreeBrick* brick = found.data() + first;
        exec_.next_is(double(first) / count, double(first + std::uint64_t(n)) / count);
        exec_.for_each_team(n, ClosestInBrick{clusters, radius_, tree_.quantum, lists.runs.code.data() + first,
                                              lists.runs.start.data() + first, lists.item.data(), brick, point.data()});
        exec_.for_each(n, CountCells{brick, band.data(), surface.data()});
        const std::uint32_t cells = exec_.exclusive_scan(band.data(), band.data(), n);
        const std::uint32_t surface_cells = exec_.exclusive_scan(surface.data(), surface.data(), n);
        exec_.for_each(n, NumberCells{brick, band.data(), surface.data(), tree_.cells, tree_.surface_cells});
        tree_.cells += cells;
        tree_.surface_cells += surface_cells;
        arena.resize_last(tree_.point, tree_.cells);
        exec_.for_each_team(n, GatherPoints{brick, point.data(), tree_.point.data()});
      }
    }
    keep_filled(found, lists.runs.code);
  }

  /// Some of the bricks found have no cell within the radius.
  void keep_filled(const Array<OctreeBrick>& found, const Array<std::uint64_t>& code) {
    Arena& arena = exec_.arena();
    const auto count = std::int64_t(found.size());
    Array<std::uint32_t> number = arena.temporary<std::uint32_t>(count);
    exec_.for_each(count, FlagFilled{found.data(), number.data()});
    tree_.brick_count = exec_.exclusive_scan(number.data(), number.data(), count);
    tree_.brick_code = arena.permanent<std::uint64_t>(tree_.brick_count);
    tree_.brick = arena.permanent<OctreeBrick>(tree_.brick_count);
    exec_.for_each(count,
                   GatherBricks{found.data(), code.data(), number.data(), tree_.brick.data(), tree_.brick_code.data()});
  }

  void list_triangles() {
    Arena& arena = exec_.arena();
    Arena::Scope scope(arena);
    const CodeLists lists = code_lists(exec_, triangles_, BricksTouched{mesh_, tree_.levels, wanted_});
    tree_.list_start = arena.permanent<std::uint64_t>(std::size_t(tree_.brick_count) + 1);
    tree_.list = arena.permanent<std::uint32_t>(lists.item.size());
    exec_.for_each(std::int64_t(tree_.brick_count) + 1,
                   FindList{tree_.brick_code.data(), tree_.brick_count, lists.runs.count, lists.item.size(),
                            lists.runs.code.data(), lists.runs.start.data(), tree_.list_start.data()});
    exec_.for_each(std::int64_t(lists.item.size()), CopyItems{lists.item.data(), tree_.list.data()});
  }

  Executor<Backend>& exec_;
  MeshView mesh_;
  std::uint32_t triangles_;
  double radius_;
  WantedBricks wanted_{};
  BrickOctree tree_;
};

}  // namespace detail

/// Builds the octree around `triangles` triangles whose points are in cells, in a domain of 8 << levels cells per axis,
/// at most 2^20. Every cell whose centre is within `radius` (1 to 1000 cells) of a triangle is stored, with the closest
/// point of the whole mesh (of equally distant triangles the lower one); whatever is outside of the domain is cut off.
/// Empty space costs nothing. Arrays are permanent in the executor's arena; while building, a brick needs some 500
/// bytes more. `part`: only these bricks, with the same cells as in the whole octree, perhaps none; null: all. Throws
/// Error if levels or radius are out of range, no cell is in the band, or memory is insufficient.
template <class Backend>
BrickOctree build_brick_octree(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                               double radius, const OctreePart* part = nullptr) {
  if (levels < 0 || levels > 17)
    throw Error("the grid is too fine", std::to_string(levels) + " levels; at most 2^20 cells per axis",
                "lower the resolution");
  if (!(radius >= 1 && radius <= 1000)) throw Error("the band's radius is out of range", "", "use 1 to 1000 cells");
  return detail::BrickOctreeBuilder<Backend>(exec, mesh, triangles, levels, radius).build(part);
}

}  // namespace nacre
