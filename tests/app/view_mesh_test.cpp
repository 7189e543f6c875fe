// Nacre: meshes in the viewer, as a script runs it without a display.
#include <cstdlib>

#include "engine/picture/png.hpp"
#include "tests/app/mesh_program.hpp"
#include "tests/app/view_program.hpp"

namespace nacre::test {
namespace {

/// A mesh that is soon done: 20 iterations for its curve, 20 for its surfaces.
const Arguments quick = {"--sample", "two-spheres", "--detail", "20",      "--set",  "iterations=20",
                         "--set",    "remesh=0",    "--size",   "200x150", "--quiet"};

class ViewMesh : public MeshTest {
 protected:
  void SetUp() override {
    static const Outcome tried = nacre({"view", "--offscreen", "--sample", "sphere", "--detail", "24", "--resolution",
                                        "32", "--frames-count", "1", "--quiet"});
    if (tried.status == 1 && (contains(tried.err, "no viewer") || contains(tried.err, "no OpenGL")))
      GTEST_SKIP() << tried.err;
  }

  /// A picture of frame `frames`, and what the run says in "view" of its report.
  Image picture(int frames, const Arguments& more = {}) {
    const Outcome run = nacre(
        Arguments{"view", "--offscreen"} + quick +
        Arguments{"--frames-count", std::to_string(frames), "--image", path("v.png"), "--report", path("v.json")} +
        more);
    EXPECT_EQ(run.status, 0) << run.err;
    if (run.status != 0) return {};
    report = read_json("v.json");
    EXPECT_EQ(report["view"]["copied_bytes"], 0);
    EXPECT_TRUE(report["view"]["driver_messages"].empty()) << report["view"].dump(1);
    return read_png(path("v.png"));
  }

  nlohmann::json report;
};

double difference(const Image& a, const Image& b) {
  if (a.pixels.size() != b.pixels.size() || a.pixels.empty()) return 255;
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(int(a.pixels[i]) - int(b.pixels[i]));
  return sum / double(a.pixels.size());
}

/// Share of pixels that are not the white background.
double covered(const Image& image) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < image.pixels.size(); i += 4)
    n += image.pixels[i] < 250 || image.pixels[i + 1] < 250 || image.pixels[i + 2] < 250;
  return 4 * double(n) / double(std::max<std::size_t>(image.pixels.size(), 1));
}

TEST_F(ViewMesh, ParticlesGrowAndSettle) {
  const Arguments all_at_once{"--set", "coarse_iterations=0"};
  const Image early = picture(2, all_at_once);
  EXPECT_EQ(report["view"]["steps"], 2);
  const Image later = picture(36, all_at_once);
  EXPECT_EQ(report["view"]["steps"], 36);  // an iteration a frame
  EXPECT_GT(covered(early), 0.001);        // the curve alone
  EXPECT_GT(covered(later), 0.15);
  EXPECT_GT(difference(early, later), 3);
}

TEST_F(ViewMesh, TrianglesAreThoseOfTheHeadlessCommand) {
  const std::string camera = write("camera.json", R"({"eye": [60, -50, 40], "target": [12, 12, 12], "up": [0, 0, 1],
                                                      "height": 26})");
  const Arguments alike = {"--set", "legend=false", "--camera", camera};
  const Image view = picture(0, alike + Arguments{"--set", "edges=true", "--set", "curves=false"});
  ASSERT_EQ(nacre(Arguments{"mesh", "--image", path("m.png")} + quick + alike).status, 0);
  EXPECT_LT(difference(view, read_png(path("m.png"))), 2);
  EXPECT_GT(covered(view), 0.1);
}

TEST_F(ViewMesh, TwoReplaysAreTheSame) {
  const Arguments slice = {"--set", "slice=z", "--set", "slice_field=distance"};
  const Image first = picture(30, slice), second = picture(30, slice + Arguments{"--threads", "1"});
  EXPECT_EQ(difference(first, second), 0);
}

