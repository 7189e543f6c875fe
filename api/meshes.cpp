// Nacre: meshes of the numerics as those of the library, and back; files of them.
#include "api/meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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

Mesh public_mesh(const SurfaceMesh& mesh, const MeshInput& input) {
  Mesh result;
  result.points = numbers(mesh.points);
  result.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) result.triangles.push_back({t.a, t.b, t.c});
  result.sides = mesh.materials;
  for (std::size_t m = 0; m < input.labels.size(); ++m)
    result.materials.push_back({input.labels[m], m < input.names.size() ? input.names[m] : ""});
  return result;
}

Tetrahedra public_tetrahedra(const TetrahedralMesh& mesh) { return {numbers(mesh.points), mesh.cells, mesh.material}; }

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
    write_surface_mesh(file, surface_of(mesh), table.labels, table.names);
  });
}

void save(const std::filesystem::path& file, const Mesh& mesh, const Tetrahedra& tetrahedra) {
  library_call([&] {
    const MaterialTable table(mesh);
    TetrahedralMesh cells;
    cells.points = vectors(tetrahedra.points);
    cells.cells = tetrahedra.cells;
    cells.material = tetrahedra.material;
    write_tetrahedral_mesh(file, cells, surface_of(mesh), table.labels, table.names);
  });
}

std::vector<std::string> surface_extensions() { return surface_mesh_extensions(); }
std::vector<std::string> volume_extensions() { return tetrahedral_mesh_extensions(); }

}  // namespace nacre
