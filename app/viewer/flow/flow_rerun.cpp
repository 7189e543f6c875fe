// Nacre: what has to run again when knobs of the flow have changed.
#include "app/viewer/flow/flow_rerun.hpp"

#include <tuple>

#include "engine/run/flow_maps.hpp"

namespace nacre {
namespace {

auto of_embedding(const FlowParameters& p) {
  return std::tie(p.method, p.octree, p.texture, p.neighbour_index, p.resolution, p.refine, p.subcells, p.radius);
}

// With the speed: the vectors in the slots are scaled already; a start fills them again.
auto of_start(const Settings& s) {
  const FlowParameters& p = s.flow;
  return std::tie(s.time, s.begin_at, p.ttl, p.steps, p.warmup, p.seed, p.step_cells, p.speed_power, p.pattern_spacing,
                  p.pattern_stretch);
}

auto of_motion(const Settings& s) { return std::tie(s.relative, s.surface_velocity, s.period); }

auto of_steps(const FlowParameters& p) { return std::tie(p.sharpen, p.jitter, p.equalise, p.streaks, p.contrast); }

auto of_arrows(const ViewSettings& l) { return std::tie(l.arrows, l.arrow_count); }

auto of_flow_map(const Settings& s) { return std::tie(s.time, s.ftle_time); }

auto of_dyes(const Settings& s) { return std::tie(s.dye, s.dye_release, s.dye_diffusion); }

auto of_lines(const Settings& s) {
  return std::tie(s.topology, s.persistence, s.streamlines, s.line_spacing, s.tracks, s.time);
}

}  // namespace

bool has_lines(const Settings& s) { return s.topology || s.streamlines || s.tracks; }

void FlowRerun::add(const FlowRerun& other) {
  for (std::size_t k = 0; k < has_.size(); ++k) has_[k] = has_[k] || other.has_[k];
}

FlowRerun flow_rerun(const Settings& before, const Settings& after) {
  using enum FlowStage;
  FlowRerun rerun;
  if (before.crease_angle != after.crease_angle || before.patch != after.patch) rerun.add({surface, embed, start});
  if (before.vectors != after.vectors || of_motion(before) != of_motion(after)) rerun.add({vectors, start});
  if (before.color != after.color) rerun.add(colours);
  if (is_ftle(after.color) && (rerun.has(surface) || rerun.has(vectors) || of_flow_map(before) != of_flow_map(after)))
    rerun.add(colours);
  if (of_arrows(before.view) != of_arrows(after.view)) rerun.add(arrows);
  const bool other_field = rerun.has(surface) || rerun.has(vectors);
  if (has_lines(after) ? other_field || of_lines(before) != of_lines(after) : has_lines(before)) rerun.add(lines);
  const bool other_times = other_field || rerun.has(colours) || before.probe != after.probe;
  if (after.probe.empty() ? !before.probe.empty() : other_times) rerun.add(probes);
  if (of_embedding(before.flow) != of_embedding(after.flow)) rerun.add({embed, start});
  if (of_start(before) != of_start(after)) rerun.add(start);
  if (of_dyes(before) != of_dyes(after) && !(before.dye.empty() && after.dye.empty())) rerun.add(dyes);
  if (of_steps(before.flow) != of_steps(after.flow)) rerun.add(step);
  return rerun;
}

}  // namespace nacre
