// Nacre: scripts, recordings and videos of the viewer, as other people's scripts run them.

#include <algorithm>

#include "engine/picture/png.hpp"
#include "engine/scene/session/session.hpp"
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

using json = nlohmann::json;

const json start = {{"sample", "sphere"},
                    {"detail", 24},
                    {"knobs",
                     {{"resolution", 48},
                      {"steps", 4},
                      {"width", 96},
                      {"height", 72},
                      {"fps", 10},
                      {"panel", false},
                      {"background", "#203040"}}}};

json camera(double x, double y, double z, double height) {
  return {{"eye", {x, y, z}}, {"target", {0, 0, 0}}, {"height", height}};
}

class Scripts : public ViewTest {
 protected:
  /// `start` with these events, in a file.
  std::string script(const json& events, double duration = 0, const std::string& name = "script.json") const {
    json text = start;
    if (!events.is_null()) text["events"] = events;
    if (duration > 0) text["duration"] = duration;
    std::ofstream(folder / name) << text.dump(1);
    return (folder / name).string();
  }

  /// Everything that a script can do to a flow: 13 frames.
  std::string demo() const {
    return script(
        {{{"time", 0.2}, {"knobs", {{"ttl", 2}}}},
         {{"time", 0.3}, {"camera", camera(0, -9, 3, 3)}, {"over", 0.4}},
         {{"time", 0.4}, {"knobs", {{"resolution", 32}}}},
         {{"time", 0.5}, {"knobs", {{"contrast", 0.1}}}},
         {{"time", 0.6}, {"screenshot", {{"file", "large.png"}, {"scale", 2}, {"transparent", true}}}},
         {{"time", 0.7}, {"knobs", {{"panel", true}}}, {"screenshot", {{"file", "panel.png"}, {"panel", true}}}},
         {{"time", 0.8}, {"knobs", {{"panel", false}, {"legend", false}}}},
         {{"time", 0.9}, {"sample", "torus"}, {"detail", 24}},
         {{"time", 1.1}, {"knobs", {{"camera", "+z"}}}}},
        1.2);
  }

  Outcome play(const std::string& file, const Arguments& more) const {
    return nacre(Arguments{"view", "--offscreen", "--quiet", "--script", file} + more);
  }

  /// All but that with the panel, in which are times.
  void expect_same_frames(const std::string& a, const std::string& b) const {
    ASSERT_EQ(names(a), names(b));
    for (const std::string& name : names(a))
      EXPECT_TRUE(name == "frame_0007.png" || content(a + "/" + name) == content(b + "/" + name)) << name;
  }

  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::string content(const std::string& name) const { return read_all(folder / name); }

