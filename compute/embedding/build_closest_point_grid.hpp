// Nacre: the closest-point grid from triangles (sec. 5.1.1, Alg. 5.1, corrected as the notes in docs/method.md say).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/bricks_near.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/closest_point_grid.hpp"
#include "compute/embedding/clusters.hpp"
#include "compute/embedding/octet_search.hpp"
#include "compute/embedding/sorted_pairs.hpp"

namespace nacre {

/// A closest-point grid and who owns its arrays.
struct ClosestPointGrid {
  Int3 bricks{};
  int sub = 4;
  float radius = 0;
  std::uint32_t brick_count = 0;
  std::uint64_t cells = 0;  ///< stored: brick_count * sub^3
  Array<std::uint32_t> brick_index;
  Array<std::uint64_t> brick_code;
  Array<Float4> offset;
  Array<std::uint32_t> triangle;
  Array<std::uint32_t> touch_start;
  Array<std::uint32_t> touch_triangle;

  ClosestPointGridView view() const {
    return {bricks,
            sub,
            Divider(sub),
            radius,
            brick_index.data(),
            brick_code.data(),
            offset.data(),
            triangle.data(),
            touch_start.data(),
            touch_triangle.data()};
  }

  std::uint64_t bytes() const {
    return brick_index.bytes() + brick_code.bytes() + offset.bytes() + triangle.bytes() + touch_start.bytes() +
           touch_triangle.bytes();
  }
};

namespace detail {

/// Writes what begins at the first key of each brick.
struct BrickStart {
  std::uint64_t pairs;
  std::uint32_t count;
  Int3 bricks;
  const std::uint64_t* keys;
  const std::uint32_t* number;
  std::uint64_t* start;
  std::uint64_t* code;
  std::uint32_t* index;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t next = std::uint64_t(i) + 1 < pairs ? number[i + 1] : count;
    if (next != number[i]) {
      const std::uint32_t b = number[i];
      start[b] = std::uint64_t(i);
      code[b] = keys[i] >> 32;
      const Int3 c = morton_cell(code[b]);
      index[(std::int64_t(c.z) * bricks.y + c.y) * bricks.x + c.x] = b;
    }
    if (std::uint64_t(i) + 1 == pairs) start[count] = pairs;
  }
};

/// Exact closest points of an octet (2^3 cells) among the clusters of its brick, of which it keeps the few that can
/// hold one of any of its cells.
struct ClosestOfOctet {
  static constexpr int room = 96;  // clusters kept; with more than that the octet searches the whole list

  ClosestPointGridView grid;
  ClusterView clusters;
  const std::uint64_t* list_start;
  const std::uint64_t* list;  // keys: the low half is the cluster
  Float4* offset;
  std::uint32_t* triangle;

  NACRE_HD static int octets(int sub) { return (sub + 1) / 2; }

  NACRE_HD void operator()(std::int64_t i) const {
    const int n = octets(grid.sub);
    const auto brick = std::uint32_t(i / (n * n * n));
    const int o = int(i % (n * n * n));
    const Int3 corner{2 * (o % n), 2 * (o / n % n), 2 * (o / (n * n))};
    const Vec3d centre(morton_cell(grid.brick_code[brick]) * Int3(grid.sub) + corner + Int3(1));
    const std::uint64_t* all = list + list_start[brick];
    const auto count = int(list_start[brick + 1] - list_start[brick]);
    const float near = distance(Vec3f(centre), all, count);
    std::uint32_t kept[room + 1];
    const int few = keep(Vec3f(centre), near, all, count, kept);
    const float farthest =
        near + 2 * cell_diagonal;  // more than any cell is from the surface: all have a closest point
    OctetSearch search(clusters, centre, near, farthest, OctetSearch::all_touched);
    if (few <= room)
      search.search(few, [&](std::uint64_t k) { return kept[k]; });
    else
      search.search(count, [&](std::uint64_t k) { return std::uint32_t(all[k]); });
    for (int k = 0; k < 8; ++k) {
      const Int3 local = corner + Int3(k & 1, k >> 1 & 1, k >> 2);
      if (local.x >= grid.sub || local.y >= grid.sub || local.z >= grid.sub) continue;
      const std::uint32_t at = brick * grid.cells_per_brick() + (local.z * grid.sub + local.y) * grid.sub + local.x;
      offset[at] = search.offset(k);
      triangle[at] = search.triangle(k);
    }
  }

  /// How far the surface is from `centre`, at most: the clusters' centres lie on it.
  NACRE_HD float distance(const Vec3f& centre, const std::uint64_t* all, int count) const {
    float nearest = 1e30f;
    for (int k = 0; k < count; ++k) {
      const Vec3f d = clusters.bound[std::uint32_t(all[k])].centre - centre;
      const float square = dot(d, d);
      nearest = square < nearest ? square : nearest;
    }
    return std::sqrt(nearest) + clusters.rounding + 1e-3f;
  }

