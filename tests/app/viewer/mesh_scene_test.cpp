// Nacre: a mesh in the viewer's loop, on an OpenGL context without a display.
#include "app/viewer/mesh/mesh_scene.hpp"

#include <chrono>
#include <functional>
#include <thread>

#include "app/viewer/scene/scene_view.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/io/nrrd_writer.hpp"
#include "tests/app/viewer/scene_in_view.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

class MeshInView : public test::SceneInView<MeshScene> {
 protected:
  void open(bool lockstep, int iterations = 20) {
    if (session_.inputs.empty()) session_.sample = "two-spheres", session_.detail = 20;
    session_.settings.mesh.iterations = iterations;
    if (iterations > 20) session_.settings.mesh.stagnation = 0;
    session_.settings.mesh.remesh = 0;
    SceneOptions options;
    options.open_device = [] { return make_cpu_device(2); };
    options.lockstep = lockstep;
    scene_ = std::make_unique<MeshScene>(session_, options);
  }

  void advance() { scene_->advance_and_wait(stop_); }

  bool settles() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!scene_->settled() && std::chrono::steady_clock::now() < end) advance();
    return scene_->settled();
  }

  /// Pixels that are not white.
  int drawn() {
    View view = scene_view(session_, scene_->corners(), 0, 120, 120);
    view.camera = fit_camera("iso", scene_->corners(), 120, 120);
    const Framebuffer frame(120, 120);
    frame.bind();
    frame.clear({1, 1, 1, 1});
    scene_->draw(view);
    const Image image = frame.read();
    int count = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
      count += image.pixels[i] != 255 || image.pixels[i + 1] != 255;
    return count;
  }

  /// The line of a probe that begins like this.
  static std::string line(const ProbeResult& probed, const std::string& name) {
    for (const std::string& one : probed.lines)
      if (one.starts_with(name + ": ")) return one.substr(name.size() + 2);
    return "";
  }

  std::atomic<bool> stop_{false};
};

TEST_F(MeshInView, EachCallIsOneIteration) {
  open(true);
  for (int k = 1; k <= 25; ++k) {
    advance();
    EXPECT_EQ(scene_->steps(), k);
    EXPECT_TRUE(scene_->complete());
    EXPECT_GT(drawn(), 0) << k;
  }
  EXPECT_FALSE(scene_->settled());
  EXPECT_TRUE(settles());
  EXPECT_GT(drawn(), 1500);
  EXPECT_EQ(scene_->copied_bytes(), 0u);
  EXPECT_EQ(scene_->failure(), "");
}

TEST_F(MeshInView, APreviewIsSeenBeforeThereAreParticles) {
  open(false, 200);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  int most = 0;
  bool replaced = false;
  while (!scene_->settled() && std::chrono::steady_clock::now() < end) {
    scene_->advance(0);
    if (scene_->previews()) most = std::max(most, drawn());
    replaced = replaced || (most > 0 && !scene_->previews());
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_GT(most, 1500);  // both spheres, not the box alone
  EXPECT_TRUE(replaced);
}

TEST_F(MeshInView, MaterialsHaveOpacitiesAndColours) {
  open(true);
  EXPECT_TRUE(settles());
  const auto red = [&] {
    View view = scene_view(session_, scene_->corners(), 0, 120, 120);
    view.camera = fit_camera("iso", scene_->corners(), 120, 120);
    const Framebuffer frame(120, 120);
    frame.bind();
    frame.clear({1, 1, 1, 1});
    scene_->draw(view);
    const Image image = frame.read();
    int count = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
      count += image.pixels[i] > 2 * image.pixels[i + 1] && image.pixels[i] > 2 * image.pixels[i + 2];
    return count;
  };
  EXPECT_EQ(red(), 0);
  change([](Settings& s) { s.view.material_colors = "1:#ff0000"; });
  const int solid = red();
  EXPECT_GT(solid, 500);
  change([](Settings& s) { s.view.opacity = "1:0.2"; });
  EXPECT_LT(red(), solid / 10);  // pale
  change([](Settings& s) { s.view.opacity = "1:0"; });
  EXPECT_EQ(red(), 0);
}

TEST_F(MeshInView, AFilmThatBeginsInTheMiddleGoesOnInLockstep) {
  open(false, 200);
  while (scene_->steps() < 3) scene_->advance(0);
  scene_->set_lockstep(true);
  advance();  // what had been told before
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  advance();
  const int begun = scene_->steps();
  for (int k = 1; k <= 10; ++k) {
    advance();
    std::this_thread::sleep_for(std::chrono::milliseconds(k % 2 ? 20 : 0));  // which it does not use to run ahead
    EXPECT_EQ(scene_->steps(), begun + k);
  }
  int waits = 0;
  while (!scene_->settled() && waits < 100000) waits += !scene_->advance_and_wait(stop_, 1e-4);
  EXPECT_TRUE(scene_->settled());
  EXPECT_GT(waits, 0);  // an impatient call comes back without a frame
  change([](Settings& s) { s.mesh.theta *= 0.9; });
  advance();
  scene_->set_lockstep(false);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!scene_->settled() && std::chrono::steady_clock::now() < end) scene_->advance(0);
  EXPECT_TRUE(scene_->settled());
}

