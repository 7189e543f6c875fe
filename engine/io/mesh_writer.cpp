// Nacre: writes meshes of materials in the format of the file's extension.
#include "engine/io/mesh_writer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <numeric>
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

/// Triangles, one physical group per pair of materials.
GmshMesh::Block gmsh_triangles(const MeshParts& mesh) {
  GmshMesh::Block block;
  block.cells = mesh.triangles.size();
  block.corner = [&mesh](std::size_t i, int k) { return mesh.triangles[i][k]; };
  block.group = [&mesh](std::size_t i) { return mesh.interfaces.at(mesh.materials[i]).tag; };
  for (const auto& [pair, group] : mesh.interfaces) block.groups.push_back({group.tag, group.name});
  return block;
}

void write_msh(const fs::path& file, const SurfaceMesh& mesh, const MeshParts& parts, Labels labels) {
  GmshMesh out;
  out.points = mesh.points;
  out.origin = parts.origin;
  out.blocks.push_back(gmsh_triangles(parts));
  for (CellNumbers& side : side_numbers(mesh, labels))
    out.numbers.push_back({side.name, [of = side.of](std::size_t, std::size_t i) { return double(of(i)); }});
  write_gmsh(file, out);
}

/// The facets of one material, oriented so that their normals point out of it, with the points that they use.
SurfaceMesh surface_of(const SurfaceMesh& mesh, std::uint16_t material) {
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> number(mesh.points.size(), none);
  SurfaceMesh surface;
  const auto use = [&](std::uint32_t p) {
    if (number[p] == none) {
      number[p] = std::uint32_t(surface.points.size());
      surface.points.push_back(mesh.points[p]);
    }
    return number[p];
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    if (mesh.materials[i][1] == material)
      surface.triangles.push_back({use(t.a), use(t.b), use(t.c)});
    else if (mesh.materials[i][0] == material)
      surface.triangles.push_back({use(t.a), use(t.c), use(t.b)});
  }
  surface.materials.assign(surface.triangles.size(), {0, material});
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
};
constexpr std::array parts_formats{
    PartsFormat{".msh4", write_gmsh4, write_gmsh4}, PartsFormat{".inp", write_abaqus, write_abaqus},
    PartsFormat{".mesh", nullptr, write_mfem},      PartsFormat{".feb", nullptr, write_febio},
    PartsFormat{".foam", nullptr, write_openfoam},  PartsFormat{".xdmf", write_xdmf, write_xdmf},
    PartsFormat{".glb", write_gltf, nullptr},
};

const PartsFormat* parts_format(const std::string& extension) {
  const auto found = std::find_if(parts_formats.begin(), parts_formats.end(),
                                  [&](const PartsFormat& format) { return format.extension == extension; });
  return found == parts_formats.end() ? nullptr : &*found;
}

/// One group, which has the name of the material whatever is around it.
void write_one_material(const fs::path& file, SurfaceMesh&& surface, Labels labels, const std::string& name,
                        const std::string& origin) {
  const std::string extension = checked_extension(file, surface_mesh_extensions());
  MeshParts parts = surface_parts(surface, labels, {});
  parts.interfaces.begin()->second.name = name;
  parts.origin = origin;
  if (const PartsFormat* format = parts_format(extension)) return format->surface(file, parts);
  if (extension == ".msh") return write_gmsh(file, {surface.points, {gmsh_triangles(parts)}, {}, origin});
  write_surface(file, {std::move(surface.points), std::move(surface.triangles), {}}, std::nullopt, origin);
}