  /// Lists the clusters whose balls come near enough to hold a closest point of a cell of the octet around `centre`,
  /// from which the surface is at most `near` away; returns how many there are.
  NACRE_HD int keep(const Vec3f& centre, float near, const std::uint64_t* all, int count, std::uint32_t* kept) const {
    const float reach = near + 2 * cell_diagonal + clusters.rounding + 1e-3f;  // to a cell and back
    int few = 0;
    for (int k = 0; k < count; ++k) {
      const auto c = std::uint32_t(all[k]);
      const ClusterBound& b = clusters.bound[c];
      const Vec3f d = b.centre - centre;
      const float farthest = reach + b.radius;
      kept[few < room ? few : room] = c;
      few += int(dot(d, d) <= farthest * farthest);
    }
    return few;
  }
};

/// The cells that a triangle touches, by address.
struct CellsTouched {
  MeshView mesh;
  ClosestPointGridView grid;
  template <class Visit>
  NACRE_HD void operator()(std::int64_t t, Visit&& visit) const {
    for_cells_near(mesh.corners(std::uint32_t(t)), 0.0, grid.dims(), [&](const Int3& c) { visit(grid.address(c)); });
  }
};

}  // namespace detail

/// Builds the grid around `triangles` triangles whose points are in cells, inside `bricks` coarse cells (each extent at
/// most 1024) of `sub` cells per axis. Marks every brick that comes within `radius` cells of a triangle, not only those
/// that hold a vertex, and takes the true closest triangle, not one that shares the nearest vertex (Alg. 5.1 does
/// neither). Arrays are permanent in the executor's arena. Throws Error when they do not fit.
template <class Backend>
ClosestPointGrid build_closest_point_grid(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles,
                                          Int3 bricks, int sub, float radius) {
  Arena& arena = exec.arena();
  ClosestPointGrid grid;
  grid.bricks = bricks;
  grid.sub = sub;
  grid.radius = radius;
  grid.brick_index = arena.permanent<std::uint32_t>(std::size_t(bricks.x) * bricks.y * bricks.z);
  grid.brick_index.fill_bytes(0xff);
  {
    Arena::Scope scope(arena);
    const Clusters clusters = make_clusters(exec, mesh, triangles, bricks * Int3(sub));
    const detail::BricksNearCluster near{
        clusters.corners.data(), clusters.start.data(), clusters.bound.data(), bricks, double(sub), double(radius)};
    const Array<std::uint64_t> pairs = sorted_pairs(exec, clusters.count, near);
    Array<std::uint32_t> number;
    grid.brick_count = number_bins(exec, pairs, number);
    grid.cells = std::uint64_t(grid.brick_count) * sub * sub * sub;
    if (grid.cells >= none) throw Error("the grid is too fine", "over 2^32 cells", "lower `resolution`");
    Array<std::uint64_t> list_start = arena.temporary<std::uint64_t>(grid.brick_count + 1);
    grid.brick_code = arena.permanent<std::uint64_t>(grid.brick_count);
    exec.for_each(pairs.size(), detail::BrickStart{pairs.size(), grid.brick_count, bricks, pairs.data(), number.data(),
                                                   list_start.data(), grid.brick_code.data(), grid.brick_index.data()});
    grid.offset = arena.permanent<Float4>(grid.cells);
    grid.triangle = arena.permanent<std::uint32_t>(grid.cells);
    Array<TriangleFrame> frame = arena.temporary<TriangleFrame>(triangles);
    exec.for_each(triangles, detail::FrameTriangle{clusters.corners.data(), frame.data()});
    const Int3 dims = bricks * Int3(sub);
    const detail::ClusterView view{clusters.order.data(), clusters.start.data(),
                                   clusters.bound.data(), clusters.corners.data(),
                                   frame.data(),          float(std::max({dims.x, dims.y, dims.z})) * 1.1e-7f};
    const int octets = detail::ClosestOfOctet::octets(sub);
    exec.next_is(0.05, 0.3);
    exec.for_each(std::int64_t(grid.brick_count) * octets * octets * octets,
                  detail::ClosestOfOctet{grid.view(), view, list_start.data(), pairs.data(), grid.offset.data(),
                                         grid.triangle.data()});
  }
  Arena::Scope scope(arena);
  const Array<std::uint64_t> pairs = sorted_pairs(exec, triangles, detail::CellsTouched{mesh, grid.view()});
  if (pairs.size() >= none) throw Error("the mesh is too fine", "over 2^32 pairs of triangle and cell");
  grid.touch_start = arena.permanent<std::uint32_t>(grid.cells + 1);
  grid.touch_triangle = arena.permanent<std::uint32_t>(pairs.size());
  exec.for_each(grid.cells + 1, detail::ListStart<std::uint32_t>{pairs.size(), pairs.data(), grid.touch_start.data()});
  exec.for_each(pairs.size(), detail::LowHalf{pairs.data(), grid.touch_triangle.data()});
  return grid;
}

}  // namespace nacre
