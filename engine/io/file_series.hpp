// Nacre: a surface over time, with its steps in files.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/io/array_families.hpp"
#include "engine/io/file_steps.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Reads steps on demand. A step with the polygons of the first one, which it keeps, is triangulated like that one.
class FileSeries {
 public:
  /// Reads the first step. If there is only one, its array families become the time steps. Throws Error.
  explicit FileSeries(FileSteps files);

  std::vector<double> times() const;
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Points or triangles of some step differ from those of the first: of the second, a middle or the last one.
  bool moves() const { return moves_; }

  /// Step k, 0 <= k < times().size(). Throws Error if the series does not move, but this step does not fit the first.
  Surface load(std::size_t k) const;

 private:
  Surface load_file(std::size_t k, bool& moved) const;
  bool has_first_polygons(const RawMesh& mesh) const;
  void probe_later_steps();

  FileSteps files_;
  ArrayFamilies families_;
  bool moves_ = false;
  // Of the first step as in the file, including points that no triangle uses.
  std::vector<Vec3d> file_points_;
  std::vector<std::size_t> file_offsets_;
  std::vector<std::uint32_t> file_corners_;
  Surface first_;
  std::vector<std::string> warnings_;
};

}  // namespace nacre
