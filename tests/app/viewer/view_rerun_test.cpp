// Nacre: what runs again when a knob is changed in the viewer.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "app/viewer/flow/flow_rerun.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

using enum FlowStage;

/// Every knob that a flow can have, and what it makes run again.
const std::map<std::string, FlowRerun>& expected() {
  static const std::map<std::string, FlowRerun> table{
      {"method", {embed, start}},
      {"octree", {embed, start}},
      {"neighbour_index", {embed, start}},
      {"resolution", {embed, start}},
      {"refine", {embed, start}},
      {"subcells", {embed, start}},
      {"radius", {embed, start}},
      {"crease_angle", {surface, embed, start}},
      {"patch", {surface, embed, start}},
      {"vectors", {vectors, start}},
      {"relative", {vectors, start}},
      {"surface_velocity", {vectors, start}},
      {"period", {vectors, start}},
      {"time", {start}},
      {"begin_at", {start}},
      {"texture", {embed, start}},
      {"pattern_spacing", {start}},
      {"pattern_stretch", {start}},
      {"ttl", {start}},
      {"steps", {start}},
      {"step_cells", {start}},
      {"speed_power", {start}},
      {"warmup", {start}},
      {"seed", {start}},
      {"sharpen", {step}},
      {"jitter", {step}},
      {"equalise", {step}},
      {"streaks", {step}},
      {"contrast", {step}},
      {"color", {colours}},
      {"arrows", {arrows}},
      {"arrow_count", {arrows}},
      // These are of the picture: they are drawn otherwise, and nothing runs again.
      {"colormap", {}},
      {"color_range", {}},
      {"color_symmetric", {}},
      {"color_scale", {}},
      {"color_below", {}},
      {"color_above", {}},
      {"color_nan", {}},
      {"back_faces", {}},
      {"legend", {}},
      {"time_stamp", {}},
      {"focus", {}},
      {"orbit", {}},
      {"fps", {}},
      {"topology", {lines}},
      {"persistence", {}},  // of lines that are off
      {"streamlines", {lines}},
      {"ftle_time", {}},  // of exponents that are not shown
      {"dye", {dyes}},
      {"dye_release", {}},  // of dyes that there are not
      {"dye_diffusion", {}},
      {"dye_regions", {}},
      {"tracks", {lines}},
      {"probe", {probes}},
      {"line_spacing", {}},
  };
  return table;
}

/// The same with one knob at another value.
Settings with_changed(const std::string& name) {
  Settings settings;
  for (const Knob& knob : knobs(settings)) {
    if (knob.name != name) continue;
    if (auto* const* flag = std::get_if<bool*>(&knob.value)) **flag = !**flag;
    if (auto* const* real = std::get_if<double*>(&knob.value))
      **real = 0.5 * (**real + (**real < knob.max ? knob.max : knob.min));
    if (auto* const* whole = std::get_if<int*>(&knob.value)) ++**whole;
    if (auto* const* number = std::get_if<std::uint32_t*>(&knob.value)) ++**number;
    if (const auto* choice = std::get_if<KnobChoice>(&knob.value))
      choice->set(choice->member, 1 - choice->get(choice->member));
    if (auto* const* word = std::get_if<std::string*>(&knob.value))
      **word = knob.choices.empty() ? "other" : **word == knob.choices[0] ? knob.choices[1] : knob.choices[0];
  }
  return settings;
}

TEST(FlowRerun, EachKnobBeginsWhereItIsUsed) {
  for (const auto& [name, stages] : expected()) {
    const Settings changed = with_changed(name);
    EXPECT_NE(knob_values(changed), knob_values(Settings())) << name;
    EXPECT_TRUE(flow_rerun(Settings(), changed) == stages) << name;
    EXPECT_TRUE(flow_rerun(changed, Settings()) == stages) << name;
  }
}

TEST(FlowRerun, NoKnobIsForgotten) {
  const std::set<std::string> of_flow{"embedding", "flow", "general", "colours", "frames"};
  Settings settings;
  for (const Knob& knob : knobs(settings)) {
    if (of_flow.count(knob.group) > 0) {
      EXPECT_EQ(expected().count(knob.name), 1u) << knob.name << " is not classified";
    } else if (expected().count(knob.name) == 0) {
      EXPECT_TRUE(flow_rerun(Settings(), with_changed(knob.name)) == FlowRerun()) << knob.name;
    }
  }
}

TEST(FlowRerun, LinesFollowTheFieldWhileTheyAreShown) {
  Settings shown;
  shown.topology = true;
  Settings after = shown;
  after.persistence = 0.3;
  EXPECT_TRUE(flow_rerun(shown, after) == FlowRerun({lines}));
  after = shown;
  after.vectors = "other";
  EXPECT_TRUE(flow_rerun(shown, after) == FlowRerun({vectors, lines, start}));
  after = shown;
  after.flow.ttl = 2;
  EXPECT_TRUE(flow_rerun(shown, after) == FlowRerun({start}));
}

TEST(FlowRerun, DyesAndExponentsFollowTheirKnobsWhileTheyAreShown) {
  Settings dyed;
  dyed.dye = "0,0,0,1";
  Settings after = dyed;
  after.dye_release = DyeRelease::always;
  EXPECT_TRUE(flow_rerun(dyed, after) == FlowRerun({dyes}));
  EXPECT_TRUE(flow_rerun(dyed, Settings()) == FlowRerun({dyes}));
  Settings stretched;
  stretched.color = "ftle";
  after = stretched;
  after.ftle_time = 2;
  EXPECT_TRUE(flow_rerun(stretched, after) == FlowRerun({colours}));
  after = stretched;
  after.vectors = "other";
  EXPECT_TRUE(flow_rerun(stretched, after) == FlowRerun({vectors, colours, start}));
}

TEST(FlowRerun, ChangesAddUp) {
  Settings after;
  after.flow.contrast = 0.1;
  after.flow.ttl = 2;
  after.color = "none";
  EXPECT_TRUE(flow_rerun(Settings(), after) == FlowRerun({colours, start, step}));
  EXPECT_TRUE(flow_rerun(after, after) == FlowRerun());
}

}  // namespace
}  // namespace nacre
