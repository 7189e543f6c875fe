// Nacre: spots and stripes through the program: pictures, values, videos in time, and what they are not offered with.
#include <cmath>
#include <span>

#include "engine/io/registry.hpp"
#include "engine/io/vtp_writer.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

/// A small run on few cells, of a pattern with several spots among them.
Arguments small_pattern(const std::string& sample) {
  return {"flow",     "--sample", sample,    "--detail",          "24", "--resolution", "64",   "--steps", "2",
          "--refine", "2",        "--quiet", "--pattern-spacing", "12", "--size",       "96x72"};
}

/// Standard deviation of the values of a file, which are in 0..1.
double deviation(const std::string& file) {
  double sum = 0, squares = 0, count = 0;
  for (const RawArray& array : read_raw(file).mesh.point_arrays)
    if (array.name == "value")
      for (const double v : array.values) {
        EXPECT_TRUE(v >= 0 && v <= 1) << v;
        sum += v;
        squares += v * v;
        count += 1;
      }
  return std::sqrt(squares / count - sum / count * (sum / count));
}

class Pattern : public AppTest {};

TEST_F(Pattern, PictureValuesAndReport) {
  for (const char* texture : {"spots", "stripes"}) {
    const Outcome run =
        nacre(small_pattern("sphere") + Arguments{"--texture", texture, "--image", path(std::string(texture) + ".png"),
                                                  "--out", path("v.vtp"), "--report", path("r.json")});
    ASSERT_EQ(run.status, 0) << run.err;
    const json report = read_json("r.json");
    EXPECT_EQ(report["parameters"]["texture"], texture);
    EXPECT_TRUE(contains(report["stages"].dump(), "react")) << report["stages"];
    EXPECT_GT(deviation(path("v.vtp")), 0.05) << "a pattern, and no plain surface";
  }
  EXPECT_NE(content("spots.png"), content("stripes.png"));
}

TEST_F(Pattern, FollowsVectorsInTime) {
  ASSERT_EQ(nacre(small_pattern("torus") + Arguments{"--texture", "spots", "--frames", path("f")}).status, 0);
  EXPECT_NE(content("f/frame_0000.png"), content("f/frame_0001.png"));
}

TEST_F(Pattern, OneThreadOrFourMakeTheSameBytes) {
  for (const char* threads : {"1", "4"})
    ASSERT_EQ(nacre(small_pattern("sphere") +
                    Arguments{"--texture", "spots", "--threads", threads, "--out", path(std::string(threads) + ".vtp")})
                  .status,
              0);
  EXPECT_EQ(bare("1.vtp"), bare("4.vtp"));
}

TEST_F(Pattern, WhatIsNotOfferedIsRefusedWithAdvice) {
  const auto refused = [&](const std::string& sample, const Arguments& arguments, const Arguments& parts) {
    expect_failure(nacre(small_pattern(sample) + Arguments{"--texture", "spots", "--image", path("p.png")} + arguments),
                   1, parts);
    EXPECT_FALSE(exists("p.png"));
  };
  refused("sphere", {"--method", "octree"}, {"--texture spots", "--method grid"});
  refused("sphere", {"--chunk", "1/2"}, {"--chunk", "--texture streaks"});
  refused("sphere", {"--refine", "4"}, {"--pattern-spacing 12 is too small", "use 20 or more", "--refine"});
  refused("sphere", {"--radius", "4"}, {"--radius 4 is too small", "5.2"});
  refused("pulse", {}, {"--texture", "does not move", "streaks"});
}

TEST_F(Pattern, VectorsOfZeroMakeRoundSpotsAndAWarning) {
  Surface square;
  square.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.arrays.push_back({"velocity", 3, std::vector<float>(12, 0.0f)});
  write_vtp(path("s.vtp"), std::span<const Vec3d>(square.points), square.triangles, square.arrays);
  const Outcome run = nacre({"flow", path("s.vtp"), "--resolution", "64", "--steps", "1", "--refine", "2",
                             "--pattern-spacing", "12", "--texture", "spots", "--out", path("v.vtp")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "spots will be round")) << run.err;
  EXPECT_GT(deviation(path("v.vtp")), 0.05);
}

}  // namespace
}  // namespace nacre::test
