// Nacre: the viewer as a script runs it, without a display.
#include <cstdlib>
#include <cstring>
#include <map>

#include "engine/picture/png.hpp"
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

const Arguments small_view = {"view", "--offscreen", "--sample", "sphere", "--detail", "24",     "--resolution",
                              "64",   "--steps",     "4",        "--size", "200x150",  "--quiet"};

using View = ViewTest;

TEST_F(View, OffscreenWritesThePictureOfTheLastFrame) {
  const fs::path png = folder / "view.png", json = folder / "view.json";
  const Outcome outcome = nacre(small_view + Arguments{"--image", png.string(), "--report", json.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, png.string() + "\n");
  EXPECT_EQ(outcome.err, "");
  const Image image = read_png(png);
  EXPECT_EQ(image.width, 200);
  EXPECT_EQ(image.height, 150);
  const nlohmann::json view = read_json(json).at("view");
  EXPECT_EQ(view.at("frames"), 4);
  EXPECT_EQ(view.at("steps"), 4);
  EXPECT_EQ(view.at("copied_bytes"), 0);
  EXPECT_TRUE(view.at("driver_messages").empty()) << view.dump(1);
}

struct Box {
  int left, top, right, bottom;
};

/// Mean difference of opacity and of the colours as far as they are opaque, 0..255; in a box.
double mean_difference(const Image& a, const Image& b, const Box& box) {
  double sum = 0;
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x)
      for (int c = 0; c < 4; ++c) {
        const auto value = [&](const Image& image) {
          const std::uint8_t* p = image.at(x, y);
          return c == 3 ? double(p[3]) : p[c] * p[3] / 255.0;
        };
        sum += std::abs(value(a) - value(b));
      }
  return sum / (4.0 * (box.right - box.left) * (box.bottom - box.top));
}

double mean_difference(const Image& a, const Image& b) { return mean_difference(a, b, {0, 0, a.width, a.height}); }

TEST_F(View, PictureIsThatOfTheHeadlessCommand) {
  const fs::path view = folder / "view.png", flow = folder / "flow.png";
  const Arguments common = {"--sample", "sphere", "--detail", "24",      "--resolution", "96",
                            "--steps",  "3",      "--size",   "320x240", "--quiet"};
  for (const Arguments& more :
       {Arguments{}, Arguments{"--set", "legend=false", "--set", "time_stamp=false"},
        Arguments{"--background", "#102030"}, Arguments{"--color-range", "-1:4", "--colormap", "gray"},
        Arguments{"--color", "none", "--background", "transparent"}, Arguments{"--method", "octree"},
        Arguments{"--topology", "--streamlines"}}) {
    ASSERT_EQ(nacre(Arguments{"view", "--offscreen", "--image", view.string()} + common + more).status, 0);
    ASSERT_EQ(nacre(Arguments{"flow", "--image", flow.string()} + common + more).status, 0);
    const Image a = read_png(view), b = read_png(flow);
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    const bool lines = more.size() > 1 && more[0] == "--topology";  // thin, and drawn in another way
    EXPECT_LT(mean_difference(a, b), lines ? 3 : 1.5) << testing::PrintToString(more);  // 4 samples a pixel elsewhere
    EXPECT_LT(mean_difference(a, b, {270, 0, 320, 240}), 0.1)
        << testing::PrintToString(more);  // legend and axes, pixel by pixel
    EXPECT_LT(mean_difference(a, b, {0, 220, 70, 240}), 0.1) << testing::PrintToString(more);  // the stamp
  }
}

TEST_F(View, LookKnobsAreSeen) {
  const fs::path png = folder / "a.png";
  const auto picture = [&](const Arguments& more) {
    const Outcome outcome = nacre(small_view + Arguments{"--image", png.string(), "--frames-count", "1"} + more);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return read_png(png);
  };
  const Image plain = picture({});
  for (const char* knob : {"arrows=true", "clip=x", "light_azimuth=60", "light_height=-50", "ambient=0.9", "edges=true",
                           "color_range=0:9", "legend=false"})
    EXPECT_GT(mean_difference(plain, picture({"--set", knob})), 0.3) << knob;
  const Outcome nonsense = nacre(small_view + Arguments{"--image", png.string(), "--color-range", "9:1"});
  EXPECT_EQ(nonsense.status, 2) << nonsense.err;
}

TEST_F(View, TwoReplaysAreTheSame) {
  const fs::path first = folder / "1.png", second = folder / "2.png";
  ASSERT_EQ(nacre(small_view + Arguments{"--image", first.string()}).status, 0);
  ASSERT_EQ(nacre(small_view + Arguments{"--image", second.string(), "--threads", "1"}).status, 0);
  EXPECT_EQ(read_png(first).pixels, read_png(second).pixels);
}

