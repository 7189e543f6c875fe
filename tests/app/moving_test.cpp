// Nacre: tests of surfaces that move, through the program: samples, real data, bad steps, outputs.
#include <cmath>

#include "engine/io/reader.hpp"
#include "engine/io/registry.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/picture/png.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

const Arguments small_moving = {"--resolution", "64", "--steps", "4", "--size", "96x72"};

class Moving : public AppTest {
 protected:
  json flow(const Arguments& arguments) {
    last_ = nacre(Arguments{"flow"} + arguments + Arguments{"--report", path("r.json")});
    EXPECT_EQ(last_.status, 0) << last_.err;
    return last_.status == 0 ? json::parse(content("r.json")) : json();
  }
  std::string said() const { return last_.out + last_.err; }
  Outcome last_;
};

TEST_F(Moving, TheSampleIsFollowedByPicturesAndValues) {
  for (const char* method : {"grid", "octree"}) {
    const json report = flow(small_moving + Arguments{"--sample", "pulse", "--detail", "24", "--method", method,
                                                      "--frames", path("f"), "--out", path("v.vtp")});
    EXPECT_TRUE(contains(said(), "the surface moves: 20 shapes of the same triangles")) << said();
    EXPECT_TRUE(contains(said(), "velocity is shown relative to the surface")) << said();
    EXPECT_EQ(report["motion"]["groups"], 1);
    EXPECT_NE(content("f/frame_0000.png"), content("f/frame_0003.png"));
    // The last frame is at time 0.95: nearly round, and 1.25 high.
    double highest = 0;
    for (const Vec3d& p : read_raw(path("v.vtp")).mesh.points) highest = std::max(highest, p.z);
    EXPECT_NEAR(highest, 1.25 * (1 + 0.08 * std::sin(2 * 3.14159265 * 0.95)), 0.05);
  }
}

TEST_F(Moving, WhatIsRelativeIsDecidedAloud) {
  const Arguments pulse = small_moving + Arguments{"--sample", "pulse", "--detail", "24"};
  const json automatic = flow(pulse), off = flow(pulse + Arguments{"--relative", "off"});
  EXPECT_TRUE(contains(said(), "is shown as it is, not relative")) << said();
  EXPECT_LT(automatic["input"]["reference_speed"].get<double>(), off["input"]["reference_speed"].get<double>());
  flow(pulse + Arguments{"--surface-velocity", "velocity"});
  EXPECT_TRUE(contains(said(), "moves with the surface: relative to it, it is slower")) << said();
  expect_failure(nacre(Arguments{"flow", "--quiet", "--surface-velocity", "nothing"} + pulse), 1,
                 {"--surface-velocity", "nothing"});
  expect_failure(
      nacre(Arguments{"flow", "--quiet", "--sample", "torus", "--detail", "24", "--relative", "on"} + small_moving), 1,
      {"--relative", "not known"});
}

TEST_F(Moving, ACycleComesRound) {
  const Arguments pulse = small_moving + Arguments{"--sample", "pulse", "--detail", "24"};
  EXPECT_EQ(flow(pulse + Arguments{"--period", "1"})["input"]["time"], json({0.0, 1.0}));
  EXPECT_EQ(flow(pulse + Arguments{"--period", "1", "--time", "0.5:0.9"})["input"]["time"], json({0.5, 0.9}));
  expect_failure(nacre(Arguments{"flow", "--quiet", "--period", "0.4"} + pulse), 1, {"--period", "shorter"});
}

TEST_F(Moving, MeansOverTimeAreWrittenAndShown) {
  const json report =
      flow(small_moving + Arguments{"--sample", "pulse", "--detail", "24", "--period", "1", "--haemodynamics",
                                    path("h.vtp"), "--color", "OSI", "--image", path("osi.png")});
  EXPECT_EQ(report["outputs"], json({path("h.vtp"), path("osi.png")}));
  const Surface means = open_surface({path("h.vtp")}).load(0);
  for (const char* name : {"TAWSS", "OSI", "RRT"}) ASSERT_NE(means.find(name), nullptr) << name;
  for (std::size_t i = 0; i < means.points.size(); ++i) {
    const float osi = means.find("OSI")->values[i], tawss = means.find("TAWSS")->values[i];
    ASSERT_GE(osi, 0);
    ASSERT_LE(osi, 0.5f);
    ASSERT_NEAR(means.find("RRT")->values[i] * (1 - 2 * osi) * tawss, 1, 1e-3);
  }
}

TEST_F(Moving, StepsThatCannotBeTrueAreLeftOut) {
  const SurfaceSeries pulse = make_sample("pulse", 16);
  Arguments files;
  for (std::size_t k = 0; k < 5; ++k) {
    Surface s = pulse.load(k);
    if (k == 2)
      for (Vec3d& p : s.points) p *= 1000;
    files.push_back(path("step_" + std::to_string(k) + ".vtp"));
    write_surface(files.back(), s, 0.1 * double(k));
  }
  flow(small_moving + files + Arguments{"--image", path("a.png")});
  EXPECT_TRUE(contains(said(), "step 2 (time 0.2) is left out: the surface is 1.02e+03 times as large")) << said();
}

TEST_F(Moving, RealDataAreFollowed) {
  NACRE_NEEDS_SHARED_DATA("flow/can-moving");
  const fs::path data = shared_data("flow");
  Arguments can, atrium;
  for (const int k : {0, 5, 10, 15, 20, 25, 30, 35, 40})
    can.push_back(data / "can-moving" / ("can_" + std::to_string(k) + ".vtp"));
  for (int k = 0; k < 20; ++k)
    atrium.push_back(data / "atrium-moving" /
                     ("model_moved_" + std::string(k < 10 ? "0" : "") + std::to_string(k) + ".vtp"));
  const json crushed = flow(small_moving + can + Arguments{"--image", path("can.png")});
  EXPECT_TRUE(contains(said(), "9 shapes of the same triangles")) << said();
  EXPECT_TRUE(contains(said(), "DISPL is shown as it is")) << said();
  EXPECT_EQ(crushed["motion"]["groups"], 1);
  const json beating = flow(small_moving + atrium + Arguments{"--vectors", "@swirl", "--method", "octree"});
  EXPECT_TRUE(contains(said(), "flows on the material")) << said();
  EXPECT_EQ(beating["motion"]["groups"], 1);
}

}  // namespace
}  // namespace nacre::test
