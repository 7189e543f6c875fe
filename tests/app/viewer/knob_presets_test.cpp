// Nacre: tests of presets.
#include "app/viewer/panel/knob_presets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/viewer/scene/view_defaults.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

TEST(KnobPresets, ThoseOfTheProgramNameKnobsOfTheirJob) {
  EXPECT_GE(built_in_presets().size(), 9u);
  for (const KnobPreset& preset : built_in_presets()) {
    Settings settings = view_defaults();
    ASSERT_NO_THROW(apply_preset(preset, settings)) << preset.name;
    const std::vector<Knob> table = knobs(settings);
    for (const auto& [name, value] : preset.knobs) {
      const auto knob = std::find_if(table.begin(), table.end(), [&](const Knob& k) { return k.name == name; });
      ASSERT_NE(knob, table.end()) << name;
      EXPECT_TRUE(knob->concerns(preset.job)) << name;
    }
  }
}

TEST(KnobPresets, StandardIsAsTheViewerBegins) {
  for (const KnobPreset& preset : built_in_presets())
    if (preset.name == "standard") {
      Settings settings = view_defaults();
      apply_preset(preset, settings);
      EXPECT_EQ(knob_values(settings), knob_values(view_defaults())) << preset.job;
    }
}

TEST(KnobPresets, WhatIsSavedIsOfferedAgainWithoutWhatNamesTheData) {
  const test::TemporaryFolder folder;
  KnobPresets presets(folder / "presets");
  Settings settings = view_defaults();
  settings.flow.ttl = 7;
  settings.vectors = "velocity";
  presets.save("long lines", "flow", settings);
  const std::vector<KnobPreset> flow = KnobPresets(folder / "presets").of("flow");
  ASSERT_FALSE(flow.empty());
  EXPECT_EQ(flow.back().name, "long lines");
  EXPECT_EQ(flow.back().knobs, (std::map<std::string, std::string>{{"ttl", "7"}}));
  for (const KnobPreset& preset : presets.of("mesh")) EXPECT_NE(preset.name, "long lines");
  EXPECT_THROW(presets.save("../a", "flow", settings), Error);
  std::ofstream(folder / "presets/broken.json") << "{";
  EXPECT_EQ(KnobPresets(folder / "presets").of("flow").size(), flow.size());
}

TEST(KnobPresets, OneThatDoesNotFitChangesNothing) {
  Settings settings = view_defaults();
  EXPECT_THROW(apply_preset({"x", "flow", "", {{"contrast", "0.2"}, {"ttl", "99"}}}, settings), Error);
  EXPECT_EQ(knob_values(settings), knob_values(view_defaults()));
}

}  // namespace
}  // namespace nacre
