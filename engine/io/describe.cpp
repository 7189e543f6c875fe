// Nacre: describes the contents of a file, for `nacre info`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "compute/device/error.hpp"
#include "engine/io/array_families.hpp"
#include "engine/io/build_surface.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/file_steps.hpp"
#include "engine/io/reader.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/io/vtk_image.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

ArrayInfo info_of(const RawArray& array, const char* on) {
  ArrayInfo info{array.name,
                 array.components,
                 on,
                 std::numeric_limits<double>::infinity(),
                 -std::numeric_limits<double>::infinity(),
                 array.items()};
  for (std::size_t i = 0; i < array.items(); ++i) {
    double value = array.values[i * array.components];
    if (array.components > 1) {
      double squares = 0;
      for (int c = 0; c < array.components; ++c) squares += std::pow(array.values[i * array.components + c], 2.0);
      value = std::sqrt(squares);
    }
    if (std::isnan(value)) continue;
    info.min = std::min(info.min, value);
    info.max = std::max(info.max, value);
  }
  if (info.min > info.max) info.min = info.max = 0;
  return info;
}

void add_arrays(FileInfo& info, const std::vector<RawArray>& arrays, const char* on) {
  for (const RawArray& array : arrays) info.arrays.push_back(info_of(array, on));
}

std::string kind_of(const RawMesh& mesh) {
  if (mesh.polygons() > 0) return "surface";
  if (mesh.lines > 0) return "lines";
  return mesh.points.empty() ? "unknown-empty" : "points";
}

void add_box(FileInfo& info, const std::vector<Vec3d>& points) {
  bool first = true;
  for (const Vec3d& p : points) {
    if (!is_finite(p)) continue;
    info.lower = first ? p : min(info.lower, p);
    info.upper = first ? p : max(info.upper, p);
    first = false;
  }
}

void add_mesh(FileInfo& info, RawMesh mesh) {
  info.kind = kind_of(mesh);
  info.points = mesh.points.size();
  info.polygons = mesh.polygons();
  add_box(info, mesh.points);
  add_arrays(info, mesh.point_arrays, "points");
  add_arrays(info, mesh.cell_arrays, "cells");
  add_arrays(info, mesh.field_arrays, "field");
  if (mesh.time) info.times = {*mesh.time};
  if (mesh.volume_cells > 0)
    info.warnings.push_back(fmt::format("{}: the outer surface of its {} volume cells is used.", info.path,
                                        with_commas(mesh.volume_cells)));
  if (info.kind != "surface") return;
  try {
    const Surface surface = build_surface(std::move(mesh), info.path, info.warnings);
    info.triangles = surface.triangles.size();
    const ArrayFamilies families = find_array_families(surface.arrays);
    info.warnings.insert(info.warnings.end(), families.warnings.begin(), families.warnings.end());
    if (families.times.empty()) return;
    info.times = families.times;
    info.kind = "series";
  } catch (const Error& error) {
    info.warnings.push_back(std::string(error.what()) + ".");
  }
}

void add_image(FileInfo& info, const VtkImage& image) {
  info.format = "VTK image";
  info.kind = "volume";
  info.points = image.points();
  std::vector<Vec3d> corners;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d p = image.origin;
    for (int row = 0; row < 3; ++row)
      for (int axis = 0; axis < 3; ++axis)
        if (corner >> axis & 1)
          p[row] += image.direction[3 * row + axis] * image.spacing[axis] * (image.dimensions[axis] - 1);
    corners.push_back(p);
  }
  add_box(info, corners);
  add_arrays(info, image.point_arrays, "points");
  add_arrays(info, image.cell_arrays, "cells");
}

void add_volume(FileInfo& info, const Volume& volume, const std::string& format) {
  info.format = format;
  info.kind = "volume";
  info.points = volume.voxels();
  info.warnings.insert(info.warnings.end(), volume.warnings.begin(), volume.warnings.end());
  std::vector<Vec3d> corners;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d p = volume.origin;
    for (int axis = 0; axis < 3; ++axis)
      if (corner >> axis & 1) p += volume.axes[axis] * (volume.spacing[axis] * (volume.dims[axis] - 1));
    corners.push_back(p);
  }
  add_box(info, corners);
  info.volume = {volume.dims,
                 volume.spacing,
                 volume.origin,
                 volume.axes,
                 volume.right_handed(),
                 volume.space,
                 value_type_name(volume.values),
                 volume_statistics(volume),
                 {},
                 volume.label_names};
  if (auto labels = count_labels(volume, most_labels)) info.volume->labels = std::move(*labels);
}

/// A file that lists or contains several steps: describes the first one, and the times of all.
void add_steps(FileInfo& info, const FileSteps& files) {
  add_mesh(info, read_step(files.steps[0], files.patches));
  info.parts = files.parts;
  if (files.steps.size() > 1) info.kind = "series";
  info.times.clear();
  for (const FileStep& step : files.steps) info.times.push_back(step.time);
}

bool is_vtk_image(const std::string& bytes) {
  const std::string_view head = std::string_view(bytes).substr(0, 4096);
  return head.find("<VTKFile") != head.npos && head.find("type=\"ImageData\"") != head.npos;
}

/// Describes a volume, if the file contains one. Of a .vti all arrays are listed, even if none has one value per voxel.
bool add_volume_file(FileInfo& info, const fs::path& path, const VolumeChoice& choice) {
  const VolumeFormat* format = find_volume_format(path);
  if (!format) return false;
  if (format_extension(path) != "vti") {
    add_volume(info, read_volume(path, choice), format->name);
    return true;
  }
  add_image(info, read_vtk_image(read_file(path), path));
  try {
    add_volume(info, read_volume(path, choice), format->name);
  } catch (const Error& error) {
    info.warnings.push_back(std::string(error.what()) + ".");
  }
  return true;
}

void add_content(FileInfo& info, const fs::path& path, const VolumeChoice& choice, const std::string& patches) {
  if (add_volume_file(info, path, choice)) return;
  if (is_file_list(path) || goes_through_vtk(path)) {
    info.format = format_extension(path) == "pvd" ? "VTK XML" : is_file_list(path) ? "list of files" : "VTK";
    add_steps(info, find_steps(path, patches));
    return;
  }
  std::string bytes = read_file(path);
  if (is_vtk_image(bytes)) {
    add_image(info, read_vtk_image(std::move(bytes), path));
    return;
  }
  RawFile file = read_raw(std::move(bytes), path);
  info.format = file.format->name;
  add_mesh(info, std::move(file.mesh));
}

/// Of a file, or of all in a folder.
std::uint64_t bytes_of(const fs::path& path) {
  std::error_code code;
  if (!fs::is_directory(path, code)) return fs::file_size(path, code);
  std::uint64_t bytes = 0;
  for (fs::recursive_directory_iterator it(path, fs::directory_options::skip_permission_denied, code), end;
       !code && it != end; it.increment(code))
    if (std::error_code gone; it->is_regular_file(gone))
      if (const std::uintmax_t of_file = it->file_size(gone); !gone) bytes += of_file;
  return bytes;
}

}  // namespace

FileInfo describe(const fs::path& path, const VolumeChoice& choice, const std::string& patches) {
  const VolumeFormat* format = find_volume_format(path);
  if (!format || format->name != "DICOM") require_file(path);
  FileInfo info;
  info.path = path.string();
  info.bytes = bytes_of(path);
  try {
    add_content(info, path, choice, patches);
  } catch (const std::bad_alloc&) {
    fail_reading(path, "it does not fit in memory", "open a smaller file");
  }
  return info;
}

}  // namespace nacre
