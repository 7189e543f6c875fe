// Nacre: the knob table: each row is whole, and values go in and out by name.
#include "engine/scene/settings/knobs.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

TEST(KnobTable, EveryRowIsWhole) {
  Settings settings;
  std::set<std::string> names;
  for (const Knob& knob : knobs(settings)) {
    SCOPED_TRACE(knob.name);
    EXPECT_FALSE(knob.group.empty());
    EXPECT_FALSE(knob.help.empty());
    EXPECT_TRUE(names.insert(knob.name).second) << "there are two";
    for (const std::string& old : knob.old_names) EXPECT_TRUE(names.insert(old).second) << old << " is another's name";
    const bool number = std::holds_alternative<int*>(knob.value) || std::holds_alternative<double*>(knob.value) ||
                        std::holds_alternative<std::uint32_t*>(knob.value);
    EXPECT_EQ(number, knob.min < knob.max) << "a range is for numbers, and each has one";
    if (std::holds_alternative<KnobChoice>(knob.value)) {
      EXPECT_GE(knob.choices.size(), 2u);
    }
    EXPECT_NO_THROW(set_knob(settings, knob.name, knob.text())) << "the default is not allowed";
  }
}

TEST(KnobTable, OldNamesSetTheSameKnob) {
  Settings settings;
  set_knob(settings, "crease", "25");
  EXPECT_EQ(settings.crease_angle, 25);
  set_knob(settings, "crease-angle", "35");
  EXPECT_EQ(settings.crease_angle, 35);
  try {
    set_knob(settings, "crase", "25");
    ADD_FAILURE() << "there is no such knob";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean crease_angle"), std::string::npos) << error.what();
  }
  set_knobs(settings, {{"crease", 45}});
  EXPECT_EQ(settings.crease_angle, 45);
  EXPECT_EQ(knob_values(settings).at("crease_angle"), 45);
  EXPECT_FALSE(knob_values(settings).contains("crease"));
}

TEST(KnobTable, ChoicesOfEnumerationsHaveNames) {
  Settings settings;
  set_knob(settings, "method", "octree");
  set_knob(settings, "octree", "source");
  EXPECT_EQ(settings.flow.method, EmbeddingKind::octree);
  EXPECT_EQ(settings.flow.octree, OctreeKind::thesis);
  EXPECT_EQ(knob_values(settings).at("octree"), "source");
  EXPECT_THROW(set_knob(settings, "method", "sieve"), Error);
  EXPECT_EQ(settings.flow.method, EmbeddingKind::octree) << "a wrong value changes nothing";
}

TEST(KnobTable, WhatIsOnOrOffHasTwoOptions) {
  Settings settings;
  for (const Knob& knob : knobs(settings)) {
    const bool flag = std::holds_alternative<bool*>(knob.value);
    EXPECT_EQ(flag, !knob.off_options().empty()) << knob.name;
  }
  const auto off_options = [&](const std::string& name) {
    for (const Knob& knob : knobs(settings))
      if (knob.name == name) return knob.off_options();
    return std::vector<std::string>();
  };
  EXPECT_EQ(off_options("edges"), std::vector<std::string>{"--no-edges"});
  EXPECT_EQ(off_options("time_stamp"), (std::vector<std::string>{"--no-time", "--no-time-stamp"}));
}

}  // namespace
}  // namespace nacre
