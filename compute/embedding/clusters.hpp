// Nacre: small triangles in groups, so that a mesh far finer than the grid costs little more than a coarse one.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/closest_point_grid.hpp"
#include "compute/math/morton.hpp"

namespace nacre {

/// A flat cylinder that contains a cluster: around a point of the surface, with `radius`, and `thickness` to either
/// side.
struct alignas(16) ClusterBound {
  Vec3f centre;
  float radius;
  Vec3f normal;
  float thickness;
};

/// Clusters of triangles whose centroids lie in one cell; a triangle that extends more than a cell from its centroid is
/// a cluster by itself. `order` sorts the triangles along a Morton curve; cluster k has order[start[k]] ..
/// order[start[k + 1] - 1].
struct Clusters {
  std::uint32_t count = 0;
  Array<std::uint32_t> order;
  Array<Corners> corners;      ///< of the triangles, in `order`: near in space, near in memory
  Array<std::uint32_t> start;  ///< count + 1 entries
  Array<ClusterBound> bound;
};

namespace detail {

/// Sorts by the cell of the centroid, and puts triangles that are clusters by themselves after the others.
struct CentroidCell {
  MeshView mesh;
  Int3 dims;
  std::uint64_t* code;
  std::uint32_t* order;
  NACRE_HD void operator()(std::int64_t i) const {
    const Corners t = mesh.corners(std::uint32_t(i));
    const Vec3d g = (t.a + t.b + t.c) / 3.0, a = t.a - g, b = t.b - g, c = t.c - g;
    const bool small = dot(a, a) <= 1 && dot(b, b) <= 1 && dot(c, c) <= 1;
    code[i] = morton({clamp_cell(g.x, dims.x), clamp_cell(g.y, dims.y), clamp_cell(g.z, dims.z)}) << 1 | !small;
    order[i] = std::uint32_t(i);
  }
};

struct GatherCorners {
  MeshView mesh;
  const std::uint32_t* order;
  Corners* corners;
  NACRE_HD void operator()(std::int64_t i) const { corners[i] = mesh.corners(order[i]); }
};

struct ClusterHead {
  const std::uint64_t* code;
  std::uint32_t* head;
  NACRE_HD void operator()(std::int64_t i) const { head[i] = i == 0 || code[i] != code[i - 1] || (code[i] & 1); }
};

struct ClusterStart {
  std::uint32_t triangles, clusters;
  const std::uint32_t* number;  // exclusive scan of the head flags
  std::uint32_t* start;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t next = i + 1 < triangles ? number[i + 1] : clusters;
    if (next != number[i]) start[number[i]] = std::uint32_t(i);
    if (i + 1 == triangles) start[clusters] = triangles;
  }
};

struct BoundCluster {
  const Corners* corners;
  const std::uint32_t* start;
  ClusterBound* bound;

  NACRE_HD void operator()(std::int64_t k) const {
    const Corners t = corners[start[k]];
    ClusterBound b{Vec3f((t.a + t.b + t.c) / 3.0), 0, Vec3f(normalized(cross(t.b - t.a, t.c - t.a))), 0};
    const Vec3d centre(b.centre), normal(b.normal);
    double square = 0, thickness = 0;
    for (std::uint32_t i = start[k]; i < start[k + 1]; ++i) {
      const Corners c = corners[i];
      const Vec3d d[3] = {c.a - centre, c.b - centre, c.c - centre};
      for (int j = 0; j < 3; ++j) {
        const double along = std::fabs(dot(d[j], normal)), across = dot(d[j], d[j]);
        thickness = along > thickness ? along : thickness;
        square = across > square ? across : square;
      }
    }
    b.radius = float(std::sqrt(square)) * 1.000001f;
    b.thickness = float(thickness) * 1.000001f;
    bound[k] = b;
  }
};

}  // namespace detail

/// Groups the triangles (points in cells, in a domain of `dims` cells, up to 2^20 per axis); the arrays are temporary.
template <class Backend>
Clusters make_clusters(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, Int3 dims) {
  Arena& arena = exec.arena();
  Clusters clusters;
  clusters.order = arena.temporary<std::uint32_t>(triangles);
  clusters.corners = arena.temporary<Corners>(triangles);
  clusters.start = arena.temporary<std::uint32_t>(triangles + 1);
  clusters.bound = arena.temporary<ClusterBound>(triangles);
  Arena::Scope scope(arena);
  Array<std::uint64_t> code = arena.temporary<std::uint64_t>(triangles);
  exec.for_each(triangles, detail::CentroidCell{mesh, dims, code.data(), clusters.order.data()});
  exec.sort_pairs(code.data(), clusters.order.data(), triangles);
  exec.for_each(triangles, detail::GatherCorners{mesh, clusters.order.data(), clusters.corners.data()});
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(triangles);
  exec.for_each(triangles, detail::ClusterHead{code.data(), number.data()});
  clusters.count = exec.exclusive_scan(number.data(), number.data(), triangles);
  exec.for_each(triangles, detail::ClusterStart{triangles, clusters.count, number.data(), clusters.start.data()});
  exec.for_each(clusters.count,
                detail::BoundCluster{clusters.corners.data(), clusters.start.data(), clusters.bound.data()});
  return clusters;
}

}  // namespace nacre
