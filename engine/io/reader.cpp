// Nacre: opens the user's input as a series of time steps.
#include "engine/io/reader.hpp"

#include <memory>
#include <new>

#include "compute/device/error.hpp"
#include "engine/io/file_bytes.hpp"
#include "engine/io/file_series.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/vtk_child.hpp"

namespace nacre {

SurfaceSeries open_surface(const std::vector<std::filesystem::path>& paths, const std::string& patches) {
  if (paths.empty()) throw Error("no file to open", "", "name at least one file");
  for (const std::filesystem::path& path : paths) require_file(path);
  try {
    const auto files = std::make_shared<const FileSeries>(find_steps(paths, patches));
    return {paths[0].filename().string(), files->times(), [files](std::size_t k) { return files->load(k); },
            files->warnings(), files->moves()};
  } catch (const std::bad_alloc&) {
    fail_reading(paths[0], "it does not fit in memory", "open a smaller file");
  }
}

std::vector<std::string> readable_extensions() {
  std::vector<std::string> extensions;
  for (const std::string& extension : own_extensions()) extensions.push_back("." + extension);
  extensions.push_back(".series");
  if (!vtk_child_available()) return extensions;
  for (const char* other : {".vtk", ".vts", ".vtr", ".vtm", ".vtmb", ".pvts", ".pvtr", ".case", ".encas", ".ex2",
                            ".exo", ".e", ".g", ".foam", ".vtkhdf"})
    if (vtk_child_reads(other)) extensions.push_back(other);
  return extensions;
}

}  // namespace nacre
