// Nacre: the volume of DICOM files, and the file through which the parent gets it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace nacre::dicom_import {

using Vec = std::array<double, 3>;

inline Vec operator-(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec operator*(const Vec& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Where slices lie: as DICOM says, in mm, x to the left, y to the back, z up (LPS).
struct SliceGeometry {
  std::array<std::size_t, 2> size{};    ///< columns, rows
  std::array<double, 2> spacing{1, 1};  ///< of voxels along a row, along a column
  Vec row{1, 0, 0}, column{0, 1, 0};    ///< unit vectors

  Vec normal() const { return cross(row, column); }
};

/// Throws std::runtime_error unless size, spacing and directions make sense.
void check(const SliceGeometry& slices);

/// Places of slices along their normal, evenly spaced.
struct SliceStack {
  std::vector<std::size_t> slot;  ///< of each given slice, from 0
  std::size_t count = 0;
  double spacing = 1;
  Vec origin{};  ///< of slot 0
};

/// Puts slices whose first voxels are at `origins` in order. Slots between them may be empty only if `gaps`.
/// `thickness`: the spacing of a single one. Throws std::runtime_error if slices are unevenly spaced, moved against
/// each other across the normal, or (unless `repeated`) two at one place.
SliceStack stack_slices(const SliceGeometry& slices, const std::vector<Vec>& origins, double thickness, bool gaps,
                        bool repeated);

struct Segment {
  std::string name;
  std::int64_t label = 0;
  std::size_t layer = 0;
};

/// A NRRD, with the layers of a segmentation, if there are several, as 3D Slicer writes them.
struct VolumeFile {
  SliceGeometry slices;
  SliceStack stack;
  std::string type;  ///< as NRRD calls it: "short"
  std::size_t bytes_per_voxel = 1, layers = 1;
  std::vector<char> values;  ///< layer fastest, then columns, rows, slices
  std::vector<Segment> segments;
};

/// Throws std::runtime_error if it cannot be written.
void write(const VolumeFile& volume, const std::filesystem::path& file);

/// rows * columns * slices * bytes; throws std::runtime_error where that is more than memory can hold.
std::size_t checked_size(const SliceGeometry& slices, std::size_t count, std::size_t bytes);

}  // namespace nacre::dicom_import
