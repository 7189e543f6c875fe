// Nacre: time steps from a .pvd, a .series, from VTK, or from a list of files.
#include "engine/io/file_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "compute/device/error.hpp"
#include "engine/io/build_surface.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/vtk_child.hpp"
#include "engine/io/vtk_xml.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

bool is_pvd(const fs::path& path) { return format_extension(path) == "pvd"; }

void require_part(const fs::path& part, const fs::path& collection) {
  std::error_code code;
  if (!fs::is_regular_file(part, code))
    throw Error(part.string() + " cannot be opened", "there is no such file, but " + collection.string() + " names it",
                "put it there or take it out of the list");
}

FileSteps collection_steps(const fs::path& path) {
  const VtkXmlFile file(read_file(path), path);
  if (file.type() != "Collection") fail_reading(path, fmt::format("it holds {}, not a Collection", file.type()));
  FileSteps result;
  for (CollectionStep& step : read_collection(file, &result.warnings)) {
    for (const fs::path& part : step.parts) require_part(part, path);
    result.steps.push_back({step.time, std::move(step.parts)});
  }
  return result;
}

const char* numbered_instead = "The files do not all hold different times; they are numbered in the order given.";

bool is_earlier(const FileStep& a, const FileStep& b) { return a.time < b.time; }

/// The time of an entry of a .series, or nothing.
std::optional<double> time_of_entry(const nlohmann::json& entry, const fs::path& path) {
  if (!entry.contains("time")) return {};
  if (!entry["time"].is_number() || !std::isfinite(entry["time"].get<double>()))
    fail_reading(path, "the time of an entry is not a number");
  return entry["time"].get<double>();
}

/// ParaView's list of files: {"file-series-version": "1.0", "files": [{"name": "a_0.vtp", "time": 0.5}, ...]}.
FileSteps series_steps(const fs::path& path) {
  const nlohmann::json json = nlohmann::json::parse(read_file(path), nullptr, false);
  if (!json.is_object() || !json.contains("files") || !json["files"].is_array())
    fail_reading(path, "it is not a list of files as ParaView writes it", "check how it was written");
  FileSteps result;
  std::size_t timed = 0;
  for (const nlohmann::json& entry : json["files"]) {
    if (!entry.is_object() || !entry.contains("name") || !entry["name"].is_string())
      fail_reading(path, "an entry names no file");
    const fs::path part = path.parent_path() / entry["name"].get<std::string>();
    if (is_file_list(part)) fail_reading(path, part.filename().string() + " in it is a list itself");
    require_part(part, path);
    const std::optional<double> time = time_of_entry(entry, path);
    timed += time.has_value();
    result.steps.push_back({time.value_or(0), {part}});
  }
  if (result.steps.empty()) fail_reading(path, "it names no files");
  std::vector<FileStep> sorted = result.steps;
  std::stable_sort(sorted.begin(), sorted.end(), is_earlier);
  const bool same = std::adjacent_find(sorted.begin(), sorted.end(), [](const FileStep& a, const FileStep& b) {
                      return a.time == b.time;
                    }) != sorted.end();
  if (timed == sorted.size() && !same) {
    result.steps = std::move(sorted);
    return result;
  }
  if (timed > 0) result.warnings.push_back(numbered_instead);
  for (std::size_t i = 0; i < result.steps.size(); ++i) result.steps[i].time = double(i);
  return result;
}

FileSteps imported_steps(const fs::path& path, const std::string& patches) {
  if (!vtk_child_available())
    throw Error(path.string() + " cannot be read",
                "." + format_extension(path) + " files go through VTK, and this program was built without it",
                "build with NACRE_VTK=ON (Debian package libvtk9-dev), or convert the file to .vtp");
  const auto conversion = std::make_shared<const VtkConversion>(convert_with_vtk(path, patches));
  if (conversion->files.empty()) fail_reading(path, "VTK found no surface in it", "check what it holds");
  FileSteps result;
  result.keep_alive = conversion;
  result.parts = conversion->parts;
  const std::vector<double>& times = conversion->times;
  const bool timed = times.size() == conversion->files.size() &&
                     std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
  for (std::size_t i = 0; i < conversion->files.size(); ++i)
    result.steps.push_back({timed ? times[i] : double(i), {conversion->files[i]}});
  return result;
}

FileSteps one_step(std::vector<fs::path> parts) {
  FileSteps result;
  result.steps.push_back({0.0, std::move(parts)});
  return result;
}

/// Parts can be chosen of what VTK reads.
void require_parts(const FileSteps& files, const fs::path& path, const std::string& patches) {
  if (patches.empty() || !files.parts.empty()) return;
  for (const FileStep& step : files.steps)
    for (const fs::path& part : step.parts)
      if (goes_through_vtk(part)) return;
  throw Error(path.string() + " has no patches that could be chosen", "", "leave --patch out");
}

