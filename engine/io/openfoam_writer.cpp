// Nacre: writes meshes for OpenFOAM (constant/polyMesh of a case).
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <system_error>

#include "compute/device/error.hpp"
#include "engine/io/cell_faces.hpp"
#include "engine/io/chunks.hpp"
#include "engine/io/mesh_format_writers.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// Files of a case, which get their names together when all are complete.
class CaseFiles {
 public:
  explicit CaseFiles(fs::path folder) : folder_(std::move(folder)) {}
  ~CaseFiles() {
    files_.clear();
    std::error_code ignored;
    for (auto it = made_.rbegin(); it != made_.rend(); ++it) fs::remove(*it, ignored);  // where they are empty
  }
  CaseFiles(const CaseFiles&) = delete;
  CaseFiles& operator=(const CaseFiles&) = delete;

  /// A file in `location` below the folder, with the header that OpenFOAM asks for.
  void write(const std::string& location, const std::string& object, const char* type, const std::string& note,
             const std::function<void(Chunks&)>& content) {
    make_folders(folder_ / location);
    files_.push_back(std::make_unique<OutputFile>(folder_ / location / object));
    Chunks out(*files_.back());
    out.print(  // some readers count on the comment
        "/*--------------------------------*- C++ -*----------------------------------*\\\n"
        "  Mesh of materials, written by Nacre\n"
        "\\*---------------------------------------------------------------------------*/\n"
        "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n{}    location    \"{}\";\n"
        "    object      {};\n}}\n\n",
        type, note.empty() ? "" : fmt::format("    note        \"{}\";\n", note), location, object);
    content(out);
    out.flush();
  }
  void commit() {
    for (const auto& file : files_) file->commit();
    made_.clear();
  }

 private:
  void make_folders(const fs::path& folder) {
    std::error_code code;
    if (fs::is_directory(folder, code)) return;
    if (folder.has_parent_path()) make_folders(folder.parent_path());
    if (!fs::create_directory(folder, code))
      throw Error("cannot write " + folder.string(), code ? code.message() : "there is a file of that name");
    made_.push_back(folder);
  }

  fs::path folder_;
  std::vector<fs::path> made_;
  std::vector<std::unique_ptr<OutputFile>> files_;
};

/// The faces, in the order of the file: those between cells, then patch by patch. `patches`: name, faces, first face.
struct PolyMesh {
  struct Patch {
    std::string name;
    std::size_t faces = 0, first = 0;
  };
  std::vector<CellFace> faces;
  std::size_t inner = 0;
  std::vector<Patch> patches;
};

PolyMesh poly_mesh(const MeshParts& mesh, Identifiers& identifiers) {
  PolyMesh result;
  result.faces = cell_faces(mesh.cells);
  const auto outer = std::find_if(result.faces.begin(), result.faces.end(),
                                  [](const CellFace& face) { return face.neighbour == no_cell; });
  result.inner = std::size_t(outer - result.faces.begin());
  std::stable_sort(outer, result.faces.end(), [&](const CellFace& a, const CellFace& b) {
    return mesh.material[a.owner] < mesh.material[b.owner];
  });
  for (std::size_t i = result.inner; i < result.faces.size();) {
    const std::uint16_t m = mesh.material[result.faces[i].owner];
    const auto group = mesh.interfaces.find({0, m});
    const std::string name =
        group != mesh.interfaces.end() ? group->second.name : "outside - " + mesh.volumes.at(m).name;
    result.patches.push_back({identifiers.of(name), 0, i});
    for (; i < result.faces.size() && mesh.material[result.faces[i].owner] == m; ++i) ++result.patches.back().faces;
  }
  return result;
}

void write_zone(Chunks& out, const std::string& name, const char* kind, const std::vector<std::size_t>& members,
                const std::vector<bool>* flips) {
  out.print("{}\n{{\n    type        {}Zone;\n    {}Labels  List<label>\n{}\n(\n", name, kind, kind, members.size());
  for (const std::size_t member : members) out.print("{}\n", member);
  out.print(");\n");
  if (flips) {
    out.print("    flipMap     List<bool>\n{}\n(\n", flips->size());
    for (const bool flip : *flips) out.print("{}\n", int(flip));
    out.print(");\n");
  }
  out.print("}}\n");
}

void write_cell_zones(Chunks& out, const MeshParts& mesh) {
  Identifiers identifiers;
  out.print("{}\n(\n", mesh.volumes.size());
  for (const auto& [m, group] : mesh.volumes) {
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i < mesh.cells.size(); ++i)
      if (mesh.material[i] == m) cells.push_back(i);
    write_zone(out, identifiers.of(group.name), "cell", cells, nullptr);
  }
  out.print(")\n");
}

