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
  std::vector<std::string> extensions;  ///< lower case, without the dot; if `gzip`, each also followed by .gz
  bool gzip = false;
  bool (*available)() = nullptr;  ///< of a format that a child process reads: whether there is one
  Volume (*read)(const std::filesystem::path& path) = nullptr;
  Volume (*read_layer)(const std::filesystem::path& path, int layer) = nullptr;  ///< if the format has layers
  /// Leaves values in the file where they lie there as they are; null where a format cannot.
  Volume (*map)(const std::filesystem::path& path) = nullptr;
};

/// The layer of a segmentation that means all of them: where they overlap, the later segment counts.
inline constexpr int all_layers = -1;

/// What a user says about a volume's file.
struct VolumeChoice {
  int layer = all_layers;       ///< of a segmentation whose segments overlap, or of another 4-D NRRD; from 0
  std::filesystem::path names;  ///< a file as read_label_names reads it; its names go before those in the volume's file
  /// Values that lie in the file as they are need not be read at once, if there are many. The file must not change as
  /// long as the volume lives.
  bool mapped = false;
};

/// All of these formats.
const std::vector<VolumeFormat>& volume_formats();

/// The format of volumes for this file, or nullptr. By extension; a legacy .vtk file only if its header says
/// STRUCTURED_POINTS, a .vtkhdf if it holds an image. Folders with DICOM files, and such files whatever they are
/// called, count by their content.
const VolumeFormat* find_volume_format(const std::filesystem::path& path);

/// Whether `read_volume` reads this file. Files of VTK and those of unknown extensions are opened to find out.
bool is_volume_file(const std::filesystem::path& path);

/// Reads one volume. Throws Error if the file is missing, of unknown format, damaged, truncated, not a volume (2-D, or
/// 4-D with more than one entry), without one value per voxel, sheared, with a spacing that is zero or not a number, or
/// larger than memory; Interrupted if the child process was stopped by Ctrl-C. Error
/// also if the file has no such layer, or the names cannot be read.
Volume read_volume(const std::filesystem::path& path, const VolumeChoice& choice = {});

/// Gives the labels of `volume` the names in this file, as `read_volume` does; nothing if `names` is empty.
void add_label_names(Volume& volume, const std::filesystem::path& names);

/// Extensions that can be opened, lower case, with dot.
std::vector<std::string> volume_extensions();

}  // namespace nacre
