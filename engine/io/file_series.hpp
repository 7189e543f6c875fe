// Nacre: a surface over time, with its steps in files.
#pragma once

#include <string>
#include <vector>

#include "engine/io/array_families.hpp"
#include "engine/io/file_steps.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Reads steps on demand, and checks that they have the points and triangles of the first step, which it keeps.
class FileSeries {
 public:
  /// Reads the first step. If there is only one, its array families become the time steps. Throws Error.
  explicit FileSeries(FileSteps files);

  std::vector<double> times() const;
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Step k, 0 <= k < times().size(). Throws Error if its points or triangles are not those of the first step.
  Surface load(std::size_t k) const;

 private:
  Surface load_file(std::size_t k, bool& moved) const;
  void probe_later_steps();

  FileSteps files_;
  ArrayFamilies families_;
  std::vector<Vec3d> file_points_;  // of the first step as in the file, including points that no triangle uses
  Surface first_;
  std::vector<std::string> warnings_;
};

}  // namespace nacre
