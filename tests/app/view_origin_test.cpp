// Nacre: what pictures and results of the viewer say of how they were made, and sessions opened from them.
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

class ViewOrigin : public ViewTest {
 protected:
  std::string path(const std::string& name) const { return (folder / name).string(); }

  const Arguments view = {"view",         "--offscreen", "--quiet", "--sample", "torus", "--detail", "48",
                          "--resolution", "64",          "--size",  "120x90",   "--ttl", "6"};
};

TEST_F(ViewOrigin, APictureOfCountedFramesIsMadeAgain) {
  ASSERT_EQ(nacre(view + Arguments{"--steps", "3", "--image", path("a.png")}).status, 0);
  const Outcome again = nacre({"rerun", path("a.png"), "--quiet"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(again.out, path("a.png") + ": the same\n");
}

TEST_F(ViewOrigin, AMeshIsMadeAgainByTheCommand) {
  ASSERT_EQ(nacre({"view", "--offscreen", "--quiet", "--sample", "ellipsoid", "--isovalue", "0.5", "--max-size", "6",
                   "--min-size", "3", "--out", path("a.vtp")})
                .status,
            0);
  const Outcome again = nacre({"rerun", path("a.vtp"), "--quiet"});
  EXPECT_EQ(again.status, 0) << again.err;
}

/// A script moves the camera and changes a knob; its screenshot cannot be made again alone, but is a session.
TEST_F(ViewOrigin, AScreenshotIsASession) {
  std::ofstream(folder / "tour.json") << R"({"sample": "torus", "detail": 48,
    "knobs": {"resolution": 64, "width": 120, "height": 90, "fps": 10, "panel": false},
    "events": [{"time": 0.2, "camera": {"eye": [0, -9, 2], "target": [0, 0, 0], "height": 3}, "knobs": {"ttl": 9}},
               {"time": 0.3, "screenshot": {"file": "shot.png"}}], "duration": 0.4})";
  ASSERT_EQ(nacre({"view", "--offscreen", "--quiet", "--script", path("tour.json")}).status, 0);
  const Outcome again = nacre({"rerun", path("shot.png"), "--quiet"});
  EXPECT_EQ(again.status, 1);
  EXPECT_TRUE(contains(again.err, "view --session")) << again.err;
  const Outcome flow = nacre({"flow", "--quiet", "--session", path("shot.png"), "--steps", "2", "--image",
                              path("b.png"), "--save-session", path("shot.json"), "--report", path("r.json")});
  ASSERT_EQ(flow.status, 0) << flow.err;
  const nlohmann::json session = read_json(folder / "shot.json");
  EXPECT_EQ(session.at("sample"), "torus");
  EXPECT_EQ(session.at("knobs").at("ttl"), 9);
  EXPECT_EQ(session.at("knobs").at("play"), false) << "stopped at the time that was seen";
  EXPECT_GT(session.at("knobs").at("begin_at"), 0);
  EXPECT_EQ(session.at("camera").at("eye"), nlohmann::json({0.0, -9.0, 2.0}));
  ASSERT_EQ(nacre({"view", "--offscreen", "--quiet", "--session", path("r.json"), "--frames-count", "1", "--image",
                   path("c.png")})
                .status,
            0)
      << "a report is one, too";
}

TEST_F(ViewOrigin, APictureFromElsewhereIsNoSession) {
  std::ofstream(folder / "other.png") << "\x89PNG\r\n\x1a\n";
  const Outcome outcome =
      nacre({"view", "--offscreen", "--quiet", "--session", path("other.png"), "--image", path("a.png")});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "other.png is not a session")) << outcome.err;
}

}  // namespace
}  // namespace nacre::test
