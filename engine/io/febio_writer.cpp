// Nacre: writes meshes for FEBio (.feb).
#include <set>
#include <utility>
#include <vector>

#include "engine/io/chunks.hpp"
#include "engine/io/mesh_format_writers.hpp"
#include "engine/io/vtk_inline.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// Names in a file have to differ.
std::string unique_febio_name(const std::string& name, std::set<std::string>& taken) {
  std::string unique = name;
  for (int times = 2; !taken.insert(unique).second; ++times) unique = fmt::format("{} {}", name, times);
  return xml_escaped(unique);
}

/// Numbers from 1.
template <class Points>
std::string febio_points(const Points& points) {
  std::string text;
  for (const std::uint32_t point : points)
    text += fmt::format("{}{}", text.empty() ? "" : ",", std::uint64_t(point) + 1);
  return text;
}

/// Elements of one kind after the other: some readers take them in this order only.
void write_febio_materials(Chunks& out, const MeshParts& mesh) {
  std::set<std::string> taken;
  std::uint64_t number = 0;
  for (const auto& [m, group] : mesh.volumes) {
    out.print("<Elements type=\"{}\" name=\"{}\">\n", mesh.second ? "tet10" : "tet4",
              unique_febio_name(group.name, taken));
    for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
      if (mesh.material[i] != m) continue;
      out.print("<elem id=\"{}\">{}</elem>\n", ++number, febio_points(mesh.cell(i)));
    }
    out.print("</Elements>\n");
  }
}

void write_febio_node_sets(Chunks& out, const MeshParts& mesh) {
  std::set<std::string> taken;
  for (const auto& [m, group] : mesh.volumes) {
    std::set<std::uint32_t> points;
    for (std::size_t i = 0; i < mesh.cells.size(); ++i)
      if (mesh.material[i] == m)
        for (const std::uint32_t point : mesh.cell(i)) points.insert(point);
    out.print("<NodeSet name=\"{}\">", unique_febio_name(group.name, taken));
    bool first = true;
    for (const std::uint32_t point : points) {
      out.print("{}{}", first ? "" : ",", std::uint64_t(point) + 1);
      first = false;
    }
    out.print("</NodeSet>\n");
  }
}

/// The triangles of an interface, with their normals out of its second material, or out of its first.
void write_febio_surface(Chunks& out, const MeshParts& mesh, const MaterialPair& pair, const std::string& name,
                         bool out_of_first) {
  out.print("<Surface name=\"{}\">\n", name);
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.materials[i] != pair) continue;
    const MeshParts::Element t = mesh.triangle(i);
    std::vector<std::uint32_t> points(t.begin(), t.end());
    if (out_of_first) {
      std::swap(points[1], points[2]);
      if (points.size() == 6) std::swap(points[3], points[5]);
    }
    const char* kind = points.size() == 6 ? "tri6" : "tri3";
    out.print("<{} id=\"{}\">{}</{}>\n", kind, ++number, febio_points(points), kind);
  }
  out.print("</Surface>\n");
}

/// Surfaces; gives the text of their pairs.
std::string write_febio_interfaces(Chunks& out, const MeshParts& mesh) {
  std::set<std::string> taken;
  std::string pairs;
  for (const auto& [pair, group] : mesh.interfaces) {
    const auto first = mesh.volumes.find(pair[0]), second = mesh.volumes.find(pair[1]);
    if (first == mesh.volumes.end() || second == mesh.volumes.end()) {
      write_febio_surface(out, mesh, pair, unique_febio_name(group.name, taken), false);
      continue;
    }
    const std::string a = first->second.name, b = second->second.name;
    const std::string out_of_a = unique_febio_name(a + " - " + b, taken),
                      out_of_b = unique_febio_name(b + " - " + a, taken);
    write_febio_surface(out, mesh, pair, out_of_a, true);
    write_febio_surface(out, mesh, pair, out_of_b, false);
    pairs +=
        fmt::format("<SurfacePair name=\"{}\">\n<primary>{}</primary>\n<secondary>{}</secondary>\n</SurfacePair>\n",
                    out_of_a, out_of_a, out_of_b);
  }
  return pairs;
}

}  // namespace

void write_febio(const fs::path& file, const MeshParts& mesh) {
  check_counts(file, mesh, "FEBio");
  OutputFile target(file);
  Chunks out(target);
  out.print("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}<febio_spec version=\"4.0\">\n", xml_origin(mesh.origin));
  out.print("<Mesh>\n<Nodes name=\"all\">\n");
  for (std::size_t i = 0; i < mesh.point_count(); ++i) {
    out.print("<node id=\"{}\">", i + 1);
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) out.print(",");
      out.number(mesh.point(i)[axis]);
    }
    out.print("</node>\n");
  }
  out.print("</Nodes>\n");
  write_febio_materials(out, mesh);
  const std::string pairs = write_febio_interfaces(out, mesh);
  write_febio_node_sets(out, mesh);
  out.print("{}</Mesh>\n</febio_spec>\n", pairs);
  out.flush();
  target.commit();
}

}  // namespace nacre
