// Nacre: what runs again when a knob is changed in the viewer.
#if NACRE_HAS_VIEWER

#include <gtest/gtest.h>

#include "app/viewer/flow_rerun.hpp"

namespace nacre {
namespace {

template <class Change>
FlowRerun after(const Change& change) {
  FlowParameters parameters;
  change(parameters);
  return flow_rerun(FlowParameters(), parameters);
}

TEST(FlowRerun, EachKnobBeginsWhereItIsUsed) {
  using P = FlowParameters;
  EXPECT_EQ(after([](P&) {}), FlowRerun::nothing);
  EXPECT_EQ(after([](P& p) { p.contrast = 0.1; }), FlowRerun::steps);
  EXPECT_EQ(after([](P& p) { p.sharpen = 0.1; }), FlowRerun::steps);
  EXPECT_EQ(after([](P& p) { p.jitter = 0.1; }), FlowRerun::steps);
  EXPECT_EQ(after([](P& p) { p.equalise = 0.1; }), FlowRerun::steps);
  EXPECT_EQ(after([](P& p) { p.ttl = 7; }), FlowRerun::start);
  EXPECT_EQ(after([](P& p) { p.steps = 7; }), FlowRerun::start);
  EXPECT_EQ(after([](P& p) { p.warmup = 7; }), FlowRerun::start);
  EXPECT_EQ(after([](P& p) { p.seed = 7; }), FlowRerun::start);
  EXPECT_EQ(after([](P& p) { p.step_cells = 7; }), FlowRerun::start);
  EXPECT_EQ(after([](P& p) { p.speed_power = 0.7; }), FlowRerun::start);
  EXPECT_EQ(after([](P& p) { p.resolution = 64; }), FlowRerun::embed);
  EXPECT_EQ(after([](P& p) { p.refine = 2; }), FlowRerun::embed);
  EXPECT_EQ(after([](P& p) { p.subcells = 5; }), FlowRerun::embed);
  EXPECT_EQ(after([](P& p) { p.radius = 6; }), FlowRerun::embed);
  EXPECT_EQ(after([](P& p) { p.method = "octree"; }), FlowRerun::embed);
}

TEST(FlowRerun, TheEarliestStageCounts) {
  EXPECT_EQ(after([](FlowParameters& p) { p.contrast = 0.1, p.resolution = 64, p.ttl = 2; }), FlowRerun::embed);
  EXPECT_EQ(after([](FlowParameters& p) { p.contrast = 0.1, p.ttl = 2; }), FlowRerun::start);
}

}  // namespace
}  // namespace nacre

#endif
