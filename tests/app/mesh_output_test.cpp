// Nacre: tests of what `nacre mesh` writes, and of Ctrl-C.
#include <thread>

#include "engine/picture/png.hpp"
#include "tests/app/mesh_program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

class MeshOutput : public MeshTest {
 protected:
  json info(const std::string& name) const {
    const Outcome run = nacre({"info", "--json", path(name)});
    EXPECT_EQ(run.status, 0) << run.err;
    return run.status == 0 ? json::parse(run.out) : json();
  }
};

TEST_F(MeshOutput, EverySurfaceFormatHoldsTheSameMesh) {
  Arguments outputs;
  json triangles;
  for (const char* name : {"a.vtp", "a.ply", "a.obj", "a.off", "a.stl"}) {
    ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path(name), "--report", path("r.json")}).status, 0) << name;
    triangles = read_json("r.json")["mesh"]["triangles"];
    EXPECT_EQ(info(name)["triangles"], triangles) << name;
  }
  const json arrays = info("a.vtp")["arrays"];
  ASSERT_EQ(arrays.size(), 2u);
  EXPECT_EQ(arrays[0]["name"], "material_0");
  EXPECT_EQ(arrays[1]["name"], "material_1");
  EXPECT_EQ(arrays[0]["on"], "cells");
  EXPECT_EQ(arrays[0]["min"], 0);
  EXPECT_EQ(arrays[1]["max"], 2);
}

TEST_F(MeshOutput, OneFilePerMaterial) {
  const Outcome run =
      nacre(small_mesh + Arguments{"--out", path("a.stl"), "--per-material", "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, path("a_1.stl") + "\n" + path("a_2.stl") + "\n");
  const json materials = read_json("r.json")["mesh"]["materials"];
  EXPECT_EQ(info("a_1.stl")["triangles"], materials[0]["triangles"]);
  EXPECT_EQ(info("a_2.stl")["triangles"], materials[1]["triangles"]);
  EXPECT_EQ(names(), (Arguments{"a_1.stl", "a_2.stl", "r.json"}));
}

TEST_F(MeshOutput, TetrahedraFillEveryMaterial) {
  for (const char* name : {"a.vtu", "a.msh"}) {
    ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path(name), "--report", path("r.json")}).status, 0) << name;
    const json r = read_json("r.json");
    expect_sound(r);
    const json& cells = r["tetrahedra"];
    EXPECT_GT(cells["cells"], 1000);
    EXPECT_EQ(cells["inverted"], 0);
    EXPECT_EQ(cells["dihedral_degrees"]["histogram"].size(), 18u);
    EXPECT_GE(cells["share_within_10_160_degrees"], 0.99);
    for (int m = 0; m < 2; ++m) {
      const double volume = r["mesh"]["materials"][m]["volume"];
      EXPECT_NEAR(cells["materials"][m]["volume"], volume, 1e-6 * volume) << "they share the surface exactly";
    }
    EXPECT_GT(fs::file_size(path(name)), 10000u);
  }
  const json coarse = read_json("r.json")["tetrahedra"]["cells"];
  ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path("b.vtu"), "--max-cell", "1", "--report", path("r.json")}).status,
            0);
  EXPECT_GT(read_json("r.json")["tetrahedra"]["cells"], coarse);
}

/// The number in the line after `heading`, each time that this stands in a file.
std::vector<std::size_t> counts_after(const std::string& file, const std::string& heading) {
  std::vector<std::size_t> counts;
  for (std::size_t at = file.find(heading); at != std::string::npos; at = file.find(heading, at + 1))
    counts.push_back(std::stoul(file.substr(at + heading.size())));
  return counts;
}

TEST_F(MeshOutput, GmshFilesHoldTheTrianglesWithOrWithoutTetrahedra) {
  ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path("a.msh"), "--report", path("r.json")}).status, 0);
  const json filled = read_json("r.json");
  ASSERT_EQ(nacre(small_mesh + Arguments{"--out", path("b.msh"), "--surface-only", "--report", path("r.json")}).status,
            0);
  const json hollow = read_json("r.json");
  EXPECT_FALSE(hollow.contains("tetrahedra"));
  EXPECT_EQ(hollow["mesh"]["triangles"], filled["mesh"]["triangles"]);
  const std::size_t triangles = hollow["mesh"]["triangles"], cells = filled["tetrahedra"]["cells"];
  using Counts = std::vector<std::size_t>;
  const std::string a = content("a.msh"), b = content("b.msh");
  EXPECT_EQ(counts_after(a, "$Elements\n"), Counts{triangles + cells});
  EXPECT_EQ(counts_after(b, "$Elements\n"), Counts{triangles});
  EXPECT_EQ(counts_after(a, "$Nodes\n"), Counts{filled["tetrahedra"]["vertices"]});
  EXPECT_EQ(counts_after(b, "$Nodes\n"), Counts{hollow["mesh"]["vertices"]});
  const std::string of = "\n1\n0\n3\n0\n1\n";
  for (const char* name : {"\"material_0\"", "\"material_1\""}) {
    EXPECT_EQ(counts_after(a, name + of), Counts{}) << name;
    EXPECT_EQ(counts_after(b, name + of), Counts{triangles}) << name;
  }
}

