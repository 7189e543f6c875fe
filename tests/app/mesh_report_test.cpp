// Nacre: tests of the report, the sessions and the repeatability of `nacre mesh`.
#include <tuple>

#include "tests/app/mesh_program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

class MeshReport : public MeshTest {};

TEST_F(MeshReport, HasEveryKeyOfTheContract) {
  const Outcome run =
      nacre(small_mesh + Arguments{"--report", path("r.json"), "--out", path("a.vtp"), "--particles-out", path("p.vtp"),
                                   "--image", path("a.png"), "--size", "64x48"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json r = read_json("r.json");
  EXPECT_EQ(r["command"], "mesh");
  EXPECT_TRUE(r["nacre"].is_string());
  EXPECT_GT(r["memory"]["peak_bytes"], 1 << 20);
  EXPECT_GT(r["memory"]["device_peak_bytes"], 1 << 10);
  EXPECT_EQ(r["outputs"], json({path("a.vtp"), path("p.vtp"), path("a.png")}));
  EXPECT_EQ(r["input"]["name"], "two-spheres");
  EXPECT_EQ(r["input"]["kind"], "labels");
  EXPECT_EQ(r["input"]["dimensions"], json({24, 24, 24}));
  EXPECT_EQ(r["input"]["materials"].size(), 2u);
  EXPECT_GT(r["fields"]["expected_particles"], 100);
  EXPECT_EQ(r["fields"]["surfaces"], 3);
  EXPECT_EQ(r["fields"]["curves"], 1);
  EXPECT_EQ(r["fields"]["junctions"], json({{0, 1, 2}, {0, 1}, {0, 2}, {1, 2}}));
  EXPECT_GT(r["particles"]["seeded"], 100);
  EXPECT_GT(r["particles"]["final"], 100);
  EXPECT_EQ(r["particles"]["energy"].size(), r["particles"]["iterations"]);
  EXPECT_EQ(r["particles"]["seconds"].size(), r["particles"]["iterations"]);
  EXPECT_GT(r["particles"]["final_energy"], 0);
  EXPECT_EQ(r["particles"]["interrupted"], false);
  const json& m = r["mesh"];
  for (const char* key : {"vertices", "triangles", "components", "nonmanifold_edges", "boundary_edges"})
    EXPECT_TRUE(m[key].is_number_integer()) << key;
  for (const json& of : {m, m["away_from_junctions"]}) {
    EXPECT_GT(of["radius_ratio"]["mean"], of["radius_ratio"]["min"]);
    EXPECT_EQ(of["radius_ratio"]["histogram"].size(), 50u);
    EXPECT_GT(of["angle_degrees"]["max"], of["angle_degrees"]["mean_min"]);
    EXPECT_GT(of["angle_degrees"]["mean_min"], of["angle_degrees"]["min"]);
  }
  EXPECT_GE(m["surface_distance_voxels"]["max"], m["surface_distance_voxels"]["mean"]);
  expect_sound(r);
  ASSERT_EQ(m["materials"].size(), 2u) << "the outside is none";
  for (const json& material : m["materials"]) EXPECT_EQ(material["euler"], 2);
  EXPECT_EQ(m["materials"][0]["label"], 1);
  // Two balls of radius 13 less a cap of height 6 each; voxels of 2.04 and their smoothing cost some of it.
  for (const json& material : m["materials"]) EXPECT_NEAR(material["volume"], 7958.7, 0.07 * 7958.7);
}

TEST_F(MeshReport, EachMaterialIsComparedWithItsVoxelsInTheUnitsOfTheData) {
  const std::string file = write("a.nrrd", ball_nrrd("spacings: 0.5 0.5 0.5\n"));
  const json r = mesh(file), m = r["mesh"]["materials"][0], v = m["against_voxels"];
  EXPECT_EQ(v["voxel_volume"], 0.125 * r["input"]["materials"][0]["voxels"].get<double>());
  EXPECT_NEAR(v["difference"], m["volume"].get<double>() - v["voxel_volume"].get<double>(), 1e-9);
  EXPECT_NEAR(v["relative_difference"], v["difference"].get<double>() / v["voxel_volume"].get<double>(), 1e-9);
  EXPECT_LT(std::abs(v["relative_difference"].get<double>()), 0.1);
  EXPECT_NEAR(v["mean_distance"], 0.5 * 0.19, 0.5 * 0.06) << "as a perfect ball of this size";
  EXPECT_LT(v["hausdorff_distance"], 0.5 * 0.9);
  for (const char* from : {"from_mesh", "from_voxels"}) {
    EXPECT_LE(v[from]["mean"], v[from]["max"]);
    EXPECT_LE(v[from]["max"], v["hausdorff_distance"]);
  }
  Arguments stages;
  for (const json& stage : r["stages"]) stages.push_back(stage["name"]);
  EXPECT_EQ(std::count(stages.begin(), stages.end(), "fidelity"), 1);
}

TEST_F(MeshReport, StageNamesAreTheFixedOnes) {
  ASSERT_EQ(nacre(small_mesh + Arguments{"--report", path("r.json"), "--out", path("a.vtu"), "--image", path("a.png"),
                                         "--size", "64x48"})
                .status,
            0);
  Arguments names;
  const json r = read_json("r.json");
  for (const json& stage : r["stages"]) names.push_back(stage["name"]);
  for (const char* name : {"read", "materials", "tighten", "distance", "sizing", "embed", "seed", "relax",
                           "triangulate", "quality", "tetrahedra", "render", "write"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST_F(MeshReport, ParametersAreTheKnobsAsSet) {
  ASSERT_EQ(nacre(small_mesh + Arguments{"--report", path("r.json"), "--seed", "7", "--set", "delta=0.7", "--epsilon",
                                         "0.6", "--curvature", "--labels"})
                .status,
            0);
  const json p = read_json("r.json")["parameters"];
  EXPECT_EQ(p["seed"], 7);
  EXPECT_EQ(p["delta"], 0.7);
  EXPECT_EQ(p["epsilon"], 0.6);
  EXPECT_EQ(p["curvature"], true);
  EXPECT_EQ(p["labels"], true);
  EXPECT_EQ(p["solver"], "tree");
}

TEST_F(MeshReport, ALostLabelIsNamedAlsoWithQuiet) {
  const std::string file = write("a.nrrd", nrrd<int>({20, 20, 20}, "uchar", unit_spacing, [](int i, int j, int k) {
                                   if (j == 10 && k == 10 && (i == 6 || i == 10)) return i;  // single voxels
                                   const double x = i - 9.5, y = j - 9.5, z = k - 9.5;
                                   return x * x + y * y + z * z < 49 ? 1 : 0;
                                 }));
  EXPECT_EQ(mesh(file)["mesh"]["lost_labels"], json::array())
      << "at sizes of a voxel all are there, and nothing is said";
  const Outcome run =
      nacre({"mesh", file, "--quiet", "--min-size", "5", "--max-size", "5", "--report", path("r.json")});
  EXPECT_EQ(run.status, 0) << run.err;
  const json m = read_json("r.json")["mesh"];
  json lost = json::array();
  for (const json& material : m["materials"])
    if (material["triangles"] == 0) lost.push_back(material["label"]);
  EXPECT_EQ(m["lost_labels"], lost);
  ASSERT_GE(lost.size(), 1u);
  EXPECT_EQ(lines_with(run.err, "warning: "), 1) << run.err;
  EXPECT_TRUE(contains(run.err, "lost") && contains(run.err, lost[0].dump()) && contains(run.err, "--min-size"))
      << run.err;
}

TEST_F(MeshReport, LabelsAreTheFilesOwn) {
  const std::string file = write("a.nrrd", nrrd<int>({16, 16, 16}, "short", unit_spacing, [](int i, int j, int k) {
                                   return !ball(i, j, k) ? 0 : i < 8 ? -5 : 700;
                                 }));
  const json r = mesh(file);
  ASSERT_EQ(r["mesh"]["materials"].size(), 2u);
  EXPECT_EQ(r["mesh"]["materials"][0]["label"], -5);
  EXPECT_EQ(r["mesh"]["materials"][1]["label"], 700);
  EXPECT_EQ(r["input"]["outside"], 0);
}

class MeshSession : public MeshTest {};

TEST_F(MeshSession, RoundTripGivesTheSameBytes) {
  const std::string file = write("a.nrrd", ball_nrrd());
  const Arguments first = {"mesh",        file,          "--quiet", "--max-size",     "1.5",
                           "--seed",      "11",          "--out",   path("a.vtp"),    "--set",
                           "tighten=0.8", "--materials", "1",       "--save-session", path("s.json")};
  ASSERT_EQ(nacre(first).status, 0);
  const Outcome again = nacre({"mesh", "--session", path("s.json"), "--quiet", "--out", path("b.vtp")});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(content("a.vtp"), content("b.vtp"));
  ASSERT_EQ(nacre({"mesh", "--session", path("s.json"), "--quiet", "--max-size", "2", "--out", path("c.vtp")}).status,
            0);
  EXPECT_NE(bare("a.vtp"), bare("c.vtp")) << "arguments on the command line go over the session's";
}

TEST_F(MeshSession, KeepsTheSampleWithItsDetail) {
  ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path("a.vtp"), "--save-session", path("s.json")}).status, 0);
  ASSERT_EQ(nacre({"mesh", "--session", path("s.json"), "--quiet", "--out", path("b.vtp")}).status, 0);
  EXPECT_EQ(content("a.vtp"), content("b.vtp"));
}

class MeshRepeats : public MeshTest,
                    public ::testing::WithParamInterface<std::tuple<const char*, const char*, const char*>> {};

TEST_P(MeshRepeats, TheSameFileOnOneAndTwoThreads) {
  const auto [sample, solver, extension] = GetParam();
  const Arguments arguments = {"mesh",     "--sample", sample,         "--detail", "24",     "--quiet",
                               "--solver", solver,     "--iterations", "12",       "--seed", "5"};
  const std::string one = "one" + std::string(extension), two = "two" + std::string(extension);
  ASSERT_EQ(nacre(arguments + Arguments{"--threads", "1", "--out", path(one)}).status, 0);
  ASSERT_EQ(nacre(arguments + Arguments{"--threads", "2", "--out", path(two)}).status, 0);
  EXPECT_EQ(content(one), content(two));
}

INSTANTIATE_TEST_SUITE_P(
    All, MeshRepeats,
    ::testing::Values(std::tuple{"three-sectors", "tree", ".vtp"}, std::tuple{"torso", "tree", ".ply"},
                      std::tuple{"three-sectors", "redblack", ".vtp"}, std::tuple{"two-spheres", "serial", ".vtp"},
                      std::tuple{"nested-shells", "tree", ".vtu"}, std::tuple{"ellipsoid", "tree", ".stl"}));

}  // namespace
}  // namespace nacre::test
