// Nacre: what happens to the shape of a surface over the steps of a series.
#include "engine/scene/surface/series_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/scene/surface/extent.hpp"
#include "engine/scene/surface/prepare.hpp"

namespace nacre {
namespace {

constexpr double other_unit = 9.5;       // times as large from one step to the next: no surface grows so
constexpr double least_fullness = 1e-3;  // of the box's volume, below which the sign of a volume says nothing

/// Whether every edge has a triangle on either side: then the volume inside has a sign.
bool is_closed(const std::vector<Triangle>& triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> up, down;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      (a < b ? up : down).push_back(std::minmax(a, b));
    }
  std::sort(up.begin(), up.end());
  std::sort(down.begin(), down.end());
  return up == down && std::adjacent_find(up.begin(), up.end()) == up.end();
}

double volume(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles, const Vec3d& from) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += dot(points[t.a] - from, cross(points[t.b] - from, points[t.c] - from));
  return sum / 6;
}

/// Judges one step after the other.
class Examiner {
 public:
  /// Why the step cannot be what is meant; empty: it can. `other`: it has other triangles than the one before.
  std::string judge(const Surface& surface, bool& other) {
    if (surface.triangles.empty()) return "the surface vanishes: it has no triangles";
    const Extent extent(surface.points, surface.triangles);
    if (!extent.finite) return "its points are not all finite";
    const double size = extent.longest_side();
    if (!(size > 0)) return "the surface vanishes: it has no extent";
    other = !known_ || surface.points.size() != points_ || surface.triangles != triangles_;
    if (known_ && (size > other_unit * size_ || size < size_ / other_unit))
      return fmt::format("the surface is {:.3g} times as large as in the step before, as if in another unit",
                         size / size_);
    if (other) begin_group(surface);
    if (closed_) {
      const double now = volume(surface.points, prepared_, extent.low);
      if (std::abs(now) < least_fullness * size * size * size * thickness_) return keep(size);
      if (volume_ != 0 && (now > 0) != (volume_ > 0)) return "the surface is turned inside out";
      volume_ = now;
    }
    return keep(size);
  }

 private:
  std::string keep(double size) {
    size_ = size;
    known_ = true;
    return {};
  }

  void begin_group(const Surface& surface) {
    points_ = surface.points.size();
    triangles_ = surface.triangles;
    prepared_ = prepare(surface).triangles;
    closed_ = is_closed(prepared_);
    volume_ = 0;
    const Extent extent(surface.points, surface.triangles);
    const double size = extent.longest_side();
    thickness_ = closed_ ? std::abs(volume(surface.points, prepared_, extent.low)) / (size * size * size) : 0;
  }

  bool known_ = false, closed_ = false;
  double size_ = 0, volume_ = 0, thickness_ = 0;
  std::size_t points_ = 0;
  std::vector<Triangle> triangles_, prepared_;
};

}  // namespace

SurfaceSeries examine_motion(SurfaceSeries series, const std::function<void(const std::string&)>& warn,
                             const std::atomic<bool>* stop) {
  auto motion = std::make_shared<SeriesMotion>();
  std::vector<std::size_t> kept;
  Examiner examiner;
  for (std::size_t k = 0; k < series.steps(); ++k) {
    check_stop(stop);
    const Surface surface = series.load(k);
    bool other = false;
    const std::string why = examiner.judge(surface, other);
    if (!why.empty()) {
      warn(fmt::format("step {} (time {:.6g}) is left out: {}", k, series.times[k], why));
      continue;
    }
    if (other) ++motion->groups;
    motion->group.push_back(motion->groups - 1);
    const Extent extent(surface.points, surface.triangles);
    motion->low.push_back(extent.low);
    motion->high.push_back(extent.high);
    kept.push_back(k);
  }
  if (kept.empty()) throw Error(series.name + " has no step with a usable surface");
  std::vector<double> times;
  for (const std::size_t k : kept) times.push_back(series.times[k]);
  series.times = std::move(times);
  series.load = [load = series.load, kept](std::size_t k) { return load(kept[k]); };
  series.motion = std::move(motion);
  return series;
}

}  // namespace nacre
