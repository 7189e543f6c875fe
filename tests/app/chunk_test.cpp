// Nacre: a run in parts (`--chunk`), whose frames are those of the whole run, and the video that `nacre join` makes.
#include "engine/picture/video.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

const Arguments unsteady = {"flow", "--sample", "torus", "--detail", "24",    "--resolution",
                            "64",   "--steps",  "7",     "--size",   "64x48", "--quiet"};

class Chunk : public AppTest {
 protected:
  Outcome part(const std::string& which, const std::string& folder) const {
    return nacre(unsteady + Arguments{"--chunk", which, "--frames", path(folder), "--report", path("report.json")});
  }
  std::string frame(const std::string& folder, int number) const {
    return content(folder + "/frame_000" + std::to_string(number) + ".png");
  }
};

TEST_F(Chunk, PartsInOneFolderAreTheWholeRun) {
  ASSERT_EQ(nacre(unsteady + Arguments{"--frames", path("whole")}).status, 0);
  ASSERT_EQ(part("2/3", "parts").status, 0);
  EXPECT_EQ(read_json("report.json")["flow"]["first_step"], 2);
  EXPECT_EQ(read_json("report.json")["flow"]["steps"], 2);
  EXPECT_FALSE(exists("parts/frame_0000.png"));
  ASSERT_EQ(part("3/3", "parts").status, 0);
  ASSERT_EQ(part("1/3", "parts").status, 0);
  for (int k = 0; k < 7; ++k) EXPECT_EQ(frame("parts", k), frame("whole", k)) << "frame " << k;
  EXPECT_FALSE(exists("parts/frame_0007.png"));
}

TEST_F(Chunk, APartReplacesItsOwnFramesOnly) {
  fs::create_directories(path("parts"));
  for (const char* name : {"parts/frame_0000.png", "parts/frame_0003.png", "parts/frame_0006.png"}) write(name, "old");
  ASSERT_EQ(part("2/3", "parts").status, 0);
  EXPECT_EQ(content("parts/frame_0000.png"), "old");
  EXPECT_NE(content("parts/frame_0003.png"), "old");
  EXPECT_EQ(content("parts/frame_0006.png"), "old");
}

TEST_F(Chunk, WrongPartsAreRefused) {
  for (const std::string arguments : {"0/3", "4/3", "1.5/3", "3", "a/b", "1/0", "-1/3", "2/8"})
    expect_failure(part(arguments, "parts"), 2, {"--chunk"});
  EXPECT_FALSE(exists("parts"));
}

TEST_F(Chunk, JoinMakesAVideoOfCompleteFramesOnly) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "there is no ffmpeg here";
  ASSERT_EQ(part("1/2", "parts").status, 0);
  const Arguments join = {"join", path("parts"), "--video", path("film.mp4"), "--fps", "10"};
  EXPECT_EQ(nacre(join).status, 0);
  EXPECT_TRUE(exists("film.mp4"));
  fs::remove(path("parts/frame_0001.png"));
  fs::remove(path("film.mp4"));
  expect_failure(nacre(join), 1, {"frame_0001.png", "missing"});
  EXPECT_FALSE(exists("film.mp4"));
  expect_failure(nacre({"join", path("none"), "--video", path("film.mp4")}), 1, {"none"});
  expect_failure(nacre({"join", path("parts"), "--video", path("film.txt")}), 2, {"film.txt"});
  expect_failure(nacre({"join", path("parts")}), 2, {"--video"});
}

}  // namespace
}  // namespace nacre::test
