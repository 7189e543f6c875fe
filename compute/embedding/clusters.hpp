// Nacre: small triangles in groups, so that a mesh far finer than the grid costs little more than a coarse one.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/embedding/closest_point_grid.hpp"
#include "compute/grid/morton.hpp"

namespace nacre {

/// A triangle in single precision for bounds: centroid and the distance from it to the farthest corner.
NACRE_HD inline Float4 triangle_bound(const Corners& t) {
  const Vec3d g = (t.a + t.b + t.c) / 3.0;
  const double a = length(t.a - g), b = length(t.b - g), c = length(t.c - g);
  return {float(g.x), float(g.y), float(g.z), float(a > b ? (a > c ? a : c) : (b > c ? b : c)) * 1.000001f};
}

/// A flat cylinder that holds a cluster: around a point of the surface, `radius` across, `thickness` to either side.
struct alignas(16) ClusterBound {
  Vec3f centre;
  float radius;
  Vec3f normal;
  float thickness;

  /// How far `x` is from the centre: the surface is no farther than that.
  NACRE_HD float upper(const Vec3f& x) const { return length(x - centre); }

  /// How far `x` is from the cylinder: no triangle of the cluster is nearer than that.
  NACRE_HD float lower(const Vec3f& x) const {
    const Vec3f d = x - centre;
    const float along = dot(d, normal);
    const float across2 = dot(d, d) - along * along;
    const float h = std::fabs(along) - thickness, r = std::sqrt(across2 > 0 ? across2 : 0) - radius;
    return std::sqrt((h > 0 ? h * h : 0) + (r > 0 ? r * r : 0));
  }
};

/// Clusters of triangles whose centroids lie in one cell; a triangle that reaches farther than a cell from its centroid
/// stands alone.
/// `order` sorts the triangles along a Morton curve; cluster k holds order[start[k]] .. order[start[k + 1] - 1].
struct Clusters {
  std::uint32_t count = 0;
  Array<std::uint32_t> order;
  Array<std::uint32_t> start;  ///< count + 1 entries
  Array<ClusterBound> bound;
};

namespace detail {

struct CentroidCell {
  MeshView mesh;
  Int3 dims;
  std::uint64_t* code;
  std::uint32_t* order;
  NACRE_HD void operator()(std::int64_t t) const {
    const Float4 b = triangle_bound(mesh.corners(std::uint32_t(t)));
    code[t] = morton({clamp_cell(b.x, dims.x), clamp_cell(b.y, dims.y), clamp_cell(b.z, dims.z)});
    order[t] = std::uint32_t(t);
  }
};

struct ClusterHead {
  MeshView mesh;
  const std::uint64_t* code;
  const std::uint32_t* order;
  std::uint32_t* head;
  NACRE_HD bool big(std::uint32_t t) const { return !(triangle_bound(mesh.corners(t)).w <= 1); }
  NACRE_HD void operator()(std::int64_t i) const {
    head[i] = i == 0 || code[i] != code[i - 1] || big(order[i]) || big(order[i - 1]);
  }
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
  MeshView mesh;
  const std::uint32_t* order;
  const std::uint32_t* start;
  ClusterBound* bound;

  NACRE_HD void operator()(std::int64_t k) const {
    const Corners t = mesh.corners(order[start[k]]);
    const Float4 first = triangle_bound(t);
    ClusterBound b{{first.x, first.y, first.z}, 0, Vec3f(normalized(cross(t.b - t.a, t.c - t.a))), 0};
    const Vec3d centre(b.centre), normal(b.normal);
    double radius = 0, thickness = 0;
    for (std::uint32_t i = start[k]; i < start[k + 1]; ++i) {
      const Corners c = mesh.corners(order[i]);
      const Vec3d d[3] = {c.a - centre, c.b - centre, c.c - centre};
      for (int j = 0; j < 3; ++j) {
        const double along = std::fabs(dot(d[j], normal));
        thickness = along > thickness ? along : thickness;
        const double across = length(d[j]);
        radius = across > radius ? across : radius;
      }
    }
    b.radius = float(radius) * 1.000001f;
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
  clusters.start = arena.temporary<std::uint32_t>(triangles + 1);
  clusters.bound = arena.temporary<ClusterBound>(triangles);
  Arena::Scope scope(arena);
  Array<std::uint64_t> code = arena.temporary<std::uint64_t>(triangles);
  exec.for_each(triangles, detail::CentroidCell{mesh, dims, code.data(), clusters.order.data()});
  exec.sort_pairs(code.data(), clusters.order.data(), triangles);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(triangles);
  exec.for_each(triangles, detail::ClusterHead{mesh, code.data(), clusters.order.data(), number.data()});
  clusters.count = exec.exclusive_scan(number.data(), number.data(), triangles);
  exec.for_each(triangles, detail::ClusterStart{triangles, clusters.count, number.data(), clusters.start.data()});
  exec.for_each(clusters.count,
                detail::BoundCluster{mesh, clusters.order.data(), clusters.start.data(), clusters.bound.data()});
  return clusters;
}

}  // namespace nacre