/// A face is flipped if its normal, which points out of its owner, points into the higher material.
void write_face_zones(Chunks& out, const MeshParts& mesh, const PolyMesh& poly, Identifiers& identifiers) {
  std::map<MaterialPair, std::pair<std::vector<std::size_t>, std::vector<bool>>> zones;
  for (std::size_t i = 0; i < poly.inner; ++i) {
    const std::uint16_t a = mesh.material[poly.faces[i].owner], b = mesh.material[poly.faces[i].neighbour];
    if (a == b) continue;
    auto& [faces, flips] = zones[{std::min(a, b), std::max(a, b)}];
    faces.push_back(i);
    flips.push_back(a < b);
  }
  out.print("{}\n(\n", zones.size());
  for (const auto& [pair, zone] : zones) {
    const auto group = mesh.interfaces.find(pair);
    const std::string name = group != mesh.interfaces.end()
                                 ? group->second.name
                                 : mesh.volumes.at(pair[0]).name + " - " + mesh.volumes.at(pair[1]).name;
    write_zone(out, identifiers.of(name), "face", zone.first, &zone.second);
  }
  out.print(")\n");
}

void write_cells_of_faces(CaseFiles& files, const std::string& folder, const MeshParts& mesh, const PolyMesh& poly) {
  const std::string note = fmt::format("nPoints:{}  nCells:{}  nFaces:{}  nInternalFaces:{}", mesh.points.size(),
                                       mesh.cells.size(), poly.faces.size(), poly.inner);
  files.write(folder, "owner", "labelList", note, [&](Chunks& out) {
    out.print("{}\n(\n", poly.faces.size());
    for (const CellFace& face : poly.faces) out.print("{}\n", face.owner);
    out.print(")\n");
  });
  files.write(folder, "neighbour", "labelList", note, [&](Chunks& out) {
    out.print("{}\n(\n", poly.inner);
    for (std::size_t i = 0; i < poly.inner; ++i) out.print("{}\n", poly.faces[i].neighbour);
    out.print(")\n");
  });
}

void write_poly_mesh(CaseFiles& files, const MeshParts& mesh) {
  const std::string folder = "constant/polyMesh";
  Identifiers identifiers;
  const PolyMesh poly = poly_mesh(mesh, identifiers);
  files.write(folder, "points", "vectorField", "", [&](Chunks& out) {
    out.print("{}\n(\n", mesh.points.size());
    for (const Vec3d& p : mesh.points) out.print("({} {} {})\n", p.x, p.y, p.z);
    out.print(")\n");
  });
  files.write(folder, "faces", "faceList", "", [&](Chunks& out) {
    out.print("{}\n(\n", poly.faces.size());
    for (const CellFace& face : poly.faces)
      out.print("3({} {} {})\n", face.corners[0], face.corners[1], face.corners[2]);
    out.print(")\n");
  });
  write_cells_of_faces(files, folder, mesh, poly);
  files.write(folder, "boundary", "polyBoundaryMesh", "", [&](Chunks& out) {
    out.print("{}\n(\n", poly.patches.size());
    for (const PolyMesh::Patch& patch : poly.patches)
      out.print("{}\n{{\n    type        patch;\n    nFaces      {};\n    startFace   {};\n}}\n", patch.name,
                patch.faces, patch.first);
    out.print(")\n");
  });
  files.write(folder, "cellZones", "regIOobject", "", [&](Chunks& out) { write_cell_zones(out, mesh); });
  files.write(folder, "faceZones", "regIOobject", "",
              [&](Chunks& out) { write_face_zones(out, mesh, poly, identifiers); });
}

}  // namespace

void write_openfoam(const fs::path& file, const MeshParts& mesh) {
  check_counts(file, mesh, "OpenFOAM");
  const fs::path folder = fs::absolute(file).parent_path();
  CaseFiles files(folder);
  write_poly_mesh(files, mesh);
  std::error_code code;
  if (!fs::exists(folder / "system/controlDict", code))
    files.write("system", "controlDict", "dictionary", "", [](Chunks& out) {
      out.print(
          "application     checkMesh;\nstartFrom       startTime;\nstartTime       0;\nstopAt          endTime;\n"
          "endTime         1;\ndeltaT          1;\nwriteControl    timeStep;\nwriteInterval   1;\n");
    });
  OutputFile marker(file);
  files.commit();
  marker.commit();
}

}  // namespace nacre
