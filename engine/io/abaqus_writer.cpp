// Nacre: writes meshes for Abaqus and CalculiX (.inp).
#include <optional>
#include <set>

#include "engine/io/cell_faces.hpp"
#include "engine/io/chunks.hpp"
#include "engine/io/mesh_format_writers.hpp"
#include "engine/system/utf8.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t abaqus_piece = 200;  // of a longer comment: a line has at most 256 characters

/// Numbers from 1, sixteen to a line, the most that Abaqus reads.
void write_abaqus_list(Chunks& out, const std::set<std::uint32_t>& numbers) {
  std::size_t written = 0;
  for (const std::uint32_t number : numbers) {
    const bool last = ++written == numbers.size();
    out.print("{}{}", std::uint64_t(number) + 1, last || written % 16 == 0 ? "\n" : ", ");
  }
}

void write_abaqus_points(Chunks& out, const MeshParts& mesh) {
  out.print("*NODE\n");
  for (std::size_t i = 0; i < mesh.point_count(); ++i) {
    out.print("{}", i + 1);
    for (int axis = 0; axis < 3; ++axis) {
      out.print(", ");
      out.number(mesh.point(i)[axis]);
    }
    out.print("\n");
  }
}

/// A name in full, where the word for it says less.
void write_abaqus_comment(Chunks& out, const std::string& name) { out.print("** {}\n", in_utf8(name, 200)); }

/// The elements of one group: `points(i)` is none unless element i is in it. They are numbered from `number` on.
template <class PointsOf>
void write_abaqus_elements(Chunks& out, const MeshParts::Group& group, const std::string& word, const char* type,
                           std::size_t count, std::uint64_t& number, PointsOf points_of) {
  write_abaqus_comment(out, group.name);
  out.print("*ELEMENT, TYPE={}, ELSET={}\n", type, word);
  std::set<std::uint32_t> points;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<MeshParts::Element> element = points_of(i);
    if (!element) continue;
    out.print("{}", ++number);
    for (const std::uint32_t point : *element) {
      out.print(", {}", std::uint64_t(point) + 1);
      points.insert(point);
    }
    out.print("\n");
  }
  out.print("*NSET, NSET={}\n", word);
  write_abaqus_list(out, points);
}

void write_abaqus_triangles(Chunks& out, const MeshParts& mesh) {
  Identifiers identifiers;
  std::vector<std::string> sets;
  std::uint64_t number = 0;
  for (const auto& [pair, group] : mesh.interfaces) {
    sets.push_back(identifiers.of(group.name));
    write_abaqus_elements(out, group, sets.back(), mesh.second ? "STRI65" : "S3", mesh.triangles.size(), number,
                          [&, pair = pair](std::size_t i) {
                            return mesh.materials[i] == pair ? std::optional(mesh.triangle(i)) : std::nullopt;
                          });
  }
  for (const std::string& set : sets)
    for (const char* side : {"SPOS", "SNEG"})
      out.print("*SURFACE, NAME={}, TYPE=ELEMENT\n{}, {}\n", identifiers.of(set + "_" + side), set, side);
}

/// The faces of the cells of `pair[side]` at the interface of the pair.
void write_abaqus_surface(Chunks& out, const MeshParts& mesh, const std::vector<CellFace>& faces,
                          const MaterialPair& pair, int side, const std::vector<std::uint64_t>& numbers) {
  const auto material = [&](std::uint32_t cell) { return cell == no_cell ? std::uint16_t(0) : mesh.material[cell]; };
  for (const CellFace& face : faces) {
    const std::uint16_t owner = material(face.owner), neighbour = material(face.neighbour);
    const std::uint16_t here = pair[std::size_t(side)], there = pair[std::size_t(1 - side)];
    if (owner == here && neighbour == there) out.print("{}, S{}\n", numbers[face.owner], face.owner_face + 1);
    if (neighbour == here && owner == there) out.print("{}, S{}\n", numbers[face.neighbour], face.neighbour_face + 1);
  }
}

void write_abaqus_tetrahedra(Chunks& out, const MeshParts& mesh) {
  Identifiers sets, surfaces;
  std::map<std::uint16_t, std::string> name_of{{std::uint16_t(0), "outside"}};
  std::vector<std::uint64_t> numbers(mesh.cells.size());
  std::uint64_t number = 0;
  for (const auto& [m, group] : mesh.volumes) {
    name_of[m] = sets.of(group.name);
    write_abaqus_elements(out, group, name_of[m], mesh.second ? "C3D10" : "C3D4", mesh.cells.size(), number,
                          [&, m = m](std::size_t i) -> std::optional<MeshParts::Element> {
                            if (mesh.material[i] != m) return std::nullopt;
                            numbers[i] = number + 1;
                            return mesh.cell(i);
                          });
  }
  std::vector<CellFace> faces = cell_faces(mesh.cells);
  std::erase_if(faces, [&](const CellFace& f) {
    return f.neighbour != no_cell && mesh.material[f.owner] == mesh.material[f.neighbour];
  });
  for (const auto& [pair, group] : mesh.interfaces) {
    write_abaqus_comment(out, group.name);
    for (int side = 0; side < 2; ++side) {
      const std::uint16_t here = pair[std::size_t(side)], there = pair[std::size_t(1 - side)];
      if (here == 0) continue;  // no elements there
      out.print("*SURFACE, NAME={}, TYPE=ELEMENT\n", surfaces.of(name_of[here] + "_" + name_of[there]));
      write_abaqus_surface(out, mesh, faces, pair, side, numbers);
    }
  }
}

}  // namespace

void write_abaqus(const fs::path& file, const MeshParts& mesh) {
  check_counts(file, mesh, "Abaqus");
  OutputFile target(file);
  Chunks out(target);
  out.print("*HEADING\nMesh of materials, by Nacre\n");
  for (std::size_t at = 0; at < mesh.origin.size(); at += abaqus_piece)
    out.print("** {}\n", mesh.origin.substr(at, abaqus_piece));
  write_abaqus_points(out, mesh);
  mesh.cells.empty() ? write_abaqus_triangles(out, mesh) : write_abaqus_tetrahedra(out, mesh);
  out.flush();
  target.commit();
}

}  // namespace nacre
