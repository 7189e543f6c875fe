// Nacre: a mesh made ready to be drawn and looked into.
#include "app/viewer/mesh/mesh_measures.hpp"

#include <algorithm>

namespace nacre {
namespace {

struct EdgeUse {
  std::uint64_t key;  ///< its two vertices, the smaller in the high half
  std::uint32_t triangle, corner;
  bool operator<(const EdgeUse& other) const { return key < other.key; }
};

/// Numbers the edges, each once.
void number_edges(MeshDrawing& drawing) {
  SurfaceGeometry& g = drawing.geometry;
  std::vector<EdgeUse> uses;
  uses.reserve(3 * g.triangles.size());
  for (std::uint32_t t = 0; t < g.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const std::uint64_t a = g.triangles[t][int(k)], b = g.triangles[t][int((k + 1) % 3)];
      uses.push_back({std::min(a, b) << 32 | std::max(a, b), t, k});
    }
  std::sort(uses.begin(), uses.end());
  g.edges.clear();
  drawing.edge_of.resize(g.triangles.size());
  for (std::size_t i = 0, end; i < uses.size(); i = end) {
    const std::uint32_t edge = std::uint32_t(g.edges.size());
    for (end = i; end < uses.size() && uses[end].key == uses[i].key; ++end)
      drawing.edge_of[uses[end].triangle][uses[end].corner] = edge;
    if (end - i >= 3) drawing.junctions.push_back(edge);
    g.edges.push_back({std::uint32_t(uses[i].key >> 32), std::uint32_t(uses[i].key)});
  }
}

}  // namespace

MeshDrawing make_mesh_drawing(const SurfaceMesh& mesh) {
  MeshDrawing drawing;
  drawing.geometry = make_surface_geometry(mesh.points, mesh.triangles, {});
  drawing.materials = mesh.materials;
  number_edges(drawing);
  return drawing;
}

std::vector<double> material_areas(const SurfaceMesh& mesh, std::size_t materials) {
  std::vector<double> area(materials, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    const double own = 0.5 * length(cross(mesh.points[c.b] - mesh.points[c.a], mesh.points[c.c] - mesh.points[c.a]));
    for (const std::uint16_t material : mesh.materials[t]) area[material] += own;
  }
  return area;
}

std::vector<WorstTriangle> worst_triangles(const SurfaceMesh& mesh, std::size_t most) {
  std::vector<WorstTriangle> all;
  all.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    all.push_back({radius_ratio(mesh.points[c.a], mesh.points[c.b], mesh.points[c.c]), t});
  }
  const auto worse = [](const WorstTriangle& a, const WorstTriangle& b) {
    return a.radius_ratio != b.radius_ratio ? a.radius_ratio < b.radius_ratio : a.triangle < b.triangle;
  };
  const std::size_t kept = std::min(most, all.size());
  std::partial_sort(all.begin(), all.begin() + std::ptrdiff_t(kept), all.end(), worse);
  all.resize(kept);
  return all;
}

}  // namespace nacre
