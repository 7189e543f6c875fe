// Nacre: vectors and colours of a series at any time.
#include "engine/scene/surface/vectors_in_time.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

constexpr std::size_t largest_sample = 1 << 16;  ///< about; of the values that percentiles are taken of

/// Mean corner normal of each point: what speed on the surface is measured against.
std::vector<Vec3f> point_normals(const PreparedSurface& surface) {
  std::vector<Vec3f> normals(surface.points.size());
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) normals[surface.triangles[t][k]] += surface.corner_normals[3 * t + k];
  for (Vec3f& n : normals) n = normalized(n);
  return normals;
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

VectorsInTime::VectorsInTime(SurfaceSeries series, PreparedSurface surface, std::string vectors, std::string color,
                             const std::atomic<bool>* stop)
    : series_(std::move(series)),
      surface_(std::move(surface)),
      point_normals_(point_normals(surface_)),
      start_(series_.times.front()),
      stop_(stop) {
  choose(vectors, color);
  survey();
}

void VectorsInTime::choose(const std::string& vectors, const std::string& color) {
  vectors_ = vectors;
  color_ = color;
  analytic_ = !vectors_.empty() && vectors_[0] == '@';
  end_ = series_.times.back();
  if (analytic_ && series_.steps() == 1) end_ = vectors_ == "@swirl" ? start_ + 1 : start_;
  for (Step& step : steps_) step = {};
}

void VectorsInTime::set_surface(PreparedSurface surface) {
  std::swap(surface_, surface);
  std::vector<Vec3f> normals = point_normals(surface_);
  std::swap(point_normals_, normals);
  try {
    survey();
  } catch (...) {
    surface_ = std::move(surface);
    point_normals_ = std::move(normals);
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

VectorsInTime::Step VectorsInTime::load(std::size_t number) const {
  Step step;
  step.number = number;
  const std::size_t n = surface_.points.size();
  const bool needs_file = !analytic_ || (color_ != "speed" && color_ != "none");
  const Surface surface = needs_file ? series_.load(number) : Surface{};
  if (!analytic_) {
    const PointArray& array = array_of(surface, vectors_, n, number);
    if (array.components != 3) throw Error("array '" + vectors_ + "' does not have three components");
    step.vectors.resize(n);
    for (std::size_t i = 0; i < n; ++i)
      step.vectors[i] = {array.values[3 * i], array.values[3 * i + 1], array.values[3 * i + 2]};
  }
  if (color_ != "speed" && color_ != "none") {
    const PointArray& array = array_of(surface, color_, n, number);
    step.scalar.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      double squares = 0;
      for (int k = 0; k < array.components; ++k) squares += std::pow(array.values[i * array.components + k], 2);
      step.scalar[i] = array.components == 1 ? array.values[i] : float(std::sqrt(squares));
    }
  }
  return step;
}

const VectorsInTime::Step& VectorsInTime::step(std::size_t number) {
  for (std::size_t k = 0; k < 2; ++k)
    if (steps_[k].number == number) {
      oldest_ = 1 - k;  // who asks for two holds on to the first
      return steps_[k];
    }
  Step& place = steps_[oldest_];
  place = load(number);
  oldest_ = 1 - oldest_;
  return place;
}

VectorsInTime::Between VectorsInTime::around(double t) const {
  const std::vector<double>& times = series_.times;
  const auto after = std::size_t(std::upper_bound(times.begin(), times.end(), t) - times.begin());
  if (after == 0) return {0, 0, 0};
  if (after == times.size()) return {after - 1, after - 1, 0};
  return {after - 1, after, float((t - times[after - 1]) / (times[after] - times[after - 1]))};
}

void VectorsInTime::vectors(double t, std::span<Vec3f> out) {
  if (analytic_) {
    const std::vector<Vec3f> values = analytic_vectors(vectors_, surface_, t);
    std::copy(values.begin(), values.end(), out.begin());
    return;
  }
  const Between at = around(t);
  const std::vector<Vec3f>& a = step(at.before).vectors;
  const std::vector<Vec3f>& b = step(at.after).vectors;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = a[i] + (b[i] - a[i]) * at.share;
}

std::vector<float> VectorsInTime::scalar(double t) {
  std::vector<float> result(surface_.points.size());
  if (color_ == "speed") {
    std::vector<Vec3f> v(result.size());
    vectors(t, v);
    for (std::size_t i = 0; i < v.size(); ++i) result[i] = speed_of(v[i], i);
    return result;
  }
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
  ColourSurvey speeds, values;
  const bool scalars = color_ != "none" && color_ != "speed";
  VectorStatistics all = statistics_;
  const std::size_t moments = analytic_ && series_.steps() == 1 && end_ > start_ ? 8 : series_.steps();
  std::vector<Vec3f> now(surface_.points.size()), next = now;
  const std::size_t stride = now.size() * moments / largest_sample | 1;  // odd: rows of a surface are even at times
  const auto look_at = [&](std::size_t k) {
    check_stop(stop_);
    const double t = moments == series_.steps() ? series_.times[k] : start_ + (end_ - start_) * double(k) / 8;
    if (vectors_too) vectors(t, next);
    if (!scalars) return;
    const std::vector<float> all_values = scalar(t);
    for (std::size_t i = 0; i < all_values.size(); ++i) values.add(all_values[i], i % stride == k % stride);
  };
  const bool any = vectors_too || scalars;
  if (any) look_at(0);
  for (std::size_t k = 0; any && k < moments; ++k) {  // the next one is read while this one is judged
    std::swap(now, next);
    VectorStatistics s;
    tbb::parallel_invoke(
        [&] {
          if (!vectors_too) return;
          s = vector_statistics(surface_, now);
          for (std::size_t i = k % stride; i < now.size(); i += stride) speeds.add(speed_of(now[i], i), true);
        },
        [&] {
          if (k + 1 < moments) look_at(k + 1);
        });
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
  if (vectors_too) {
    speeds_ = std::move(speeds).spread();
    speeds_.low = 0;
    speeds_.high = statistics_.percentile_98 > 0 ? statistics_.percentile_98 : 1;
  }
  if (scalars) scalars_ = std::move(values).spread();
}

}  // namespace nacre
