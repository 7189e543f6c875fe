// Nacre: the vectors of a surface that moves: its shape at any time, and what flows on it.
#include <algorithm>
#include <cmath>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/scene/surface/material_map.hpp"
#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// The nearer of two steps counts where these have other triangles.
bool VectorsInTime::enter(double t) {
  if (!moves() || series_.motion->groups < 2) return false;
  const std::vector<double>& times = series_.times;
  t = time_in_period(t);
  auto step = std::size_t(std::lower_bound(times.begin(), times.end(), t) - times.begin());
  if (step == times.size() || (step > 0 && t - times[step - 1] <= times[step] - t)) --step;
  const std::size_t group = series_.motion->group[step];
  if (group == group_) return false;
  enter_group(group);
  return true;
}

void VectorsInTime::enter_group(std::size_t group) {
  const std::vector<std::size_t>& groups = series_.motion->group;
  const auto first = std::size_t(std::lower_bound(groups.begin(), groups.end(), group) - groups.begin());
  PreparedSurface surface = prepare(series_.load(first), motion_.crease_degrees);
  group_ = group;
  begin_group(std::move(surface));
}

void VectorsInTime::rebase(double t) {
  if (!moves()) return;
  base_ = t;
  surface_ = shape(t);
  point_normals_ = point_normals(surface_);
}

std::vector<Vec3d> VectorsInTime::points(double t) {
  if (!moves()) return surface_.points;
  const Between at = around(t);
  const std::vector<Vec3d>& a = step(at.before).points;
  if (at.share == 0) return a;
  const std::vector<Vec3d>& b = step(at.after).points;
  std::vector<Vec3d> points(a.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = a[i] + (b[i] - a[i]) * double(at.share);
  return points;
}

PreparedSurface VectorsInTime::shape(double t) {
  if (!moves()) return surface_;
  PreparedSurface shape{points(t), surface_.triangles, {}, surface_.second_sheet};
  update_normals(shape, same_, motion_.crease_degrees);
  return shape;
}

void VectorsInTime::material_vectors(double t, std::span<Vec3f> out) {
  if (!moves()) return vectors(t, out);
  if (analytic_) {
    const std::vector<Vec3f> values = analytic_vectors(vectors_, began_, t);
    return transfer_vectors(began_.points, surface_.points, surface_.triangles, values, out);
  }
  std::vector<Vec3f> present(out.size());
  vectors(t, present);
  transfer_vectors(points(t), surface_.points, surface_.triangles, present, out);
}

/// The steps before and after, of the same group; round the period where there is one.
std::pair<std::size_t, std::size_t> VectorsInTime::beside(std::size_t step) const {
  std::pair<std::size_t, std::size_t> two{std::max(step, first_ + 1) - 1, std::min(step + 1, last_)};
  if (!(motion_.period > 0) || first_ > 0 || last_ + 1 < series_.steps() || last_ < 2) return two;
  const bool repeats = start_ + motion_.period - series_.times.back() <= 1e-9 * motion_.period;  // the first step
  if (step == 0) two.first = repeats ? last_ - 1 : last_;
  if (step == last_) two.second = repeats ? 1 : 0;
  return two;
}

/// At a step the central difference of the positions, one-sided at the ends; between steps linear, as the vectors are.
/// The difference between two steps alone would be the exact velocity of the shapes that are drawn, but jump at each
/// step, by as much as the vectors do not.
void VectorsInTime::add_surface_velocity(const Between& at, float factor, std::span<Vec3f> out) {
  for (const auto& [number, share] : {std::pair{at.before, 1 - at.share}, std::pair{at.after, at.share}}) {
    if (share == 0) continue;
    if (!motion_.surface_velocity.empty()) {
      const std::vector<Vec3f>& velocity = step(number).surface_velocity;
      for (std::size_t i = 0; i < out.size(); ++i) out[i] += velocity[i] * (factor * share);
      continue;
    }
    const auto [before, after] = beside(number);
    if (!moves() || before == after) continue;
    double time = series_.times[after] - series_.times[before];
    // Round the period, one of the two lies in the cycle before or after.
    if (before > number || after < number) time += motion_.period;
    const std::vector<Vec3d>& a = step(before).points;
    const std::vector<Vec3d>& b = step(after).points;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += Vec3f((b[i] - a[i]) / time) * (factor * share);
  }
}

std::vector<float> VectorsInTime::speeds(const PreparedSurface& shape, std::span<const Vec3f> vectors) const {
  const std::vector<Vec3f> normals = point_normals(shape);
  std::vector<float> speeds(vectors.size());
  for (std::size_t i = 0; i < speeds.size(); ++i)
    speeds[i] = length(vectors[i] - normals[i] * dot(vectors[i], normals[i]));
  return speeds;
}

/// As `survey`, on the shape of each step.
void VectorsInTime::survey_motion(bool vectors_too) {
  const bool scalars = color_ != "none" && color_ != "speed";
  ColourSurvey speed_survey, values;
  VectorStatistics all = statistics_;
  std::size_t seen = 0, points = 0;
  double squares = 0;  // of the surface's own speed
  const std::size_t group_before = group_;
  const PreparedSurface surface_before = surface_, began_before = began_;
  for (std::size_t k = 0; k < series_.steps(); ++k) {
    check_stop(stop_);
    if (series_.motion->group[k] != group_) enter_group(series_.motion->group[k]);
    const double t = series_.times[k];
    const std::size_t n = surface_.points.size(), stride = n * series_.steps() / largest_sample | 1;
    if (scalars) {
      const std::vector<float> numbers = scalar(t);
      for (std::size_t i = 0; i < n; ++i) values.add(numbers[i], i % stride == k % stride);
    }
    if (!vectors_too) continue;
    std::vector<Vec3f> now(n);
    vectors(t, now);
    if (motion_.relative) {
      std::vector<Vec3f> own(n);
      add_surface_velocity(around(t), 1, own);
      for (const Vec3f& w : own) squares += dot(w, w);
      points += n;
    }
    const PreparedSurface present = shape(t);
    const VectorStatistics s = vector_statistics(present, now);
    const std::vector<float> speed = speeds(present, now);
    for (std::size_t i = k % stride; i < n; i += stride) speed_survey.add(speed[i], true);
    if (seen++ == 0) {
      all = s;
      continue;
    }
    all.percentile_98 += s.percentile_98;
    all.max_speed = std::max(all.max_speed, s.max_speed);
    all.zero_share = std::min(all.zero_share, s.zero_share);
  }
  if (group_ != group_before) {
    group_ = group_before;
    begin_group(surface_before);
    began_ = began_before;
  }
  if (scalars) scalars_ = std::move(values).spread();
  if (!vectors_too) return;
  surface_speed_ = points > 0 ? std::sqrt(squares / double(points)) : 0;
  all.percentile_98 = std::max(all.percentile_98 / double(seen), least_relative_speed * surface_speed_);
  statistics_ = all;
  speeds_ = std::move(speed_survey).spread();
  speeds_.low = 0;
  speeds_.high = statistics_.percentile_98 > 0 ? statistics_.percentile_98 : 1;
}

}  // namespace nacre
