// Nacre: combines several parts of a mesh.
#include "engine/io/raw_mesh.hpp"

#include <algorithm>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

void append_arrays(std::vector<RawArray>& arrays, std::vector<RawArray>& part) {
  std::erase_if(arrays, [&](RawArray& array) {
    const auto other = std::find_if(part.begin(), part.end(), [&](const RawArray& candidate) {
      return candidate.name == array.name && candidate.components == array.components;
    });
    if (other == part.end()) return true;
    array.values.insert(array.values.end(), other->values.begin(), other->values.end());
    return false;
  });
}

}  // namespace

void append(RawMesh& mesh, RawMesh&& part) {
  mesh.lines += part.lines;
  mesh.volume_cells += part.volume_cells;
  for (std::string& warning : part.warnings) mesh.warnings.push_back(std::move(warning));
  if (!mesh.time) mesh.time = part.time;
  if (part.points.empty()) return;
  if (mesh.points.empty()) {
    // An empty part does not decide which arrays exist.
    part.lines = mesh.lines;
    part.volume_cells = mesh.volume_cells;
    part.warnings = std::move(mesh.warnings);
    part.time = mesh.time;
    if (part.field_arrays.empty()) part.field_arrays = std::move(mesh.field_arrays);
    mesh = std::move(part);
    return;
  }
  const std::size_t shift = mesh.points.size();
  if (shift + part.points.size() >= RawMesh::no_point)
    throw Error("the parts have more points together than can be numbered", "at most 4,294,967,294");
  append_arrays(mesh.point_arrays, part.point_arrays);
  append_arrays(mesh.cell_arrays, part.cell_arrays);
  mesh.points.insert(mesh.points.end(), part.points.begin(), part.points.end());
  const std::size_t corners = mesh.connectivity.size();
  for (const std::uint32_t point : part.connectivity)
    mesh.connectivity.push_back(point < part.points.size() ? std::uint32_t(point + shift) : RawMesh::no_point);
  for (std::size_t i = 1; i < part.offsets.size(); ++i) mesh.offsets.push_back(corners + part.offsets[i]);
}

}  // namespace nacre