TEST_F(MeshOutput, ParticlesComeWithTheirArrays) {
  ASSERT_EQ(nacre(small_mesh + Arguments{"--particles-out", path("p.vtp"), "--report", path("r.json")}).status, 0);
  const json particles = info("p.vtp");
  EXPECT_EQ(particles["points"], read_json("r.json")["particles"]["final"]);
  Arguments found;
  for (const json& array : particles["arrays"]) found.push_back(array["name"]);
  EXPECT_EQ(found, (Arguments{"size", "energy", "order", "normal"}));
  EXPECT_EQ(particles["arrays"][2]["min"], 1) << "the junction circle";
  EXPECT_EQ(particles["arrays"][2]["max"], 2);
}

TEST_F(MeshOutput, AsManySeedsAsAskedForStandOnSurfaces) {
  const Outcome run = nacre({"mesh", "--sample", "two-spheres", "--detail", "24", "--particles", "500", "--iterations",
                             "5", "--out", path("a.vtp"), "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  const json particles = read_json("r.json")["particles"];
  EXPECT_NEAR(double(particles["seeded_on_surfaces"]), 500, 2);
  EXPECT_GT(particles["seeded"], particles["seeded_on_surfaces"]) << "the junction has its own";
}

TEST_F(MeshOutput, APictureShowsTheMesh) {
  ASSERT_EQ(nacre(small_mesh + Arguments{"--image", path("a.png"), "--size", "96x72", "--camera", "+x", "--background",
                                         "transparent"})
                .status,
            0);
  const Image image = read_png(path("a.png"));
  EXPECT_EQ(image.width, 96);
  EXPECT_EQ(image.height, 72);
  EXPECT_EQ(image.at(48, 36)[3], 255);
  EXPECT_EQ(image.at(0, 0)[3], 0);
  ASSERT_EQ(
      nacre(small_mesh + Arguments{"--image", path("b.png"), "--size", "96x72", "--camera", "+x", "--cut-away"}).status,
      0);
  EXPECT_NE(bare("a.png"), bare("b.png"));
}

TEST_F(MeshOutput, AFileSizeLimitLeavesNothingBehind) {
  for (const char* name : {"a.vtp", "a.vtu", "a.stl"})
    expect_failure(nacre_limited("-f 8", small_mesh + Arguments{"--out", path(name)}), 1, {name, "File too large"});
  EXPECT_EQ(names(), Arguments{});
}

using Clock = std::chrono::steady_clock;

/// What the program does when Ctrl-C comes after `seconds`, and how long it takes from there.
std::pair<Outcome, double> interrupt_after(const Arguments& arguments, double seconds) {
  const auto before = Clock::now();
  const Outcome result = run("/usr/bin/timeout", Arguments{"--foreground", "--preserve-status", "-s", "INT", "-k", "60",
                                                           std::to_string(seconds), program_path} +
                                                     arguments);
  return {result, std::chrono::duration<double>(Clock::now() - before).count() - seconds};
}

class MeshCtrlC : public MeshTest, public ::testing::WithParamInterface<double> {};

TEST_P(MeshCtrlC, StopsWithinTwoSecondsAndLeavesNothing) {
  const auto [run, seconds] = interrupt_after({"mesh", "--sample", "head", "--quiet", "--out", path("a.vtu"), "--image",
                                               path("a.png"), "--report", path("r.json")},
                                              GetParam());
  EXPECT_EQ(run.status, 130) << run.err;
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(seconds, 2);
#endif
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(names(), Arguments{});
}

INSTANTIATE_TEST_SUITE_P(After, MeshCtrlC, ::testing::Values(0.3, 3.0));
INSTANTIATE_TEST_SUITE_P(LongAfter, MeshCtrlC, ::testing::Values(10.0));

TEST_F(MeshCtrlC, KeepsWhatThereIsWhenAskedTo) {
  // Particles that would move for hours: no stagnation, no end of iterations.
  const auto [run, seconds] =
      interrupt_after({"mesh", "--sample", "ellipsoid", "--quiet", "--iterations", "1000000", "--stagnation", "0",
                       "--keep-on-interrupt", "--out", path("a.vtp"), "--report", path("r.json")},
                      5.0);
  EXPECT_EQ(run.status, 130) << run.err;
  EXPECT_EQ(run.out, path("a.vtp") + "\n");
  EXPECT_EQ(names(), (Arguments{"a.vtp", "r.json"}));
  EXPECT_LT(seconds, 20);
  const json r = read_json("r.json");
  EXPECT_EQ(r["particles"]["interrupted"], true);
  expect_sound(r);
}

TEST_F(MeshCtrlC, KeepsWhatThereIsWhileCurvesMove) {
  // The curve of two balls would move for minutes before the first particle of a surface does.
  const auto [run, seconds] =
      interrupt_after(small_mesh + Arguments{"--iterations", "1000000", "--stagnation", "0", "--keep-on-interrupt",
                                             "--out", path("a.vtp"), "--report", path("r.json")},
                      5.0);
  EXPECT_EQ(run.status, 130) << run.err;
  EXPECT_EQ(names(), (Arguments{"a.vtp", "r.json"}));
  EXPECT_LT(seconds, 10);
  const json r = read_json("r.json");
  EXPECT_EQ(r["particles"]["interrupted"], true);
  EXPECT_EQ(r["particles"]["iterations"], 0);
  EXPECT_GT(r["particles"]["on_curves"], 10);
  EXPECT_GT(r["particles"]["on_surfaces"], 300);
  expect_sound(r);
}

}  // namespace
}  // namespace nacre::test