TEST_F(MeshInView, ChangesInTheMiddleAreTakenOver) {
  open(true);
  for (int k = 0; k < 12; ++k) {
    for (int i = 0; i < 3 * k; ++i) advance();
    change([&](Settings& s) {
      (k % 3 == 0 ? s.mesh.theta : k % 3 == 1 ? s.mesh.epsilon : s.mesh.max_size) *= k % 2 ? 0.9 : 1.1;
      s.view.boxes = k % 2 == 0;
      s.view.slice = k % 4 == 0 ? PlaneAxis::none : PlaneAxis::y;
      s.view.slice_field = k % 3 == 0 ? SliceField::distance : SliceField::size;
    });
    advance();
    drawn();
  }
  EXPECT_TRUE(settles());
  EXPECT_EQ(scene_->failure(), "");
}

TEST_F(MeshInView, CancelStopsAndResumeGoesOn) {
  open(true);
  for (int k = 0; k < 25; ++k) advance();
  scene_->cancel();
  advance();
  advance();
  EXPECT_LE(scene_->steps(), 26);
  EXPECT_FALSE(scene_->settled());
  EXPECT_TRUE(scene_->halted());
  EXPECT_TRUE(scene_->state().ends_with("cancelled")) << scene_->state();
  EXPECT_GT(drawn(), 100);  // what there is stays
  scene_->resume();
  EXPECT_FALSE(scene_->halted());
  EXPECT_TRUE(settles());
  EXPECT_FALSE(scene_->state().ends_with("cancelled"));
}

TEST_F(MeshInView, AProbeTellsWhatIsUnderTheCursor) {
  open(true);
  EXPECT_FALSE(scene_->probe({0, 0, 0}, {0, 0, 1}));
  ASSERT_TRUE(settles());
  const std::vector<Vec3d>& corners = scene_->corners();
  const Vec3d middle = (corners.front() + corners.back()) * 0.5, from = middle - Vec3d(100, 0, 0), along(1, 0, 0);
  const std::optional<ProbeResult> probed = scene_->probe(from, along);
  ASSERT_TRUE(probed);
  EXPECT_NEAR(probed->position.x, corners.front().x, 1.5);
  EXPECT_EQ(line(*probed, "between"), "outside and 1");
  const double ratio = std::stod(line(*probed, "radius ratio"));
  EXPECT_TRUE(ratio > 0.3 && ratio <= 1) << ratio;
  const Vec3d spacing = scene_->results().volume->input.spacing;
  ASSERT_NE(spacing.x, 1) << "or voxels could not be told from the world's units";
  const double size = std::stod(line(*probed, "wanted size"));  // voxels
  EXPECT_GE(size, 0.999 * session_.settings.mesh.min_size);
  EXPECT_LE(size, 1.001 * session_.settings.mesh.max_size);
  change([](Settings& s) { s.view.hidden = "1"; });
  const std::optional<ProbeResult> behind = scene_->probe(from, along);
  ASSERT_TRUE(behind);
  EXPECT_EQ(line(*behind, "between"), "1 and 2");
  change([](Settings& s) { s.view.clip = PlaneAxis::x, s.view.clip_at = 0.9; });
  const std::optional<ProbeResult> beyond = scene_->probe(from, along);
  ASSERT_TRUE(beyond);
  EXPECT_EQ(line(*beyond, "between"), "outside and 2");
  change([](Settings& s) { s.view.slice = PlaneAxis::x, s.view.slice_at = 0.1; });
  advance();
  const std::optional<ProbeResult> slice = scene_->probe(from, along);
  ASSERT_TRUE(slice);
  EXPECT_LT(slice->position.x, beyond->position.x);
  EXPECT_NE(line(*slice, "material"), "");
  EXPECT_FALSE(scene_->probe(from, along * -1.0));
}

TEST_F(MeshInView, AProbeTellsTheProbabilityOfWhatIsThere) {
  const test::TemporaryFolder folder;
  for (const char* name : {"left", "right"}) {
    Volume volume;
    volume.dims = {12, 8, 8};
    std::vector<std::uint8_t> values(12 * 8 * 8, 0);
    for (std::size_t i = 0; i < values.size(); ++i)
      if ((i % 12 < 6) == (std::string(name) == "left")) values[i] = i % 12 < 6 ? 200 : 250;
    volume.values = std::move(values);
    write_nrrd(folder / (name + std::string(".nrrd")), volume);
    session_.inputs.push_back(folder / (name + std::string(".nrrd")));
  }
  open(true);
  advance();
  change([](Settings& s) { s.view.slice = PlaneAxis::z; });
  const std::optional<ProbeResult> left = scene_->probe({2, 4, 100}, {0, 0, -1}),
                                   right = scene_->probe({9, 4, 100}, {0, 0, -1});
  ASSERT_TRUE(left && right);
  EXPECT_EQ(line(*left, "material"), "1 left");
  EXPECT_EQ(line(*left, "left"), "200");
  EXPECT_EQ(line(*right, "right"), "250");
  EXPECT_EQ(line(*right, "volume"), "") << "of which file?";
}

