// Nacre: tests of what the program takes: samples, meshes without vectors, series, times.
#include <cmath>

#include "engine/io/surface_writer.hpp"
#include "engine/picture/png.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

class Input : public AppTest {
 protected:
  /// A run that must go well; its report.
  json flow(const Arguments& arguments) {
    last_ = nacre(Arguments{"flow"} + arguments + Arguments{"--report", path("r.json")});
    EXPECT_EQ(last_.status, 0) << last_.err;
    return last_.status == 0 ? json::parse(content("r.json")) : json();
  }

  /// An octahedron with the vectors (-y, x, 0) times `speed`.
  Surface octahedron(float speed) const {
    Surface surface;
    surface.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    surface.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    PointArray velocity{"velocity", 3, {}};
    for (const Vec3d& p : surface.points)
      velocity.values.insert(velocity.values.end(), {-speed * float(p.y), speed * float(p.x), 0});
    surface.arrays.push_back(velocity);
    return surface;
  }

  Outcome last_;
};

const Arguments small_input = {"--resolution", "48", "--steps", "2", "--size", "64x48"};

class EverySample : public AppTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(EverySample, Runs) {
  const Outcome run = nacre({"flow", "--sample", GetParam(), "--detail", "200", "--resolution", "96", "--steps", "2",
                             "--size", "96x72", "--image", path("a.png"), "--quiet"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_EQ(read_png(path("a.png")).width, 96);
}

INSTANTIATE_TEST_SUITE_P(Samples, EverySample,
                         ::testing::Values("sphere", "sphere-rotation", "torus", "train", "aircraft", "cylinder",
                                           "delta-wing", "pulse"));

TEST_F(Input, MeshesWithoutVectorsTakeAnalyticOnes) {
  Surface surface = octahedron(1);
  surface.arrays.clear();
  write_surface(path("o.off"), surface);
  for (const char* field : {"@swirl", "@rotation"}) {
    const json report = flow(small_input + Arguments{path("o.off"), "--vectors", field});
    EXPECT_EQ(report["input"]["vectors"], field);
    EXPECT_EQ(report["input"]["zero_share"].get<double>() < 0.9, true);
  }
  expect_failure(nacre(Arguments{"flow", path("o.off"), "--quiet"} + small_input), 1,
                 {"no vectors", "--vectors @swirl"});
}

TEST_F(Input, SteadyInputIsUnsteadyInputWithOneStep) {
  write_surface(path("o.vtp"), octahedron(2));
  const json report = flow(small_input + Arguments{path("o.vtp"), "--frames", path("f")});
  EXPECT_EQ(report["input"]["time"], json({0.0, 0.0}));
  EXPECT_NE(content("f/frame_0000.png"), content("f/frame_0001.png")) << "the texture still moves";
  // Nothing to stamp: the time stands still.
  flow(small_input + Arguments{path("o.vtp"), "--frames", path("g"), "--no-time"});
  EXPECT_EQ(content("f/frame_0001.png"), content("g/frame_0001.png"));
}

TEST_F(Input, NumberedFilesAreOneSeries) {
  Arguments files;
  for (int k = 0; k < 3; ++k) {
    files.push_back(path("step_" + std::to_string(k) + ".vtp"));
    write_surface(files.back(), octahedron(float(k + 1)), 0.5 * k);
  }
  EXPECT_EQ(flow(small_input + files)["input"]["time"], json({0.0, 1.0}));
}

TEST_F(Input, APartOfTheTime) {
  for (int k = 0; k < 3; ++k) write_surface(path("s" + std::to_string(k) + ".vtp"), octahedron(float(k + 1)), k);
  const Arguments files = small_input + Arguments{path("s0.vtp"), path("s1.vtp"), path("s2.vtp")};
  EXPECT_EQ(flow(files + Arguments{"--time", "0.5:1.5"})["input"]["time"], json({0.5, 1.5}));
  const auto with = [&](const std::string& time) {
    return nacre(Arguments{"flow", "--quiet", "--time", time} + files);
  };
  expect_failure(with("5:6"), 1, {"5:6", "0:2"});
  expect_failure(with("-3:-1"), 1, {"0:2"});
  expect_failure(with("1"), 2, {"--time"});
  expect_failure(with("a:b"), 2, {"--time"});
  expect_failure(with("nan:nan"), 2, {"--time"});
  expect_failure(with("0:inf"), 2, {"--time"});
}

TEST_F(Input, StepsOfOtherTrianglesAreFollowed) {
  Surface other = octahedron(1);
  other.triangles.pop_back();
  write_surface(path("s0.vtp"), octahedron(1), 0);
  write_surface(path("s1.vtp"), other, 1);
  const Outcome run = nacre(Arguments{"flow", path("s0.vtp"), path("s1.vtp"), "--image", path("a.png")} + small_input);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "triangles of the surface change 1 times")) << run.err;
}

TEST_F(Input, AnArrayThatALaterStepLacksIsNamed) {
  Surface bare = octahedron(1);
  bare.arrays.clear();
  write_surface(path("s0.vtp"), octahedron(1), 0);
  write_surface(path("s1.vtp"), bare, 1);
  expect_failure(nacre(Arguments{"flow", "--quiet", path("s0.vtp"), path("s1.vtp")} + small_input), 1, {"velocity"});
}

TEST_F(Input, ColourByAnArray) {
  Surface surface = octahedron(1);
  surface.arrays.push_back({"pressure", 1, {1, 2, 3, 4, 5, 6}});
  write_surface(path("o.vtp"), surface);
  const Arguments arguments = small_input + Arguments{path("o.vtp"), "--no-legend", "--image", path("a.png")};
  flow(arguments + Arguments{"--color", "pressure"});
  const std::string by_pressure = content("a.png");
  flow(arguments + Arguments{"--color", "none"});
  const Image grey = read_png(path("a.png"));
  const std::uint8_t* p = grey.at(32, 24);
  EXPECT_TRUE(p[0] == p[1] && p[1] == p[2]) << "without colours the texture is grey";
  EXPECT_NE(by_pressure, content("a.png"));
}

TEST_F(Input, AFamilyOfArraysIsASeries) {
  NACRE_NEEDS_SHARED_DATA("flow/wind-sphere/wind_sphere_9steps.vtp");
  const fs::path file = shared_data("flow/wind-sphere/wind_sphere_9steps.vtp");
  const json report = flow(small_input + Arguments{file.string(), "--image", path("a.png")});
  EXPECT_LT(report["input"]["time"][0], report["input"]["time"][1]);
  EXPECT_TRUE(contains(last_.err, "vectors: ")) << last_.err;
}

}  // namespace
}  // namespace nacre::test
