// Nacre: reads formats that only VTK knows, in a child process.
#pragma once

#include <filesystem>
#include <string>

#include "engine/io/import_child.hpp"

namespace nacre {

/// Whether `nacre-vtk-import` exists: beside this program, or where the environment variable NACRE_VTK_IMPORT says.
bool vtk_child_available();

/// Whether `convert_with_vtk` reads this format. `extension` in lower case, with dot (".vtk").
bool vtk_child_reads(const std::string& extension);

/// A file as VTK read it: its surface, triangulated, one .vtp per time step; or its image as one .vti.
using VtkConversion = ImportResult;

/// Converts `file` in a child process, since VTK ends the whole process on some broken files. `parts`: names of patches
/// or blocks, separated by commas, with * and ? for any letters; empty: all (of an OpenFOAM case, all patches). Throws
/// as `import_by_child`, and if no part has such a name.
VtkConversion convert_with_vtk(const std::filesystem::path& file, const std::string& parts = {});

/// The same for the image in an SLC, VTKHDF or legacy .vtk file: one .vti, its values in the type of the file.
VtkConversion convert_volume_with_vtk(const std::filesystem::path& file);

}  // namespace nacre
