// Nacre: a list of keyframes, made by a user in a window.
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

using LongViewKeyframes = ViewTest;

/// A knob, and a camera on its way; the window films the list, without its panels, as the command films its file.
TEST_F(LongViewKeyframes, AreMadePlayedSavedAndFilmedInAWindow) {
  const Outcome window =
      run("/bin/bash", {source_file("tests/app/view_keyframes.sh"), program_path, (folder / "").string()});
  if (window.status == 77) GTEST_SKIP() << window.err;
  ASSERT_EQ(window.status, 0) << window.err;
  const nlohmann::json list = read_json(folder / "list.json");
  ASSERT_EQ(list.at("events").size(), 2u);
  EXPECT_EQ(list.at("events")[0].at("time"), 2);
  EXPECT_EQ(list.at("events")[0].at("knobs"), (nlohmann::json{{"edges", true}}));
  EXPECT_EQ(list.at("events")[1].at("time"), 2);
  EXPECT_EQ(list.at("events")[1].at("over"), 2);
  EXPECT_NE(list.at("events")[1].at("camera"), list.at("camera"));
  EXPECT_EQ(list.at("duration"), 4);

  const std::string again = (folder / "again.mp4").string();
  const Outcome played =
      nacre({"view", "--offscreen", "--quiet", "--script", (folder / "list.json").string(), "--record", again});
  ASSERT_EQ(played.status, 0) << played.err;
  const auto frames = [](const std::string& video) {  // without the line that says how it was made
    return run("/usr/bin/env", {"ffmpeg", "-loglevel", "error", "-i", video, "-f", "framemd5", "-"}).out;
  };
  const std::string filmed = frames((folder / "list.mp4").string());
  EXPECT_TRUE(contains(filmed, "MD5")) << filmed;
  EXPECT_EQ(filmed, frames(again));
}

}  // namespace
}  // namespace nacre::test
