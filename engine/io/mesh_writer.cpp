// Nacre: writes meshes of materials in the format of the file's extension.
#include "engine/io/mesh_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <system_error>

#include "compute/device/error.hpp"
#include "engine/io/chunks.hpp"
#include "engine/io/gmsh_writer.hpp"
#include "engine/io/mesh_format_writers.hpp"
#include "engine/io/mesh_parts.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/io/vtk_inline.hpp"
#include "engine/io/vtp_writer.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;
using Labels = std::span<const std::int64_t>;
using Names = std::vector<std::string>;
using Pair = MaterialPair;

std::string checked_extension(const fs::path& file, const std::vector<std::string>& known) {
  const std::string extension = lower_extension(file);
  if (std::find(known.begin(), known.end(), extension) == known.end())
    throw Error(fmt::format("cannot write {}", file.string()),
                extension.empty() ? "its name has no extension" : fmt::format("{} files cannot be written", extension),
                fmt::format("use one of {}", fmt::join(known, " ")));
  return extension;
}

[[noreturn]] void fail(const fs::path& file, const std::string& why) {
  throw Error(fmt::format("cannot write {}", file.string()), why);
}

void check(const fs::path& file, const SurfaceMesh& mesh, Labels labels) {
  if (mesh.triangles.empty()) fail(file, "the mesh has no triangles");
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max())
    fail(file, "it has more than 4,294,967,295 triangles");
  if (mesh.materials.size() != mesh.triangles.size()) fail(file, "its triangles have no materials");
  for (const Triangle& t : mesh.triangles)
    if (std::max({t.a, t.b, t.c}) >= mesh.points.size()) fail(file, "a triangle refers to a point that does not exist");
  for (const Pair& pair : mesh.materials)
    if (std::max(pair[0], pair[1]) >= labels.size()) fail(file, "a triangle has a material without a label");
}

void check(const fs::path& file, const TetrahedralMesh& mesh, Labels labels) {
  if (mesh.cells.empty()) fail(file, "the mesh has no cells");
  if (mesh.material.size() != mesh.cells.size()) fail(file, "its cells have no materials");
  for (const auto& cell : mesh.cells)
    if (*std::max_element(cell.begin(), cell.end()) >= mesh.points.size())
      fail(file, "a cell refers to a point that does not exist");
  for (const std::uint16_t m : mesh.material)
    if (m >= labels.size()) fail(file, "a cell has a material without a label");
}

CellNumbers cell_numbers(const std::string& name, Labels labels, std::function<std::uint16_t(std::uint64_t)> of) {
  const auto [lower, upper] = std::minmax_element(labels.begin(), labels.end());
  return {name, *lower, *upper, [=](std::uint64_t i) { return labels[of(i)]; }};
}

/// Names as field data: for each material an array of its name that contains its label. Arrays of strings would make
/// meshio fail.
std::string announce_names(Labels labels, const Names& names) {
  if (names.empty()) return {};
  std::string xml = "<FieldData>\n";
  for (std::size_t m = 0; m < names.size(); ++m)
    xml += fmt::format("<DataArray type=\"Int64\" Name=\"{}\" NumberOfTuples=\"1\" format=\"ascii\">{}</DataArray>\n",
                       xml_escaped(names[m]), labels[m]);
  return xml + "</FieldData>\n";
}

/// The labels on the two sides of each triangle.
std::array<CellNumbers, 2> side_numbers(const SurfaceMesh& mesh, Labels labels) {
  const auto side = [&](std::size_t k) {
    return cell_numbers(fmt::format("material_{}", k), labels,
                        [&mesh, k](std::uint64_t i) { return mesh.materials[i][k]; });
  };
  return {side(0), side(1)};
}

void write_ply(const fs::path& file, const SurfaceMesh& mesh, Labels labels, const std::string& origin) {
  const auto [lower, upper] = std::minmax_element(labels.begin(), labels.end());
  using Narrow = std::numeric_limits<std::int32_t>;
  if (*lower < Narrow::min() || *upper > Narrow::max())
    throw Error(fmt::format("cannot write {}", file.string()), "PLY has no labels beyond 32 bits", "use .vtp");
  OutputFile target(file);
  Chunks out(target);
  out.print("ply\nformat binary_little_endian 1.0\n");
  if (!origin.empty()) out.print("comment {}\n", origin);
  out.print("element vertex {}\n", mesh.points.size());
  out.print("property double x\nproperty double y\nproperty double z\nelement face {}\n", mesh.triangles.size());
  out.print("property list uchar uint vertex_indices\nproperty int material_0\nproperty int material_1\nend_header\n");
  for (const Vec3d& p : mesh.points) out.raw(p);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    out.raw(std::uint8_t(3));
    out.raw(mesh.triangles[i]);
    for (const std::uint16_t m : mesh.materials[i]) out.raw(std::int32_t(labels[m]));
  }
  out.flush();
  target.commit();
}

