// Nacre: time steps in several files, or in the arrays of one file.
#include "engine/io/file_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/io/build_surface.hpp"
#include "engine/io/same_points.hpp"

namespace nacre {
namespace {

std::string name_of(const FileStep& step) { return step.parts.front().string(); }

double size_of(const std::vector<Vec3d>& points) {
  Vec3d lower(1e300), upper(-1e300);
  for (const Vec3d& p : points)
    if (is_finite(p)) lower = min(lower, p), upper = max(upper, p);
  return length(upper - lower);
}

}  // namespace

FileSeries::FileSeries(FileSteps files) : files_(std::move(files)), warnings_(files_.warnings) {
  RawMesh mesh = read_step(files_.steps[0], files_.patches);
  file_points_ = mesh.points;
  file_offsets_ = mesh.offsets;
  file_corners_ = mesh.connectivity;
  first_ = build_surface(std::move(mesh), name_of(files_.steps[0]), warnings_);
  if (files_.steps.size() > 1) {
    probe_later_steps();
    return;
  }
  families_ = find_array_families(first_.arrays);
  warnings_.insert(warnings_.end(), families_.warnings.begin(), families_.warnings.end());
  if (!families_.times.empty()) select_step(first_, families_, 0);
}

std::vector<double> FileSeries::times() const {
  if (!families_.times.empty()) return families_.times;
  std::vector<double> times;
  for (const FileStep& step : files_.steps) times.push_back(step.time);
  return times;
}

Surface FileSeries::load(std::size_t k) const {
  assert(k < times().size());
  if (k == 0) return first_;
  bool moved = false;
  if (families_.times.empty()) {
    Surface surface = load_file(k, moved);
    if (moved && !moves_)
      throw Error(name_of(files_.steps[k]) + " does not fit the first step",
                  "its points or triangles differ from those of " + name_of(files_.steps[0]) +
                      ", which those of other steps do not",
                  "check whether it belongs to the series");
    return surface;
  }
  Surface surface = load_file(0, moved);
  select_step(surface, families_, k);
  return surface;
}

bool FileSeries::has_first_polygons(const RawMesh& mesh) const {
  return mesh.points.size() == file_points_.size() && mesh.offsets == file_offsets_ &&
         mesh.connectivity == file_corners_;
}

Surface FileSeries::load_file(std::size_t k, bool& moved) const {
  const FileStep& step = files_.steps[k];
  RawMesh mesh = read_step(step, files_.patches);
  std::vector<std::string> warnings;
  if (!has_first_polygons(mesh)) {
    moved = true;
    if (mesh.polygons() == 0) return {};  // for those who look at the motion: it vanishes
    return build_surface(std::move(mesh), name_of(step), warnings);
  }
  moved = differ(file_points_, mesh.points, size_of(file_points_));
  // With the points of the first step, the polygons are also triangulated as in the first step.
  const std::vector<Vec3d> points = std::exchange(mesh.points, file_points_);
  return build_surface(std::move(mesh), name_of(step), warnings, moved ? &points : nullptr);
}

/// A cycle may end where it began, so the last step alone would not show that a surface moves.
void FileSeries::probe_later_steps() {
  const std::size_t last = files_.steps.size() - 1;
  for (const std::size_t k : {std::size_t(1), last, (last + 1) / 2})
    if (!moves_) load_file(k, moves_);
}

}  // namespace nacre