TEST_F(View, LiveFramesDoNotWaitForCompute) {
  const fs::path json = folder / "view.json";
  ASSERT_EQ(
      nacre(small_view + Arguments{"--live", "--frames-count", "60", "--panel", "--report", json.string()}).status, 0);
  const nlohmann::json view = read_json(json).at("view");
  EXPECT_GE(view.at("frames"), 60);
  EXPECT_LT(view.at("first_frame_seconds"), 2.0);
  EXPECT_TRUE(view.at("driver_messages").empty()) << view.dump(1);
}

Outcome with_faults(const std::string& faults, const Arguments& arguments) {
  return run("/bin/bash",
             Arguments{"-c", "NACRE_FAULTS=" + faults + " exec \"$0\" \"$@\"", program_path} + small_view + arguments);
}

TEST_F(View, AResetGraphicsDeviceIsBornAndTheSessionGoesOn) {
  const fs::path png = folder / "view.png", json = folder / "view.json", whole = folder / "whole.png";
  ASSERT_EQ(nacre(small_view + Arguments{"--image", whole.string()}).status, 0);
  // In the second frame: the flow starts over, so that six frames show what four do without it.
  const Outcome outcome =
      with_faults("lost-context@2", {"--frames-count", "6", "--image", png.string(), "--report", json.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_png(png).pixels, read_png(whole).pixels);
  EXPECT_TRUE(read_json(json).at("view").at("driver_messages").empty());
}

TEST_F(View, AnotherDevicesPictureIsTheSameAndItsCopiesAreCounted) {
  const fs::path png = folder / "view.png", json = folder / "view.json", mapped = folder / "mapped.png";
  ASSERT_EQ(nacre(small_view + Arguments{"--image", mapped.string()}).status, 0);
  const Outcome outcome = with_faults("other-device", {"--image", png.string(), "--report", json.string()});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_png(png).pixels, read_png(mapped).pixels);
  EXPECT_GT(read_json(json).at("view").at("copied_bytes"), 0);
}

/// The texture of the second embedding, which is larger, has no memory: nothing is written to that of the first.
TEST_F(LongUserAtTheWindow, AWindowOutlivesATextureWithoutMemory) {
  std::ofstream(folder / "larger.json") << R"({"sample": "sphere", "detail": 24, "knobs": {"resolution": 48},
    "events": [{"time": 3, "knobs": {"resolution": 160}}]})";
  const fs::path json = folder / "view.json";
  const Outcome outcome = in_window({"--script", (folder / "larger.json").string(), "--frames-count", "400", "--size",
                                     "160x120", "--report", json.string()},
                                    "export NACRE_FAULTS=graphics-memory@2");
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_json(json).at("view").at("steps"), 0);
}

TEST_F(View, OutOfMemoryIsOneLineThatSaysWhatToDo) {
  const Outcome outcome = with_faults("out-of-memory@1", {"--image", (folder / "view.png").string()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "out of memory")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "resolution")) << outcome.err;
  EXPECT_FALSE(fs::exists(folder / "view.png"));
}

TEST_F(View, WordsThatAreOffAreUsageErrors) {
  EXPECT_EQ(nacre({"view", "--offscreen"}).status, 2);
  EXPECT_EQ(nacre({"view", "--live"}).status, 2);
  EXPECT_EQ(nacre({"view", "--offscreen", "--image", "x.png", "--size", "0x9"}).status, 2);
  EXPECT_EQ(nacre({"view", "--offscreen", "--image", "x.png", "--colormap", "nosuch"}).status, 2);
}

TEST_F(View, FailuresAreOneLine) {
  const Outcome missing = nacre({"view", "--offscreen", "--image", (folder / "x.png").string(), "nosuch.vtp"});
  EXPECT_EQ(missing.status, 1);
  EXPECT_TRUE(contains(missing.err, "nosuch.vtp")) << missing.err;
  EXPECT_FALSE(fs::exists(folder / "x.png"));
}

TEST_F(View, OldOpenGlIsNamed) {
  const Outcome outcome =
      run("/bin/bash", Arguments{"-c", "MESA_GL_VERSION_OVERRIDE=3.3 exec \"$0\" \"$@\"", program_path} + small_view +
                           Arguments{"--image", (folder / "x.png").string()});
  if (outcome.status == 0) GTEST_SKIP() << "this driver is not Mesa's";
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "no OpenGL 4.5")) << outcome.err;
}

TEST_F(View, WithoutADisplayAWindowIsAnError) {
  const Outcome outcome = run("/bin/bash", {"-c", "unset DISPLAY WAYLAND_DISPLAY; exec \"$0\" view", program_path});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_TRUE(contains(outcome.err, "no display")) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "--offscreen")) << outcome.err;
}

