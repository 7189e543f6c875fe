// Nacre: from labelled Delaunay cells to the triangles between them.
#include "compute/meshing/interfaces.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "compute/meshing/incidence.hpp"
#include "compute/meshing/interface_facets.hpp"
#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr std::size_t chunk = 1 << 14;  // cells that one thread processes

/// Calls visit(cell, k, label of the cell, label beyond facet k) for the facets between labels of cells [begin, end).
template <class Visit>
void visit_facets(const DelaunayCells& cells, std::span<const std::uint16_t> label, std::size_t begin, std::size_t end,
                  const Visit& visit) {
  for (std::size_t i = begin; i < end; ++i)
    for (int k = 0; k < 4; ++k) {
      const std::int32_t other = cells.neighbours[i][k];
      const std::uint16_t here = label[i], beyond = other < 0 ? std::uint16_t(0) : label[other];
      if (here != beyond && (other < 0 || other > std::int32_t(i))) visit(i, k, here, beyond);
    }
}

/// Facet k of a cell, seen from the side of the lower label, its smallest corner first.
Triangle facet_of(const std::array<std::uint32_t, 4>& cell, int k, bool cell_is_higher) {
  const auto [a, b, c] = facet_corners[k];
  Triangle t{cell[a], cell[b], cell[c]};
  if (!cell_is_higher) std::swap(t.b, t.c);
  while (t.a > t.b || t.a > t.c) t = {t.b, t.c, t.a};
  return t;
}

}  // namespace

InterfaceFacets interface_facets(const DelaunayCells& cells, std::span<const std::uint16_t> label) {
  const std::size_t count = cells.vertices.size(), chunks = (count + chunk - 1) / chunk;
  assert(label.size() == count);
  std::vector<std::size_t> first(chunks + 1);
  tbb::parallel_for(std::size_t(0), chunks, [&](std::size_t i) {
    std::size_t facets = 0;
    visit_facets(cells, label, i * chunk, std::min(count, (i + 1) * chunk), [&](auto...) { ++facets; });
    first[i + 1] = facets;
  });
  std::partial_sum(first.begin(), first.end(), first.begin());
  InterfaceFacets facets;
  facets.triangles.resize(first.back());
  facets.materials.resize(first.back());
  facets.cell.resize(first.back());
  tbb::parallel_for(std::size_t(0), chunks, [&](std::size_t i) {
    std::size_t f = first[i];
    visit_facets(cells, label, i * chunk, std::min(count, (i + 1) * chunk),
                 [&](std::size_t cell, int k, std::uint16_t here, std::uint16_t beyond) {
                   facets.triangles[f] = facet_of(cells.vertices[cell], k, here > beyond);
                   facets.materials[f] = {std::min(here, beyond), std::max(here, beyond)};
                   facets.cell[f++] = std::int32_t(cell);
                 });
  });
  return facets;
}

SurfaceMesh mesh_of_triangles(std::span<const Vec3d> points, std::vector<Triangle> triangles,
                              std::vector<std::array<std::uint16_t, 2>> materials,
                              std::vector<std::uint32_t>* point_of) {
  std::vector<std::uint32_t> used = marked(mark_corners(triangles, points.size()));
  std::vector<std::uint32_t> number(points.size());
  SurfaceMesh mesh;
  mesh.points.resize(used.size());
  tbb::parallel_for(std::size_t(0), used.size(), [&](std::size_t v) {
    number[used[v]] = std::uint32_t(v);
    mesh.points[v] = points[used[v]];
  });
  mesh.triangles = std::move(triangles);
  mesh.materials = std::move(materials);
  tbb::parallel_for(std::size_t(0), mesh.triangles.size(), [&](std::size_t i) {
    Triangle& t = mesh.triangles[i];
    t = {number[t.a], number[t.b], number[t.c]};
  });
  if (point_of) *point_of = std::move(used);
  return mesh;
}

SurfaceMesh extract_interfaces(std::span<const Vec3d> points, const DelaunayCells& cells,
                               std::span<const std::uint16_t> label, std::vector<std::uint32_t>* point_of) {
  InterfaceFacets facets = interface_facets(cells, label);
  return mesh_of_triangles(points, std::move(facets.triangles), std::move(facets.materials), point_of);
}

}  // namespace nacre
