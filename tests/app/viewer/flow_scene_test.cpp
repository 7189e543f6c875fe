// Nacre: a flow in the viewer's loop, on an OpenGL context without a display.
#include "app/viewer/flow/flow_scene.hpp"

#include <imgui.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <set>
#include <thread>

#include "app/viewer/panel/flow_panel.hpp"
#include "app/viewer/window/imgui_layer.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/io/surface_writer.hpp"
#include "engine/picture/png.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/app/viewer/scene_in_view.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

Session small_session() {
  Session session;
  session.sample = "sphere";
  session.detail = 24;
  session.settings.flow.resolution = 48;
  session.settings.flow.steps = 4;
  return session;
}

class FlowInView : public test::SceneInView<FlowScene> {
 protected:
  void open(const Session& session) {
    session_ = session;
    scene_ = std::make_unique<FlowScene>(session, make_cpu_device(2), false);
  }

  void advance() { scene_->advance_and_wait(stop_); }

  /// Nothing goes on and nothing will come; the worker tells a moment before it rests.
  bool settles() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!scene_->settled() && std::chrono::steady_clock::now() < end) scene_->advance(0);
    return scene_->settled();
  }

  Image picture() {
    View view;
    view.width = view.height = 120;
    view.camera = fit_camera("iso", scene_->corners(), 120, 120);
    view.light = flow_light(view.camera);
    const Framebuffer frame(120, 120);
    frame.bind();
    frame.clear({1, 1, 1, 1});
    scene_->draw(view);
    return frame.read();
  }

  std::atomic<bool> stop_{false};
};

TEST_F(FlowInView, EachCallIsOneStep) {
  open(small_session());
  EXPECT_FALSE(scene_->complete());
  for (int k = 1; k <= 3; ++k) {
    advance();
    EXPECT_EQ(scene_->steps(), k);
  }
  EXPECT_TRUE(scene_->complete());
  EXPECT_FALSE(scene_->settled());
  EXPECT_EQ(scene_->copied_bytes(), 0u);
}

TEST_F(FlowInView, OffersTheArraysOfTheData) {
  const test::TemporaryFolder folder;
  Surface surface = make_sample("sphere", 24).load(0);
  const std::size_t points = surface.points.size();
  surface.arrays.push_back({"pressure", 1, std::vector<float>(points, 1)});
  surface.arrays.push_back({"shear", 3, std::vector<float>(3 * points, 1)});
  write_surface(folder / "a.vtp", surface);
  Session session = small_session();
  session.sample.clear();
  session.inputs = {folder / "a.vtp"};
  open(session);
  using Names = std::vector<std::string>;
  EXPECT_EQ(flow_choices(scene_->results().offer, "vectors"), (Names{"", "@swirl", "@rotation"}))
      << "before anything is read";
  advance();
  EXPECT_EQ(flow_choices(scene_->results().offer, "vectors"), (Names{"", "velocity", "shear", "@swirl", "@rotation"}));
  EXPECT_EQ(flow_choices(scene_->results().offer, "color"),
            (Names{"speed", "none", "FTLE", "velocity", "pressure", "shear"}));
  EXPECT_TRUE(flow_choices(scene_->results().offer, "time").empty());
}

TEST_F(FlowInView, StandsStillWhereItDoesNotPlay) {
  Session session = small_session();
  session.settings.view.play = false;
  open(session);
  advance();  // one step, for without it there is no texture
  EXPECT_EQ(scene_->steps(), 1);
  EXPECT_TRUE(settles());
  advance();
  EXPECT_EQ(scene_->steps(), 1);
  change([](Settings& s) { s.flow.contrast = 0.3; });  // can only be seen in another step
  EXPECT_FALSE(scene_->settled());
  advance();
  EXPECT_EQ(scene_->steps(), 2);
  change([](Settings& s) { s.flow.ttl = 2; });
  advance();
  EXPECT_EQ(scene_->steps(), 1);  // from the noise
  advance();
  EXPECT_EQ(scene_->steps(), 1);
}

TEST_F(FlowInView, WhatWasShownStaysWhileAnotherIsMade) {
  open(small_session());
  advance();
  const Image before = picture();
  change([](Settings& s) { s.flow.resolution = 768; });
  while (scene_->progress().stage != "embedding") scene_->advance(0);
  scene_->cancel();
  advance();  // returns, for nothing more will come
  EXPECT_TRUE(scene_->complete());
  EXPECT_EQ(picture().pixels, before.pixels);
  EXPECT_NE(scene_->state().find("cancelled"), std::string::npos);
  change([](Settings& s) { s.flow.resolution = 96; });
  advance();
  EXPECT_EQ(scene_->steps(), 1);
  EXPECT_NE(picture().pixels, before.pixels);
}

