// Nacre: tests of what results say of how they were made, and of making them again.
#include <map>

#include "tests/app/mesh_program.hpp"

namespace nacre::test {
namespace {

class Rerun : public MeshTest {
 protected:
  /// `nacre rerun` says that the file is the same; and with --out, it makes the same bytes.
  void expect_same(const std::string& name, const Arguments& more = {}) const {
    const Outcome compared = nacre(Arguments{"rerun", path(name), "--quiet"} + more);
    EXPECT_EQ(compared.status, 0) << compared.err;
    EXPECT_EQ(compared.out, path(name) + ": the same\n");
    const std::string again = "again" + fs::path(name).extension().string();
    const Outcome written = nacre(Arguments{"rerun", path(name), "--quiet", "--out", path(again)} + more);
    EXPECT_EQ(written.status, 0) << written.err;
    EXPECT_EQ(written.out, path(again) + "\n");
    if (fs::path(name).extension() != ".json") {
      EXPECT_EQ(content(again), content(name)) << name;
    }
  }
  std::string of_origin(const std::string& name) const {
    const std::string text = content(name);
    return text.substr(text.find("{\"Nacre origin\":"), 4000);
  }
};

TEST_F(Rerun, PictureAndValuesOfAFlow) {
  const Arguments flow =
      small_flow + Arguments{"--size", "96x72", "--seed", "5", "--camera", "+x", "--step-cells", "3.7"};
  ASSERT_EQ(nacre(flow + Arguments{"--image", path("a.png")}).status, 0);
  ASSERT_EQ(
      nacre(flow + Arguments{"--image", path("b.png"), "--out", path("b.vtp"), "--report", path("b.json")}).status, 0);
  for (const char* name : {"a.png", "b.png", "b.vtp", "b.json"}) expect_same(name);
  expect_same("a.png", {"--threads", "1"});
  const std::string said = of_origin("a.png");
  for (const char* part : {"\"command\":\"flow\"", "\"sample\":\"sphere\"", "\"seed\":\"5\"", "\"step_cells\":\"3.7\""})
    EXPECT_TRUE(contains(said, part)) << part << "\n" << said;
  for (const std::string& word :
       Arguments{path(""), "threads", "a.png"})  // nothing of this machine, nothing of the name
    EXPECT_FALSE(contains(content("a.png"), word)) << word;
}

TEST_F(Rerun, PartOfARunAndMeansOverTime) {
  const Arguments flow = small_flow + Arguments{"--size", "96x72"};
  ASSERT_EQ(nacre(flow + Arguments{"--chunk", "2/2", "--lead-in", "3", "--image", path("part.png")}).status, 0);
  expect_same("part.png");
  ASSERT_EQ(nacre(flow + Arguments{"--haemodynamics", path("means.vtp")}).status, 0);
  expect_same("means.vtp");
}

TEST_F(Rerun, TopologyStreamlinesAndFlowMaps) {
  ASSERT_EQ(nacre(small_flow + Arguments{"--topology-out", path("points.vtp"), "--streamlines-out", path("lines.vtp"),
                                         "--persistence", "0.1", "--ftle-out", path("map.vtp"), "--ftle-time=-0.4",
                                         "--tracks-out", path("tracks.vtp"), "--report", path("a.json")})
                .status,
            0);
  for (const char* name : {"points.vtp", "lines.vtp", "map.vtp", "tracks.vtp", "a.json"}) expect_same(name);
}

TEST_F(Rerun, MeshWithSizesFromAnImage) {
  const std::string file = write("a.nrrd", ball_nrrd());
  const std::string sizes =
      write("s.nrrd", nrrd<int>({4, 4, 4}, "uchar", "spacings: 5 5 5\n", [](int i, int, int) { return 1 + i; }));
  ASSERT_EQ(nacre({"mesh", file, "--quiet", "--size-image", sizes, "--out", path("a.vtp")}).status, 0);
  expect_same("a.vtp");
  write("s.nrrd", nrrd<int>({4, 4, 4}, "uchar", "spacings: 5 5 5\n", [](int, int, int) { return 2; }));
  const Outcome changed = nacre({"rerun", path("a.vtp"), "--quiet"});
  EXPECT_EQ(changed.status, 1);
  EXPECT_TRUE(contains(changed.err, "s.nrrd")) << changed.err;
}

TEST_F(Rerun, CameraOfASession) {
  write("s.json", R"({"nacre": "session 1", "sample": "sphere", "detail": 24, "knobs": {"resolution": 64, "steps": 1},
    "camera": {"eye": [3, 2, 1], "target": [0, 0, 0], "up": [0, 0, 1], "height": 2.5, "orthographic": false}})");
  const Outcome run =
      nacre(Arguments{"flow", "--session", path("s.json"), "--quiet", "--size", "96x72", "--image", path("a.png")});
  ASSERT_EQ(run.status, 0) << run.err;
  fs::remove(folder_ / "s.json");
  expect_same("a.png");
}

TEST_F(Rerun, AFileFromElsewhereWritesNothingElse) {
  ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path("a.ply"), "--report", path("a.json"), "--per-material"}).status,
            0);
  for (const auto& [before, after] :
       std::map<std::string, std::string>{{R"("--per-material")", R"("--report=)" + path("stolen") + R"(")"},
                                          {R"("output": "report")", R"("output": "save-session")"},
                                          {R"(".ply")", R"("/../stolen")"},
                                          {R"("command": "mesh")", R"("command": "sample")"}}) {
    std::string text = content("a.json");
    const std::size_t at = text.rfind(before);
    ASSERT_NE(at, text.npos) << before;
    write("b.json", text.replace(at, before.size(), after));
    expect_failure(nacre({"rerun", path("b.json")}), 1, {"not by nacre"});
    EXPECT_FALSE(exists("stolen"));
  }
}

