// Nacre: what has to run again when knobs of the flow have changed.
#include "app/viewer/flow_rerun.hpp"

#include <tuple>

namespace nacre {
namespace {

auto of_embedding(const FlowParameters& p) {
  return std::tie(p.method, p.octree, p.neighbour_index, p.resolution, p.refine, p.subcells, p.radius);
}

auto of_start(const FlowParameters& p) { return std::tie(p.ttl, p.steps, p.warmup, p.seed); }

// The vectors in the slots are scaled already; a start fills them anew.
auto of_speed(const FlowParameters& p) { return std::tie(p.step_cells, p.speed_power); }

auto of_steps(const FlowParameters& p) { return std::tie(p.sharpen, p.jitter, p.equalise, p.contrast); }

}  // namespace

FlowRerun flow_rerun(const FlowParameters& before, const FlowParameters& after) {
  if (of_embedding(before) != of_embedding(after)) return FlowRerun::embed;
  if (of_start(before) != of_start(after) || of_speed(before) != of_speed(after)) return FlowRerun::start;
  return of_steps(before) != of_steps(after) ? FlowRerun::steps : FlowRerun::nothing;
}

}  // namespace nacre
