// Nacre: time steps in several files, or in the arrays of one file.
#include "engine/io/file_series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "compute/device/error.hpp"
#include "engine/io/build_surface.hpp"

namespace nacre {
namespace {

// Fraction of the surface's size below which a difference between two steps is rounding, not motion.
constexpr double rounding = 1e-6;

std::string name_of(const FileStep& step) { return step.parts.front().string(); }

double size_of(const std::vector<Vec3d>& points) {
  Vec3d lower(1e300), upper(-1e300);
  for (const Vec3d& p : points)
    if (is_finite(p)) lower = min(lower, p), upper = max(upper, p);
  return length(upper - lower);
}

bool differ(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  const double tolerance = rounding * size_of(a);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(a[i] == b[i]) && is_finite(a[i]) && !(length(a[i] - b[i]) <= tolerance)) return true;
  return false;
}

}  // namespace

FileSeries::FileSeries(FileSteps files) : files_(std::move(files)), warnings_(files_.warnings) {
  RawMesh mesh = read_step(files_.steps[0], files_.patches);
  file_points_ = mesh.points;
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
  if (families_.times.empty()) return load_file(k, moved);
  Surface surface = load_file(0, moved);
  select_step(surface, families_, k);
  return surface;
}

Surface FileSeries::load_file(std::size_t k, bool& moved) const {
  const FileStep& step = files_.steps[k];
  RawMesh mesh = read_step(step, files_.patches);
  const auto fail = [&](const char* what, std::size_t here, std::size_t first) {
    throw Error(
        name_of(step) + " does not fit the first step",
        fmt::format("it has {} {}, {} has {}", with_commas(here), what, name_of(files_.steps[0]), with_commas(first)),
        "all steps need the same points and triangles");
  };
  if (mesh.points.size() != file_points_.size()) fail("points", mesh.points.size(), file_points_.size());
  moved = differ(file_points_, mesh.points);
  // With the points of the first step, the polygons are also triangulated as in the first step.
  mesh.points = file_points_;
  std::vector<std::string> warnings;
  Surface surface = build_surface(std::move(mesh), name_of(step), warnings);
  if (surface.triangles.size() != first_.triangles.size())
    fail("usable triangles", surface.triangles.size(), first_.triangles.size());
  if (surface.triangles != first_.triangles)
    throw Error(name_of(step) + " does not fit the first step",
                fmt::format("its {} triangles join other points than those of {}",
                            with_commas(surface.triangles.size()), name_of(files_.steps[0])),
                "all steps need the same points and triangles");
  return surface;
}

void FileSeries::probe_later_steps() {
  // A cycle may end where it began, so the last step alone would not show that a surface moves.
  bool moves = false;
  const std::size_t last = files_.steps.size() - 1;
  load_file(1, moves);
  if (!moves && last > 1) load_file(last, moves);
  if (moves) warnings_.push_back("The surface moves between the steps; it is shown in the shape of the first step.");
}

}  // namespace nacre
