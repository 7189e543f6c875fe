// Nacre: dye beside the texture of a run.
#include "engine/run/dye_run.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "compute/device/error.hpp"
#include "engine/picture/compose.hpp"
#include "engine/run/moments.hpp"
#include "engine/scene/surface/welded.hpp"

namespace nacre {
namespace {

constexpr std::array<double, 3> ink{214, 24, 118};
constexpr double most_cover = 0.9;

/// Between the corners of a triangle, at a point of it.
double interpolate(const TriangleTree& tree, std::uint32_t triangle, const Vec3d& at, std::span<const float> values) {
  const Triangle& t = tree.triangles()[triangle];
  const Vec3d &a = tree.points()[t.a], b = tree.points()[t.b] - a, c = tree.points()[t.c] - a, d = at - a;
  const Vec3d normal = cross(b, c);
  const double whole = dot(normal, normal);
  const double v = std::clamp(dot(cross(d, c), normal) / whole, 0.0, 1.0);
  const double w = std::clamp(dot(cross(b, d), normal) / whole, 0.0, 1.0 - v);
  return values[t.a] * (1 - v - w) + values[t.b] * v + values[t.c] * w;
}

}  // namespace

DyeRun::DyeRun(VectorsInTime& input, const Settings& settings, double start, double steady_step,
               const std::atomic<bool>* stop)
    : input_(input),
      settings_(settings),
      stop_(stop),
      time_(start),
      steady_step_(steady_step),
      steady_(!(input.end() > input.start())),
      triangles_(welded_triangles(input.surface())),
      dye_(input.surface().points.size(), triangles_, settings.dye_diffusion) {
  if (input.moves() && input.series().motion->groups > 1)
    throw Error("`dye` needs the same triangles in all steps", "those of " + input.series().name + " change");
  if (!(input.statistics().percentile_98 > 0) && settings.dye_diffusion == 0)
    throw Error("`dye` would stay where it is", input.array() + " is zero everywhere",
                "choose others with `vectors`, or let it diffuse (`dye_diffusion`)");
  const PreparedSurface shape = input.moves() ? input.shape(start) : input.surface();
  const Surface first = input.series().load(0);
  for (const DyeSource& source : parse_dye(settings.dye)) {
    const std::vector<std::uint32_t> points = points_in(source, shape, triangles_, first);
    sources_.insert(sources_.end(), points.begin(), points.end());
  }
  std::sort(sources_.begin(), sources_.end());
  sources_.erase(std::unique(sources_.begin(), sources_.end()), sources_.end());
  dye_.release(shape.points, sources_);
  show(start);
  note();
}

void DyeRun::go_to(double time) {
  if (settings_.dye_release == DyeRelease::always) dye_.release(input_.points(time_), sources_);
  std::vector<Vec3f> first(concentration_.size()), last = first;
  sub_steps_ = 0;
  const double duration = steady_ ? steady_step_ : time - time_;
  if (duration > 0) {
    const std::vector<double> times =
        steady_ ? std::vector{time_, time_ + duration} : moments(input_, time_, duration, 1);
    input_.vectors(times.front(), first);
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
      input_.vectors(times[k + 1], last);
      sub_steps_ +=
          dye_.step(input_.points(0.5 * (times[k] + times[k + 1])), times[k + 1] - times[k], first, last, stop_);
      std::swap(first, last);
    }
  }
  time_ = steady_ ? time_ + duration : time;
  show(time_);
  note();
}

/// The shape at a time, to draw on.
void DyeRun::show(double time) {
  const std::vector<Vec3d> points = input_.points(time);
  concentration_ = dye_.concentration(points);
  if (frames_.empty() || input_.moves()) tree_ = TriangleTree(points, triangles_);
}

void DyeRun::note() { frames_.push_back({time_, dye_.mass(), dye_.released(), dye_.left(), sub_steps_}); }

void DyeRun::draw(Image& image, const Camera& camera) const {
  const Vec3d forward = camera.forward(), right = camera.right(), up = cross(right, forward);
  const double distance = length(camera.target - camera.eye), pixel = camera.height / image.height;
  tbb::parallel_for(0, image.height, [&](int y) {
    for (int x = 0; x < image.width; ++x) {
      const Vec3d offset =
          right * ((x + 0.5 - 0.5 * image.width) * pixel) + up * ((0.5 * image.height - y - 0.5) * pixel);
      const Vec3d from = camera.orthographic ? camera.eye + offset : camera.eye;
      const Vec3d along = camera.orthographic ? forward : normalized(forward * distance + offset);
      const auto hit = tree_.first(from, along);
      if (!hit) continue;
      const double c = std::clamp(interpolate(tree_, hit->triangle, hit->position, concentration_), 0.0, 1.0);
      if (!(c > 0.002)) continue;
      std::uint8_t* p = image.at(x, y);
      const double light = 0.25 + 0.75 * std::min(1.0, (0.3 * p[0] + 0.6 * p[1] + 0.1 * p[2]) / 170);  // the texture's
      const auto channel = [&](double value) { return std::uint8_t(std::lround(value * light)); };
      blend_pixel(p, {channel(ink[0]), channel(ink[1]), channel(ink[2]), 255}, float(most_cover * std::sqrt(c)));
    }
  });
}

std::vector<float> DyeRun::at(std::span<const Vec3d> points) const {
  std::vector<float> result(points.size());
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
    const auto hit = tree_.closest(points[i]);
    if (hit) result[i] = float(interpolate(tree_, hit->triangle, hit->position, concentration_));
  });
  return result;
}

nlohmann::json DyeRun::report() const {
  nlohmann::json steps = nlohmann::json::array();
  for (const Frame& each : frames_)
    steps.push_back({{"time", each.time},
                     {"mass", each.mass},
                     {"released", each.released},
                     {"left", each.left},
                     {"sub_steps", each.sub_steps}});
  return {{"source_points", sources_.size()}, {"steps", steps}};
}

}  // namespace nacre