TEST_F(View, WindowUnderXvfb) {
  const fs::path png = folder / "window.png", json = folder / "window.json";
  const Outcome outcome =
      in_window({"--sample", "sphere", "--detail", "24", "--resolution", "64", "--size", "400x300", "--no-panel",
                 "--frames-count", "40", "--image", png.string(), "--report", json.string()});
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json view = read_json(json).at("view");
  EXPECT_GE(view.at("frames"), 40);
  EXPECT_TRUE(view.at("driver_messages").empty()) << view.dump(1);
  EXPECT_LT(view.at("first_frame_seconds"), 2.0);
  const Image image = read_png(png);
  int coloured = 0;  // the sphere in its colours: neither background nor gray panel
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = image.at(x, y);
      coloured += std::abs(int(p[0]) - int(p[2])) > 30;
    }
  EXPECT_GT(coloured, image.width * image.height / 10);
}

TEST_F(UserAtTheWindow, KeysAndMouseInTheWindow) {
  const fs::path recording = folder / "done.json", report = folder / "keys.json", png = folder / "keys.png";
  const Outcome outcome = run("/bin/bash", {source_file("tests/app/view_keys.sh"), program_path, recording.string(),
                                            report.string(), png.string()});
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::map<std::string, std::vector<nlohmann::json>> knobs;
  int turns = 0, orthographic = 0;
  const nlohmann::json done = read_json(recording);
  for (const auto& event : done.at("events")) {
    if (event.contains("knobs"))
      for (const auto& [name, value] : event.at("knobs").items()) knobs[name].push_back(value);
    if (event.contains("camera")) ++turns, orthographic += event.at("camera").at("orthographic").get<bool>();
  }
  EXPECT_EQ(knobs["edges"], (std::vector<nlohmann::json>{true}));
  EXPECT_EQ(knobs["theme"], (std::vector<nlohmann::json>{"light", "dark", "light"}));  // undone, and done again
  EXPECT_EQ(knobs["panel"], (std::vector<nlohmann::json>{false}));
  EXPECT_GE(turns, 3);  // orthographic, turned, nearer
  EXPECT_EQ(orthographic, turns);
  EXPECT_TRUE(read_json(report).at("view").at("driver_messages").empty());
}

TEST_F(LongUserAtTheWindow, AClipPlaneIsDraggedAndTheCrosshairMoved) {
  const fs::path recording = folder / "done.json", report = folder / "planes.json", camera = folder / "camera.json";
  std::ofstream(camera) << R"({"eye": [23.5, -150, 23.5], "target": [23.5, 23.5, 23.5], "up": [0, 0, 1], "height": 60,
                               "orthographic": true})";
  const Outcome outcome = run("/bin/bash", {source_file("tests/app/view_planes.sh"), program_path, recording.string(),
                                            report.string(), camera.string()});
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::vector<std::array<double, 6>> planes;
  std::vector<std::string> crosshairs;
  const nlohmann::json done = read_json(recording);
  for (const auto& event : done.at("events")) {
    EXPECT_FALSE(event.contains("camera")) << "the mouse was the handle's, and the slices': " << event.dump();
    if (!event.contains("knobs")) continue;
    if (event["knobs"].contains("crosshair")) crosshairs.push_back(event["knobs"]["crosshair"]);
    if (!event["knobs"].contains("clip_planes")) continue;
    std::istringstream numbers(event["knobs"]["clip_planes"].get<std::string>());
    std::array<double, 6> plane{};
    for (double& number : plane) numbers >> number;
    planes.push_back(plane);
  }
  ASSERT_GE(planes.size(), 4u) << done.dump(1);
  EXPECT_NEAR(planes.front()[1], 1, 1e-6) << "faces the camera";
  double farthest = 0;
  for (const auto& plane : planes) farthest = std::max(farthest, plane[4] - planes.front()[4]);
  EXPECT_NEAR(farthest, 60 * 60 / 614.0, 1) << "60 pixels, of which the picture has 614";
  EXPECT_NEAR(planes.back()[4], planes.front()[4], 1e-3) << "undone, before it was turned";
  EXPECT_GT(std::fabs(planes.back()[0]), 0.3);
  ASSERT_GE(crosshairs.size(), 2u);
  EXPECT_NE(crosshairs.front(), crosshairs.back());
  EXPECT_TRUE(read_json(report).at("view").at("driver_messages").empty());
}

TEST_F(UserAtTheWindow, AWindowAsksBeforeSomethingIsLostAndCtrlCWritesWhatQuittingWrites) {
  const Outcome outcome =
      run("/bin/bash", {source_file("tests/app/view_quit.sh"), program_path, folder.path().string()});
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "130\n")) << outcome.out;
  const nlohmann::json report = read_json(folder / "r.json");
  EXPECT_GT(report.at("view").at("frames"), 0);
  EXPECT_TRUE(fs::exists(folder / "p.png"));
  EXPECT_FALSE(read_json(folder / "done.json").at("events").empty());
}

