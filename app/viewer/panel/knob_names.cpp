// Nacre: texts of the knobs for people.
#include "app/viewer/panel/knob_names.hpp"

#include <map>
#include <utility>
#include <variant>

#include "app/viewer/flow/flow_rerun.hpp"
#include "app/viewer/mesh/mesh_worker.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

/// The same with one knob at another value.
Settings with_other(const std::string& name) {
  Settings settings;
  for (const Knob& knob : knobs(settings)) {
    if (knob.name != name) continue;
    if (auto* const* flag = std::get_if<bool*>(&knob.value)) **flag = !**flag;
    if (auto* const* real = std::get_if<double*>(&knob.value)) **real = **real < knob.max ? knob.max : knob.min;
    if (auto* const* whole = std::get_if<int*>(&knob.value)) ++**whole;
    if (auto* const* number = std::get_if<std::uint32_t*>(&knob.value)) {
      ++**number;
      if (knob.also) *knob.also = **number;
    }
    if (const auto* choice = std::get_if<KnobChoice>(&knob.value))
      choice->set(choice->member, choice->get(choice->member) == 0 ? 1 : 0);
    if (auto* const* string = std::get_if<std::string*>(&knob.value))
      **string = knob.choices.empty() ? "1" : **string == knob.choices[0] ? knob.choices[1] : knob.choices[0];
  }
  return settings;
}

std::string flow_cost(const FlowRerun& rerun) {
  using enum FlowStage;
  if (rerun.has(surface) || rerun.has(embed)) return "a change rebuilds the grid and restarts the texture";
  if (rerun.has(start)) return "a change restarts the texture";
  if (rerun.has(step)) return "a change is seen from the next step on";
  return "a change is seen at once";
}

std::string mesh_cost(MeshStage stage) {
  switch (stage) {
    case MeshStage::read:
    case MeshStage::materials: return "a change recomputes everything from the materials on";
    case MeshStage::fields: return "a change rebuilds the fields, then the particles and triangles";
    case MeshStage::relax: return "a change moves the particles again";
    case MeshStage::triangulate: return "a change rebuilds the triangles";
    default: return "a change is seen at once";
  }
}

}  // namespace

std::string plain_name(const std::string& knob) {
  static const std::map<std::string, std::string> names{
      {"resolution", "Texture detail"},
      {"texture", "Texture"},
      {"pattern_spacing", "Pattern spacing"},
      {"pattern_stretch", "Pattern stretch"},
      {"ttl", "Streak length"},
      {"streaks", "Smoothing"},
      {"contrast", "Contrast"},
      {"step_cells", "Motion per step"},
      {"speed_power", "True speeds"},
      {"steps", "Steps over all times"},
      {"time", "Part of the time"},
      {"crease_angle", "Sharp edges above"},
      {"isovalue", "Iso-value"},
      {"labels", "Values are labels"},
      {"materials", "Labels to keep"},
      {"quality", "Quality"},
      {"max_size", "Largest triangles"},
      {"min_size", "Smallest triangles"},
      {"epsilon", "Follow thin parts"},
      {"tighten", "Smooth the voxels"},
      {"remesh", "Repair bad triangles"},
      {"iterations", "Most iterations"},
  };
  const auto found = names.find(knob);
  return found == names.end() ? "" : found->second;
}

const std::vector<std::string>& basic_knobs(const std::string& job) {
  static const std::vector<std::string> flow{"resolution", "ttl",   "streaks", "contrast",
                                             "step_cells", "steps", "time",    "speed_power"};
  static const std::vector<std::string> mesh{"quality",  "labels",  "isovalue", "materials", "max_size",
                                             "min_size", "epsilon", "tighten",  "remesh",    "iterations"};
  return job == "mesh" ? mesh : flow;
}

std::string knob_cost(const std::string& knob, const std::string& job) {
  static std::map<std::pair<std::string, std::string>, std::string> known;
  const auto [at, fresh] = known.try_emplace({knob, job});
  if (fresh) {
    const Settings usual, other = with_other(knob);
    at->second = job == "mesh" ? mesh_cost(mesh_restart(usual, other)) : flow_cost(flow_rerun(usual, other));
  }
  return at->second;
}

}  // namespace nacre