TEST_F(ViewMesh, OutIsThatOfTheHeadlessCommand) {
  for (const char* name : {"a.vtp", "a.stl"}) {
    ASSERT_EQ(nacre(Arguments{"mesh", "--out", path(name)} + quick).status, 0);
    const std::string mesh = bare(name);
    fs::remove(path(name));
    const Outcome run = nacre(Arguments{"view", "--offscreen", "--frames-count", "3", "--out", path(name)} + quick);
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_TRUE(bare(name) == mesh) << name;
  }
}

TEST_F(ViewMesh, TheSourcesPresetIsThatOfTheHeadlessCommand) {
  // Labels, a scalar that is cut at an iso-value, and a region of it.
  const std::vector<std::pair<Arguments, std::string>> inputs{{{"two-spheres"}, "catmull-rom"},
                                                              {{"ellipsoid"}, "b-spline"},
                                                              {{"ellipsoid", "--threshold", "0.3:0.6"}, "catmull-rom"}};
  for (const auto& [input, kernel] : inputs) {
    SCOPED_TRACE(kernel + " for " + input.back());
    const Arguments alike =
        Arguments{"--set", "resolution=100", "--sample"} + input +
        Arguments{"--detail", "20", "--preset", "source", "--theta", "0.8", "--quiet", "--save-session"};
    ASSERT_EQ(nacre(Arguments{"mesh"} + alike + Arguments{path("m.json")}).status, 0);
    const Outcome run =
        nacre(Arguments{"view", "--offscreen", "--frames-count", "1"} + alike + Arguments{path("v.json")});
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(read_json("v.json"), read_json("m.json"));
    EXPECT_EQ(read_json("m.json").at("knobs").at("kernel"), kernel);
  }
  const Outcome run = nacre({"view", "--offscreen", "--frames-count", "1", "--preset", "source", "--sample", "sphere"});
  EXPECT_EQ(run.status, 2);
  EXPECT_TRUE(contains(run.err, "volume")) << run.err;
}

TEST_F(ViewMesh, AVolumeWithoutAnIsovalueIsCutInALiveViewAndRefusedInAReplay) {
  ASSERT_EQ(nacre({"sample", "ellipsoid", "--detail", "24", "--out", path("e.nrrd")}).status, 0);
  const Arguments arguments = {"view", "--offscreen", path("e.nrrd"), "--size", "200x150", "--image", path("x.png")};
  const Outcome replay = nacre(arguments + Arguments{"--frames-count", "1"});
  EXPECT_EQ(replay.status, 1);
  EXPECT_TRUE(contains(replay.err, "needs an iso-value")) << replay.err;
  const Outcome live =
      nacre(arguments + Arguments{"--live", "--frames-count", "3", "--save-recording", path("done.json")});
  ASSERT_EQ(live.status, 0) << live.err;
  EXPECT_TRUE(contains(live.err, "iso-value 0.")) << live.err;
  const nlohmann::json events = read_json("done.json")["events"];
  ASSERT_FALSE(events.empty());
  EXPECT_TRUE(contains(events[0]["knobs"]["isovalue"].get<std::string>(), "0.")) << events.dump(1);
}

TEST_F(ViewMesh, LooksChangeWhatIsSeenAndNothingElse) {
  const Image plain = picture(0);
  const double all = covered(plain);
  EXPECT_LT(covered(picture(0, {"--set", "hidden=1"})), 0.85 * all);
  EXPECT_GT(difference(plain, picture(0, {"--set", "ghosts=1"})), 1);
  EXPECT_LT(covered(picture(0, {"--set", "clip=x", "--set", "clip_at=0.6"})), 0.85 * all);
  // Across the diagonal, and half of the rest: the balls lie side by side along x, in a cube of 47 units.
  const double half = covered(picture(0, {"--set", "clip_planes=0 1 1 23 23 23"}));
  EXPECT_LT(half, all);
  EXPECT_LT(covered(picture(0, {"--set", "clip_planes=0 1 1 23 23 23;-1 0 0 20 23 23"})), 0.75 * half);
  EXPECT_EQ(covered(picture(0, {"--set", "clip_planes=0 1 1 23 23 23;0 -1 -1 23 22 22", "--set", "legend=false"})), 0)
      << "they leave nothing";
  EXPECT_GT(difference(plain, picture(0, {"--set", "worst=30"})), 0.2);
  EXPECT_GT(difference(plain, picture(0, {"--set", "triangles=false"})), 1);  // particles instead
}

