// Nacre: vectors and colours of a series at any time.
#include "engine/scene/surface/vectors_in_time.hpp"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/scene/surface/haemodynamics.hpp"
#include "engine/scene/surface/material_map.hpp"
#include "engine/scene/surface/surface_share.hpp"
#include "engine/scene/surface/winding.hpp"

namespace nacre {
namespace {

/// Whether a value is among those that percentiles are taken of. It depends on the position alone, so that all
/// processes agree.
bool is_sampled(const Vec3d& point, std::size_t step, std::size_t stride) {
  return (position_hash(point) + step) % stride == 0;
}

const PointArray& array_of(const Surface& surface, const std::string& name, std::size_t points, std::size_t step) {
  const PointArray* array = surface.find(name);
  if (!array) {
    std::string names;
    for (const PointArray& a : surface.arrays) names += (names.empty() ? "" : ", ") + a.name;
    throw Error("no array '" + name + "' in step " + std::to_string(step),
                names.empty() ? "it has none" : "it has " + names);
  }
  if (array->size() != points) throw Error("array '" + name + "' has another length in step " + std::to_string(step));
  return *array;
}

}  // namespace

std::vector<Vec3f> point_normals(const PreparedSurface& surface) {
  std::vector<Vec3f> normals(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) normals[surface.triangles[t][k]] += surface.corner_normals[3 * t + k];
  for (Vec3f& n : normals) n = normalized(n);
  return normals;
}

bool is_ftle(const std::string& color) {
  return color.size() == 4 && std::equal(color.begin(), color.end(), "ftle", [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) == b;
         });
}

VectorsInTime::VectorsInTime(SurfaceSeries series, PreparedSurface surface, std::string vectors, std::string color,
                             const std::atomic<bool>* stop, MotionChoice motion, std::shared_ptr<const Share> share)
    : series_(std::move(series)),
      start_(series_.times.front()),
      base_(start_),
      steps_(std::size_t(series_.motion ? 4 : 2)),
      motion_(std::move(motion)),
      stop_(stop),
      share_(std::move(share)) {
  check_period();
  begin_group(std::move(surface));
  choose(vectors, color);
  survey();
}

/// The time of the data is not longer than a period.
void VectorsInTime::check_period() const {
  const double length = series_.times.back() - series_.times.front();
  if (motion_.period > 0 && length > motion_.period * (1 + 1e-9))
    throw Error(fmt::format("`period` {:g} is shorter than the time of the data", motion_.period),
                fmt::format("that goes from {:g} to {:g}", series_.times.front(), series_.times.back()),
                fmt::format("use {:g} or more", length));
}

void VectorsInTime::begin_group(PreparedSurface surface) {
  surface_ = std::move(surface);
  point_normals_ = point_normals(surface_);
  first_ = 0;
  last_ = series_.steps() - 1;
  if (!series_.motion) return;
  const std::vector<std::size_t>& group = series_.motion->group;
  first_ = std::size_t(std::lower_bound(group.begin(), group.end(), group_) - group.begin());
  last_ = std::size_t(std::upper_bound(group.begin(), group.end(), group_) - group.begin()) - 1;
  same_ = first_at_position(surface_.points);
  began_ = surface_;
  for (Step& step : steps_) step = {};
}

void VectorsInTime::choose(const std::string& vectors, const std::string& color) {
  vectors_ = vectors;
  color_ = color;
  analytic_ = !vectors_.empty() && vectors_[0] == '@';
  end_ = motion_.period > 0 ? start_ + motion_.period : series_.times.back();
  if (analytic_ && motion_.period == 0 && series_.steps() == 1) end_ = vectors_ == "@swirl" ? start_ + 1 : start_;
  for (Step& step : steps_) step = {};
  if (is_ftle(color_) && !series_.load(0).find(color_)) color_ = "none";
  derived_ = is_haemodynamic(color_) && !series_.load(0).find(color_);
}

void VectorsInTime::set_surface(PreparedSurface surface) {
  PreparedSurface before = surface_;
  const std::size_t group = std::exchange(group_, 0);
  begin_group(std::move(surface));
  try {
    survey();
  } catch (...) {
    group_ = group;
    begin_group(std::move(before));
    throw;
  }
}

