// Nacre: a run that was stopped goes on (`--checkpoint`), and its results are those of a run that was not.
#include "engine/io/surface_writer.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

const Arguments small_torus = {"flow", "--sample", "torus", "--detail", "20",    "--resolution",
                               "48",   "--steps",  "4",     "--size",   "64x48", "--quiet"};

class Resumed : public AppTest {
 protected:
  /// The user stops the run after so many of its steps, those of the warm-up included; 0: never.
  Outcome stop(int steps, const Arguments& arguments) const {
    const std::string fault = steps > 0 ? "NACRE_FAULTS=stop@" + std::to_string(steps) : "NACRE_FAULTS=";
    return run("/usr/bin/env", Arguments{fault, program_path} + arguments);
  }
  Arguments results(const std::string& name) const {
    return {"--frames", path(name), "--out", path(name + ".vtp"), "--image", path(name + ".png")};
  }
  Arguments with_checkpoint(const std::string& name) const { return {"--checkpoint", path(name)}; }
  std::string frame(const std::string& folder, int number) const {
    return content(folder + "/frame_000" + std::to_string(number) + ".png");
  }

  /// A run that stops after each of `stops` and then goes on to its end is like one that does not.
  void expect_same(const Arguments& arguments, const std::vector<int>& stops, int frames) const {
    const Arguments parts = arguments + results("parts") + with_checkpoint("state");
    ASSERT_EQ(nacre(arguments + results("whole")).status, 0);
    for (const int steps : stops) {
      const Outcome stopped = stop(steps, parts + Arguments{"--threads", steps % 2 ? "1" : "2"});
      ASSERT_EQ(stopped.status, 130) << stopped.err;
      ASSERT_TRUE(exists("state"));
      EXPECT_FALSE(exists("parts.vtp"));
    }
    const Outcome rest = nacre(parts);
    ASSERT_EQ(rest.status, 0) << rest.err;
    for (int k = 0; k < frames; ++k) EXPECT_EQ(frame("parts", k), frame("whole", k)) << "frame " << k;
    EXPECT_EQ(content("parts.vtp"), content("whole.vtp"));
    EXPECT_EQ(content("parts.png"), content("whole.png"));
    EXPECT_FALSE(exists("state")) << "it is of no use any more";
    for (const char* name : {"whole", "parts", "parts.vtp", "parts.png"}) fs::remove_all(path(name));
  }
};

TEST_F(Resumed, EachMethodGoesOnFromTheWarmUpAndFromBetweenFrames) {
  for (const Arguments& method : {Arguments{"--method", "grid"}, Arguments{"--method", "octree"},
                                  Arguments{"--method", "octree", "--octree", "source"}})
    expect_same(small_torus + method, {2, 3, 1}, 4);
}

TEST_F(Resumed, AfterTheLastStepOnlyTheResultsAreLeft) { expect_same(small_torus, {8}, 4); }

TEST_F(Resumed, PatternsGoOn) {
  expect_same(small_torus + Arguments{"--texture", "spots", "--time", "0:0.5"}, {1, 2}, 4);
}

TEST_F(Resumed, ASurfaceThatMovesGoesOnInTheShapeThatIsEmbedded) {
  Arguments flow = {"flow", "--resolution", "48", "--steps", "8", "--size", "64x48", "--quiet"};
  for (int k = 0; k < 4; ++k) {  // it is stretched, and then has other triangles
    Surface s = make_sample("pulse", k < 3 ? 16 : 20).load(std::size_t(k));
    for (Vec3d& p : s.points) p.x *= 1 + 0.5 * k;
    flow.push_back(path("step_" + std::to_string(k) + ".vtp"));
    write_surface(flow.back(), s, double(k));
  }
  ASSERT_EQ(nacre(flow + Arguments{"--report", path("r.json")}).status, 0);
  ASSERT_GT(read_json("r.json")["motion"]["rebuilds"], 1);
  expect_same(flow + Arguments{"--method", "grid"}, {5, 2, 3}, 8);
  expect_same(flow + Arguments{"--method", "octree"}, {8}, 8);
}

TEST_F(Resumed, DyeAndAPartOfARunGoOn) {
  expect_same(small_torus + Arguments{"--dye", "1,0,0,0.4", "--dye-release", "always"}, {6}, 4);
  expect_same(small_torus + Arguments{"--chunk", "1/1", "--lead-in", "2"}, {1, 4}, 4);
}

TEST_F(Resumed, AVideoIsMadeOfItsFramesAgain) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "there is no ffmpeg here";
  const Arguments parts = small_torus + with_checkpoint("state") + Arguments{"--video", path("parts.mp4")};
  expect_failure(nacre(parts), 2, {"--video", "--frames"});
  ASSERT_EQ(nacre(small_torus + Arguments{"--video", path("whole.mp4")}).status, 0);
  ASSERT_EQ(stop(6, parts + Arguments{"--frames", path("frames")}).status, 130);
  EXPECT_FALSE(exists("parts.mp4"));
  ASSERT_EQ(nacre(parts + Arguments{"--frames", path("frames")}).status, 0);
  EXPECT_EQ(content("parts.mp4"), content("whole.mp4"));
}

