// Nacre: volumes from files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// A format of volumes.
struct VolumeFormat {
  std::string name;                     ///< "NRRD"
  std::vector<std::string> extensions;  ///< lower case, without the dot; each also with .gz behind it where `gzip`
  bool gzip = false;
  bool through_vtk = false;  ///< by way of the child process
  Volume (*read)(const std::filesystem::path& path) = nullptr;
};

/// All of them.
const std::vector<VolumeFormat>& volume_formats();

/// The format of volumes that takes this file, or nullptr. By extension; a legacy .vtk file only where its header says
/// STRUCTURED_POINTS.
const VolumeFormat* find_volume_format(const std::filesystem::path& path);

/// Is this a file for `read_volume`? Nothing but a .vtk file is looked into.
bool is_volume_file(const std::filesystem::path& path);

/// Reads one volume. Throws Error if the file is missing, of no known format, damaged, cut short, no volume (2-D, or
/// 4-D with more than one entry), without one value per voxel, sheared, with a spacing that is zero or no number, or
/// larger than memory; Interrupted if the child process was stopped by Ctrl-C.
Volume read_volume(const std::filesystem::path& path);

/// Extensions that can be opened, lower case, with dot.
std::vector<std::string> volume_extensions();

}  // namespace nacre
