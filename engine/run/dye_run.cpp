// Nacre: dyes beside the texture of a run.
#include "engine/run/dye_run.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/picture/compose.hpp"
#include "engine/run/moments.hpp"
#include "engine/scene/surface/welded.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_regions = 1000;

double concentration_at(const Triangle& t, const Vec3d& weights, std::span<const float> values) {
  return values[t.a] * weights.x + values[t.b] * weights.y + values[t.c] * weights.z;
}

void blend_dye(std::uint8_t* pixel, const std::array<double, most_dyes>& mix) {
  double sum = 0;
  for (const double c : mix) sum += c;
  if (!(sum > least_drawn_dye)) return;
  const double light = (0.3 * pixel[0] + 0.6 * pixel[1] + 0.1 * pixel[2]) / dye_full_light;
  const double share = dye_least_light + (1 - dye_least_light) * std::min(1.0, light);
  const auto channel = [&](std::size_t k) {
    double ink = 0;
    for (std::size_t d = 0; d < most_dyes; ++d) ink += mix[d] / sum * dye_inks[d][k];
    return std::uint8_t(std::lround(ink * share));
  };
  blend_pixel(pixel, {channel(0), channel(1), channel(2), 255}, float(dye_cover * std::sqrt(std::min(1.0, sum))));
}

}  // namespace

double steady_dye_step(const VectorsInTime& input, const Settings& settings, double cell_size) {
  const double speed = input.statistics().percentile_98;
  return settings.flow.step_cells * cell_size / (speed > 0 ? speed : 1);
}

DyeRun::DyeRun(VectorsInTime& input, const Settings& settings, double start, double steady_step,
               const std::atomic<bool>* stop)
    : input_(input),
      stop_(stop),
      time_(start),
      steady_step_(steady_step),
      steady_(!(input.end() > input.start())),
      triangles_(welded_triangles(input.surface())),
      welded_(input.surface().points.size()) {
  for (std::uint32_t p = 0; p < welded_.size(); ++p) welded_[p] = p;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int k = 0; k < 3; ++k) welded_[input.surface().triangles[t][k]] = triangles_[t][k];
  if (input.moves() && input.series().motion->groups > 1)
    throw Error("`dye` needs the same triangles in all steps", "those of " + input.series().name + " change");
  set(settings);
}

void DyeRun::check(const Settings& settings) const {
  if (!(input_.statistics().percentile_98 > 0) && settings.dye_diffusion == 0)
    throw Error("`dye` would stay where it is", input_.array() + " is zero everywhere",
                "choose others with `vectors`, or let it diffuse (`dye_diffusion`)");
}