/// The panel as a window draws it with this fault, without the lines that tell steps and times; empty where there is no
/// Xvfb.
Image panel_in_window(const std::string& fault, const fs::path& png, const Arguments& more) {
  const Arguments arguments = {"--sample", "sphere",    "--detail", "24",       "--resolution",   "64",
                               "--size",   "800x600",   "--set",    "tab=look", "--frames-count", "30",
                               "--image",  png.string()};
  const Outcome outcome = in_window(arguments + more, "export NACRE_FAULTS=" + fault);
  if (outcome.status == 77) return {};
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const Image whole = read_png(png);
  Image panel(400, 400);
  for (int y = 0; y < panel.height; ++y)
    std::memcpy(panel.at(0, y), whole.at(0, y + 130), 4 * std::size_t(panel.width));
  return panel;
}

TEST_F(LongUserAtTheWindow, OnADenserScreenPanelsAndLettersGrow) {
  const Image small = panel_in_window("none", folder / "small.png", {});
  if (small.pixels.empty()) GTEST_SKIP() << "no Xvfb here";
  const Image moved = panel_in_window("other-screen@10", folder / "moved.png", {});
  const Image large = panel_in_window("none", folder / "large.png", {"--set", "text_size=2"});
  EXPECT_EQ(moved.pixels, large.pixels);
  EXPECT_NE(moved.pixels, small.pixels);
  EXPECT_FALSE(panel_in_window("other-screen", folder / "last.png", {}).pixels.empty());  // to and fro, every frame
}

TEST_F(LongUserAtTheWindow, AnySizeAndScreenOfTheWindow) {
  const fs::path recording = folder / "done.json", report = folder / "screens.json";
  const Outcome outcome =
      run("/bin/bash", {source_file("tests/app/view_screens.sh"), program_path, recording.string(), report.string()});
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(read_json(report).at("view").at("driver_messages").empty());
}

/// A frame of the video is a step, seen or not; then the window is pulled larger, and what it shows fills it.
TEST_F(LongUserAtTheWindow, AMinimisedWindowIsFilmedAndAPulledOneIsFilled) {
  const fs::path video = folder / "flow.mp4", report = folder / "film.json", png = folder / "screen.png";
  const Outcome outcome = run("/bin/bash", {source_file("tests/app/view_film.sh"), program_path, video.string(),
                                            report.string(), png.string()});
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const nlohmann::json told = read_json(report), view = told.at("view");
  const Outcome counted = run("/usr/bin/env", {"ffprobe", "-v", "error", "-count_frames", "-show_entries",
                                               "stream=nb_read_frames", "-of", "csv=p=0", video.string()});
  ASSERT_EQ(counted.status, 0) << counted.err;
  EXPECT_EQ(std::stoi(counted.out), view.at("filmed_frames"));
  EXPECT_GE(view.at("filmed_frames"), 3);
  for (const auto& stage : told.at("stages")) {
    if (stage.at("name") != "filter") continue;
    EXPECT_GE(stage.at("calls"), view.at("filmed_frames"));
  }
  const Image screen = read_png(png);
  ASSERT_EQ(screen.width, 720);
  for (const int y : {8, 548})  // the bars of menus and status are dark from one side to the other
    for (const int x : {3, 716})
      EXPECT_LT(*std::max_element(screen.at(x, y), screen.at(x, y) + 3), 60) << x << ' ' << y;
}

TEST_F(UserAtTheWindow, ANewcomerGetsAVideoAndAMesh) {
  const fs::path flow = folder / "flow.vtp", labels = folder / "labels.nrrd";
  ASSERT_EQ(nacre({"sample", "torus", "--detail", "48", "--out", flow.string()}).status, 0);
  ASSERT_EQ(nacre({"sample", "three-sectors", "--detail", "24", "--out", labels.string()}).status, 0);
  const Outcome outcome = run("/bin/bash", {source_file("tests/app/view_newcomer.sh"), program_path, flow.string(),
                                            labels.string(), (folder / "").string()});
  if (outcome.status == 77) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "12 actions, and 6 for a knob")) << outcome.out;  // as docs/viewer.md says
  EXPECT_GT(fs::file_size(folder / "flow.mp4"), 1000u);
  EXPECT_GT(fs::file_size(folder / "labels-mesh.vtp"), 1000u);
  const nlohmann::json done = read_json(folder / "done.json");
  bool changed = false;
  for (const auto& event : done.at("events"))
    changed |= event.contains("knobs") && event.at("knobs").contains("ttl") && event.at("knobs").at("ttl") == 6;
  EXPECT_TRUE(changed) << done.dump(1);
}

}  // namespace
}  // namespace nacre::test