  Arguments names(const std::string& of) const {
    Arguments found;
    for (const auto& entry : fs::directory_iterator(folder / of)) found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
};

using LongScripts = Scripts;

TEST_F(Scripts, OfADurationHaveFramesFromItsStartToItsEnd) {
  const Outcome run = play(demo(), {"--record", path("frames"), "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, path("large.png") + "\n" + path("panel.png") + "\n" + path("frames") + "\n");
  EXPECT_EQ(run.err, "");
  const Arguments frames = names("frames");
  ASSERT_EQ(frames.size(), 13u);
  EXPECT_EQ(frames.front(), "frame_0000.png");
  EXPECT_EQ(frames.back(), "frame_0012.png");
  const json report = read_json(folder / "r.json");
  EXPECT_EQ(report["view"]["frames"], 13);
  EXPECT_TRUE(report["view"]["driver_messages"].empty()) << report["view"].dump(1);
  EXPECT_EQ(report["outputs"].size(), 3u);
  EXPECT_GT(report["memory"]["peak_bytes"], 1 << 20);
  EXPECT_GE(report["device"]["threads"], 1);
  EXPECT_FALSE(report["input"].empty());
}

TEST_F(Scripts, TakePictures) {
  ASSERT_EQ(play(demo(), {"--record", path("frames")}).status, 0);
  const Image large = read_png(folder / "large.png"), panel = read_png(folder / "panel.png");
  EXPECT_EQ(large.width, 192);
  EXPECT_EQ(large.height, 144);
  EXPECT_EQ(large.at(0, 0)[3], 0);      // transparent beside the sphere
  EXPECT_EQ(large.at(96, 72)[3], 255);  // and not on it
  const Image seventh = read_png(folder / "frames/frame_0007.png"), fifth = read_png(folder / "frames/frame_0005.png");
  EXPECT_EQ(panel.pixels, seventh.pixels);
  EXPECT_EQ(std::vector<std::uint8_t>(fifth.at(0, 0), fifth.at(0, 0) + 3), (std::vector<std::uint8_t>{32, 48, 64}));
  int differ = 0;
  for (std::size_t i = 0; i < fifth.pixels.size(); ++i) differ += fifth.pixels[i] != seventh.pixels[i];
  EXPECT_GT(differ, 96 * 72 / 4) << "the panel covers much of so small a frame";
}

TEST_F(Scripts, RunWhatDependsOnEachKnob) {
  const std::string file =
      script({{{"time", 0.2}, {"knobs", {{"ttl", 2}}}},
              {{"time", 0.4}, {"knobs", {{"resolution", 32}}}},
              {{"time", 0.6}, {"knobs", {{"contrast", 0.1}, {"edges", true}, {"colormap", "ember"}}}}},
             0.8);
  ASSERT_EQ(play(file, {"--report", path("r.json")}).status, 0);
  const json report = read_json(folder / "r.json");
  json calls;
  for (const json& stage : report["stages"]) calls[stage["name"].get<std::string>()] = stage["calls"];
  EXPECT_EQ(calls["read"], 1);
  EXPECT_EQ(calls["embed"], 2);
}

TEST_F(Scripts, GiveTheSameBytesOnEachRunAndAnyNumberOfThreads) {
  ASSERT_EQ(play(demo(), {"--record", path("a")}).status, 0);
  ASSERT_EQ(play(demo(), {"--record", path("b")}).status, 0);
  ASSERT_EQ(play(demo(), {"--record", path("c"), "--threads", "1"}).status, 0);
  expect_same_frames("a", "b");
  expect_same_frames("a", "c");
  EXPECT_NE(content("a/frame_0000.png"), content("a/frame_0001.png"));
}

TEST_F(Scripts, RecordingsOfReplaysAreTheSame) {
  ASSERT_EQ(play(demo(), {"--save-recording", path("a.json"), "--record", path("first")}).status, 0);
  ASSERT_EQ(play(path("a.json"), {"--save-recording", path("b.json"), "--record", path("second")}).status, 0);
  ASSERT_EQ(play(path("b.json"), {"--save-recording", path("c.json")}).status, 0);
  EXPECT_EQ(content("a.json"), content("b.json"));
  EXPECT_EQ(content("b.json"), content("c.json"));
  expect_same_frames("first", "second");
  const json recording = read_json(folder / "a.json");
  EXPECT_EQ(recording["duration"], 1.2);
  EXPECT_EQ(recording["events"].size(), 8u);  // each frame of the glide is one, with what else changes in it
}

TEST_F(Scripts, RecordVideos) {
  if (find_program("ffmpeg").empty() || find_program("ffprobe").empty()) GTEST_SKIP() << "there is no ffmpeg";
  ASSERT_EQ(play(demo(), {"--record", path("demo.mp4"), "--size", "97x73"}).status, 0);
  const Outcome probe = run(find_program("ffprobe"),
                            {"-v", "error", "-count_frames", "-select_streams", "v:0", "-show_entries",
                             "stream=width,height,r_frame_rate,nb_read_frames", "-of", "csv=p=0", path("demo.mp4")});
  EXPECT_EQ(probe.out, "98,74,10/1,13\n") << probe.err;
}

TEST_F(Scripts, FrameRateIsTheKnobsAndStaysWhenThatIsChanged) {
  const std::string file = script({{{"time", 0.5}, {"knobs", {{"fps", 3}}}}}, 1);
  ASSERT_EQ(play(file, {"--fps", "20", "--record", path("frames")}).status, 0);
  EXPECT_EQ(names("frames").size(), 21u);
}

TEST_F(Scripts, FramesOfAVideoHaveTheSizeOfTheFirst) {
  const std::string file = script({{{"time", 0.2}, {"knobs", {{"width", 64}, {"height", 120}}}}}, 0.3);
  ASSERT_EQ(play(file, {"--record", path("frames"), "--image", path("last.png")}).status, 0);
  const Image frame = read_png(folder / "frames/frame_0003.png");
  EXPECT_EQ(frame.width, 96);
  EXPECT_EQ(frame.height, 72);
  EXPECT_EQ(read_png(folder / "last.png").width, 64);
}

TEST_F(Scripts, ASessionIsTheStateAtTheStart) {
  const Arguments still = {"--frames-count", "1", "--record"};
  ASSERT_EQ(play(demo(), still + Arguments{path("script")}).status, 0);
  ASSERT_EQ(nacre(Arguments{"view", "--offscreen", "--quiet", "--session", demo()} + still + Arguments{path("session")})
                .status,
            0);
  EXPECT_EQ(content("script/frame_0000.png"), content("session/frame_0000.png"));
}

TEST_F(Scripts, CameraOfASessionIsEveryCommands) {
  json text = start;
  text["camera"] = camera(0, -9, 0, 6);
  std::ofstream(folder / "s.json") << text;
  const auto blank_above = [&](const Arguments& arguments) {  // rows above the sphere
    EXPECT_EQ(nacre(arguments + Arguments{"--session", path("s.json"), "--quiet", "--set", "legend=false", "--set",
                                          "time_stamp=false", "--image", path("x.png")})
                  .status,
              0);
    const Image image = read_png(folder / "x.png");
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (std::abs(int(image.at(x, y)[0]) - 32) > 8) return y;
    return image.height;
  };
  const int expected = 24;  // a ball of radius 1 in a picture of 72 rows and height 6
  EXPECT_NEAR(blank_above({"flow"}), expected, 2);
  EXPECT_NEAR(blank_above({"view", "--offscreen"}), expected, 2);
  EXPECT_LT(blank_above({"flow", "--camera", "+x"}), 8);
  EXPECT_LT(blank_above({"view", "--offscreen", "--camera", "+x"}), 8);
  std::ofstream(folder / "s.json") << json{
      {"sample", "two-spheres"}, {"detail", 24}, {"camera", camera(12, -900, 12, 400)}, {"knobs", start["knobs"]}};
  EXPECT_GT(blank_above({"mesh"}), 20);
  EXPECT_LT(blank_above({"mesh", "--camera", "+x"}), 12);
}

TEST_F(Scripts, PlayInRealTimeWhereFramesDoNotWait) {
  const std::string file = script({{{"time", 0.3}, {"knobs", {{"ttl", 2}}}},
                                   {{"time", 1}, {"knobs", {{"contrast", 0.1}}}},
                                   {{"time", 1}, {"screenshot", {{"file", "end.png"}}}}});
  ASSERT_EQ(play(file, {"--live", "--save-recording", path("live.json")}).status, 0);
  EXPECT_TRUE(exists(folder / "end.png"));
  const json recording = read_json(folder / "live.json");
  EXPECT_GE(recording["duration"], 1);
  EXPECT_EQ(recording["events"].back()["knobs"]["contrast"], 0.1);
}

TEST_F(Scripts, AnInterruptLeavesNoHalfVideoButWhatWasDone) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "there is no ffmpeg";
  const std::string file = script(nullptr, 100000);
  const Outcome stopped = run("/usr/bin/timeout", {"--foreground", "--preserve-status", "-s", "INT", "-k", "30", "3",
                                                   program_path, "view", "--offscreen", "--quiet", "--script", file,
                                                   "--record", path("v.mp4"), "--save-recording", path("done.json")});
  EXPECT_EQ(stopped.status, 130) << stopped.err;
  EXPECT_EQ(names(""), (Arguments{"done.json", "script.json"}));
  EXPECT_EQ(read_json(folder / "done.json")["sample"], "sphere");
}

#if !defined(__SANITIZE_ADDRESS__)  // which keeps what was freed
TEST_F(LongScripts, ThousandFramesTakeNoMoreMemoryThanAFew) {
  json changes;
  for (int k = 1; k < 20; ++k)
    changes.push_back({{"time", 10.0 * k}, {"knobs", {{"resolution", k % 2 ? 32 : 48}, {"edges", k % 3 == 0}}}});
  const std::string file = script(changes, 200);
  const auto peak = [&](int frames) {
    const Arguments arguments = {"view",
                                 "--offscreen",
                                 "--quiet",
                                 "--script",
                                 file,
                                 "--size",
                                 "64x48",
                                 "--report",
                                 path("r.json"),
                                 "--frames-count",
                                 std::to_string(frames)};
    EXPECT_EQ(run_child(program_path, arguments, std::chrono::seconds(400)).exit_status, 0);
    const json report = read_json(folder / "r.json");
    EXPECT_EQ(report["view"]["frames"], frames);
    return report["memory"]["peak_bytes"].get<double>();
  };
  const double few = peak(300);  // with changes of the resolution to and fro, after which both textures are kept
  EXPECT_LT(peak(1000), few + 8e6);
}
#endif

TEST_F(Scripts, ThatMeanNothingAreRefusedBeforeAnyFrame) {
  const auto refused = [&](const std::string& file, int status, const Arguments& parts, const Arguments& more = {}) {
    expect_failure(play(file, more + Arguments{"--record", path("never")}), status, parts);
    EXPECT_FALSE(exists(folder / "never")) << file;
  };
  refused(path("nosuch.json"), 1, {"cannot read session", "nosuch.json"});
  refused(script(nullptr), 1, {"nothing to play", "--session"});
  refused(script({{{"time", 1}, {"knobs", {{"tttl", 3}}}}}), 1, {"event 1", "no knob 'tttl'", "ttl"});
  refused(script({{{"time", 1}, {"knobs", {{"ttl", 99}}}}}), 1, {"event 1", "out of range"});
  refused(script({{{"time", 1}, {"colour", "red"}}}), 1, {"event 1", "'colour' is not valid"});
  refused(script({{{"time", 1}, {"knobs", {{"colormap", "rust"}}}}}), 2, {"the event at 1 s", "rust"});
  refused(script({{{"time", 1}, {"sample", "teapot"}}}), 2, {"the event at 1 s", "teapot"});
  refused(script({{{"time", 1}, {"knobs", {{"background", "blue"}}}}}), 2, {"the event at 1 s", "blue"});
  refused(demo(), 2, {"--session or --script"}, {"--session", demo()});
  refused(demo(), 2, {"--live or --record"}, {"--live"});
}

TEST_F(Scripts, WhatCannotBeWrittenIsSaid) {
  expect_failure(play(demo(), {"--record", path("x.avi")}), 2, {"x.avi", ".mp4"});
  expect_failure(play(demo(), {"--record", path("none/x.mp4")}), 1, {"none"});
  const std::string file = script({{{"time", 0}, {"screenshot", {{"file", "none/a.png"}}}}});
  expect_failure(play(file, {}), 1, {"none/a.png"});
  expect_failure(play(file, {"--out", path("a.txt")}), 2, {"a.txt"});
}

TEST_F(Scripts, AnInputThatFailsInTheMiddleEndsTheRunWithItsName) {
  const std::string file = script({{{"time", 0.3}, {"inputs", {"nosuch.vtp"}}}}, 1);
  const Outcome run = play(file, {"--record", path("v.mp4"), "--save-recording", path("done.json")});
  expect_failure(run, 1, {"nosuch.vtp"});
  EXPECT_FALSE(exists(folder / "v.mp4"));
  EXPECT_EQ(read_json(folder / "done.json")["events"].size(), 0u);
}

TEST_F(Scripts, AWindowThatRecordsAVideoWaitsForComputeAndRecordsTheSame) {
  json with_camera = json::array();
  with_camera.push_back({{"time", 0}, {"camera", camera(0, -9, 0, 3)}});
  with_camera.push_back({{"time", 0.2}, {"camera", camera(9, -9, 0, 3)}, {"over", 0.4}});
  with_camera.push_back({{"time", 0.5}, {"knobs", {{"ttl", 2}}}});
  const std::string file = script(with_camera, 1);
  const Arguments arguments = {"--script", file, "--frames-count", "11"};
  const Outcome shown =
      in_window(arguments + Arguments{"--record", path("window"), "--save-recording", path("window.json")});
  if (shown.status == 77) GTEST_SKIP() << shown.err;
  ASSERT_EQ(shown.status, 0) << shown.err;
  ASSERT_EQ(
      nacre(Arguments{"view", "--offscreen", "--quiet", "--save-recording", path("offscreen.json")} + arguments).status,
      0);
  EXPECT_EQ(names("window").size(), 11u);
  EXPECT_EQ(content("window.json"), content("offscreen.json"));
}

TEST_F(Scripts, AWindowOutlivesTheFolderThatItRecordsInto) {
  const std::string frames = path("frames"), fourth = "'" + frames + "/frame_0003.png'";
  const std::string move = "(for i in {1..600}; do [ -e " + fourth + " ] && break; sleep 0.05; done; mv '" + frames +
                           "' '" + path("gone") + "') & :";
  const Outcome shown = in_window({"--script", script(nullptr, 60), "--record", frames, "--frames-count", "80",
                                   "--save-recording", path("done.json"), "--report", path("view.json")},
                                  move);
  if (shown.status == 77) GTEST_SKIP() << shown.err;
  EXPECT_NE(shown.status, 0);
  EXPECT_TRUE(contains(shown.err, "cannot write " + frames + "/frame_")) << shown.err;
  EXPECT_EQ(shown.err.find("cannot write"), shown.err.rfind("cannot write")) << shown.err;  // said once
  EXPECT_GE(read_json(folder / "view.json")["view"]["frames"], 80);                         // it went on
  EXPECT_EQ(read_json(folder / "done.json")["sample"], "sphere");                           // and nothing is lost
}

TEST_F(Scripts, AWindowOutlivesADiskThatIsFull) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "there is no ffmpeg";
  const Outcome shown = in_window({"--script", script(nullptr, 60), "--record", path("v.mkv"), "--frames-count", "100",
                                   "--save-recording", path("done.json"), "--report", path("view.json")},
                                  "ulimit -f 12");  // KiB of any file
  if (shown.status == 77) GTEST_SKIP() << shown.err;
  EXPECT_NE(shown.status, 0);
  EXPECT_TRUE(contains(shown.err, "cannot write the video")) << shown.err;
  EXPECT_EQ(shown.err.find("cannot write"), shown.err.rfind("cannot write")) << shown.err;  // said once
  EXPECT_GE(read_json(folder / "view.json")["view"]["frames"], 100);
  EXPECT_EQ(read_json(folder / "done.json")["sample"], "sphere");
  for (const auto& file : fs::directory_iterator(folder / "")) EXPECT_NE(file.path().extension(), ".mkv") << file;
}

TEST_F(Scripts, ASessionGivesTheSameValuesHeadlessOffscreenAndInAWindow) {
  const Arguments session = {"--quiet", "--session", script(nullptr)};
  ASSERT_EQ(nacre(Arguments{"flow", "--out", path("flow.vtp")} + session).status, 0);
  const Outcome offscreen = nacre(Arguments{"view", "--offscreen", "--out", path("view.vtp")} + session);
  if (contains(offscreen.err, "no format")) GTEST_SKIP() << offscreen.err;
  ASSERT_EQ(offscreen.status, 0) << offscreen.err;
  EXPECT_TRUE(without_origin(content("flow.vtp")) == without_origin(content("view.vtp")));
  const Outcome shown =
      in_window(session + Arguments{"--record", path("frames"), "--frames-count", "4", "--out", path("window.vtp")});
  if (shown.status == 77) GTEST_SKIP() << shown.err;
  ASSERT_EQ(shown.status, 0) << shown.err;
  EXPECT_TRUE(without_origin(content("flow.vtp")) == without_origin(content("window.vtp")));
}

TEST_F(Scripts, ASessionGivesTheSameMeshHeadlessAndOffscreen) {
  std::ofstream(folder / "s.json") << json{
      {"sample", "two-spheres"}, {"detail", 24}, {"knobs", {{"width", 96}, {"height", 72}, {"max_size", 3}}}};
  const Arguments session = {"--quiet", "--session", path("s.json")};
  const Outcome offscreen =
      nacre(Arguments{"view", "--offscreen", "--frames-count", "300", "--out", path("view.vtp")} + session);
  if (contains(offscreen.err, "cannot be viewed yet")) GTEST_SKIP() << offscreen.err;
  ASSERT_EQ(offscreen.status, 0) << offscreen.err;
  ASSERT_EQ(nacre(Arguments{"mesh", "--out", path("mesh.vtp")} + session).status, 0);
  EXPECT_TRUE(without_origin(content("mesh.vtp")) == without_origin(content("view.vtp")));
}

TEST(DemoSessions, AreSessionsThatPlay) {
  for (const char* name : {"flow_demo.json", "mesh_demo.json"}) {
    const Session demo = read_session(source_file(std::string("assets/") + name));
    EXPECT_TRUE(demo.camera) << name;
    EXPECT_GE(demo.events.size(), 5u) << name;
    EXPECT_GE(demo.duration, 8) << name;
    EXPECT_LE(demo.duration, 12) << name;
  }
}

}  // namespace
}  // namespace nacre::test