TEST_F(ViewMesh, SlicesOfAllFields) {
  for (const char* field : {"volume", "material", "distance", "size"})
    EXPECT_GT(
        covered(picture(0, {"--set", "slice=y", "--set", std::string("slice_field=") + field, "--set", "hidden=1,2"})),
        0.15)
        << field;
}

/// The plane cuts the mesh, and its slice closes the cut.
TEST_F(ViewMesh, ASliceInTheFirstOfTheClipPlanes) {
  const Arguments cut = {"--set", "clip_planes=1 2 -1 23 23 23"};
  const Image open = picture(0, cut);
  for (const char* field : {"volume", "material", "distance", "size"}) {
    const Arguments slice = {"--set", "slice=plane", "--set", std::string("slice_field=") + field};
    EXPECT_GT(difference(open, picture(0, cut + slice)), 1) << field;
    EXPECT_GT(covered(picture(0, cut + slice + Arguments{"--set", "hidden=1,2"})), 0.15) << field;
  }
  EXPECT_EQ(difference(picture(0), picture(0, {"--set", "slice=plane"})), 0) << "there is no plane";
}

/// A bar of 10 x 5 voxels in a volume of 20 x 20, all along z: a file that any program could write.
std::string bar_volume() {
  std::string file = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 20 20\nencoding: raw\n\n";
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) file += char(x >= 5 && x < 15 && y >= 10 && y < 15 && z >= 2 && z < 18 ? 1 : 0);
  return file;
}

