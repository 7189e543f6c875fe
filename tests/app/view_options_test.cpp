// Nacre: arguments of `nacre view` that are refused before anything is drawn, as those of flow and mesh are.
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

class ViewCommandLine : public ViewTest {
 protected:
  const Arguments start_ = {"view", "--offscreen", "--quiet"};
  std::string path(const std::string& name) const { return (folder / name).string(); }
};

TEST_F(ViewCommandLine, SizesOfParticlesAreInOrder) {
  const Arguments mesh = start_ + Arguments{"--sample", "two-spheres", "--frames-count", "1"};
  const std::string complaint = "--min-size 3 is larger than --max-size 2";
  expect_failure(nacre(mesh + Arguments{"--min-size", "3", "--max-size", "2"}), 2, {complaint});
  std::ofstream(path("s.json")) << R"({"nacre": "session 1", "sample": "two-spheres", "knobs": {"max_size": 2},
                                       "events": [{"time": 1, "knobs": {"min_size": 3}}]})";
  expect_failure(nacre(start_ + Arguments{"--script", path("s.json")}), 2, {"the event at 1 s", complaint});
}

TEST_F(ViewCommandLine, ASessionIsRefusedInTheWindowAsOnTheCommandLine) {
  std::ofstream(path("s.json")) << R"({"nacre": "session 1", "sample": "two-spheres",
                                       "knobs": {"min_size": 3, "max_size": 2}})";
  const Outcome window =
      run("/bin/bash", {source_file("tests/app/view_refused.sh"), program_path, path("s.json"), path("done.json")});
  if (window.status == 77) GTEST_SKIP() << window.err;
  ASSERT_EQ(window.status, 0) << window.err;
  EXPECT_TRUE(contains(window.err, "--min-size 3 is larger than --max-size 2")) << window.err;
  EXPECT_EQ(read_json(folder / "done.json").at("sample"), "sphere") << "what was open stays";
  EXPECT_FALSE(contains(read_json(folder / "done.json").dump(), "two-spheres"));
}

TEST_F(ViewCommandLine, PicturesThatNoFileCanHold) {
  const Arguments flow = start_ + Arguments{"--sample", "sphere"}, large = {"--size", "16384x16384"};
  const std::string limit = "268435455 pixels";
  expect_failure(nacre(flow + large + Arguments{"--image", path("a.png")}), 2, {limit});
  expect_failure(nacre(flow + large + Arguments{"--record", path("frames")}), 2, {limit});
  expect_failure(nacre(flow + large + Arguments{"--record", path("a.mp4")}), 2, {"268 million pixels"});
  std::ofstream(path("s.json"))
      << R"({"nacre": "session 1", "sample": "sphere", "knobs": {"width": 8192, "height": 8192},
                                       "events": [{"time": 1, "screenshot": {"file": "a.png", "scale": 2}}]})";
  expect_failure(nacre(start_ + Arguments{"--script", path("s.json")}), 2, {"the event at 1 s", limit});
  EXPECT_EQ(folder.entries(), 1u);
}

TEST_F(ViewCommandLine, OutputsThatCannotBeWritten) {
  const Arguments mesh = start_ + Arguments{"--sample", "two-spheres"};
  expect_failure(nacre(mesh + Arguments{"--out", path("a.xyz")}), 2, {"a.xyz", ".msh"});
  expect_failure(nacre(start_ + Arguments{"--sample", "sphere", "--out", path("a.ply")}), 2, {"a.ply", ".vtp"});
  for (const char* option : {"--out", "--save-recording", "--save-session"})
    expect_failure(nacre(mesh + Arguments{"--frames-count", "1", option, path("none/a.vtp")}), 1, {"none/a.vtp"});
  EXPECT_EQ(folder.entries(), 0u);
}

TEST_F(ViewCommandLine, LargeLettersAreAnExtensionToo) {
  const Outcome run = nacre(start_ + Arguments{"--sample", "sphere", "--detail", "24", "--resolution", "48", "--steps",
                                               "1", "--out", path("A.VTP")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(fs::exists(path("A.VTP")));
}

TEST_F(ViewCommandLine, FlagsAreThoseOfFlowAndMesh) {
  const Arguments flags = {"--labels", "--curvature", "--no-legend", "--no-time"};
  ASSERT_EQ(nacre(start_ + flags +
                  Arguments{"--sample", "two-spheres", "--detail", "16", "--frames-count", "1", "--save-session",
                            path("s.json")})
                .status,
            0);
  const nlohmann::json knobs = read_json(path("s.json")).at("knobs");
  EXPECT_EQ(knobs.at("labels"), true);
  EXPECT_EQ(knobs.at("curvature"), true);
  EXPECT_EQ(knobs.at("legend"), false);
  EXPECT_EQ(knobs.at("time_stamp"), false);
}

TEST_F(ViewCommandLine, KnobsThatAreOnOrOffAreOptions) {
  const Arguments flags = {"--edges", "--boxes", "--no-play", "--no-curves", "--no-by-density", "--clip-back"};
  const Arguments rest = {"--sample",       "two-spheres", "--detail",       "16",
                          "--frames-count", "1",           "--save-session", path("s.json")};
  ASSERT_EQ(nacre(start_ + flags + rest).status, 0);
  const nlohmann::json knobs = read_json(path("s.json")).at("knobs");
  for (const char* on : {"edges", "boxes", "clip_back", "triangles"}) EXPECT_EQ(knobs.at(on), true) << on;
  for (const char* off : {"play", "curves", "by_density"}) EXPECT_EQ(knobs.at(off), false) << off;
  ASSERT_EQ(nacre(start_ + Arguments{"--edges", "--no-edges"} + rest).status, 0);
  EXPECT_EQ(read_json(path("s.json")).at("knobs").at("edges"), false) << "the last one counts";
}

}  // namespace
}  // namespace nacre::test
