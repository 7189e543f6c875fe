// Nacre: tests of the arguments of `nacre mesh`.
#include "tests/app/mesh_program.hpp"

namespace nacre::test {
namespace {

TEST(MeshCommandLine, HelpHasEveryOptionOfTheContract) {
  const Outcome help = nacre({"mesh", "--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* option :
       {"--labels",    "--isovalue",      "--threshold",    "--preset",    "--solver",  "--epsilon",
        "--delta",     "--min-size",      "--max-size",     "--materials", "--merge",   "--min-component",
        "--theta",     "--iterations",    "--particles",    "--tighten",   "--kernel",  "--keep-on-interrupt",
        "--out",       "--particles-out", "--image",        "--sample",    "--device",  "--threads",
        "--seed",      "--report",        "--quiet",        "--set",       "--session", "--save-session",
        "--curvature", "--per-material",  "--surface-only", "--detail",    "--camera",  "--background"})
    EXPECT_TRUE(contains(help.out, option)) << option;
  for (const char* of_flow : {"--ttl", "--step-cells", "--colormap"})
    EXPECT_FALSE(contains(help.out, of_flow)) << of_flow;
  const Outcome flow = nacre({"flow", "--help"});
  EXPECT_FALSE(contains(flow.out, "--epsilon"));
  EXPECT_TRUE(contains(flow.out, "--seed"));
}

TEST(MeshCommandLine, WrongOnesEndWithTwo) {
  expect_failure(nacre({"mesh"}), 2, {"--sample", "FILE"});
  expect_failure(nacre({"mesh", "a.nrrd", "--sample", "two-spheres"}), 2, {"not both"});
  expect_failure(nacre({"mesh", "--sample", "two-sphres"}), 2, {"two-spheres", "torso"});
  expect_failure(nacre({"mesh", "--sample", "torso", "--detail", "5"}), 2, {"16 to 1024"});
  for (const auto& [arguments, part] :
       std::vector<std::pair<Arguments, std::string>>{{{"--solver", "magic"}, "tree|redblack|serial"},
                                                      {{"--epsilon", "0"}, "--epsilon 0"},
                                                      {{"--delta", "-1"}, "--delta -1"},
                                                      {{"--epsilon", "nan"}, "nan"},
                                                      {{"--kernel", "cubic"}, "b-spline"},
                                                      {{"--min-size", "2", "--max-size", "1"}, "--min-size 2"},
                                                      {{"--iterations", "1.5"}, "1.5"},
                                                      {{"--particles", "-3"}, "--particles"},
                                                      {{"--preset", "mine"}, "source"},
                                                      {{"--isovalue", "a"}, "--isovalue takes V[,V...], not 'a'"},
                                                      {{"--isovalue", "1,,2"}, "1,,2"},
                                                      {{"--threshold", "1"}, "LO:HI"},
                                                      {{"--threshold", "2:1"}, "ends before"},
                                                      {{"--materials", "1;2"}, "L[,L...]"},
                                                      {{"--materials", "1.5"}, "1.5"},
                                                      {{"--merge", "4"}, "A:B"},
                                                      {{"--merge", "99999999999999999999:1"}, "99999999999999999999"},
                                                      {{"--labels", "--isovalue", "1"}, "exclude"},
                                                      {{"--threshold", "0:1", "--isovalue", "1"}, "exclude"},
                                                      {{"--isovalue", "1", "--materials", "1"}, "labels"},
                                                      {{"--min-component", "-1"}, "--min-component"},
                                                      {{"--out", "a.xyz"}, ".vtp"},
                                                      {{"--out", "a"}, ".vtp"},
                                                      {{"--out", "a.vtu", "--per-material"}, "--per-material"},
                                                      {{"--per-material"}, "--out"},
                                                      {{"--out", "a.vtu", "--surface-only"}, "--surface-only"},
                                                      {{"--surface-only"}, "--out"},
                                                      {{"--particles-out", "a.ply"}, ".vtp"},
                                                      {{"--image", "a.jpg"}, ".png"},
                                                      {{"--camera", "top"}, "iso"},
                                                      {{"--background", "greenish"}, "#rrggbb"},
                                                      {{"--set", "epsilom=1"}, "did you mean epsilon"},
                                                      {{"--resolution", "100"}, "--resolution"}})
    expect_failure(nacre(small_mesh + arguments), 2, {part});
}

TEST(MeshCommandLine, MissingFilesAndFoldersAreNamedBeforeTheWork) {
  const TemporaryFolder folder;
  expect_failure(nacre({"mesh", (folder / "none.nrrd").string(), "--quiet"}), 1, {"none.nrrd"});
  expect_failure(nacre({"mesh", (folder / "none.xyz").string(), "--quiet"}), 1, {"none.xyz"});
  for (const auto& [option, name] : std::vector<std::pair<std::string, std::string>>{
           {"--out", "a.vtp"}, {"--particles-out", "a.vtp"}, {"--image", "a.png"}, {"--report", "a.json"}}) {
    const std::string file = (folder / "nowhere" / name).string();
    expect_failure(nacre(small_mesh + Arguments{"--materials", "9", option, file}), 1, {"nowhere"});
  }
  EXPECT_EQ(folder.entries(), 0u);
}

TEST(MeshCommandLine, NegativeNumbersAreValues) {
  const TemporaryFolder folder;
  const std::string file = (folder / "a.nrrd").string();
  std::ofstream(file) << nrrd<double>({16, 16, 16}, "float", unit_spacing, [](int i, int j, int k) {
    return -10 - std::sqrt((i - 7.5) * (i - 7.5) + (j - 7.5) * (j - 7.5) + (k - 7.5) * (k - 7.5));
  });
  const std::string report = (folder / "r.json").string();
  const Outcome run = nacre({"mesh", file, "--isovalue", "-15", "--quiet", "--report", report});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NEAR(nlohmann::json::parse(read_all(report))["mesh"]["materials"][0]["volume"], 523.6, 10);
}

TEST(MeshCommandLine, TheSourcesPresetGivesWayToWhatIsSaid) {
  const TemporaryFolder folder;
  const std::string session = (folder / "s.json").string();
  const auto knobs = [&](const Arguments& arguments) {
    const Outcome run = nacre(arguments + Arguments{"--preset", "source", "--save-session", session, "--quiet"});
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(read_all(session))["knobs"];
  };
  const Arguments labels = {"mesh", "--sample", "two-spheres", "--detail", "24"};
  const nlohmann::json preset = knobs(labels);
  EXPECT_EQ(preset["theta"], 0.75);
  EXPECT_EQ(preset["iterations"], 50);
  EXPECT_EQ(preset["stagnation"], 0.0015);
  EXPECT_EQ(preset["add_below"], 0.75);
  EXPECT_EQ(preset["delete_above"], 1.35);
  EXPECT_EQ(preset["mesh_subcells"], 3);
  EXPECT_EQ(preset["smooth"], 0);
  EXPECT_EQ(preset["remesh"], 0);
  EXPECT_EQ(preset["by_density"], false);
  EXPECT_EQ(preset["kernel"], "catmull-rom");
  EXPECT_EQ(preset["ideal_energy"], 0);
  EXPECT_EQ(knobs(labels + Arguments{"--theta", "0.4"})["theta"], 0.4);
  EXPECT_EQ(knobs(labels + Arguments{"--set", "iterations=7"})["iterations"], 7);
  const Arguments scalar = {"mesh", "--sample", "ellipsoid", "--detail", "24"};
  EXPECT_EQ(knobs(scalar)["kernel"], "b-spline");
  EXPECT_EQ(knobs(scalar + Arguments{"--kernel", "catmull-rom"})["kernel"], "catmull-rom");
}

TEST(MeshCommandLine, SizesFarAboveTheVolumeAreRefusedAtOnce) {
  const auto before = std::chrono::steady_clock::now();
  expect_failure(nacre(small_mesh + Arguments{"--min-size", "1000", "--max-size", "1000"}), 1,
                 {"fewer than four", "--max-size"});
  EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(60)) << "a second, where nobody else works";
}

TEST(MeshCommandLine, ASummaryForPeopleResultsForPipes) {
  const TemporaryFolder folder;
  const std::string out = (folder / "a.vtp").string();
  Arguments arguments = small_mesh + Arguments{"--out", out};
  std::erase(arguments, "--quiet");
  const Outcome run = nacre(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, out + "\n");
  for (const char* part : {"device: ", "particles", "triangles", "all closed", "radius ratio", " s"})
    EXPECT_TRUE(contains(run.err, part)) << part << "\n" << run.err;
  EXPECT_FALSE(contains(run.err, "\033")) << "no progress bar in a pipe";
  EXPECT_EQ(nacre(small_mesh).err, "") << "--quiet";
}

TEST(MeshCommandLine, VolumeSamplesAreListedAndWritten) {
  const Outcome list = nacre({"sample"});
  for (const char* name : {"torso", "head", "heart", "lungs", "ribcage", "two-spheres", "nested-shells", "ellipsoid"})
    EXPECT_EQ(lines_with(list.out, std::string(name) + " "), 1) << name;
  const TemporaryFolder folder;
  const std::string file = (folder / "a.nrrd").string();
  const Outcome written = nacre({"sample", "two-spheres", "--detail", "24", "--out", file});
  EXPECT_EQ(written.out, file + "\n") << written.err;
  EXPECT_TRUE(contains(nacre({"info", file}).out, "volume"));
  expect_failure(nacre({"sample", "two-spheres", "--out", (folder / "a.obj").string()}), 2, {".nrrd"});
}

}  // namespace
}  // namespace nacre::test