/// Triangles by pair of materials, one group per pair.
void write_obj(const fs::path& file, const SurfaceMesh& mesh, Labels labels, const std::string& origin) {
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t i, std::uint32_t j) { return mesh.materials[i] < mesh.materials[j]; });
  OutputFile target(file);
  Chunks out(target);
  if (!origin.empty()) out.print("# {}\n", origin);
  for (const Vec3d& p : mesh.points) out.point(p, "v ");
  const Pair* last = nullptr;
  for (const std::uint32_t i : order) {
    const Pair& pair = mesh.materials[i];
    if (!last || *last != pair) out.print("g {}\n", interface_name(pair, labels, {}));
    last = &pair;
    const Triangle& t = mesh.triangles[i];
    out.print("f {} {} {}\n", std::uint64_t(t.a) + 1, std::uint64_t(t.b) + 1, std::uint64_t(t.c) + 1);
  }
  out.flush();
  target.commit();
}

std::span<const Vec3d> nodes_of(const MeshParts& mesh) {
  return mesh.second ? std::span<const Vec3d>(mesh.second->nodes) : std::span<const Vec3d>();
}

/// Triangles, one physical group per pair of materials.
GmshMesh::Block gmsh_triangles(const MeshParts& mesh) {
  GmshMesh::Block block;
  block.points = mesh.second ? 6 : 3;
  block.cells = mesh.triangles.size();
  block.point = [&mesh](std::size_t i, int k) { return mesh.triangle(i)[std::size_t(k)]; };
  block.group = [&mesh](std::size_t i) { return mesh.interfaces.at(mesh.materials[i]).tag; };
  for (const auto& [pair, group] : mesh.interfaces) block.groups.push_back({group.tag, group.name});
  return block;
}

void write_msh(const fs::path& file, const SurfaceMesh& mesh, const MeshParts& parts, Labels labels) {
  GmshMesh out;
  out.points = mesh.points;
  out.nodes = nodes_of(parts);
  out.origin = parts.origin;
  out.blocks.push_back(gmsh_triangles(parts));
  for (CellNumbers& side : side_numbers(mesh, labels))
    out.numbers.push_back({side.name, [of = side.of](std::size_t, std::size_t i) { return double(of(i)); }});
  write_gmsh(file, out);
}

/// One material's surface of its own.
struct MaterialSurface {
  SurfaceMesh mesh;
  std::optional<SecondOrder> second;
};

/// The facets of one material, oriented so that their normals point out of it, with the points that they use.
MaterialSurface surface_of(const SurfaceMesh& mesh, std::uint16_t material, const SecondOrder* second) {
  std::vector<std::uint32_t> number(mesh.points.size(), none), node_number(second ? second->nodes.size() : 0, none);
  MaterialSurface surface;
  if (second) surface.second.emplace();
  const auto use = [&](std::uint32_t p) {
    if (number[p] == none) {
      number[p] = std::uint32_t(surface.mesh.points.size());
      surface.mesh.points.push_back(mesh.points[p]);
    }
    return number[p];
  };
  const auto use_node = [&](std::uint32_t n) {
    if (node_number[n] == none) {
      node_number[n] = std::uint32_t(surface.second->nodes.size());
      surface.second->nodes.push_back(second->nodes[n]);
    }
    return node_number[n];
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const bool second_side = mesh.materials[i][1] == material;
    if (!second_side && mesh.materials[i][0] != material) continue;
    const std::uint32_t a = use(t.a), b = use(second_side ? t.b : t.c), c = use(second_side ? t.c : t.b);
    surface.mesh.triangles.push_back({a, b, c});
    if (!second) continue;
    const auto& n = second->triangles[i];
    const std::uint32_t ab = use_node(second_side ? n[0] : n[2]), bc = use_node(n[1]),
                        ca = use_node(second_side ? n[2] : n[0]);
    surface.second->triangles.push_back({ab, bc, ca});
  }
  surface.mesh.materials.assign(surface.mesh.triangles.size(), {0, material});
  return surface;
}

using Writer = void (*)(const fs::path& file, const MeshParts& mesh);

}  // namespace

void write_xdmf(const fs::path& file, const MeshParts& mesh) {
  if (!xdmf_writer)
    throw Error(file.string() + " needs HDF5, which is not built in", "",
                "write .vtu or .msh, and convert it with meshio");
  xdmf_writer(file, mesh);
}