void DyeRun::set(const Settings& settings) {
  check(settings);
  const PreparedSurface now = input_.shape(time_);
  const Surface first = input_.series().load(0);
  const auto all = parse_dyes(settings.dye);
  std::vector<std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>> found;  // all sources, new ones
  for (std::size_t d = 0; d < all.size(); ++d) {
    auto& [sources, added] = found.emplace_back();
    for (const DyeSource& part : all[d]) {
      const std::vector<std::uint32_t> points = points_in(part, now, triangles_, first);
      sources.insert(sources.end(), points.begin(), points.end());
      const auto same = [&](const DyeSource& before) { return before.text == part.text; };
      if (d >= dyes_.size() || std::none_of(dyes_[d].parts.begin(), dyes_[d].parts.end(), same))
        added.insert(added.end(), points.begin(), points.end());
    }
    for (auto* list : {&sources, &added}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
  }
  find_regions(settings.dye_regions);
  release_ = settings.dye_release;
  if (dyes_.size() > all.size()) dyes_.erase(dyes_.begin() + std::ptrdiff_t(all.size()), dyes_.end());
  for (std::size_t d = 0; d < all.size(); ++d) {
    if (d == dyes_.size()) dyes_.push_back({{}, {}, {}, Dye(welded_.size(), triangles_, 0), {}, {}, 0});
    OneDye& each = dyes_[d];
    each.dye.set_diffusion(settings.dye_diffusion);
    each.parts = all[d];
    each.text.clear();
    for (const DyeSource& part : each.parts) each.text += (each.text.empty() ? "" : ";") + part.text;
    each.sources = std::move(found[d].first);
    each.dye.release(now.points, found[d].second);
  }
  show();
}

/// The array has a whole number for each point.
void DyeRun::find_regions(const std::string& name) {
  region_.clear();
  if (name.empty()) return;
  const Surface first = input_.series().load(0);
  const PointArray* array = first.find(name);
  if (!array || array->components != 1 || array->size() != welded_.size())
    throw Error("`dye_regions`: the surface has no array \"" + name + "\" of one number per point");
  std::map<int, bool> values;
  region_.assign(welded_.size(), 0);
  for (std::size_t p = 0; p < welded_.size(); ++p) {
    const float value = array->values[p];
    if (!(std::fabs(value) < 1e9f) || value != std::floor(value))
      throw Error("`dye_regions`: the array \"" + name + "\" has other values than whole numbers");
    region_[welded_[p]] = int(value);
    values[int(value)] = true;
  }
  if (values.size() > most_regions)
    throw Error(fmt::format("`dye_regions`: the array \"{}\" has {} values", name, values.size()),
                fmt::format("at most {} regions are told apart", most_regions));
}

void DyeRun::go_to(double time) {
  if (release_ == DyeRelease::always)
    for (OneDye& each : dyes_) each.dye.release(input_.points(time_), each.sources);
  std::vector<Vec3f> first(welded_.size()), last = first;
  for (OneDye& each : dyes_) each.sub_steps = 0;
  const double duration = steady_ ? steady_step_ : time - time_;
  if (duration > 0) {
    const std::vector<double> times =
        steady_ ? std::vector{time_, time_ + duration} : moments(input_, time_, duration, 1);
    input_.vectors(times.front(), first);
    for (std::size_t k = 0; k + 1 < times.size(); ++k) {
      input_.vectors(times[k + 1], last);
      const std::vector<Vec3d> shape = input_.points(0.5 * (times[k] + times[k + 1]));
      for (OneDye& each : dyes_) each.sub_steps += each.dye.step(shape, times[k + 1] - times[k], first, last, stop_);
      std::swap(first, last);
    }
  }
  time_ = steady_ ? time_ + duration : time;
  show();
}

/// The shape at this time, to draw on.
void DyeRun::show() {
  const std::vector<Vec3d> points = input_.points(time_);
  for (OneDye& each : dyes_) each.concentration = each.dye.concentration(points);
  if (!has_tree_ || input_.moves()) tree_ = TriangleTree(points, triangles_);
  has_tree_ = true;
}

void DyeRun::note() {
  for (OneDye& each : dyes_) {
    Frame frame{time_, each.dye.mass(), each.dye.released(), each.dye.left(), each.sub_steps, {}};
    const std::span<const double> masses = each.dye.masses();
    for (std::size_t p = 0; p < region_.size(); ++p)
      if (welded_[p] == p) frame.regions[region_[p]] += masses[p];
    each.frames.push_back(std::move(frame));
  }
}

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
      const Triangle& t = tree_.triangles()[hit->triangle];
      const Vec3d weights = tree_.weights_at(hit->triangle, hit->position);
      std::array<double, most_dyes> mix{};
      for (std::size_t d = 0; d < dyes_.size(); ++d)
        mix[d] = std::clamp(concentration_at(t, weights, dyes_[d].concentration), 0.0, 1.0);
      blend_dye(image.at(x, y), mix);
    }
  });
}

std::vector<PointArray> DyeRun::at(std::span<const Vec3d> points) const {
  std::vector<PointArray> arrays;
  for (std::size_t d = 0; d < dyes_.size(); ++d)
    arrays.push_back({d == 0 ? "dye" : fmt::format("dye_{}", d + 1), 1, std::vector<float>(points.size())});
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
    const auto hit = tree_.closest(points[i]);
    if (!hit) return;
    const Triangle& t = tree_.triangles()[hit->triangle];
    const Vec3d weights = tree_.weights_at(hit->triangle, hit->position);
    for (std::size_t d = 0; d < dyes_.size(); ++d)
      arrays[d].values[i] = float(concentration_at(t, weights, dyes_[d].concentration));
  });
  return arrays;
}

std::vector<DyeMix> DyeRun::mixes() const {
  std::vector<DyeMix> mixes(welded_.size());
  for (std::size_t p = 0; p < mixes.size(); ++p)
    for (std::size_t d = 0; d < dyes_.size(); ++d) mixes[p][d] = dyes_[d].concentration[welded_[p]];
  return mixes;
}

nlohmann::json DyeRun::report() const {
  nlohmann::json dyes = nlohmann::json::array();
  for (std::size_t d = 0; d < dyes_.size(); ++d) {
    const OneDye& each = dyes_[d];
    const auto [red, green, blue] = dye_inks[d];
    nlohmann::json steps = nlohmann::json::array();
    double mass_time = 0;
    for (std::size_t k = 0; k < each.frames.size(); ++k) {
      const Frame& f = each.frames[k];
      if (k > 0) mass_time += 0.5 * (f.mass + each.frames[k - 1].mass) * (f.time - each.frames[k - 1].time);
      steps.push_back(
          {{"time", f.time}, {"mass", f.mass}, {"released", f.released}, {"left", f.left}, {"sub_steps", f.sub_steps}});
      for (const auto& [region, mass] : f.regions) steps.back()["regions"][std::to_string(region)] = mass;
    }
    nlohmann::json one = {{"sources", each.text},
                          {"color", fmt::format("#{:02x}{:02x}{:02x}", red, green, blue)},
                          {"source_points", each.sources.size()},
                          {"steps", std::move(steps)}};
    const double released = each.dye.released();
    if (released > 0) one["washout"] = each.dye.left() / released;
    if (released > 0 && release_ == DyeRelease::once) one["residence_time"] = mass_time / released;
    dyes.push_back(std::move(one));
  }
  return {{"dyes", std::move(dyes)}};
}

}  // namespace nacre
