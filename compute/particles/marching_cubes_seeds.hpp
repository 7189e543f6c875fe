// Nacre: seeds from marching cubes (ch. 3): where edges between voxels pass from one material to another.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/field/build_material_bricks.hpp"
#include "compute/field/sizing.hpp"
#include "compute/field/voxel_edges.hpp"
#include "compute/math/morton.hpp"
#include "compute/particles/seed.hpp"

namespace nacre {

namespace detail {

struct CountCubeEdges {
  VoxelEdges edges;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint32_t n = 0;
    edges(i, [&](const Int3&, int) { ++n; });
    count[i] = n;
  }
};

struct CubeEdge {
  Int3 voxel;
  int axis;
};

struct ListCubeEdges {
  VoxelEdges edges;
  const std::uint32_t* start;
  CubeEdge* edge;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint32_t to = start[i];
    edges(i, [&](const Int3& voxel, int axis) { edge[to++] = {voxel, axis}; });
  }
};

/// A vertex of marching cubes on an interface.
struct CubeVertex {
  Float4 position;  ///< position in voxels; h
  Float4 normal;    ///< unit; the area that the vertex stands for, 0 where it is of no use
  std::uint32_t interface;
};

/// Where the difference of an edge's two materials vanishes, linearly, brought onto the interface (Eq. 3.5).
struct FindCubeVertices {
  MaterialBricksView field;
  SizingFieldView size;
  const Junction* table;
  std::uint32_t table_size;
  const CubeEdge* edge;
  CubeVertex* vertex;

  NACRE_HD void operator()(std::int64_t i) const {
    CubeVertex& result = vertex[i];
    result.normal = {0, 0, 0, 0};
    Int3 a = edge[i].voxel, b = a;
    ++b[edge[i].axis];
    const std::uint32_t m = material(a), n = material(b);
    const Junction surface(m < n ? m : n, m < n ? n : m);
    result.interface = junction_number(table, table_size, surface);
    if (!(table[result.interface] == surface)) return;
    const Vec3f p = centre(a), q = centre(b);
    if (!field.inside(p, 3) || !field.inside(q, 3)) return;
    const FieldSample f = lead(p, surface), g = lead(q, surface);
    const float t = f.value * g.value < 0 ? f.value / (f.value - g.value) : 0.5f;
    JunctionPoint at;
    if (!project(field, surface, p + (q - p) * t, 2, at)) return;
    if (junction_margin(field, surface, at.p, at.steepness) < 0) return;  // a third material lies over it
    const Vec3f& d = at.direction;
    result.position = {at.p.x, at.p.y, at.p.z, size(at.p)};
    result.normal = {d.x, d.y, d.z, area(f.gradient + (g.gradient - f.gradient) * t, edge[i].axis)};
  }

 private:
  NACRE_HD std::uint32_t material(const Int3& v) const { return field.material(v); }
  NACRE_HD Vec3f centre(const Int3& v) const {
    return {(v.x + 0.5f) / field.cells_per_unit.x, (v.y + 0.5f) / field.cells_per_unit.y,
            (v.z + 0.5f) / field.cells_per_unit.z};
  }
  /// By how much the first material of a surface is ahead of the second.
  NACRE_HD FieldSample lead(const Vec3f& p, const Junction& surface) const {
    return CubicStencil(field, p).difference(field, surface.material(0), surface.material(1));
  }
  /// Edges along an axis meet |n| times an area of their grid on a surface; times |n| again, the three axes make its
  /// area. The normal is that of the voxels' differences, as marching cubes has it: the interpolated one waves with the
  /// voxels.
  NACRE_HD float area(const Vec3f& gradient, int axis) const {
    const Vec3f& u = field.cells_per_unit;
    return std::fabs(gradient[axis]) / max(length(gradient), 1e-12f) * u[axis] / (u.x * u.y * u.z);
  }
};

}  // namespace detail

/// Vertices of marching cubes on all interfaces of two materials, in temporary memory of the caller's scope: every
/// component of voxels has some, however thin. As a source of seeds each stands for the area that it is the only one
/// on, so that there are as many seeds as the sizing field asks for, not as many as vertices; the thesis leaves
/// that to the control of the population.
class MarchingCubesSeeds {
 public:
  MarchingCubesSeeds(const detail::CubeVertex* vertex, std::int64_t sites) : vertex_(vertex), sites_(sites) {}

  std::int64_t sites() const { return sites_; }
  NACRE_HD int order() const { return 2; }
  NACRE_HD std::uint32_t interface(std::int64_t i) const { return vertex_[i].interface; }
  NACRE_HD std::uint64_t code(std::int64_t i) const {
    const Float4 p = vertex_[i].position;
    return morton(Int3(int(2 * p.x), int(2 * p.y), int(2 * p.z)));
  }
  NACRE_HD float share(std::int64_t i) const {
    const float h = vertex_[i].position.w, area = vertex_[i].normal.w;
    return area > 0 ? area * hexagonal_density / (h * h) : 0;
  }
  NACRE_HD SeedSite site(std::int64_t i) const {
    const Float4 p = vertex_[i].position, d = vertex_[i].normal;
    return {{p.x, p.y, p.z}, {d.x, d.y, d.z}, p.w, 1};
  }

 private:
  const detail::CubeVertex* vertex_;
  std::int64_t sites_;
};

/// `table`: the surfaces and curves that there are, ascending.
template <class Backend>
MarchingCubesSeeds marching_cubes(Executor<Backend>& exec, const MaterialBricks& b, const SizingField& size,
                                  const Array<Junction>& table) {
  if (table.size() == 0) return {nullptr, 0};
  Arena& arena = exec.arena();
  const VoxelEdges edges(b);
  const std::int64_t rows = edges.rows();
  Array<std::uint32_t> start = arena.temporary<std::uint32_t>(rows);
  exec.for_each(rows, detail::CountCubeEdges{edges, start.data()});
  const std::int64_t n = exec.exclusive_scan(start.data(), start.data(), rows);
  Array<detail::CubeEdge> edge = arena.temporary<detail::CubeEdge>(n);
  Array<detail::CubeVertex> vertex = arena.temporary<detail::CubeVertex>(n);
  exec.for_each(rows, detail::ListCubeEdges{edges, start.data(), edge.data()});
  exec.for_each(n, detail::FindCubeVertices{b.view(), size.view(), table.data(), std::uint32_t(table.size()),
                                            edge.data(), vertex.data()});
  return {vertex.data(), n};
}

}  // namespace nacre