TEST_F(ViewMesh, ThreeSlicesLieBesideTheView) {
  const std::string file = write("bar.nrrd", bar_volume());
  const Arguments words = {"view",    "--offscreen",   file,       "--size",     "400x300",
                           "--quiet", "--set",         "remesh=0", "--set",      "legend=false",
                           "--set",   "layout=slices", "--image",  path("s.png")};
  const auto slices = [&](const Arguments& more) {
    const Outcome run = nacre(words + more);
    EXPECT_EQ(run.status, 0) << run.err;
    return read_png(path("s.png"));
  };
  const Image image = slices({"--set", "material_colors=1:#3366cc"});
  // Pixels of the bar in a part of the picture, and where they lie in it.
  struct Found {
    int count = 0, left = 1000, right = -1, top = 1000, bottom = -1;
  };
  const auto found = [](const Image& drawn, int x0, int y0) {
    Found f;
    for (int y = 0; y < 150; ++y)
      for (int x = 0; x < 200; ++x) {
        const std::uint8_t* p = drawn.at(x0 + x, y0 + y);
        if (p[0] != 0x33 || p[1] != 0x66 || p[2] != 0xcc) continue;
        ++f.count;
        f.left = std::min(f.left, x), f.right = std::max(f.right, x);
        f.top = std::min(f.top, y), f.bottom = std::max(f.bottom, y);
      }
    return f;
  };
  const double voxel = 150 / (1.12 * 20);  // pixels: the volume's 20 voxels and a margin fill the height
  const auto expect_bar = [&](const Found& f, double left, double right, double low, double high) {
    EXPECT_NEAR(f.left, 100 + (left - 10) * voxel, 2.5);
    EXPECT_NEAR(f.right, 100 + (right - 10) * voxel, 2.5);
    EXPECT_NEAR(f.top, 75 - (high - 10) * voxel, 2.5);
    EXPECT_NEAR(f.bottom, 75 - (low - 10) * voxel, 2.5);
    EXPECT_NEAR(f.count, (right - left) * (high - low) * voxel * voxel, 0.25 * f.count) << "but for the lines on it";
  };
  expect_bar(found(image, 0, 0), 5, 15, 10, 15);         // across z
  expect_bar(found(image, 0, 150), 5, 15, 2, 18);        // across y
  expect_bar(found(image, 200, 150), 10, 15, 2, 18);     // across x
  const auto dark = [&](int x0, int y0, int x, int y) {  // is there an outline near this pixel?
    for (int dy = -4; dy <= 4; ++dy)
      for (int dx = -4; dx <= 4; ++dx)
        if (const std::uint8_t* p = image.at(x0 + x + dx, y0 + y + dy); p[0] + p[1] + p[2] < 120) return true;
    return false;
  };
  EXPECT_TRUE(dark(0, 0, int(100 - 5 * voxel), int(75 - 2.5 * voxel))) << "the mesh ends where the bar does";
  EXPECT_FALSE(dark(0, 0, int(100 - 2.5 * voxel), int(75 - 2.5 * voxel)));
  const Image beside = slices({"--set", "material_colors=1:#3366cc", "--set", "crosshair=0.1 0.5 0.5"});
  EXPECT_EQ(found(beside, 200, 150).count, 0) << "there is no bar at the third voxel along x";
  EXPECT_GT(found(beside, 0, 0).count, 1000);
  const Image alone = slices({"--set", "material_colors=1:#3366cc", "--set", "layout=z"});
  EXPECT_GT(found(alone, 100, 0).count, 2500) << "twice as large";
  const Outcome flow =
      nacre({"view", "--offscreen", "--sample", "sphere", "--detail", "24", "--resolution", "32", "--frames-count", "2",
             "--set", "layout=slices", "--image", path("f.png"), "--size", "400x300"});
  EXPECT_EQ(flow.status, 0);
  EXPECT_FALSE(contains(flow.err, "layout")) << flow.err;
}

TEST_F(ViewMesh, ALabelThatIsNotThereIsAWarning) {
  const Outcome run = nacre({"view", "--offscreen", "--sample", "two-spheres", "--detail", "20", "--frames-count", "2",
                             "--set", "hidden=9", "--image", path("x.png")});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "no label 9")) << run.err;
}

TEST_F(ViewMesh, FailuresAreOneLine) {
  const Outcome run = nacre(Arguments{"view", "--offscreen", "--set", "materials=7", "--image", path("x.png")} + quick);
  EXPECT_EQ(run.status, 1) << run.err;
  EXPECT_TRUE(contains(run.err, "7")) << run.err;
  EXPECT_FALSE(exists("x.png"));
}

TEST_F(ViewMesh, LiveFramesDoNotWaitForCompute) {
  picture(30, {"--live", "--panel", "--set", "tab=result", "--set", "boxes=true"});
  EXPECT_GE(report["view"]["frames"], 30);
}

TEST_F(ViewMesh, LiveOneEndsWhenItIsDone) {
  const Outcome run =
      nacre(Arguments{"view", "--offscreen", "--live", "--out", path("v.vtp"), "--image", path("v.png")} + quick);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_GT(covered(read_png(path("v.png"))), 0.1);
  EXPECT_TRUE(exists("v.vtp"));
}

/// The memory of the particles' positions is there, that of their directions is not.
TEST_F(ViewMesh, AWindowOutlivesMemoryThatItDoesNotGet) {
  const Outcome run = in_window(quick + Arguments{"--frames-count", "20"}, "export NACRE_FAULTS=graphics-memory@2");
  if (run.status == 77) GTEST_SKIP() << run.err;
  EXPECT_EQ(run.status, 0) << run.err;
}

}  // namespace
}  // namespace nacre::test