std::optional<double> own_time(const fs::path& path) {
  const SurfaceFormat* format = find_format(format_extension(path));
  if (!format || format->name != "VTK XML") return {};
  return VtkXmlFile(read_file(path), path).time();
}

}  // namespace

bool is_file_list(const fs::path& path) { return is_pvd(path) || format_extension(path) == "series"; }

bool goes_through_vtk(const fs::path& path) {
  const std::string extension = format_extension(path);
  return lower_extension(path) != ".gz" && !find_format(extension) && vtk_child_reads("." + extension);
}

FileSteps find_steps(const fs::path& path, const std::string& patches) {
  FileSteps result = is_pvd(path)             ? collection_steps(path)
                     : is_file_list(path)     ? series_steps(path)
                     : goes_through_vtk(path) ? imported_steps(path, patches)
                                              : one_step({path});
  require_parts(result, path, patches);
  if (result.parts.empty()) result.patches = patches;  // else they have been chosen
  return result;
}

namespace {

bool may_hold_steps(const fs::path& path) {
  static const std::set<std::string> extensions = {"case", "encas", "ex2", "exo", "e", "g", "foam", "vtkhdf"};
  return extensions.count(format_extension(path)) > 0;
}

/// GIFTI has shapes and vectors in files of their own, beside the surface.
bool is_surface_with_shapes(const std::vector<fs::path>& paths) {
  const bool gifti =
      std::all_of(paths.begin(), paths.end(), [](const fs::path& p) { return format_extension(p) == "gii"; });
  if (!gifti || !read_raw(paths[1]).mesh.points.empty()) return false;
  if (read_raw(paths[0]).mesh.points.empty())
    throw Error(paths[0].string() + " has no points", "", "name the surface first, then what is on it");
  return true;
}

/// The arrays of `part`, which has no points of its own, become arrays on those of `mesh`.
void add_shapes(RawMesh& mesh, RawMesh&& part, const fs::path& file) {
  for (RawArray& array : part.field_arrays) {
    if (array.items() != mesh.points.size())
      throw Error(file.string() + " does not fit the surface",
                  fmt::format("\"{}\" has {} values for {} points", array.name, with_commas(array.items()),
                              with_commas(mesh.points.size())),
                  "name the surface that it was made for");
    mesh.point_arrays.push_back(std::move(array));
  }
}

}  // namespace

FileSteps find_steps(const std::vector<fs::path>& paths, const std::string& patches) {
  if (paths.size() == 1) return find_steps(paths[0], patches);
  if (is_surface_with_shapes(paths)) return one_step(paths);
  FileSteps result;
  std::size_t timed = 0;
  for (const fs::path& path : paths) {
    if (is_file_list(path) || (goes_through_vtk(path) && may_hold_steps(path)))
      throw Error(path.string() + " cannot be one of several files", "it may hold several steps itself",
                  "open it alone");
    const std::optional<double> time = own_time(path);
    timed += time.has_value();
    result.steps.push_back({time.value_or(0), {path}});
  }
  require_parts(result, paths[0], patches);
  result.patches = patches;
  const auto same = [](const FileStep& a, const FileStep& b) { return a.time == b.time; };
  std::vector<FileStep> sorted = result.steps;
  std::stable_sort(sorted.begin(), sorted.end(), is_earlier);
  if (timed == paths.size() && std::adjacent_find(sorted.begin(), sorted.end(), same) == sorted.end()) {
    if (!std::is_sorted(result.steps.begin(), result.steps.end(), is_earlier))
      result.warnings.push_back("The files were put in the order of the times that they hold.");
    result.steps = std::move(sorted);
    return result;
  }
  if (timed > 0) result.warnings.push_back(numbered_instead);
  for (std::size_t i = 0; i < paths.size(); ++i) result.steps[i].time = double(i);
  return result;
}

namespace {

/// A part that only VTK reads may have steps itself; the first is taken.
RawMesh read_part(const fs::path& part, const std::string& patches) {
  if (!goes_through_vtk(part)) return read_raw(part).mesh;
  const FileSteps imported = imported_steps(part, patches);
  return read_raw(imported.steps.front().parts.front()).mesh;
}

}  // namespace

RawMesh read_step(const FileStep& step, const std::string& patches) {
  RawMesh mesh = read_part(step.parts.front(), patches);
  for (std::size_t i = 1; i < step.parts.size(); ++i) {
    RawMesh part = read_part(step.parts[i], patches);
    if (format_extension(step.parts[i]) == "gii" && part.points.empty())
      add_shapes(mesh, std::move(part), step.parts[i]);
    else
      append(mesh, std::move(part));
  }
  return mesh;
}

}  // namespace nacre
