// Nacre: arguments of knobs for people. No OpenGL here.
#include "app/viewer/panel/knob_names.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

TEST(KnobNames, BasicKnobsAreKnobsOfTheirJobAndHavePlainNames) {
  Settings settings;
  const std::vector<Knob> table = knobs(settings);
  for (const char* job : {"flow", "mesh"}) {
    EXPECT_GE(basic_knobs(job).size(), 5u);
    for (const std::string& name : basic_knobs(job)) {
      const auto knob = std::find_if(table.begin(), table.end(), [&](const Knob& k) { return k.name == name; });
      ASSERT_NE(knob, table.end()) << name;
      EXPECT_TRUE(knob->concerns(job)) << name;
      EXPECT_NE(plain_name(name), "") << name;
    }
  }
  EXPECT_EQ(plain_name("theta"), "");
}

TEST(KnobNames, CostsAreThoseOfWhatRunsAgain) {
  EXPECT_NE(knob_cost("resolution", "flow").find("grid"), std::string::npos);
  EXPECT_NE(knob_cost("ttl", "flow").find("restarts the texture"), std::string::npos);
  EXPECT_NE(knob_cost("contrast", "flow").find("next step"), std::string::npos);
  EXPECT_NE(knob_cost("colormap", "flow").find("at once"), std::string::npos);
  EXPECT_NE(knob_cost("epsilon", "mesh").find("fields"), std::string::npos);
  EXPECT_NE(knob_cost("theta", "mesh").find("particles"), std::string::npos);
}

}  // namespace
}  // namespace nacre