void VectorsInTime::set_motion(const MotionChoice& motion) {
  const MotionChoice before = std::exchange(motion_, motion);
  try {
    check_period();
    choose(vectors_, color_);
    survey();
  } catch (...) {
    motion_ = before;
    choose(vectors_, color_);
    throw;
  }
}

void VectorsInTime::set_vectors(const std::string& vectors) {
  const std::string before = vectors_;
  choose(vectors, color_);
  try {
    survey();
  } catch (...) {
    choose(before, color_);
    throw;
  }
}

void VectorsInTime::set_color(const std::string& color) {
  const std::string before = color_;
  choose(vectors_, color);
  try {
    survey(false);
  } catch (...) {
    choose(vectors_, before);
    throw;
  }
}

void VectorsInTime::show_scalar(const std::string& name, std::vector<float> values) {
  color_ = name;
  for (Step& step : steps_) step = {};
  derived_ = true;
  derived_scalar_ = std::move(values);
  ColourSurvey survey;
  const std::size_t stride = derived_scalar_.size() / largest_sample | 1;
  for (std::size_t i = 0; i < derived_scalar_.size(); ++i) survey.add(derived_scalar_[i], i % stride == 0);
  scalars_ = std::move(survey).spread();
}

VectorsInTime::Step VectorsInTime::load(std::size_t number) const {
  Step step;
  step.number = number;
  const std::size_t n = surface_.points.size(), known = share_ ? share_->points : n;
  const bool needs_file = moves() || !analytic_ || colours_by_array();
  const Surface surface = needs_file ? series_.load(number) : Surface{};
  const auto vectors_of = [&](const std::string& name) {
    const PointArray& array = array_of(surface, name, known, number);
    if (array.components != 3) throw Error("array '" + name + "' does not have three components");
    std::vector<Vec3f> vectors(n);
    for (std::size_t i = 0; i < known; ++i)
      vectors[i] = {array.values[3 * i], array.values[3 * i + 1], array.values[3 * i + 2]};
    return vectors;
  };
  if (!analytic_) step.vectors = vectors_of(vectors_);
  if (motion_.relative && !motion_.surface_velocity.empty())
    step.surface_velocity = vectors_of(motion_.surface_velocity);
  if (moves()) step.points = surface.points;
  if (colours_by_array()) {
    const PointArray& array = array_of(surface, color_, known, number);
    step.scalar.resize(n);
    for (std::size_t i = 0; i < known; ++i) {
      double squares = 0;
      for (int k = 0; k < array.components; ++k) squares += std::pow(array.values[i * array.components + k], 2);
      step.scalar[i] = array.components == 1 ? array.values[i] : float(std::sqrt(squares));
    }
  }
  return step;
}

const VectorsInTime::Step& VectorsInTime::step(std::size_t number) {
  for (Step& step : steps_)
    if (step.number == number) {
      step.used = ++uses_;
      return step;
    }
  Step& oldest =
      *std::min_element(steps_.begin(), steps_.end(), [](const Step& a, const Step& b) { return a.used < b.used; });
  oldest = load(number);
  oldest.used = ++uses_;
  return oldest;
}

double VectorsInTime::time_in_period(double t) const {
  if (!(motion_.period > 0)) return t;
  const double since = std::fmod(t - start_, motion_.period);
  return start_ + (since < 0 ? since + motion_.period : since);
}