namespace {

/// Formats that are written from parts; nothing where a format has no surfaces, or no tetrahedra.
struct PartsFormat {
  const char* extension;
  Writer surface, tetrahedra;
  bool second_order;
};
constexpr std::array parts_formats{
    PartsFormat{".msh4", write_gmsh4, write_gmsh4, true}, PartsFormat{".inp", write_abaqus, write_abaqus, true},
    PartsFormat{".mesh", nullptr, write_mfem, true},      PartsFormat{".feb", nullptr, write_febio, true},
    PartsFormat{".foam", nullptr, write_openfoam, false}, PartsFormat{".xdmf", write_xdmf, write_xdmf, false},
    PartsFormat{".glb", write_gltf, nullptr, false},
};

const PartsFormat* parts_format(const std::string& extension) {
  const auto found = std::find_if(parts_formats.begin(), parts_formats.end(),
                                  [&](const PartsFormat& format) { return format.extension == extension; });
  return found == parts_formats.end() ? nullptr : &*found;
}

/// One group, which has the name of the material whatever is around it.
void write_one_material(const fs::path& file, MaterialSurface&& own, Labels labels, const std::string& name,
                        const std::string& origin) {
  SurfaceMesh& surface = own.mesh;
  const std::string extension = checked_extension(file, surface_mesh_extensions());
  MeshParts parts = surface_parts(surface, labels, {});
  parts.interfaces.begin()->second.name = name;
  parts.origin = origin;
  parts.second = own.second ? &*own.second : nullptr;
  if (const PartsFormat* format = parts_format(extension)) return format->surface(file, parts);
  if (extension == ".msh")
    return write_gmsh(file, {surface.points, nodes_of(parts), {gmsh_triangles(parts)}, {}, origin});
  write_surface(file, {std::move(surface.points), std::move(surface.triangles), {}}, std::nullopt, origin);
}

void write_vtu(const fs::path& path, const MeshParts& mesh, Labels labels, const Names& names) {
  constexpr int vtk_tetrahedron = 10, vtk_quadratic_tetrahedron = 24;
  const std::uint64_t cells = mesh.cells.size(), each = mesh.second ? 10 : 4;
  const int type = mesh.second ? vtk_quadratic_tetrahedron : vtk_tetrahedron;
  const CellNumbers material = cell_numbers("material", labels, [&mesh](std::uint64_t i) { return mesh.material[i]; });
  Inline numbers;
  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n{}<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      xml_origin(mesh.origin) + announce_names(labels, names), mesh.point_count(), cells);
  xml += announce_cell_data(numbers, cells, std::span(&material, 1));
  xml += "<Points>\n" +
         numbers.announce("Float64", "Points", 3, mesh.point_count() * sizeof(Vec3d),
                          [&](Base64Text& file) {
                            file.write(mesh.points.data(), mesh.points.size_bytes());
                            file.write(nodes_of(mesh).data(), nodes_of(mesh).size_bytes());
                          }) +
         "</Points>\n<Cells>\n";
  xml += announce_indices(numbers, "connectivity", each * cells, mesh.point_count(),
                          [&mesh, each](std::uint64_t i) { return mesh.cell(i / each)[i % each]; });
  xml += announce_indices(numbers, "offsets", cells, each * cells, [each](std::uint64_t i) { return each * i + each; });
  xml += numbers.announce("UInt8", "types", 1, cells, [cells, type](Base64Text& file) {
    write_generated<std::uint8_t>(file, cells, [type](std::uint64_t) { return type; });
  });
  OutputFile file(path);
  numbers.write(file, xml + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  file.commit();
}

/// Tetrahedra, one physical group per material.
GmshMesh::Block gmsh_tetrahedra(const MeshParts& mesh) {
  GmshMesh::Block block;
  block.dimension = 3;
  block.points = mesh.second ? 10 : 4;
  block.cells = mesh.cells.size();
  block.point = [&mesh, n = std::size_t(block.points)](std::size_t i, int k) {
    return mesh.cell(i)[gmsh_order(n, std::size_t(k))];
  };
  block.group = [&mesh](std::size_t i) { return mesh.volumes.at(mesh.material[i]).tag; };
  for (const auto& [m, group] : mesh.volumes) block.groups.push_back({group.tag, group.name});
  return block;
}

/// The triangles between the materials, then the tetrahedra. Only groups say what each belongs to: from a file with
/// two kinds of cells, meshio 5.3 reads no numbers beside them, nor anything after them.
void write_msh(const fs::path& file, const MeshParts& parts) {
  GmshMesh out;
  out.points = parts.points;
  out.nodes = nodes_of(parts);
  out.origin = parts.origin;
  out.blocks = {gmsh_triangles(parts), gmsh_tetrahedra(parts)};
  write_gmsh(file, out);
}

}  // namespace