TEST_F(FlowInView, ColoursChangeWithoutAStep) {
  Session session = small_session();
  session.settings.view.play = false;
  open(session);
  advance();
  const Image plain = picture();
  const std::uint64_t version = scene_->overlay_version();
  change([](Settings& s) { s.color_range = "0:9"; });
  EXPECT_NE(scene_->overlay_version(), version);
  const Image locked = picture();
  EXPECT_NE(locked.pixels, plain.pixels);
  change([](Settings& s) { s.color_range = "9:0"; });
  EXPECT_EQ(picture().pixels, plain.pixels);  // nonsense: that of the data
  ASSERT_EQ(scene_->warnings().size(), 1u);
  EXPECT_NE(scene_->warnings()[0].find("9:0"), std::string::npos);
  change([](Settings& s) { s.color_range = "", s.color = "none"; });
  ASSERT_TRUE(settles());
  scene_->advance(0);
  EXPECT_NE(picture().pixels, plain.pixels);
  EXPECT_EQ(scene_->steps(), 1);
}

TEST_F(FlowInView, ProbesWhatARayMeets) {
  open(small_session());
  const Vec3d from(0, -50, 0), along(0, 1, 0);
  EXPECT_FALSE(scene_->probe(from, along));  // nothing read yet
  advance();
  Vec3d low = scene_->corners().front(), high = low;
  for (const Vec3d& p : scene_->corners()) low = min(low, p), high = max(high, p);
  const Vec3d middle = (low + high) * 0.5;
  const auto start = std::chrono::steady_clock::now();
  std::optional<ProbeResult> probed = scene_->probe(middle - Vec3d(0, 50, 0), along);
  ASSERT_TRUE(probed);
  EXPECT_NEAR(probed->position.y, low.y, 0.01 * (high.y - low.y));
  std::string all;
  for (const std::string& line : probed->lines) all += line + "\n";
  for (const char* name : {"position: ", "triangle: ", "velocity: ", "magnitude: ", "speed: ", "time: "})
    EXPECT_NE(all.find(name), std::string::npos) << name << all;
  EXPECT_FALSE(scene_->probe(middle - Vec3d(0, 50, 0), {0, -1, 0}));
  change([](Settings& s) { s.view.play = false; });
  while (std::chrono::steady_clock::now() - start < std::chrono::seconds(20) &&
         probed->lines.back().rfind("texture: ", 0) != 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    scene_->advance(0);
    probed = scene_->probe(middle - Vec3d(0, 50, 0), along);
  }
  EXPECT_EQ(probed->lines.back().rfind("texture: 0.", 0), 0u) << probed->lines.back();
}

TEST_F(FlowInView, WhatIsCutAwayIsNotProbed) {
  open(small_session());
  advance();
  const Camera camera = fit_camera("iso", scene_->corners(), 120, 120);
  View view;
  view.width = view.height = 120;
  view.camera = camera;
  view.clip = ClipPlanes({{0, 1, 0}, camera.target.y});  // the half towards us is gone
  const Framebuffer frame(120, 120);
  frame.bind();
  scene_->draw(view);
  const auto probed = scene_->probe(camera.target - Vec3d(0, 50, 0), {0, 1, 0});
  ASSERT_TRUE(probed);
  EXPECT_GT(probed->position.y, camera.target.y);
  view.clip.add({{0, -1, 0}, -camera.target.y - 1e-3});  // and nearly all of the other
  scene_->draw(view);
  EXPECT_FALSE(scene_->probe(camera.target - Vec3d(0, 50, 0), {0, 1, 0}));
}

TEST_F(FlowInView, ThesisOctreesAreDrawnToo) {
  Session session = small_session();
  session.settings.flow.method = EmbeddingKind::octree;
  open(session);
  advance();
  const Image brick = picture();
  change([](Settings& s) { s.flow.octree = OctreeKind::thesis; });
  advance();
  EXPECT_EQ(scene_->steps(), 1);
  EXPECT_TRUE(scene_->warnings().empty());
  const Image source = picture();
  EXPECT_NE(source.pixels, brick.pixels);  // other particles
  advance();
  EXPECT_NE(picture().pixels, source.pixels);  // it flows
}

TEST_F(FlowInView, BoxesAreWrittenOnceAndNotCopied) {
  Session session = small_session();
  session.settings.view.play = false;
  open(session);
  for (const EmbeddingKind method : {EmbeddingKind::grid, EmbeddingKind::octree}) {
    SCOPED_TRACE(method == EmbeddingKind::grid ? "grid" : "octree");
    change([&](Settings& s) { s.flow.method = method, s.view.boxes = false; });
    advance();
    const Image plain = picture();
    change([](Settings& s) { s.view.boxes = true; });
    advance();
    EXPECT_EQ(scene_->steps(), 1);  // it stands still all the same
    const Image boxed = picture();
    EXPECT_NE(boxed.pixels, plain.pixels);
    advance();
    EXPECT_EQ(picture().pixels, boxed.pixels);
    change([](Settings& s) { s.view.boxes = false; });
    advance();
    EXPECT_EQ(picture().pixels, plain.pixels);
  }
  EXPECT_EQ(scene_->copied_bytes(), 0u);
}

