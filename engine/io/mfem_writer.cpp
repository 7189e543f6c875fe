// Nacre: writes meshes for MFEM (.mesh, version 1.3).
#include "engine/io/chunks.hpp"
#include "engine/io/mesh_format_writers.hpp"
#include "engine/system/utf8.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// MFEM reads a name up to the next quotation mark.
std::string mfem_name(const std::string& name) {
  std::string text = "\"";
  for (const char c : in_utf8(name, 200)) text += c == '"' ? '_' : c;
  return text + '"';
}

constexpr const char* mfem_nodes_follow =
    "\nnodes\nFiniteElementSpace\nFiniteElementCollection: H1_3D_P2\nVDim: 3\nOrdering: 1\n\n";

/// MFEM numbers edges as they come, cell after cell, and those of a cell as 01 02 03 12 13 23.
std::vector<std::uint32_t> in_mfem_order(const SecondOrder& second) {
  std::vector<std::uint32_t> nodes;
  std::vector<bool> placed(second.nodes.size());
  for (const auto& cell : second.cells)
    for (const std::size_t side : {0, 2, 3, 1, 4, 5}) {
      if (!placed[cell[side]]) nodes.push_back(cell[side]);
      placed[cell[side]] = true;
    }
  return nodes;
}

/// One set for each group, with its attribute alone.
template <class Groups>
void write_mfem_sets(Chunks& out, const char* section, const Groups& groups) {
  out.print("\n{}\n{}\n", section, groups.size());
  std::map<std::string, int> times;
  for (const auto& [key, group] : groups) {
    const bool again = times[group.name]++ > 0;
    out.print("{}\n1\n{}\n", mfem_name(again ? fmt::format("{} {}", group.name, group.tag) : group.name), group.tag);
  }
}

}  // namespace

void write_mfem(const fs::path& file, const MeshParts& mesh) {
  constexpr int triangle = 2, tetrahedron = 4;
  check_counts(file, mesh, "MFEM");
  OutputFile target(file);
  Chunks out(target);
  out.print("MFEM mesh v1.3\n");
  if (!mesh.origin.empty()) out.print("\n# {}\n", mesh.origin);
  out.print("\ndimension\n3\n\nelements\n{}\n", mesh.cells.size());
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    const auto& c = mesh.cells[i];
    out.print("{} {} {} {} {} {}\n", mesh.volumes.at(mesh.material[i]).tag, tetrahedron, c[0], c[1], c[2], c[3]);
  }
  write_mfem_sets(out, "attribute_sets", mesh.volumes);
  out.print("\nboundary\n{}\n", mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    out.print("{} {} {} {} {}\n", mesh.interfaces.at(mesh.materials[i]).tag, triangle, t.a, t.b, t.c);
  }
  write_mfem_sets(out, "bdr_attribute_sets", mesh.interfaces);
  out.print("\nvertices\n{}\n", mesh.points.size());
  out.print("{}", mesh.second ? mfem_nodes_follow : "3\n");
  for (const Vec3d& p : mesh.points) out.point(p, "");
  if (mesh.second)
    for (const std::uint32_t node : in_mfem_order(*mesh.second)) out.point(mesh.second->nodes[node], "");
  out.print("\nmfem_mesh_end\n");
  out.flush();
  target.commit();
}

}  // namespace nacre
