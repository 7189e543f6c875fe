// Nacre: reads formats that only VTK knows, in a child process.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace nacre {

/// Whether `nacre-vtk-import` exists: beside this program, or where the environment variable NACRE_VTK_IMPORT says.
bool vtk_child_available();

/// Whether `convert_with_vtk` reads this format. `extension` in lower case, with dot (".vtk").
bool vtk_child_reads(const std::string& extension);

/// A file as VTK read it: its surface, triangulated, one .vtp per time step; or its image as one .vti.
struct VtkConversion {
  std::shared_ptr<const std::filesystem::path> folder;  ///< removed with the last copy
  std::vector<std::filesystem::path> files;             ///< in `folder`, at least one
  std::vector<double> times;                            ///< one per file, as in the file; 0 if it has none
};

/// Converts `file` in a child process, since VTK ends the whole process on some broken files. Throws Error if VTK
/// reports an error (its first line), crashes, or takes more than 120 s; Interrupted if it was stopped by Ctrl-C.
VtkConversion convert_with_vtk(const std::filesystem::path& file);

/// The same for the image in an SLC or legacy .vtk file: one .vti, its values in the type of the file.
VtkConversion convert_volume_with_vtk(const std::filesystem::path& file);

/// From now on both stop (Interrupted) once `*stop` is true. Without this, they stop only if Ctrl-C reaches the child
/// itself, as from a terminal.
void watch_vtk_child(const std::atomic<bool>* stop);

}  // namespace nacre