std::vector<std::string> surface_mesh_extensions() {
  std::vector<std::string> extensions = {".vtp", ".ply", ".msh", ".obj", ".off", ".stl"};
  for (const PartsFormat& format : parts_formats)
    if (format.surface) extensions.push_back(format.extension);
  return extensions;
}

std::vector<std::string> tetrahedral_mesh_extensions() {
  std::vector<std::string> extensions = {".vtu", ".msh"};
  for (const PartsFormat& format : parts_formats)
    if (format.tetrahedra) extensions.push_back(format.extension);
  return extensions;
}

void check_second_order(const fs::path& file, bool tetrahedra) {
  const auto has_second = [](const std::string& extension) {
    const PartsFormat* format = parts_format(extension);
    return format ? format->second_order : extension == ".msh" || extension == ".vtu";
  };
  std::vector<std::string> known = tetrahedra ? tetrahedral_mesh_extensions() : surface_mesh_extensions();
  const std::string extension = lower_extension(file);
  if (has_second(extension)) return;
  std::erase_if(known, [&](const std::string& each) { return !has_second(each); });
  throw Error(fmt::format("cannot write {} with `element_order` 2", file.string()),
              fmt::format("{} files have no elements with nodes on their edges", extension),
              fmt::format("use one of {}, or `element_order` 1", fmt::join(known, " ")));
}

std::vector<std::string> mesh_extensions() {
  std::vector<std::string> all = surface_mesh_extensions();
  for (const std::string& extension : tetrahedral_mesh_extensions())
    if (std::find(all.begin(), all.end(), extension) == all.end()) all.push_back(extension);
  return all;
}

void write_surface_mesh(const fs::path& file, const SurfaceMesh& mesh, Labels labels,
                        std::span<const std::string> names, const std::string& origin, const SecondOrder* second) {
  const std::string extension = checked_extension(file, surface_mesh_extensions());
  check(file, mesh, labels);
  if (second) check_second_order(file, false);
  if (extension == ".vtp")
    return write_vtp(file, std::span<const Vec3d>(mesh.points), mesh.triangles, {}, std::nullopt,
                     side_numbers(mesh, labels),
                     xml_origin(origin) + announce_names(labels, full_names(labels, names)));
  if (extension == ".ply") return write_ply(file, mesh, labels, origin);
  if (extension == ".obj") return write_obj(file, mesh, labels, origin);
  const Names full = full_names(labels, names);
  const PartsFormat* format = parts_format(extension);
  if (format || extension == ".msh") {
    MeshParts parts = surface_parts(mesh, labels, full);
    parts.origin = origin;
    parts.second = second;
    return format ? format->surface(file, parts) : write_msh(file, mesh, parts, labels);
  }
  write_surface(file, {mesh.points, mesh.triangles, {}}, std::nullopt, origin);
}

std::vector<fs::path> write_material_surfaces(const fs::path& file, const SurfaceMesh& mesh, Labels labels,
                                              std::span<const std::string> names, const std::string& origin,
                                              const SecondOrder* second) {
  checked_extension(file, surface_mesh_extensions());
  check(file, mesh, labels);
  if (second) check_second_order(file, false);
  const Names full = full_names(labels, names);
  std::vector<fs::path> written;
  try {
    for (std::size_t m = 1; m < labels.size(); ++m) {
      MaterialSurface surface = surface_of(mesh, std::uint16_t(m), second);
      if (surface.mesh.triangles.empty()) continue;
      const std::string name = fmt::format("{}_{}{}", file.stem().string(), labels[m], file.extension().string());
      write_one_material(file.parent_path() / name, std::move(surface), labels,
                         material_name(std::uint16_t(m), labels, full), origin);
      written.push_back(file.parent_path() / name);
    }
  } catch (...) {
    std::error_code ignored;
    for (const fs::path& done : written) fs::remove(done, ignored);
    throw;
  }
  return written;
}

void write_tetrahedral_mesh(const fs::path& file, const TetrahedralMesh& mesh, const SurfaceMesh& surface,
                            Labels labels, std::span<const std::string> names, const std::string& origin,
                            const SecondOrder* second) {
  const std::string extension = checked_extension(file, tetrahedral_mesh_extensions());
  check(file, mesh, labels);
  check(file, surface, labels);
  if (surface.points.size() > mesh.points.size()) fail(file, "its surface has more points than it");
  const Names full = full_names(labels, names);
  if (second) check_second_order(file, true);
  MeshParts parts = volume_parts(mesh, surface, labels, full);
  parts.origin = origin;
  parts.second = second;
  if (extension == ".vtu") return write_vtu(file, parts, labels, full);
  const PartsFormat* format = parts_format(extension);
  format ? format->tetrahedra(file, parts) : write_msh(file, parts);
}

}  // namespace nacre