void write_vtu(const fs::path& path, const TetrahedralMesh& mesh, Labels labels, const Names& names,
               const std::string& origin) {
  constexpr int vtk_tetrahedron = 10;
  const std::uint64_t cells = mesh.cells.size();
  const CellNumbers material = cell_numbers("material", labels, [&mesh](std::uint64_t i) { return mesh.material[i]; });
  Inline numbers;
  std::string xml = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<UnstructuredGrid>\n{}<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      xml_origin(origin) + announce_names(labels, names), mesh.points.size(), cells);
  xml += announce_cell_data(numbers, cells, std::span(&material, 1));
  const std::uint64_t bytes = mesh.points.size() * sizeof(Vec3d);
  xml += "<Points>\n" + numbers.announce("Float64", "Points", 3, bytes, [&](Base64Text& file) {
    file.write(mesh.points.data(), bytes);
  }) + "</Points>\n<Cells>\n";
  xml += announce_indices(numbers, "connectivity", 4 * cells, mesh.points.size(),
                          [&mesh](std::uint64_t i) { return mesh.cells[i / 4][i % 4]; });
  xml += announce_indices(numbers, "offsets", cells, 4 * cells, [](std::uint64_t i) { return 4 * i + 4; });
  xml += numbers.announce("UInt8", "types", 1, cells, [cells](Base64Text& file) {
    write_generated<std::uint8_t>(file, cells, [](std::uint64_t) { return vtk_tetrahedron; });
  });
  OutputFile file(path);
  numbers.write(file, xml + "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
  file.commit();
}

/// Tetrahedra, one physical group per material.
GmshMesh::Block gmsh_tetrahedra(const MeshParts& mesh) {
  GmshMesh::Block block;
  block.corners = 4;
  block.cells = mesh.cells.size();
  block.corner = [&mesh](std::size_t i, int k) { return mesh.cells[i][std::size_t(k)]; };
  block.group = [&mesh](std::size_t i) { return mesh.volumes.at(mesh.material[i]).tag; };
  for (const auto& [m, group] : mesh.volumes) block.groups.push_back({group.tag, group.name});
  return block;
}

/// The triangles between the materials, then the tetrahedra. Only groups say what each belongs to: from a file with
/// two kinds of cells, meshio 5.3 reads no numbers beside them, nor anything after them.
void write_msh(const fs::path& file, const MeshParts& parts) {
  GmshMesh out;
  out.points = parts.points;
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

std::vector<std::string> mesh_extensions() {
  std::vector<std::string> all = surface_mesh_extensions();
  for (const std::string& extension : tetrahedral_mesh_extensions())
    if (std::find(all.begin(), all.end(), extension) == all.end()) all.push_back(extension);
  return all;
}

void write_surface_mesh(const fs::path& file, const SurfaceMesh& mesh, Labels labels,
                        std::span<const std::string> names, const std::string& origin) {
  const std::string extension = checked_extension(file, surface_mesh_extensions());
  check(file, mesh, labels);
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
    return format ? format->surface(file, parts) : write_msh(file, mesh, parts, labels);
  }
  write_surface(file, {mesh.points, mesh.triangles, {}}, std::nullopt, origin);
}

std::vector<fs::path> write_material_surfaces(const fs::path& file, const SurfaceMesh& mesh, Labels labels,
                                              std::span<const std::string> names, const std::string& origin) {
  checked_extension(file, surface_mesh_extensions());
  check(file, mesh, labels);
  const Names full = full_names(labels, names);
  std::vector<fs::path> written;
  try {
    for (std::size_t m = 1; m < labels.size(); ++m) {
      SurfaceMesh surface = surface_of(mesh, std::uint16_t(m));
      if (surface.triangles.empty()) continue;
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
                            Labels labels, std::span<const std::string> names, const std::string& origin) {
  const std::string extension = checked_extension(file, tetrahedral_mesh_extensions());
  check(file, mesh, labels);
  check(file, surface, labels);
  if (surface.points.size() > mesh.points.size()) fail(file, "its surface has more points than it");
  const Names full = full_names(labels, names);
  if (extension == ".vtu") return write_vtu(file, mesh, labels, full, origin);
  MeshParts parts = volume_parts(mesh, surface, labels, full);
  parts.origin = origin;
  const PartsFormat* format = parts_format(extension);
  format ? format->tetrahedra(file, parts) : write_msh(file, parts);
}

}  // namespace nacre
