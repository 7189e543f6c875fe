// Nacre: a surface with vectors over time, ready for the flow pipeline.
#include "engine/scene/surface/flow_input.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "compute/device/among_all.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/surface/series_motion.hpp"

namespace nacre {

VectorsInTime make_flow_input(SurfaceSeries series, const Settings& settings, const FlowLog& log,
                              const std::atomic<bool>* stop) {
  for (const std::string& warning : series.warnings) log.warn(warning);
  if (series.moves) series = examine_motion(std::move(series), log.warn, stop);
  const Surface first = series.load(0);
  if (log.read) log.read(first);
  std::vector<std::string> warnings;
  PreparedSurface surface = prepare(first, settings.crease_angle, &warnings);
  for (const std::string& warning : warnings) log.warn(warning);
  const VectorChoice choice = choose_vectors(first, settings.vectors);
  log.chosen(choice);
  if (log.first_step && series.steps() > 1) {
    SurfaceSeries alone;
    alone.name = series.name;
    alone.times = {series.times.front()};
    alone.load = [&first](std::size_t) { return first; };
    VectorsInTime seen(std::move(alone), surface, choice.name, settings.color, stop);
    log.first_step(seen);
  }
  MotionChoice motion = choose_motion(series, first, choice.name, settings, log);
  VectorsInTime vectors(std::move(series), std::move(surface), choice.name, settings.color, stop, std::move(motion));
  warn_of_vectors(vectors, settings, log);
  return vectors;
}

std::optional<VectorsInTime> make_flow_input(SharedSeries shared, Ranks& ranks, const Settings& settings,
                                             const FlowLog& log, std::string& why, const std::atomic<bool>* stop) {
  SurfaceSeries& series = shared.series;
  if (series.moves) throw Error("a surface that moves needs one process", "", "leave mpirun away");
  std::vector<std::string> warnings;
  Surface first = series.load(0);
  PreparedShare prepared = prepare_share(ranks, first, shared.point_id, settings.crease_angle, &warnings);
  why = prepared.whole_needed;
  if (!why.empty()) return {};
  for (const std::string& warning : series.warnings) log.warn(warning);
  for (const std::string& warning : warnings) log.warn(warning);
  const VectorChoice choice = choose_vectors(first, settings.vectors, &prepared.share);
  log.chosen(choice);
  MotionChoice motion = choose_motion(series, first, choice.name, settings, log);
  first = {};
  VectorsInTime vectors(std::move(series), std::move(prepared.surface), choice.name, settings.color, stop,
                        std::move(motion), std::make_shared<const Share>(std::move(prepared.share)));
  warn_of_vectors(vectors, settings, log);
  return vectors;
}

MotionChoice choose_motion(const SurfaceSeries& series, const Surface& first, const std::string& vectors,
                           const Settings& settings, const FlowLog& log) {
  const auto& tell = log.note ? log.note : log.warn;
  MotionChoice choice{false, settings.surface_velocity, settings.period, settings.crease_angle};
  const std::size_t groups = series.motion ? series.motion->groups : 0;
  if (groups == 1)
    tell(fmt::format("the surface moves: {} shapes of the same triangles; the texture stays with the material",
                     series.steps()));
  if (groups > 1)
    tell(
        fmt::format("the triangles of the surface change {} times in {} steps: there, values go along the normal to "
                    "the closest point of the new surface",
                    groups - 1, series.steps()));
  if (!choice.surface_velocity.empty()) {
    const PointArray* array = first.find(choice.surface_velocity);
    if (!array || array->components != 3)
      throw Error("`surface_velocity`: the surface has no vectors \"" + choice.surface_velocity + "\"");
  }
  const bool from_positions = groups > 0 && groups < series.steps();
  const bool known = !choice.surface_velocity.empty() || from_positions;
  const std::string source =
      choice.surface_velocity.empty() ? "from its positions" : "the array " + choice.surface_velocity;
  const bool analytic = vectors.starts_with('@');
  const VectorKind kind = analytic ? VectorKind::other : vector_kind(vectors);
  if (settings.relative == RelativeVectors::on && !known)
    throw Error("`relative` on: the velocity of the surface is not known", "its points do not move",
                "name an array with `surface_velocity`");
  if (settings.relative == RelativeVectors::off || !known) {
    if (known && kind == VectorKind::velocity) tell(vectors + " is shown as it is, not relative to the surface");
    if (groups > 1 && !known)
      tell(
          "the velocity of the surface is not known where all steps have other triangles: vectors are shown as they "
          "are");
    return choice;
  }
  if (kind == VectorKind::wall_shear)
    tell(vectors + " is wall shear stress: it is never changed by the motion of the surface");
  else if (analytic)
    tell(vectors + " flows on the material, whatever the motion of the surface");
  else if (settings.relative == RelativeVectors::on || kind == VectorKind::velocity)
    choice.relative = true;
  else
    tell(vectors +
         " is shown as it is: by its name it is no velocity (relative on shows it less the surface's velocity)");
  if (choice.relative) tell(fmt::format("{} is shown relative to the surface, whose velocity is {}", vectors, source));
  return choice;
}

void warn_of_vectors(const VectorsInTime& vectors, const Settings& settings, const FlowLog& log) {
  const VectorStatistics& s = vectors.statistics();
  if (vectors.surface_speed() > 0 &&
      s.percentile_98 <= vectors.surface_speed() * vectors.least_relative_speed * (1 + 1e-9))
    log.warn(
        fmt::format("{} moves with the surface: relative to it, it is slower than a hundredth of the surface itself",
                    vectors.array()));
  if (s.percentile_98 <= 0)
    log.warn(settings.flow.texture == FlowTexture::streaks
                 ? "the vectors are zero everywhere: the texture will remain noise"
                 : "the vectors are zero everywhere: spots will be round, and stripes have no direction");
  else if (s.normal_share > 0.5)
    log.warn(fmt::format("{} is {:.0f}% normal to the surface: only its tangential part is shown", vectors.array(),
                         100 * s.normal_share));
  if (s.zero_share > 0.5)
    log.warn(fmt::format("{} is zero at {:.0f}% of the points", vectors.array(), 100 * s.zero_share));
}

FlowVectors flow_vectors(VectorsInTime& input, double start, double end, const SurfacePart* part) {
  FlowVectors vectors;
  vectors.at = [&input](double t, std::span<Vec3f> out) { input.material_vectors(t, out); };
  if (part)
    vectors.at = [&input, part, whole = std::vector<Vec3f>(input.surface().points.size())](
                     double t, std::span<Vec3f> out) mutable {
      input.vectors(t, whole);
      part->take(whole, out);
    };
  vectors.start = start;
  vectors.end = end;
  const double speed = input.statistics().percentile_98;
  vectors.reference_speed = speed > 0 ? speed : 1;
  return vectors;
}

std::vector<Vec3d> corners_of_all_steps(const VectorsInTime& input) {
  if (input.share()) {
    std::vector<Camera> views;
    for (const char* view : {"iso", "+x", "-x", "+y", "-y", "+z", "-z"}) views.push_back(preset_camera(view));
    return outermost_corners(input, views);
  }
  std::vector<Vec3d> corners = triangle_corners(input.surface());
  if (!input.moves()) return corners;
  const SeriesMotion& motion = *input.series().motion;
  for (std::size_t k = 0; k < motion.low.size(); ++k)
    for (int corner = 0; corner < 8; ++corner) {
      Vec3d p = motion.low[k];
      for (int axis = 0; axis < 3; ++axis)
        if (corner >> axis & 1) p[axis] = motion.high[k][axis];
      corners.push_back(p);
    }
  return corners;
}

std::vector<Vec3d> outermost_corners(const VectorsInTime& input, std::span<const Camera> cameras) {
  const PreparedSurface& surface = input.surface();
  Ranks& ranks = *input.share()->ranks;
  std::vector<Vec3d> corners;
  Vec3d low(1e300), high(-1e300);
  for (const Triangle& t : own_triangles(surface, input.share()))
    for (int k = 0; k < 3; ++k) {
      corners.push_back(surface.points[t[k]]);
      low = min(low, corners.back());
      high = max(high, corners.back());
    }
  extremes_of_all(&ranks, {&low.x, 3}, {&high.x, 3});
  std::vector<Vec3d> own;
  for (const Camera& camera : cameras)
    for (const Vec3d& p : outermost(camera, corners, low, high)) own.push_back(p);
  ForEachRank<Vec3d> send(static_cast<std::size_t>(ranks.count()), own);
  corners.clear();
  for (const std::vector<Vec3d>& from : exchange_items(ranks, send))
    corners.insert(corners.end(), from.begin(), from.end());
  return corners;
}

std::vector<Vec3d> triangle_corners(const PreparedSurface& surface) {
  std::vector<Vec3d> corners;
  corners.reserve(3 * surface.triangles.size());
  for (const Triangle& t : surface.triangles)
    for (int k = 0; k < 3; ++k) corners.push_back(surface.points[t[k]]);
  return corners;
}

}  // namespace nacre
