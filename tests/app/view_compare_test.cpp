// Nacre: two views side by side: alike where nothing differs, at the same time, and refused where they mean nothing.
#include <algorithm>

#include "engine/picture/png.hpp"
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

constexpr int half = 200, gap = 2, height = 200;  // the picture is 402 x 200

/// How many pixels of the two halves differ, of those in the box from the left upper corner of a half.
int different(const Image& image, int x0, int y0, int wide, int high) {
  int count = 0;
  for (int y = y0; y < y0 + high; ++y)
    for (int x = x0; x < x0 + wide; ++x)
      count += !std::equal(image.at(x, y), image.at(x, y) + 3, image.at(x + half + gap, y));
  return count;
}

int different(const Image& image) { return different(image, 0, 0, half, height); }

class Compared : public ViewTest {
 protected:
  Arguments arguments(const std::string& knobs) const {
    return {"view",
            "--offscreen",
            "--sample",
            "torus",
            "--detail",
            "48",
            "--resolution",
            "64",
            "--size",
            "402x200",
            "--steps",
            "4",
            "--quiet",
            "--set",
            "compare=same",
            "--set",
            "compare_knobs=" + knobs};
  }
  Image picture(const std::string& knobs) {
    const fs::path file = folder / "compared.png";
    const Outcome outcome = nacre(arguments(knobs) + Arguments{"--image", file.string()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_png(file);
  }
};

/// But for the rounding of the rasteriser, which depends on where in a frame something is drawn.
TEST_F(Compared, WithoutADifferenceBothHalvesAreTheSame) { EXPECT_LT(different(picture("")), half * height / 1000); }

TEST_F(Compared, ADifferentKnobIsSeenInOneOfThem) {
  EXPECT_GT(different(picture("streaks=0")), half * height / 20);
  EXPECT_GT(different(picture("color=none")), half * height / 5);
}

/// The first view goes on while the second begins again with its new knobs: both stamps say the same time.
TEST_F(Compared, TimesStayTogetherWhereOneBeginsAgain) {
  const fs::path script = folder / "compare.json", late = folder / "late.png";
  std::ofstream(script) << R"({"sample": "torus", "detail": 48,
    "knobs": {"resolution": 64, "width": 402, "height": 200, "fps": 10, "steps": 20, "compare": "same", "color": "none",
              "panel": false},
    "events": [{"time": 0.3, "knobs": {"compare_knobs": "ttl=9"}}, {"time": 0.6, "knobs": {"compare_knobs": ""}}],
    "duration": 1})";
  const Outcome outcome =
      nacre({"view", "--offscreen", "--script", script.string(), "--quiet", "--image", late.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(different(read_png(late), 0, height - 24, 60, 24), 0) << "the stamps";
}

TEST_F(Compared, WhatMeansNothingIsAWrongCommandLine) {
  for (const char* knobs : {"tlt=4", "ttl=many", "width=10"}) {
    const Outcome outcome = nacre(arguments(knobs) + Arguments{"--image", (folder / "x.png").string()});
    EXPECT_EQ(outcome.status, 2) << knobs;
    EXPECT_TRUE(contains(outcome.err, "compare_knobs") || contains(outcome.err, "ttl")) << outcome.err;
  }
}

TEST_F(Compared, AMeshBesideAFlowAndAMissingFileIsSaid) {
  const fs::path file = folder / "both.png";
  Arguments mesh = arguments("max_size=4");
  mesh[mesh.size() - 3] = "compare=sample:two-spheres:16";
  EXPECT_EQ(nacre(mesh + Arguments{"--image", file.string()}).status, 0);
  mesh[mesh.size() - 3] = "compare=missing.vtp";
  const Outcome missing = nacre(mesh + Arguments{"--image", file.string()});
  EXPECT_EQ(missing.status, 1);
  EXPECT_TRUE(contains(missing.err, "missing.vtp")) << missing.err;
}

}  // namespace
}  // namespace nacre::test
