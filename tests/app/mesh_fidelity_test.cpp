// Nacre: tests of `nacre mesh` with a bound on the deviation, and of meshes of second order.
#include <cmath>

#include "tests/app/mesh_program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

class MeshFidelity : public MeshTest {};

TEST_F(MeshFidelity, TheBoundIsKeptAndReported) {
  const Arguments arguments = small_mesh + Arguments{"--max-size", "4", "--epsilon", "2", "--max-deviation", "0.05"};
  const Outcome run = nacre(arguments + Arguments{"--report", path("r.json"), "--out", path("a.vtp")});
  ASSERT_EQ(run.status, 0) << run.err;
  const json r = read_json("r.json"), d = r["mesh"]["deviation"];
  expect_sound(r);
  EXPECT_EQ(d["bound_voxels"], 0.05);
  EXPECT_EQ(d["met"], true) << d;
  EXPECT_LE(d["max_voxels"], 0.05);
  EXPECT_GT(d["max_voxels"], 0.02);
  EXPECT_LT(d["mean_voxels"], d["max_voxels"]);
  EXPECT_EQ(d["places"], json::array());
  EXPECT_LE(r["mesh"]["surface_distance_voxels"]["facet_max"], 0.0501);
  ASSERT_EQ(nacre(small_mesh + Arguments{"--max-size", "4", "--epsilon", "2", "--report", path("r.json")}).status, 0);
  EXPECT_FALSE(read_json("r.json")["mesh"].contains("deviation"));
  EXPECT_GT(read_json("r.json")["mesh"]["surface_distance_voxels"]["facet_max"], 0.1) << "the bound did nothing";
}

/// Of phantoms of the torso nearly all of these keep the bound, whatever the seed; of 48 voxels a few triangles at one
/// spot stay above it for most seeds.
TEST_F(MeshFidelity, TheBoundIsKeptWhereThirdMaterialsBeginBetweenParticles) {
  for (const char* detail : {"26", "30", "32", "36", "48"}) {
    ASSERT_EQ(nacre({"mesh", "--sample", "torso", "--detail", detail, "--surface-only", "--max-deviation", "0.1",
                     "--out", path("a.ply"), "--report", path("r.json")})
                  .status,
              0);
    const json r = read_json("r.json"), d = r["mesh"]["deviation"];
    expect_sound(r);
    EXPECT_GT(d["before_refining"]["max_voxels"], 0.3) << detail;
    const int before = d["before_refining"]["triangles_above"];
    int above = 0;
    for (const json& count : d["triangles_above"]) above += int(count);
    EXPECT_EQ(d["met"], above == 0) << detail << ": " << d;
    if (detail == std::string("48")) {
      EXPECT_LE(above, before / 200) << d;
      continue;
    }
    EXPECT_EQ(above, 0) << detail << ": " << d;
    EXPECT_GT(r["mesh"]["radius_ratio"]["min"], 0.05) << detail << ": points beside each other";
  }
}

TEST_F(MeshFidelity, ABoundThatCannotBeMetIsSaid) {
  const Outcome run =
      nacre({"mesh", write("a.nrrd", ball_nrrd()), "--max-deviation", "0.001", "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  const json d = read_json("r.json")["mesh"]["deviation"];
  EXPECT_EQ(d["met"], false) << d;
  EXPECT_GT(d["triangles_above"]["too_small_to_divide"], 0);
  EXPECT_FALSE(d["places"].empty());
  EXPECT_TRUE(contains(run.err, "above the bound")) << run.err;
}

TEST_F(MeshFidelity, TheSameFileOnOneAndTwoThreads) {
  const Arguments arguments =
      small_mesh + Arguments{"--max-size", "3", "--max-deviation", "0.02", "--element-order", "2"};
  ASSERT_EQ(nacre(arguments + Arguments{"--threads", "1", "--out", path("one.msh")}).status, 0);
  ASSERT_EQ(nacre(arguments + Arguments{"--threads", "2", "--out", path("two.msh")}).status, 0);
  EXPECT_EQ(content("one.msh"), content("two.msh"));
}

TEST_F(MeshFidelity, WrongValuesAreRefused) {
  const std::string file = write("a.nrrd", ball_nrrd());
  for (const char* value : {"-1", "0.0001", "many"})
    expect_refused(file, 2, {"--max-deviation", value}, {"--max-deviation", value});
  for (const char* value : {"0", "3", "-2", "1.5"})
    expect_refused(file, 2, {"order", value}, {"--element-order", value});
  expect_refused(file, 2, {"order"}, {"--order", "3"});
}

TEST_F(MeshFidelity, FormatsWithoutNodesOnEdgesAreRefusedBeforeTheWork) {
  for (const char* name : {"a.vtp", "a.stl", "a.foam", "a.glb"}) {
    const Outcome run = nacre(small_mesh + Arguments{"--element-order", "2", "--out", path(name)});
    expect_failure(run, 2, {"--element-order 2", ".msh4", "--element-order 1"});
    EXPECT_FALSE(exists(name));
  }
}

/// At a coarse size the flat triangles cut off much of the balls; those with nodes hardly any.
TEST_F(MeshFidelity, ElementsOfSecondOrderAreNearerToTheInterface) {
  const Arguments arguments =
      small_mesh + Arguments{"--max-size", "3", "--min-size", "2", "--epsilon", "3", "--order", "2"};
  for (const char* name : {"a.vtu", "a.inp", "a.mesh", "a.feb", "a.msh", "a.msh4"}) {
    const Outcome run = nacre(arguments + Arguments{"--report", path("r.json"), "--out", path(name)});
    ASSERT_EQ(run.status, 0) << name << run.err;
    EXPECT_GT(fs::file_size(path(name)), 10000u) << name;
  }
  const json r = read_json("r.json"), s = r["second_order"];
  EXPECT_EQ(r["parameters"]["element_order"], 2);
  EXPECT_EQ(s["elements"], "tetrahedra");
  EXPECT_GE(s["least_scaled_jacobian"], 0.0999);
  EXPECT_GT(s["on_surfaces"], 100);
  EXPECT_GT(s["on_curves"], 5) << "the rim of the disk";
  EXPECT_LT(s["straightened"], s["on_surfaces"].get<int>() / 10);
  const json d = s["deviation_voxels"];
  EXPECT_LT(d["order_2"]["mean"], 0.35 * d["order_1"]["mean"].get<double>()) << d;
  const json hollow = [&] {
    EXPECT_EQ(nacre(arguments + Arguments{"--report", path("r.json"), "--surface-only", "--out", path("b.msh")}).status,
              0);
    return read_json("r.json");
  }();
  EXPECT_FALSE(hollow.contains("tetrahedra"));
  EXPECT_EQ(hollow["second_order"]["elements"], "triangles");
  EXPECT_EQ(nacre(arguments + Arguments{"--per-material", "--out", path("c.inp")}).status, 0);
  EXPECT_TRUE(contains(content("c_1.inp"), "STRI65"));
}

TEST_F(MeshFidelity, ASessionKeepsBoth) {
  const Arguments arguments =
      small_mesh + Arguments{"--max-size", "3", "--max-deviation", "0.1", "--element-order", "2"};
  ASSERT_EQ(nacre(arguments + Arguments{"--out", path("a.msh"), "--save-session", path("s.json")}).status, 0);
  ASSERT_EQ(nacre({"mesh", "--session", path("s.json"), "--quiet", "--out", path("b.msh")}).status, 0);
  EXPECT_EQ(content("a.msh"), content("b.msh"));
}

}  // namespace
}  // namespace nacre::test
