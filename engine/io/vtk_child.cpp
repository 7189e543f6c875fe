// Nacre: reads formats that only VTK knows, in a child process.
#include "engine/io/vtk_child.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace nacre {
namespace {

constexpr Importer vtk{"nacre-vtk-import", "NACRE_VTK_IMPORT", "VTK", "ParaView"};

}  // namespace

bool vtk_child_available() { return is_available(vtk); }

bool vtk_child_reads(const std::string& extension) {
  static constexpr std::array<std::string_view, 15> extensions = {".vtk",  ".vts",  ".vtr",  ".vtm",   ".vtmb",
                                                                  ".pvts", ".pvtr", ".case", ".encas", ".ex2",
                                                                  ".exo",  ".e",    ".g",    ".foam",  ".vtkhdf"};
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

VtkConversion convert_with_vtk(const std::filesystem::path& file, const std::string& parts) {
  std::vector<std::string> options;
  if (!parts.empty()) options = {"--parts", parts};
  return import_by_child(vtk, {file, options, "surface", ".vtp or .vtu"});
}

VtkConversion convert_volume_with_vtk(const std::filesystem::path& file) {
  return import_by_child(vtk, {file, {"--volume"}, "volume", ".vti or .nrrd"});
}

}  // namespace nacre
