// Nacre: meshes of the numerics as those of the library, and back; files of them.
#include "api/meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "api/support.hpp"
#include "engine/io/mesh_writer.hpp"

namespace nacre {
namespace {

std::array<double, 3> numbers(const Vec3d& v) { return {v.x, v.y, v.z}; }

std::vector<std::array<double, 3>> numbers(std::span<const Vec3d> points) {
  std::vector<std::array<double, 3>> result(points.size());
  std::transform(points.begin(), points.end(), result.begin(), [](const Vec3d& p) { return numbers(p); });
  return result;
}

std::vector<Vec3d> vectors(std::span<const std::array<double, 3>> points) {
  std::vector<Vec3d> result;
  result.reserve(points.size());
  for (const auto& p : points) result.emplace_back(p[0], p[1], p[2]);
  return result;
}

/// Numbers of nodes behind `corners` points.
template <std::size_t N>
std::vector<std::array<std::uint32_t, N>> behind(std::size_t corners,
                                                 std::vector<std::array<std::uint32_t, N>> midsides) {
  for (auto& element : midsides)
    for (std::uint32_t& node : element) node += std::uint32_t(corners);
  return midsides;
}

/// Points and elements of second order, taken apart: corners, and nodes behind them.
template <std::size_t N, class Elements>
std::vector<std::array<std::uint32_t, N>> take_nodes(std::vector<Vec3d>& points, std::vector<Vec3d>& nodes,
                                                     const Elements& elements,
                                                     std::vector<std::array<std::uint32_t, N>> midsides) {
  if (midsides.size() != elements.size())
    throw Error("some elements of the mesh have no midsides", "", "all have them, or none");
  std::uint32_t first = std::uint32_t(std::min<std::size_t>(points.size(), std::numeric_limits<std::uint32_t>::max()));
  for (const auto& element : midsides)
    for (const std::uint32_t node : element) {
      if (node >= points.size()) throw Error("a midside of the mesh refers to a point that does not exist");
      first = std::min(first, node);
    }
  for (const auto& element : elements)
    for (const std::uint32_t corner : element)
      if (corner >= first) throw Error("the midsides of the mesh do not come behind all corners");
  nodes.assign(points.begin() + first, points.end());
  points.resize(first);
  for (auto& element : midsides)
    for (std::uint32_t& node : element) node -= first;
  return midsides;
}

/// The nodes of the triangles' edges, which are edges of cells.
void name_nodes_of_triangles(SecondOrder& second, const SurfaceMesh& surface, const TetrahedralMesh& filled) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> node_of;
  node_of.reserve(6 * filled.cells.size());
  for (std::size_t i = 0; i < filled.cells.size(); ++i)
    for (std::size_t e = 0; e < 6; ++e)
      node_of.emplace_back(edge_key(filled.cells[i][cell_edges[e][0]], filled.cells[i][cell_edges[e][1]]),
                           second.cells[i][e]);
  std::sort(node_of.begin(), node_of.end());
  for (const Triangle& t : surface.triangles) {
    second.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      const std::pair wanted(edge_key(t[k], t[(k + 1) % 3]), std::uint32_t(0));
      const auto at = std::lower_bound(node_of.begin(), node_of.end(), wanted);
      if (at == node_of.end() || at->first != wanted.first) throw Error("a triangle has an edge that no cell has");
      second.triangles.back()[std::size_t(k)] = at->second;
    }
  }
}

SurfaceMesh surface_of(const Mesh& mesh) {
  SurfaceMesh result;
  result.points = vectors(mesh.points);
  result.triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) result.triangles.push_back({t[0], t[1], t[2]});
  result.materials = mesh.sides;
  return result;
}

/// Labels and names of the materials, as files have them.
struct MaterialTable {
  std::vector<std::int64_t> labels;
  std::vector<std::string> names;

  explicit MaterialTable(const Mesh& mesh) {
    if (mesh.materials.empty()) throw Error("the mesh has no materials", "", "entry 0 is the outside");
    bool named = false;
    for (const Material& material : mesh.materials) {
      labels.push_back(material.label);
      names.push_back(material.name);
      named = named || !material.name.empty();
    }
    if (!named) names.clear();
  }
};

}  // namespace

Mesh public_mesh(const SurfaceMesh& mesh, const SecondOrder* second, const MeshInput& input) {
  Mesh result;
  result.points = numbers(mesh.points);
  if (second) {
    const auto nodes = numbers(second->nodes);
    result.points.insert(result.points.end(), nodes.begin(), nodes.end());
    result.midsides = behind(mesh.points.size(), second->triangles);
  }
  result.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) result.triangles.push_back({t.a, t.b, t.c});
  result.sides = mesh.materials;
  for (std::size_t m = 0; m < input.labels.size(); ++m)
    result.materials.push_back({input.labels[m], m < input.names.size() ? input.names[m] : ""});
  return result;
}

Tetrahedra public_tetrahedra(const TetrahedralMesh& mesh, const SecondOrder* second) {
  Tetrahedra result{numbers(mesh.points), mesh.cells, mesh.material, {}};
  if (second) {
    const auto nodes = numbers(second->nodes);
    result.points.insert(result.points.end(), nodes.begin(), nodes.end());
    result.midsides = behind(mesh.points.size(), second->cells);
  }
  return result;
}

Particles public_particles(const MeshParticles& particles) {
  Particles result;
  result.points = numbers(particles.points);
  result.size = particles.size;
  result.energy = particles.energy;
  for (const Vec3f& n : particles.normal) result.normal.push_back({n.x, n.y, n.z});
  result.order = particles.order;
  return result;
}

void save(const std::filesystem::path& file, const Mesh& mesh) {
  library_call([&] {
    const MaterialTable table(mesh);
    SurfaceMesh surface = surface_of(mesh);
    if (mesh.midsides.empty()) return write_surface_mesh(file, surface, table.labels, table.names, mesh.origin);
    SecondOrder second;
    second.triangles = take_nodes(surface.points, second.nodes, mesh.triangles, mesh.midsides);
    write_surface_mesh(file, surface, table.labels, table.names, mesh.origin, &second);
  });
}

void save(const std::filesystem::path& file, const Mesh& mesh, const Tetrahedra& tetrahedra) {
  library_call([&] {
    const MaterialTable table(mesh);
    TetrahedralMesh cells;
    cells.points = vectors(tetrahedra.points);
    cells.cells = tetrahedra.cells;
    cells.material = tetrahedra.material;
    SurfaceMesh surface = surface_of(mesh);
    if (!mesh.midsides.empty()) {
      std::vector<Vec3d> own;
      take_nodes(surface.points, own, mesh.triangles, mesh.midsides);
    }
    if (tetrahedra.midsides.empty())
      return write_tetrahedral_mesh(file, cells, surface, table.labels, table.names, mesh.origin);
    SecondOrder second;
    second.cells = take_nodes(cells.points, second.nodes, cells.cells, tetrahedra.midsides);
    name_nodes_of_triangles(second, surface, cells);
    write_tetrahedral_mesh(file, cells, surface, table.labels, table.names, mesh.origin, &second);
  });
}

std::vector<std::string> surface_extensions() { return surface_mesh_extensions(); }
std::vector<std::string> volume_extensions() { return tetrahedral_mesh_extensions(); }

}  // namespace nacre
