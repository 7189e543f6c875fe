// Nacre: surfaces from files: open one, or look at what is in it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/scene/surface/surface.hpp"
#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// An array as the file has it, before anything is moved or dropped.
struct ArrayInfo {
  std::string name;
  int components = 1;
  std::string on;           ///< "points", "cells" or "field"
  double min = 0, max = 0;  ///< of the magnitude where there are several components; NaN is ignored; 0 if all are NaN
  std::size_t count = 0;    ///< items: values / components
};

/// A volume in a file.
struct VolumeInfo {
  Int3 dims{};
  Vec3d spacing, origin;
  std::array<Vec3d, 3> axes{};
  bool right_handed = true;
  std::string space;  ///< what the world's axes point to; empty where the file does not say
  std::string type;   ///< "uint8", ..., "float", "double"
  VolumeStatistics statistics;
  std::vector<LabelCount> labels;  ///< its different values, if they are integral and at most `most_labels`
  LabelNames label_names;          ///< where the file has any
};
inline constexpr std::size_t most_labels = 65535;

/// What is in a file.
struct FileInfo {
  std::string path;
  std::string format;         ///< "OBJ", "PLY", "STL", "OFF", "VTK XML", "VTK", or as in `volume_formats`
  std::string kind;           ///< "surface", "volume", "points", "lines", "series" or "unknown-empty"
  std::uint64_t bytes = 0;    ///< of the file itself
  std::size_t points = 0;     ///< in the file (of a series: in its first step)
  std::size_t triangles = 0;  ///< that can be used, after triangulation
  std::size_t polygons = 0;   ///< in the file; of volume cells the outer faces
  Vec3d lower, upper;         ///< box around the finite points, in the file's unit
  std::vector<double> times;  ///< one per step; empty if there is no time
  std::vector<ArrayInfo> arrays;
  std::optional<VolumeInfo> volume;   ///< where it is one that `read_volume` reads
  std::vector<std::string> warnings;  ///< full sentences
};

/// Opens one file, a .pvd, or several files of one series in the order given (in the order of their own TimeValue where
/// all have one). The first step is read at once, and two more to see whether the surface moves; the others are read
/// when asked for. A surface that moves keeps the points of its first step, with a warning.
/// Throws Error if a file is missing, unreadable, no surface, or has other points or triangles than the first step.
SurfaceSeries open_surface(const std::vector<std::filesystem::path>& paths);

/// Says what is in a file, also where it is no surface. Throws Error if it cannot be read.
FileInfo describe(const std::filesystem::path& path);

/// Extensions that can be opened, lower case, with dot.
std::vector<std::string> readable_extensions();

}  // namespace nacre