TEST_F(Resumed, AnotherRunIsRefusedAndSaysWhy) {
  const Arguments first = small_torus + with_checkpoint("state") + Arguments{"--image", path("a.png")};
  ASSERT_EQ(stop(3, first).status, 130);
  const std::string state = content("state");
  expect_failure(nacre(first + Arguments{"--seed", "7"}), 1, {"state", "--seed was 1 and is 7"});
  expect_failure(nacre(first + Arguments{"--streaks", "5"}), 1, {"--streaks was the default and is 5"});
  expect_failure(nacre(first + Arguments{"--out", path("a.vtp")}), 1, {"other kinds of results"});
  expect_failure(nacre(first + Arguments{"--chunk", "1/2"}), 1, {"--chunk"});
  Arguments other = first;
  other[2] = "sphere";
  expect_failure(nacre(other), 1, {"'torus'", "'sphere'"});
  EXPECT_EQ(content("state"), state) << "none has touched it";
  EXPECT_FALSE(exists("a.png"));
}

TEST_F(Resumed, AnotherInputIsRefused) {
  for (const char* detail : {"20", "24"})
    ASSERT_EQ(
        nacre({"sample", "torus", "--detail", detail, "--out", path(std::string(detail) + ".vtp"), "--quiet"}).status,
        0);
  fs::copy(path("20.vtp"), path("in.vtp"));
  const Arguments flow = Arguments{"flow",   path("in.vtp"), "--resolution", "48",      "--steps",    "3",
                                   "--size", "64x48",        "--quiet",      "--image", path("a.png")} +
                         with_checkpoint("state");
  ASSERT_EQ(stop(3, flow).status, 130);
  fs::copy(path("24.vtp"), path("in.vtp"), fs::copy_options::overwrite_existing);
  expect_failure(nacre(flow), 1, {"in.vtp is not the file"});
  Arguments renamed = flow;
  renamed[1] = path("20.vtp");
  EXPECT_EQ(nacre(renamed).status, 0) << "the same content counts";
}

TEST_F(Resumed, ADamagedCheckpointAndMissingFramesAreRefused) {
  const Arguments flow = small_torus + with_checkpoint("state") + Arguments{"--frames", path("frames")};
  ASSERT_EQ(stop(7, flow).status, 130);
  const std::string state = content("state");
  write("state", state.substr(0, state.size() / 2));
  expect_failure(nacre(flow), 1, {"state", "damaged"});
  write("state", "something else");
  expect_failure(nacre(flow), 1, {"state", "no checkpoint"});
  write("state", state);
  fs::rename(path("frames/frame_0001.png"), path("away.png"));
  expect_failure(nacre(flow), 1, {"frame_0001.png is missing"});
  fs::rename(path("away.png"), path("frames/frame_0001.png"));
  EXPECT_EQ(nacre(flow).status, 0);
}

TEST_F(Resumed, AFullDiskKeepsTheOlderOneAndTheRunGoesOn) {
  const Arguments flow = small_torus + with_checkpoint("state") + Arguments{"--frames", path("frames")};
  ASSERT_EQ(stop(5, flow).status, 130);
  const std::string state = content("state");
  ASSERT_GT(state.size(), 40u << 10);
  const Outcome limited = nacre_limited("-f 32", flow + Arguments{"--checkpoint-every", "0"});
  EXPECT_EQ(limited.status, 0) << limited.err;
  EXPECT_TRUE(contains(limited.err, "older checkpoint is kept")) << limited.err;
  EXPECT_EQ(names(), (Arguments{"frames"})) << "it is removed at the end";
  write("state", state);
  const Outcome stopped =
      run("/bin/bash", Arguments{"-c", "ulimit -f 32; NACRE_FAULTS=stop@2 exec \"$0\" \"$@\"", program_path} + flow);
  EXPECT_EQ(stopped.status, 130) << stopped.err;
  EXPECT_EQ(content("state"), state);
}

TEST_F(Resumed, ASignalIsHeededAfterTheStep) {
  const std::string script =
      "\"$0\" \"$@\" & pid=$!; until [[ -e frames/frame_0001.png ]]; do kill -0 $pid || exit 1; sleep 0.05; done; "
      "kill -$signal $pid; wait $pid";
  for (const char* signal : {"TERM", "INT", "USR1"}) {
    Arguments flow = small_torus + Arguments{"--checkpoint", "state", "--frames", "frames"};
    flow[8] = "100000";
    const Outcome stopped =
        run("/bin/bash",
            Arguments{"-c", "cd '" + path(".") + "'; set -m; signal=" + signal + "; " + script, program_path} + flow);
    EXPECT_EQ(stopped.status, 130) << signal << stopped.err;
    ASSERT_TRUE(exists("state")) << signal;
    EXPECT_TRUE(contains(content("state").substr(0, 4000), "next_step"));
    for (const char* name : {"state", "frames"}) fs::remove_all(path(name));
  }
}

}  // namespace
}  // namespace nacre::test
