// Nacre: writes meshes for Gmsh (.msh, version 2.2, binary).
#include "engine/io/gmsh_writer.hpp"

#include <fmt/format.h>

#include <bit>
#include <limits>

#include "compute/device/error.hpp"
#include "engine/io/chunks.hpp"
#include "engine/system/utf8.hpp"

namespace nacre {
namespace {

static_assert(std::endian::native == std::endian::little);  // readers detect it from the 1 in the header

std::string quoted(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) out += c == '"' || static_cast<unsigned char>(c) < 32 ? '_' : c;
  return out + '"';
}

void write_points(Chunks& out, const GmshMesh& mesh) {
  out.print("$Nodes\n{}\n", mesh.points.size() + mesh.nodes.size());
  std::int32_t number = 0;
  for (const std::span<const Vec3d> some : {mesh.points, mesh.nodes})
    for (const Vec3d& p : some) {
      out.raw(++number);
      out.raw(p);
    }
  out.print("\n$EndNodes\n");
}

void write_groups(Chunks& out, const GmshMesh& mesh) {
  std::size_t groups = 0;
  for (const GmshMesh::Block& block : mesh.blocks) groups += block.groups.size();
  out.print("$PhysicalNames\n{}\n", groups);
  std::set<std::string> taken;
  for (const GmshMesh::Block& block : mesh.blocks)
    for (const GmshMesh::Group& group : block.groups)
      out.print("{} {} {}\n", block.dimension, group.tag, gmsh_name(group.name, group.tag, taken));
  out.print("$EndPhysicalNames\n");
}

void write_cells(Chunks& out, const GmshMesh& mesh) {
  constexpr std::int32_t tags = 2;
  out.print("$Elements\n{}\n", mesh.cells());
  std::int32_t number = 0;
  for (const GmshMesh::Block& block : mesh.blocks) {
    if (block.cells == 0) continue;
    out.raw(gmsh_type(std::size_t(block.points)));
    out.raw(std::int32_t(block.cells));
    out.raw(tags);
    for (std::size_t i = 0; i < block.cells; ++i) {
      const std::int32_t group = block.group(i);
      out.raw(++number);
      out.raw(group);  // physical
      out.raw(group);  // elementary
      for (int k = 0; k < block.points; ++k) out.raw(std::int32_t(block.point(i, k) + 1));
    }
  }
  out.print("\n$EndElements\n");
}

void write_numbers(Chunks& out, const GmshMesh::Numbers& numbers, const GmshMesh& mesh) {
  out.print("$ElementData\n1\n{}\n1\n0\n3\n0\n1\n{}\n", quoted(numbers.name), mesh.cells());
  std::int32_t number = 0;
  for (std::size_t block = 0; block < mesh.blocks.size(); ++block)
    for (std::size_t i = 0; i < mesh.blocks[block].cells; ++i) {
      out.raw(++number);
      out.raw(numbers.of(block, i));
    }
  out.print("\n$EndElementData\n");
}

}  // namespace

std::string gmsh_name(const std::string& given, std::int32_t tag, std::set<std::string>& taken) {
  constexpr std::size_t most = 127;
  std::string name = quoted(in_utf8(given, most));
  for (int times = 1; !taken.insert(name).second; ++times) {
    const std::string number = times == 1 ? fmt::format(" {}", tag) : fmt::format(" {}.{}", tag, times);
    name = quoted(in_utf8(given, most - number.size()) + number);
  }
  return name;
}

std::int32_t gmsh_type(std::size_t points) { return points == 3 ? 2 : points == 4 ? 4 : points == 6 ? 9 : 11; }

std::size_t gmsh_order(std::size_t points, std::size_t k) {
  return points == 10 && k >= 8 ? 17 - k : k;  // of a tetrahedron, edge 23 comes before 13
}

std::size_t GmshMesh::cells() const {
  std::size_t sum = 0;
  for (const Block& block : blocks) sum += block.cells;
  return sum;
}

void write_gmsh(const std::filesystem::path& file, const GmshMesh& mesh) {
  constexpr auto most = std::size_t(std::numeric_limits<std::int32_t>::max());
  if (mesh.points.size() + mesh.nodes.size() > most || mesh.cells() > most)
    throw Error("cannot write " + file.string(), "Gmsh's format counts to 2,147,483,647", "use .vtp or .vtu");
  OutputFile target(file);
  Chunks out(target);
  out.print("$MeshFormat\n2.2 1 8\n");
  out.raw(std::int32_t(1));
  out.print("\n$EndMeshFormat\n");
  if (!mesh.origin.empty()) out.print("$Comments\n{}\n$EndComments\n", mesh.origin);
  write_groups(out, mesh);
  write_points(out, mesh);
  write_cells(out, mesh);
  for (const GmshMesh::Numbers& numbers : mesh.numbers) write_numbers(out, numbers, mesh);
  out.flush();
  target.commit();
}

}  // namespace nacre