TEST_F(Rerun, EveryFormatOfMeshes) {
  for (const char* name :
       {"a.vtp", "a.ply", "a.obj", "a.off", "a.glb", "a.vtu", "a.msh", "a.msh4", "a.inp", "a.mesh", "a.feb"}) {
    ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path(name), "--iterations", "3"}).status, 0);
    const Outcome run = nacre({"rerun", path(name), "--quiet"});
    EXPECT_EQ(run.status, 0) << name << "\n" << run.err;
  }
  expect_same("a.vtp");
}

TEST_F(Rerun, MeshFromAFileWithPictureParticlesAndReport) {
  write("ball.nrrd", ball_nrrd());
  const Arguments mesh = {"mesh", path("ball.nrrd"), "--quiet", "--preset", "source", "--max-size",
                          "3",    "--min-size",      "2"};
  ASSERT_EQ(nacre(mesh + Arguments{"--out", path("m.stl"), "--particles-out", path("p.vtp"), "--image", path("m.png"),
                                   "--cut-away", "--size", "96x72", "--report", path("m.json")})
                .status,
            0);
  for (const char* name : {"p.vtp", "m.png", "m.json"}) expect_same(name);
  // STL has no place for it: the report makes it again.
  expect_failure(nacre({"rerun", path("m.stl")}), 1, {"does not say how it was made", "report"});
  const Outcome from_report = nacre({"rerun", path("m.json"), "--quiet", "--out", path("again.stl")});
  EXPECT_EQ(from_report.status, 0) << from_report.err;
  EXPECT_EQ(content("again.stl"), content("m.stl"));
  EXPECT_TRUE(contains(content("m.json"), "\"sha256\""));

  ASSERT_EQ(nacre(mesh + Arguments{"--per-material", "--out", path("one.ply")}).status, 0);
  EXPECT_EQ(nacre({"rerun", path("one_1.ply"), "--quiet"}).out, path("one_1.ply") + ": the same\n");
}

TEST_F(Rerun, InputsThatHaveChanged) {
  write("ball.nrrd", ball_nrrd());
  ASSERT_EQ(nacre({"mesh", path("ball.nrrd"), "--quiet", "--out", path("m.ply")}).status, 0);
  write("ball.nrrd", ball_nrrd("spacings: 1 1 2\n"));
  expect_failure(nacre({"rerun", path("m.ply")}), 1, {"ball.nrrd has changed since"});
  fs::remove(folder_ / "ball.nrrd");
  expect_failure(nacre({"rerun", path("m.ply"), "--out", path("n.ply")}), 1, {"ball.nrrd is not there"});
  EXPECT_FALSE(exists("n.ply"));
}

TEST_F(Rerun, ResultsThatAreNotTheSame) {
  ASSERT_EQ(nacre(small_flow + Arguments{"--size", "96x72", "--image", path("a.png")}).status, 0);
  std::string bytes = content("a.png");
  bytes[bytes.size() - 20] ^= 1;
  write("b.png", bytes);
  expect_failure(nacre({"rerun", path("b.png"), "--quiet"}), 1, {"is not the same"});
  write("c.png", bytes.substr(0, 200));
  expect_failure(nacre({"rerun", path("c.png")}), 1, {"does not say how it was made"});
  write("d.png", "no picture");
  expect_failure(nacre({"rerun", path("d.png")}), 1, {"does not say how it was made"});
  expect_failure(nacre({"rerun", path("none.png")}), 1, {"no such file"});
}

TEST_F(Rerun, VideoHasItsOriginAsComment) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "no ffmpeg";
  for (const char* name : {"a.mp4", "a.mkv"}) {
    ASSERT_EQ(nacre(small_flow + Arguments{"--size", "96x72", "--video", path(name)}).status, 0);
    EXPECT_TRUE(contains(of_origin(name), "\"output\":\"video\"")) << name;
    const Outcome run = nacre({"rerun", path(name), "--quiet"});
    EXPECT_EQ(run.status, 0) << name << "\n" << run.err;
  }
}

TEST_F(Rerun, VideoOfFramesThatWereJoined) {
  if (find_program("ffmpeg").empty()) GTEST_SKIP() << "no ffmpeg";
  ASSERT_EQ(nacre(small_flow + Arguments{"--size", "96x72", "--frames", path("frames")}).status, 0);
  ASSERT_EQ(nacre({"join", path("frames"), "--video", path("a.mkv"), "--fps", "7", "--report", path("a.json")}).status,
            0);
  EXPECT_TRUE(contains(of_origin("a.mkv"), "\"command\":\"join\"")) << of_origin("a.mkv");
  for (const char* name : {"a.mkv", "a.json"}) {
    const Outcome run = nacre({"rerun", path(name), "--quiet"});
    EXPECT_EQ(run.status, 0) << name << "\n" << run.err;
  }
  fs::copy_file(path("frames/frame_0000.png"), path("frames/frame_0001.png"), fs::copy_options::overwrite_existing);
  expect_failure(nacre({"rerun", path("a.mkv"), "--quiet"}), 1, {"a.mkv", "have changed"});
  fs::remove(path("frames/frame_0000.png"));
  expect_failure(nacre({"rerun", path("a.mkv"), "--quiet"}), 1, {"frame_0000.png"});
}

}  // namespace
}  // namespace nacre::test
