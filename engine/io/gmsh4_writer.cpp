// Nacre: writes meshes for Gmsh (.msh, version 4.1, binary).
#include <algorithm>
#include <bit>

#include "engine/io/chunks.hpp"
#include "engine/io/gmsh_writer.hpp"
#include "engine/io/mesh_format_writers.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);  // readers detect it from the 1 in the header
using GmshCount = std::uint64_t;                            // a size_t of the file
using GmshTag = std::int32_t;

struct EntityBox {
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  void add(const Vec3d& p) { low = min(low, p), high = max(high, p); }
};

/// An interface or a material: what belongs to it, and the points that no entity before it has.
struct GmshEntity {
  int dimension;
  const MeshParts::Group* group;
  EntityBox box;
  std::vector<GmshTag> bounds;  ///< of a volume: its interfaces, negative if their normals point into it
  std::vector<std::uint32_t> points;
};

void write_gmsh4_entity(Chunks& out, const GmshEntity& entity) {
  out.raw(entity.group->tag);
  out.raw(entity.box.low);
  out.raw(entity.box.high);
  out.raw(GmshCount(1));  // physical groups
  out.raw(entity.group->tag);
  out.raw(GmshCount(entity.bounds.size()));
  for (const GmshTag bound : entity.bounds) out.raw(bound);
}

std::vector<GmshTag> bounds_of(const MeshParts& mesh, std::uint16_t material) {
  std::vector<GmshTag> bounds;
  for (const auto& [pair, group] : mesh.interfaces) {
    if (pair[1] == material) bounds.push_back(group.tag);
    if (pair[0] == material) bounds.push_back(-group.tag);
  }
  return bounds;
}

/// Interfaces first, so that points on them are theirs.
std::vector<GmshEntity> entities_of(const MeshParts& mesh) {
  std::vector<GmshEntity> entities;
  std::map<MaterialPair, std::size_t> surface;
  std::map<std::uint16_t, std::size_t> volume;
  for (const auto& [pair, group] : mesh.interfaces) {
    surface[pair] = entities.size();
    entities.push_back({2, &group, {}, {}, {}});
  }
  for (const auto& [m, group] : mesh.volumes) {
    volume[m] = entities.size();
    entities.push_back({3, &group, {}, bounds_of(mesh, m), {}});
  }
  std::vector<bool> placed(mesh.point_count());
  const auto use = [&](GmshEntity& entity, std::uint32_t point) {
    entity.box.add(mesh.point(point));
    if (!placed[point]) entity.points.push_back(point);
    placed[point] = true;
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const std::uint32_t point : mesh.triangle(i)) use(entities[surface.at(mesh.materials[i])], point);
  for (std::size_t i = 0; i < mesh.cells.size(); ++i)
    for (const std::uint32_t point : mesh.cell(i)) use(entities[volume.at(mesh.material[i])], point);
  return entities;
}

void write_gmsh4_names(Chunks& out, const std::vector<GmshEntity>& entities) {
  out.print("$PhysicalNames\n{}\n", entities.size());
  std::set<std::string> taken;
  for (const GmshEntity& entity : entities)
    out.print("{} {} {}\n", entity.dimension, entity.group->tag,
              gmsh_name(entity.group->name, entity.group->tag, taken));
  out.print("$EndPhysicalNames\n");
}

void write_gmsh4_entities(Chunks& out, const MeshParts& mesh, const std::vector<GmshEntity>& entities) {
  out.print("$Entities\n");
  for (const std::size_t count : {std::size_t(0), std::size_t(0), mesh.interfaces.size(), mesh.volumes.size()})
    out.raw(GmshCount(count));
  for (const GmshEntity& entity : entities) write_gmsh4_entity(out, entity);
  out.print("\n$EndEntities\n");
}

/// Point i has the tag i + 1.
void write_gmsh4_nodes(Chunks& out, const MeshParts& mesh, const std::vector<GmshEntity>& entities) {
  GmshCount blocks = 0, points = 0;
  for (const GmshEntity& entity : entities) blocks += !entity.points.empty(), points += entity.points.size();
  out.print("$Nodes\n");
  for (const GmshCount count : {blocks, points, GmshCount(1), GmshCount(mesh.point_count())}) out.raw(count);
  for (const GmshEntity& entity : entities) {
    if (entity.points.empty()) continue;
    for (const std::int32_t head : {entity.dimension, entity.group->tag, 0}) out.raw(head);
    out.raw(GmshCount(entity.points.size()));
    for (const std::uint32_t point : entity.points) out.raw(GmshCount(point) + 1);
    for (const std::uint32_t point : entity.points) out.raw(mesh.point(point));
  }
  out.print("\n$EndNodes\n");
}

/// A block of elements of one group: `element(i)` of those i that are `in` it.
template <class In, class ElementOf>
void write_gmsh4_block(Chunks& out, int dimension, const MeshParts::Group& group, std::size_t count, GmshCount& number,
                       std::size_t points, In in, ElementOf element) {
  for (const std::int32_t head : {dimension, group.tag, gmsh_type(points)}) out.raw(head);
  out.raw(GmshCount(group.cells));
  for (std::size_t i = 0; i < count; ++i) {
    if (!in(i)) continue;
    out.raw(++number);
    const MeshParts::Element of = element(i);
    for (std::size_t k = 0; k < points; ++k) out.raw(GmshCount(of[gmsh_order(points, k)]) + 1);
  }
}

void write_gmsh4_elements(Chunks& out, const MeshParts& mesh) {
  const GmshCount elements = mesh.triangles.size() + mesh.cells.size();
  out.print("$Elements\n");
  for (const GmshCount count :
       {GmshCount(mesh.interfaces.size() + mesh.volumes.size()), elements, GmshCount(1), elements})
    out.raw(count);
  GmshCount number = 0;
  for (const auto& [pair, group] : mesh.interfaces)
    write_gmsh4_block(
        out, 2, group, mesh.triangles.size(), number, mesh.second ? 6 : 3,
        [&, p = pair](std::size_t i) { return mesh.materials[i] == p; },
        [&](std::size_t i) { return mesh.triangle(i); });
  for (const auto& [m, group] : mesh.volumes)
    write_gmsh4_block(
        out, 3, group, mesh.cells.size(), number, mesh.second ? 10 : 4,
        [&, m = m](std::size_t i) { return mesh.material[i] == m; }, [&](std::size_t i) { return mesh.cell(i); });
  out.print("\n$EndElements\n");
}

}  // namespace

void write_gmsh4(const fs::path& file, const MeshParts& mesh) {
  check_counts(file, mesh, "Gmsh's format");
  const std::vector<GmshEntity> entities = entities_of(mesh);
  OutputFile target(file);
  Chunks out(target);
  out.print("$MeshFormat\n4.1 1 8\n");
  out.raw(std::int32_t(1));
  out.print("\n$EndMeshFormat\n");
  if (!mesh.origin.empty()) out.print("$Comments\n{}\n$EndComments\n", mesh.origin);
  write_gmsh4_names(out, entities);
  write_gmsh4_entities(out, mesh, entities);
  write_gmsh4_nodes(out, mesh, entities);
  write_gmsh4_elements(out, mesh);
  out.flush();
  target.commit();
}

}  // namespace nacre
