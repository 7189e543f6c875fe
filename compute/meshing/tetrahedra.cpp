// Nacre: the insides of the materials filled with tetrahedra.
#include "compute/meshing/tetrahedra.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/meshing/ball_search.hpp"
#include "compute/meshing/cell_materials.hpp"
#include "compute/meshing/delaunay.hpp"
#include "compute/meshing/improve_cells.hpp"

namespace nacre {
namespace {

constexpr double lattice_edge = 1.1;      // of the lattice's cubes, by edges of the triangles near them
constexpr double facet_clearance = 1.1;   // balls of facets that lattice points keep out of, by the smallest empty ones
constexpr double vertex_clearance = 0.6;  // around the surface's vertices, by the edges there
constexpr int attempts = 5;

[[noreturn]] void cannot_fill(const char* why, const char* advice = "") {
  throw Error("the surface cannot be filled", why, advice);
}

void check_mesh(const SurfaceMesh& mesh) {
  if (mesh.triangles.empty()) cannot_fill("it has no triangles");
  if (mesh.materials.size() != mesh.triangles.size()) cannot_fill("its triangles have no materials");
  for (const Triangle& t : mesh.triangles) {
    if (std::max({t.a, t.b, t.c}) >= mesh.points.size())
      cannot_fill("a triangle refers to a point that does not exist");
    if (t.a == t.b || t.b == t.c || t.c == t.a) cannot_fill("a triangle has a corner twice");
  }
}

/// Mean length of the edges at each point.
std::vector<double> local_edges(const SurfaceMesh& mesh) {
  std::vector<double> sum(mesh.points.size()), count(mesh.points.size());
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      const double edge = length(mesh.points[a] - mesh.points[b]);
      for (const std::uint32_t p : {a, b}) sum[p] += edge, count[p] += 1;
    }
  double smallest = std::numeric_limits<double>::max();
  for (std::size_t p = 0; p < sum.size(); ++p)
    if (count[p] > 0) smallest = std::min(smallest, sum[p] /= count[p]);
  if (!(smallest > 0)) cannot_fill("the corners of a triangle are at one place");
  for (std::size_t p = 0; p < sum.size(); ++p)
    if (count[p] == 0) sum[p] = smallest;
  return sum;
}

struct Ball {
  Vec3d centre;
  double radius;
};

/// The smallest ball with the triangle's corners on its surface and no point of the mesh within: its centre lies on the
/// line between the circumcentres of the two cells at the triangle.
Ball empty_ball(const SurfaceMesh& mesh, const DelaunayCells& cells, const CellMaterials& materials, std::size_t i) {
  const Triangle& t = mesh.triangles[i];
  const Vec3d a = mesh.points[t.a], u = mesh.points[t.b] - a, v = mesh.points[t.c] - a, n = cross(u, v);
  const double area = dot(n, n);
  if (!(area > 0)) return {a, 0};
  const Vec3d centre = a + (dot(u, u) * cross(v, n) + dot(v, v) * cross(n, u)) / (2 * area);
  const auto along = [&](std::int32_t cell, double beyond_hull) {
    return cell < 0 ? beyond_hull : dot(cells.circumcentres[cell] - centre, n) / area;
  };
  constexpr double far = std::numeric_limits<double>::infinity();
  const double first = along(materials.cells_at[i][0], far), second = along(materials.cells_at[i][1], -far);
  const double at = std::clamp(0.0, std::min(first, second), std::max(first, second));
  return {centre + at * n, length(centre + at * n - a)};
}

/// The lattice's points within materials and far enough from the surface for its triangles to stay facets.
std::vector<Vec3d> inner_points(const SurfaceMesh& mesh, const EdgeLength& edge_length, const std::atomic<bool>* stop) {
  const DelaunayCells cells = delaunay(mesh.points, 0, stop);
  const CellMaterials materials = cell_materials(cells, mesh);
  if (!materials.missing.empty()) cannot_fill("its triangles are not those of a Delaunay triangulation of its points");
  const std::vector<double> edges = local_edges(mesh);
  std::vector<double> cubes = edges;
  for (double& edge : cubes) edge *= lattice_edge;
  const std::vector<Vec3d> lattice = graded_lattice(mesh.points, cubes, edge_length);
  check_stop(stop);
  const std::vector<std::uint16_t> material = materials_at(lattice, mesh.points, cells, materials.material);
  std::vector<char> keep(lattice.size());
  for (std::size_t i = 0; i < lattice.size(); ++i) keep[i] = material[i] != 0;
  const BallSearch search(lattice);
  const auto clear = [&](const Vec3d& centre, double radius) {
    search.visit_within(centre, radius,
                        [&](std::uint32_t i) { std::atomic_ref<char>(keep[i]).store(0, std::memory_order_relaxed); });
  };
  tbb::parallel_for(std::size_t(0), mesh.triangles.size(), [&](std::size_t i) {
    const Ball ball = empty_ball(mesh, cells, materials, i);
    clear(ball.centre, facet_clearance * ball.radius);
  });
  tbb::parallel_for(std::size_t(0), mesh.points.size(),
                    [&](std::size_t i) { clear(mesh.points[i], vertex_clearance * edges[i]); });
  std::vector<Vec3d> inner;
  for (std::size_t i = 0; i < lattice.size(); ++i)
    if (keep[i]) inner.push_back(lattice[i]);
  return inner;
}

/// Takes away the inner points near triangles that are no facets of the cells.
void clear_around(const SurfaceMesh& mesh, const std::vector<std::uint32_t>& triangles, double radius,
                  std::vector<Vec3d>& inner) {
  std::vector<char> gone(inner.size());
  const BallSearch search(inner);
  for (const std::uint32_t i : triangles) {
    const Triangle& t = mesh.triangles[i];
    const Vec3d a = mesh.points[t.a], b = mesh.points[t.b], c = mesh.points[t.c];
    const double longest = std::max({length(b - a), length(c - b), length(a - c)});
    search.visit_within((a + b + c) / 3, radius * longest, [&](std::uint32_t p) { gone[p] = 1; });
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (!gone[i]) inner[kept++] = inner[i];
  inner.resize(kept);
}

/// The cells of the materials, without the outside.
MaterialCells inside(const DelaunayCells& cells, const std::vector<std::uint16_t>& material) {
  std::vector<std::int32_t> number(material.size(), -1);
  MaterialCells result;
  for (std::size_t i = 0; i < material.size(); ++i)
    if (material[i] != 0) {
      number[i] = std::int32_t(result.material.size());
      result.material.push_back(material[i]);
      result.cells.vertices.push_back(cells.vertices[i]);
      result.cells.neighbours.push_back(cells.neighbours[i]);
    }
  for (auto& neighbours : result.cells.neighbours)
    for (std::int32_t& n : neighbours) n = n < 0 ? -1 : number[n];
  return result;
}

}  // namespace

TetrahedralMesh fill_with_tetrahedra(const SurfaceMesh& mesh, const EdgeLength& edge_length,
                                     const std::atomic<bool>* stop) {
  check_mesh(mesh);
  std::vector<Vec3d> inner = inner_points(mesh, edge_length, stop);
  for (int attempt = 0; attempt < attempts; ++attempt) {
    check_stop(stop);
    std::vector<Vec3d> points = mesh.points;
    points.insert(points.end(), inner.begin(), inner.end());
    MaterialCells filled;
    {
      const DelaunayCells cells = delaunay(points, 0, stop);
      const CellMaterials materials = cell_materials(cells, mesh);
      if (!materials.missing.empty()) {
        clear_around(mesh, materials.missing, 1 << attempt, inner);
        continue;
      }
      filled = inside(cells, materials.material);
    }
    check_stop(stop);
    improve_cells(points, mesh.points.size(), filled, stop);
    return {std::move(points), std::move(filled.cells.vertices), std::move(filled.material)};
  }
  cannot_fill("points within it break its triangles", "choose a smaller `max_size`");
}

}  // namespace nacre
