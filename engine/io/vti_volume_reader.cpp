// Nacre: reads the scalars of a .vti as a volume, in the type of the file.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "engine/io/file_bytes.hpp"
#include "engine/io/volume_geometry.hpp"
#include "engine/io/volume_readers.hpp"
#include "engine/io/vtk_image.hpp"
#include "engine/io/vtk_xml.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

/// A <DataArray>, and whether its values belong to cells.
struct Choice {
  pugi::xml_node array;
  bool on_cells = false;
};

/// Arrays with one component; those that the file marks as its scalars come first.
std::vector<pugi::xml_node> scalar_arrays(const VtkXmlFile& file, pugi::xml_node parent) {
  std::vector<pugi::xml_node> arrays;
  const std::string_view marked = parent.attribute("Scalars").value();
  for (const pugi::xml_node array : parent.children("DataArray")) {
    const std::string_view name = array.attribute("Name").value();
    if (file.components_of(array) != 1 || name == "vtkGhostType" || name == "vtkValidPointMask") continue;
    arrays.insert(name == marked && !marked.empty() ? arrays.begin() : arrays.end(), array);
  }
  return arrays;
}

Choice choose(const VtkXmlFile& file, Volume& volume) {
  const pugi::xml_node piece = file.dataset().child("Piece");
  const auto on_points = scalar_arrays(file, piece.child("PointData"));
  const auto on_cells = scalar_arrays(file, piece.child("CellData"));
  std::vector<std::string> others;
  Choice choice;
  for (const auto* arrays : {&on_points, &on_cells})
    for (const pugi::xml_node array : *arrays)
      if (!choice.array)
        choice = {array, arrays == &on_cells};
      else
        others.push_back(array.attribute("Name").value());
  if (!choice.array) fail_reading(file.path(), "it has no array with one value per voxel", "check what it holds");
  if (!others.empty())
    volume.warnings.push_back(fmt::format("Its array {} is used, and {} ignored.",
                                          choice.array.attribute("Name").value(), fmt::join(others, ", ")));
  return choice;
}

template <class T, class Read>
void take_values(Volume& volume, const VtkXmlFile& file, pugi::xml_node array) {
  const std::vector<Read> read = file.numbers<Read>(array);
  if (read.size() < volume.voxels())
    fail_reading(file.path(), fmt::format("array '{}' has {} entries, {} are needed", array.attribute("Name").value(),
                                          read.size(), volume.voxels()));
  if (read.size() > volume.voxels()) file.warn_of_more(array.attribute("Name").value(), read.size(), volume.voxels());
  if (std::is_same_v<Read, std::int64_t> && std::string_view(array.attribute("type").value()) == "UInt64" &&
      std::any_of(read.begin(), read.end(), [](Read value) { return value < 0; }))
    fail_reading(file.path(), fmt::format("array '{}' has values of 2^63 and above", array.attribute("Name").value()),
                 "number its labels with smaller numbers");
  volume.values = std::vector<T>(read.begin(), read.begin() + std::ptrdiff_t(volume.voxels()));
}

void take_values(Volume& volume, const VtkXmlFile& file, pugi::xml_node array) {
  const std::string_view type = array.attribute("type").value();
  // Through float or double, whichever represents the type exactly.
  if (type == "UInt8") return take_values<std::uint8_t, float>(volume, file, array);
  if (type == "Int8") return take_values<std::int8_t, float>(volume, file, array);
  if (type == "UInt16") return take_values<std::uint16_t, float>(volume, file, array);
  if (type == "Int16") return take_values<std::int16_t, float>(volume, file, array);
  if (type == "UInt32") return take_values<std::uint32_t, std::int64_t>(volume, file, array);
  if (type == "Int32") return take_values<std::int32_t, std::int64_t>(volume, file, array);
  if (type == "UInt64" || type == "Int64") return take_values<std::int64_t, std::int64_t>(volume, file, array);
  if (type == "Float32") return take_values<float, float>(volume, file, array);
  if (type == "Float64") return take_values<double, double>(volume, file, array);
  fail_reading(file.path(), fmt::format("array '{}' has the unknown type '{}'", array.attribute("Name").value(), type));
}

}  // namespace

Volume read_vti(const fs::path& path) {
  const VtkXmlFile file(read_file(path), path);
  const VtkImage grid = read_vtk_grid(file);
  Volume volume;
  const Choice choice = choose(file, volume);
  std::array<std::int64_t, 3> dims{};
  std::array<Vec3d, 3> steps;
  volume.origin = grid.origin;
  for (int axis = 0; axis < 3; ++axis) {
    dims[axis] = grid.dimensions[axis] - (choice.on_cells ? 1 : 0);
    for (int row = 0; row < 3; ++row) steps[axis][row] = grid.direction[3 * row + axis] * grid.spacing[axis];
    if (choice.on_cells) volume.origin += 0.5 * steps[axis];
  }
  if (!file.dataset().attribute("Spacing")) volume.warnings.push_back("The file gives no spacing; 1 is assumed.");
  set_dims(volume, dims, 1, path);
  if (!is_finite(volume.origin)) fail_reading(path, "its origin is not a number", "correct its header");
  set_steps(volume, steps, path);
  take_values(volume, file, choice.array);
  volume.warnings.insert(volume.warnings.end(), file.warnings().begin(), file.warnings().end());
  return volume;
}

}  // namespace nacre
