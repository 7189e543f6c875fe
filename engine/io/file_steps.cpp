// Nacre: time steps from a .pvd, from VTK, or from a list of files.
#include "engine/io/file_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "compute/device/error.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/vtk_child.hpp"
#include "engine/io/vtk_xml.hpp"
#include "engine/system/extension.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

bool is_collection(const fs::path& path) { return format_extension(path) == "pvd"; }

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
  for (CollectionStep& step : read_collection(file)) {
    for (const fs::path& part : step.parts) require_part(part, path);
    result.steps.push_back({step.time, std::move(step.parts)});
  }
  return result;
}

FileSteps imported_steps(const fs::path& path) {
  if (!vtk_child_available())
    throw Error(path.string() + " cannot be read",
                "." + format_extension(path) + " files go through VTK, and this program was built without it",
                "build with NACRE_VTK=ON (Debian package libvtk9-dev), or convert the file to .vtp");
  const auto conversion = std::make_shared<const VtkConversion>(convert_with_vtk(path));
  if (conversion->files.empty()) fail_reading(path, "VTK found no surface in it", "check what it holds");
  FileSteps result;
  result.keep_alive = conversion;
  const std::vector<double>& times = conversion->times;
  const bool timed = times.size() == conversion->files.size() &&
                     std::adjacent_find(times.begin(), times.end(), std::greater_equal<>()) == times.end();
  for (std::size_t i = 0; i < conversion->files.size(); ++i)
    result.steps.push_back({timed ? times[i] : double(i), {conversion->files[i]}});
  return result;
}

std::optional<double> own_time(const fs::path& path) {
  const SurfaceFormat* format = find_format(format_extension(path));
  if (!format || format->name != "VTK XML") return {};
  return VtkXmlFile(read_file(path), path).time();
}

}  // namespace

bool goes_through_vtk(const fs::path& path) {
  const std::string extension = format_extension(path);
  return lower_extension(path) != ".gz" && !find_format(extension) && vtk_child_reads("." + extension);
}

FileSteps find_steps(const fs::path& path) {
  if (is_collection(path)) return collection_steps(path);
  if (goes_through_vtk(path)) return imported_steps(path);
  return {{{0.0, {path}}}, {}, nullptr};
}

FileSteps find_steps(const std::vector<fs::path>& paths) {
  if (paths.size() == 1) return find_steps(paths[0]);
  FileSteps result;
  std::size_t timed = 0;
  for (const fs::path& path : paths) {
    if (is_collection(path) || goes_through_vtk(path))
      throw Error(path.string() + " cannot be one of several files", "it may hold several steps itself",
                  "open it alone");
    const std::optional<double> time = own_time(path);
    timed += time.has_value();
    result.steps.push_back({time.value_or(0), {path}});
  }
  const auto earlier = [](const FileStep& a, const FileStep& b) { return a.time < b.time; };
  const auto same = [](const FileStep& a, const FileStep& b) { return a.time == b.time; };
  std::vector<FileStep> sorted = result.steps;
  std::stable_sort(sorted.begin(), sorted.end(), earlier);
  if (timed == paths.size() && std::adjacent_find(sorted.begin(), sorted.end(), same) == sorted.end()) {
    if (!std::is_sorted(result.steps.begin(), result.steps.end(), earlier))
      result.warnings.push_back("The files were put in the order of the times that they hold.");
    result.steps = std::move(sorted);
    return result;
  }
  if (timed > 0)
    result.warnings.push_back("The files do not all hold different times; they are numbered in the order given.");
  for (std::size_t i = 0; i < paths.size(); ++i) result.steps[i].time = double(i);
  return result;
}

RawMesh read_step(const FileStep& step) {
  RawMesh mesh = read_raw(step.parts.front()).mesh;
  for (std::size_t i = 1; i < step.parts.size(); ++i) append(mesh, read_raw(step.parts[i]).mesh);
  return mesh;
}

}  // namespace nacre
