// Nacre: the picture of a close-up is computed at the picture's resolution.
#include <nlohmann/json.hpp>

#include "engine/picture/png.hpp"
#include "tests/app/program.hpp"
#include "tests/evidence/crispness.hpp"

namespace nacre::test {
namespace {

class FocusTest : public AppTest {
 protected:
  /// A camera that looks at the sphere's side; `height` of the picture, of 2 that the sphere has.
  void look(double height, bool orthographic = true, const std::string& eye = "[6, 0, 0.3]",
            const std::string& target = "[0, 0, 0.3]") {
    write("camera.json", R"({"eye": )" + eye + R"(, "target": )" + target + R"(, "up": [0, 0, 1], "height": )" +
                             std::to_string(height) + R"(, "orthographic": )" + (orthographic ? "true" : "false") +
                             "}");
  }

  Outcome draw(const Arguments& arguments) {
    return nacre(
        Arguments{"flow",    "--sample",    "sphere",   "--detail",          "64",       "--resolution",     "96",
                  "--steps", "4",           "--camera", path("camera.json"), "--size",   "320x240",          "--color",
                  "none",    "--no-legend", "--image",  path("a.png"),       "--report", path("report.json")} +
        arguments);
  }

  nlohmann::json report() { return nlohmann::json::parse(content("report.json")); }

  Crispness drawn() {
    const Image image = read_png(path("a.png"));
    return crispness(image.pixels, image.width, image.height);
  }
};

using LongFocusTest = FocusTest;

TEST_F(LongFocusTest, ACloseUpIsAsSharpAsTheWhole) {
  look(2.4);
  ASSERT_EQ(draw({"--resolution", "240"}).status, 0);
  EXPECT_FALSE(report().contains("focus"));
  const Crispness whole = drawn();
  for (const double zoom : {8.0, 64.0})
    for (const std::string method : {"grid", "octree"}) {
      look(2.4 / zoom);
      ASSERT_EQ(draw({"--method", method}).status, 0);
      ASSERT_TRUE(report().contains("focus"));
      EXPECT_NEAR(report()["focus"]["cells_per_pixel"].get<double>(), 1, 0.05);
      EXPECT_LT(report()["focus"]["triangles"].get<int>(), report()["input"]["triangles"].get<int>() / 4);
      const Crispness close = drawn();
      EXPECT_LT(close.across, 1.3) << zoom << ' ' << method << ": pixels";
      EXPECT_GT(close.contrast, 0.7 * whole.contrast) << zoom << ' ' << method;
      ASSERT_EQ(draw({"--method", method, "--no-focus"}).status, 0);
      EXPECT_FALSE(report().contains("focus"));
      EXPECT_LT(drawn().contrast, 0.7 * close.contrast) << "cells larger than pixels are a blur";
    }
}

TEST_F(FocusTest, WithPerspectiveToo) {
  look(0.3, false, "[3, 0, 0.3]", "[1, 0, 0.3]");
  ASSERT_EQ(draw({}).status, 0);
  ASSERT_TRUE(report().contains("focus"));
  const Image image = read_png(path("a.png"));
  for (int y = 0; y < image.height; y += 7)
    for (int x = 0; x < image.width; x += 7)
      EXPECT_LT(image.at(x, y)[1], 255) << x << ' ' << y << " the surface covers it";
}

TEST_F(FocusTest, IsTheSameOnAnyNumberOfThreads) {
  look(0.2);
  ASSERT_EQ(draw({"--threads", "1"}).status, 0);
  const std::string one = content("a.png");
  ASSERT_EQ(draw({"--threads", "2"}).status, 0);
  EXPECT_EQ(content("a.png"), one);
}

TEST_F(FocusTest, ValuesAreThoseOfTheWholeSurface) {
  look(0.2);
  const Outcome with = draw({"--out", path("a.vtp")});
  ASSERT_EQ(with.status, 0);
  EXPECT_NE(with.err.find("--out needs the whole surface"), std::string::npos) << with.err;
  EXPECT_FALSE(report().contains("focus"));
}

TEST_F(FocusTest, ViewsThatShowNothingOrStandInsideAreDrawn) {
  look(0.2, true, "[6, 0, 40]", "[0, 0, 40]");
  ASSERT_EQ(draw({}).status, 0) << "past it";
  EXPECT_FALSE(report().contains("focus"));
  look(0.2, false, "[0, 0, 0]", "[1, 0, 0]");
  ASSERT_EQ(draw({}).status, 0) << "from within";
  look(1e-5, false, "[1.0001, 0, 0]", "[1, 0, 0]");
  ASSERT_EQ(draw({}).status, 0) << "so near that no resolution is fine enough";
}

}  // namespace
}  // namespace nacre::test