TEST_F(FlowInView, BoxesBelongToTheEmbeddingThatIsShown) {
  Session session = small_session();
  session.settings.view.boxes = true;
  open(session);
  for (const OctreeKind octree : {OctreeKind::brick, OctreeKind::thesis, OctreeKind::brick})
    for (const int resolution : {48, 32, 64}) {
      change([&](Settings& s) {
        s.flow.method = EmbeddingKind::octree, s.flow.octree = octree, s.flow.resolution = resolution;
      });
      scene_->advance(0);  // asks again while it is being built
      advance();
      EXPECT_EQ(scene_->steps(), 1);
      const Image boxed = picture();
      change([](Settings& s) { s.view.boxes = false; });
      EXPECT_NE(picture().pixels, boxed.pixels) << int(octree) << " " << resolution;
      change([](Settings& s) { s.view.boxes = true; });
    }
  EXPECT_EQ(scene_->copied_bytes(), 0u);
}

TEST_F(FlowInView, FailuresAreThrownAndOtherKnobsMendThem) {
  open(small_session());
  advance();
  change([](Settings& s) { s.flow.resolution = 1 << 20; });
  EXPECT_THROW(advance(), Error);
  EXPECT_NE(scene_->failure(), "");
  change([](Settings& s) { s.flow.resolution = 64; });
  EXPECT_EQ(scene_->failure(), "");
  advance();
  EXPECT_EQ(scene_->steps(), 1);
}

TEST_F(FlowInView, PanelShowsFiguresAndChangesNothingByItself) {
  open(small_session());
  for (int k = 0; k < 5; ++k) advance();
  const std::string before = session_text(session_);
  const Framebuffer frame(420, 420);
  Image image;
  {
    FlowPanel panel(scene_->results());
    ImGuiLayer imgui(nullptr);
    for (int k = 0; k < 3; ++k) {  // sizes are known from the second one on
      frame.bind();
      frame.clear({1, 1, 1, 1});
      imgui.begin(420, 420, 0.1, session_.settings.view);
      panel.result_tab(session_);
      imgui.end();
    }
    image = frame.read();
  }
  if (const char* folder = std::getenv("NACRE_KEEP_PICTURES"))
    write_png(std::filesystem::path(folder) / "flow_panel.png", image);
  EXPECT_EQ(session_text(session_), before);
  std::set<std::array<int, 3>> colours;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) colours.insert({image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]});
  EXPECT_GT(colours.size(), 15u);  // of letters, frames, the plot's line; an empty window has five
}

TEST_F(FlowInView, TimesAreThoseOfTheDataFromTheFirst) {
  EXPECT_EQ(time_text(17280), "17280");
  EXPECT_EQ(time_text(0.1 + 0.2), "0.3");
  const test::TemporaryFolder folder;
  std::ofstream series(folder / "a.pvd");
  series << "<VTKFile type=\"Collection\" version=\"0.1\"><Collection>";
  for (const int k : {0, 1}) {
    const std::string name = "a" + std::to_string(k) + ".vtp";
    write_surface(folder / name, make_sample("sphere", 24).load(0));
    series << "<DataSet timestep=\"" << (k == 0 ? "17280.25" : "17281.5") << "\" file=\"" << name << "\"/>";
  }
  series << "</Collection></VTKFile>";
  series.close();
  Session session = small_session();
  session.sample.clear();
  session.inputs = {folder / "a.pvd"};
  open(session);
  std::set<std::string> states;
  while (!scene_->complete()) {
    scene_->advance(0);
    states.insert(scene_->state());
    ASSERT_EQ(scene_->failure(), "");
  }
  states.erase("");  // nothing was known
  EXPECT_EQ(states.begin()->substr(0, 13), "time 17280.25") << *states.begin();
  EXPECT_EQ(states.rbegin()->substr(0, 9), "time 1728") << *states.rbegin();
}

TEST_F(FlowInView, WhatCanBeTickedInALightPopupIsSeen) {
  ImGuiLayer imgui(nullptr);
  for (const Theme theme : {Theme::light, Theme::dark}) {
    session_.settings.view.theme = theme;
    imgui.begin(100, 100, 0.1, session_.settings.view);
    const ImVec4* colours = ImGui::GetStyle().Colors;
    const ImVec4 box = colours[ImGuiCol_FrameBg];
    for (const ImGuiCol behind : {ImGuiCol_PopupBg, ImGuiCol_WindowBg}) {
      const ImVec4 paper = colours[behind];
      const float differs = box.w * (std::abs(box.x - paper.x) + std::abs(box.y - paper.y) + std::abs(box.z - paper.z));
      EXPECT_GT(differs, 0.15f) << int(theme) << " " << ImGui::GetStyleColorName(behind);
    }
    imgui.end();
  }
}

TEST_F(FlowInView, WritesItsValues) {
  const test::TemporaryFolder folder;
  open(small_session());
  advance();
  ASSERT_EQ(scene_->result_formats(), std::vector<std::string>{".vtp"});
  scene_->write_result(folder / "a.vtp", "");
  EXPECT_GT(std::filesystem::file_size(folder / "a.vtp"), 1000u);
  EXPECT_THROW(scene_->write_result(folder / "no/such/folder/a.vtp", ""), Error);
}

}  // namespace
}  // namespace nacre