TEST_F(MeshInView, SlicesAndOutlinesAreMadeWhereTheyHaveChanged) {
  open(true);
  ASSERT_TRUE(settles());
  EXPECT_EQ(scene_->slices(), nullptr) << "nobody wants them";
  change([](Settings& s) { s.view.layout = ViewLayout::slices; });
  auto* slices = dynamic_cast<OrthoSlices*>(scene_->slices());
  ASSERT_TRUE(slices);
  const auto draw_all = [&] {
    for (int k = 0; k < 3; ++k) {
      View view;
      view.width = view.height = 120;
      view.camera = scene_->slices()->camera(k, 1);
      const Framebuffer frame(120, 120);
      frame.bind();
      frame.clear({1, 1, 1, 1});
      scene_->slices()->draw(k, view);
    }
    return std::array{slices->images_made(), slices->outlines_made()};
  };
  EXPECT_EQ(draw_all(), (std::array{3, 3}));
  EXPECT_EQ(draw_all(), (std::array{3, 3})) << "nothing has changed";
  change([&](Settings& s) { s.view.crosshair = slices->crosshair_after(1, 2); });
  EXPECT_EQ(draw_all(), (std::array{4, 4})) << "one slice moves";
  change([](Settings& s) { s.view.hidden = "1"; });
  EXPECT_EQ(draw_all(), (std::array{4, 7})) << "outlines of what is hidden go";
  change([](Settings& s) { s.view.material_colors = "2:#ff0000"; });
  EXPECT_EQ(draw_all(), (std::array{7, 7}));
  change([](Settings& s) { s.view.edges = true; });
  EXPECT_EQ(draw_all(), (std::array{7, 7}));
  const Vec3d middle = (scene_->corners().front() + scene_->corners().back()) * 0.5;
  change([&](Settings& s) { s.view.crosshair = slices->crosshair_at(2, middle + Vec3d(4, 0, 0)); });
  const std::optional<ProbeResult> probed = scene_->slices()->probe(2, middle + Vec3d(4, 0, 100), Vec3d(0, 0, -1));
  ASSERT_TRUE(probed);
  EXPECT_EQ(line(*probed, "material"), "2");
}

TEST_F(MeshInView, WhatIsSeenIsTheVolumeUntilThereAreParticles) {
  open(false, 200);
  while (scene_->corners().empty()) scene_->advance(0);
  if (!scene_->complete()) {
    EXPECT_FALSE(scene_->has_legend());
    if (scene_->previews())
      EXPECT_EQ(scene_->seen(), scene_->corners());
    else
      EXPECT_GT(scene_->seen().back().x, scene_->corners().back().x) << "the box around all voxels";
  }
  while (!scene_->complete()) scene_->advance(0);
  EXPECT_EQ(scene_->seen(), scene_->corners());
  EXPECT_TRUE(scene_->has_legend()) << "of the particles";
  const std::uint64_t before = scene_->seen_version();
  change([](Settings& s) { s.view.slice = PlaneAxis::x, s.mesh.iterations = 20; });
  EXPECT_NE(scene_->seen_version(), before);
  EXPECT_GT(scene_->seen().back().x, scene_->corners().back().x);
  change([](Settings& s) { s.view.slice = PlaneAxis::none; });
  EXPECT_TRUE(settles());
  EXPECT_FALSE(scene_->has_legend()) << "triangles have none";
}

TEST_F(MeshInView, WritesWhereItIsLiveToo) {
  open(false);
  const test::TemporaryFolder folder;
  EXPECT_THROW(scene_->write_result(folder / "a.nosuch", ""), Error);
  scene_->write_result(folder / "a.vtp", "");
  EXPECT_TRUE(std::filesystem::exists(folder / "a.vtp"));
  const std::vector<std::string> formats = scene_->result_formats();
  for (const char* format : {".vtp", ".stl", ".vtu", ".msh"})
    EXPECT_EQ(std::count(formats.begin(), formats.end(), format), 1) << format;
}

TEST_F(MeshInView, AFailureIsToldAndOtherKnobsEndIt) {
  open(true);
  ASSERT_TRUE(settles());
  change([](Settings& s) { s.materials.materials = "77"; });
  EXPECT_THROW(
      {
        for (int k = 0; k < 5; ++k) advance();
      },
      Error);
  EXPECT_NE(scene_->failure(), "");
  change([](Settings& s) { s.materials.materials = "2"; });
  for (int k = 0; k < 10000 && !scene_->failure().empty(); ++k) {
    scene_->advance(0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(settles());
}

}  // namespace
}  // namespace nacre