VectorsInTime::Between VectorsInTime::around(double t) const {
  const std::vector<double>& times = series_.times;
  t = time_in_period(t);
  const auto after = std::size_t(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  if (after == times.size() && motion_.period > 0 && first_ == 0 && last_ + 1 == times.size()) {  // to the first again
    const double gap = start_ + motion_.period - times.back();
    return gap > 1e-9 * motion_.period ? Between{last_, 0, float((t - times.back()) / gap)} : Between{last_, last_, 0};
  }
  if (after <= first_) return {first_, first_, 0};
  if (after > last_) return {last_, last_, 0};
  return {after - 1, after, float((t - times[after - 1]) / (times[after] - times[after - 1]))};
}

void VectorsInTime::vectors(double t, std::span<Vec3f> out) {
  if (analytic_ && moves()) {  // a flow on the material
    const std::vector<Vec3f> values = analytic_vectors(vectors_, began_, t);
    return transfer_vectors(began_.points, points(t), surface_.triangles, values, out);
  }
  if (analytic_) {
    const std::vector<Vec3f> values = analytic_vectors(vectors_, surface_, t, share());
    std::copy(values.begin(), values.end(), out.begin());
    return;
  }
  const Between at = around(t);
  const std::vector<Vec3f>& a = step(at.before).vectors;
  const std::vector<Vec3f>& b = step(at.after).vectors;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + (b[i] - a[i]) * at.share;
  if (motion_.relative) add_surface_velocity(at, -1, out);
}

std::vector<float> VectorsInTime::scalar(double t) {
  std::vector<float> result(surface_.points.size());
  if (color_ == "speed") {
    std::vector<Vec3f> v(result.size());
    vectors(t, v);
    if (moves()) return speeds(shape(t), v);
    for (std::size_t i = 0; i < v.size(); ++i) result[i] = speed_of(v[i], i);
    return result;
  }
  if (derived_) return derived_scalar_;
  const Between at = around(t);
  const std::vector<float>& a = step(at.before).scalar;
  const std::vector<float>& b = step(at.after).scalar;
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = a[i] + (b[i] - a[i]) * at.share;
  return result;
}

/// Along the surface.
float VectorsInTime::speed_of(const Vec3f& vector, std::size_t point) const {
  return length(vector - point_normals_[point] * dot(vector, point_normals_[point]));
}

void VectorsInTime::survey(bool vectors_too) {
  if (derived_) derived_scalar_ = haemodynamic_array(haemodynamics(*this), color_);
  if (moves()) return survey_motion(vectors_too);
  ColourSurvey speeds, values;
  const bool scalars = color_ != "none" && color_ != "speed";
  VectorStatistics all = statistics_;
  const std::size_t moments = analytic_ && series_.steps() == 1 && end_ > start_ ? 8 : series_.steps();
  std::vector<Vec3f> now(surface_.points.size()), next = now;
  const std::size_t stride = (share_ ? share_->all_points : now.size()) * moments / largest_sample | 1;
  const auto look_at = [&](std::size_t k) {
    check_stop(stop_);
    const double t = moments == series_.steps() ? series_.times[k] : start_ + (end_ - start_) * double(k) / 8;
    if (vectors_too) vectors(t, next);
    if (!scalars) return;
    const std::vector<float> all_values = scalar(t);
    for (std::size_t i = 0; i < all_values.size(); ++i)
      if (is_counted(share(), i)) values.add(all_values[i], is_sampled(surface_.points[i], k, stride));
  };
  const bool any = vectors_too || scalars;
  if (any) look_at(0);
  for (std::size_t k = 0; any && k < moments; ++k) {  // the next one is read while this one is judged
    std::swap(now, next);
    VectorStatistics s;
    const auto judge = [&] {
      if (!vectors_too) return;
      s = vector_statistics(surface_, now, share());
      for (std::size_t i = 0; i < now.size(); ++i)
        if (is_counted(share(), i) && is_sampled(surface_.points[i], k, stride)) speeds.add(speed_of(now[i], i), true);
    };
    const auto look_ahead = [&] {
      if (k + 1 < moments) look_at(k + 1);
    };
    if (share_)
      judge(), look_ahead();  // both may talk to other processes
    else
      tbb::parallel_invoke(judge, look_ahead);
    if (!vectors_too) continue;
    if (k == 0)
      all = s;
    else
      all.percentile_98 += s.percentile_98;
    all.max_speed = std::max(all.max_speed, s.max_speed);
    all.zero_share = std::min(all.zero_share, s.zero_share);
  }
  if (vectors_too) all.percentile_98 /= double(moments);
  statistics_ = all;
  if (share_) speeds.join(*share_->ranks), values.join(*share_->ranks);
  if (vectors_too) {
    speeds_ = std::move(speeds).spread();
    speeds_.low = 0;
    speeds_.high = statistics_.percentile_98 > 0 ? statistics_.percentile_98 : 1;
  }
  if (scalars) scalars_ = std::move(values).spread();
}

}  // namespace nacre
