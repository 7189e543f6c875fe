// Nacre: surfaces from files: opens one, or describes its contents.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/volume_reader.hpp"
#include "engine/scene/surface/surface.hpp"
#include "engine/scene/surface/surface_share.hpp"
#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// An array as the file has it, before anything is moved or dropped.
struct ArrayInfo {
  std::string name;
  int components = 1;
  std::string on;           ///< "points", "cells" or "field"
  double min = 0, max = 0;  ///< of the magnitude if there are several components; NaN is ignored; 0 if all are NaN
  std::size_t count = 0;    ///< items: values / components
};

/// A volume in a file.
struct VolumeInfo {
  Int3 dims{};
  Vec3d spacing, origin;
  std::array<Vec3d, 3> axes{};
  bool right_handed = true;
  std::string space;  ///< directions of the world's axes; empty if the file does not give them
  std::string type;   ///< "uint8", ..., "float", "double"
  VolumeStatistics statistics;
  std::vector<LabelCount> labels;  ///< its different values, if they are integral and at most `most_labels`
  LabelNames label_names;          ///< if the file has any
};
inline constexpr std::size_t most_labels = 65535;

/// The contents of a file.
struct FileInfo {
  std::string path;
  std::string format;         ///< "OBJ", "PLY", "STL", "OFF", "VTK XML", "VTK", or as in `volume_formats`
  std::string kind;           ///< "surface", "volume", "points", "lines", "series" or "unknown-empty"
  std::uint64_t bytes = 0;    ///< of the file itself, or of all in the folder
  std::size_t points = 0;     ///< in the file (in the first step of a series)
  std::size_t triangles = 0;  ///< usable ones, after triangulation
  std::size_t polygons = 0;   ///< in the file; the outer faces of volume cells
  Vec3d lower, upper;         ///< box around the finite points, in the unit of the file
  std::vector<double> times;  ///< one per step; empty if there is no time
  std::vector<ArrayInfo> arrays;
  std::optional<VolumeInfo> volume;   ///< if `read_volume` reads it as one
  std::vector<std::string> parts;     ///< names of its patches or blocks, if it goes through VTK
  std::vector<std::string> warnings;  ///< full sentences
};

/// Opens one file, a .pvd or .series, or several files of one series in the given order (in the order of their own
/// TimeValue if all have one). The first step is read at once, and three more to see whether the surface moves; the
/// others are read on demand. Throws Error if a file is missing, unreadable or not a surface. `patches`: names of the
/// parts to take of a file that VTK reads, as `convert_with_vtk` takes them; empty: all.
SurfaceSeries open_surface(const std::vector<std::filesystem::path>& paths, const std::string& patches = {});

/// The same in shares of several processes, which read the pieces of a step as far as their shares lie in them.
/// Collective.
SharedSeries open_surface(const std::vector<std::filesystem::path>& paths, const std::string& patches, Ranks& ranks);

/// Describes the contents of a file, even if it is not a surface; `choice` for volumes, `patches` for surfaces. Throws
/// Error if it cannot be read.
FileInfo describe(const std::filesystem::path& path, const VolumeChoice& choice = {}, const std::string& patches = {});

/// Extensions that can be opened, lower case, with dot.
std::vector<std::string> readable_extensions();

}  // namespace nacre
