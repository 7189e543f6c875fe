// Nacre: tests of `nacre flow --method octree` as a user runs it.
#include "engine/picture/png.hpp"
#include "tests/app/program.hpp"

namespace nacre::test {
namespace {

using nlohmann::json;

class Octree : public AppTest, public ::testing::WithParamInterface<const char*> {
 protected:
  Arguments arguments(const Arguments& more = {}) const {
    return small_flow + Arguments{"--method", "octree", "--octree", GetParam()} + more;
  }
};

TEST_P(Octree, EveryOutputOfAFlowRun) {
  const Outcome run = nacre(arguments({"--image", path("a.png"), "--size", "64x48", "--out", path("a.vtp"), "--frames",
                                       path("frames"), "--report", path("r.json")}));
  ASSERT_EQ(run.status, 0) << run.err;
  const json report = read_json("r.json");
  const json& e = report["embedding"];
  EXPECT_EQ(e["kind"], std::string(GetParam()) + " octree");
  EXPECT_EQ(e["dimensions"], json({64, 64, 64}));
  EXPECT_GT(e["cells"], e["surface_cells"]);
  EXPECT_GT(e["sparseness_percent"], 80.0);
  for (const char* stage : {"embed", "velocity", "advect", "extend", "filter"})
    EXPECT_TRUE(std::any_of(report["stages"].begin(), report["stages"].end(), [&](const json& s) {
      return s["name"] == stage;
    })) << stage;
  const std::string points = "NumberOfPoints=\"" + std::to_string(e["surface_cells"].get<int>()) + "\"";
  EXPECT_TRUE(contains(content("a.vtp"), points)) << "one point for each cell that is touched: " << points;
  EXPECT_EQ(read_png(path("a.png")).width, 64);
  EXPECT_TRUE(exists("frames"));
}

TEST_P(Octree, OneResultOnAnyNumberOfThreads) {
  ASSERT_EQ(nacre(arguments({"--threads", "1", "--out", path("one.vtp")})).status, 0);
  ASSERT_EQ(nacre(arguments({"--threads", "2", "--out", path("two.vtp")})).status, 0);
  EXPECT_EQ(content("one.vtp"), content("two.vtp"));
}

/// One triangle as large as the domain, one far smaller than a cell, and the same sheet twice.
TEST_P(Octree, TrianglesOfAnySizeAndCoincidentSheets) {
  const std::string file = write("odd.obj",
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.5 0.5 0.3\nv 0.500001 0.5 0.3\nv 0.5 0.500001 0.3\n"
                                 "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\nf 7 8 9\n");
  const Outcome run = nacre({"flow", file, "--vectors", "@rotation", "--method", "octree", "--octree", GetParam(),
                             "--resolution", "96", "--steps", "1", "--quiet", "--report", path("r.json")});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NEAR(read_json("r.json")["embedding"]["surface_cells"], 0.5 * 88 * 88, 200) << "half a square of 88 cells";
}

INSTANTIATE_TEST_SUITE_P(Of, Octree, ::testing::Values("brick", "source"),
                         [](const auto& test) { return std::string(test.param); });

using OctreeCommandLine = AppTest;

TEST_F(OctreeCommandLine, ThatAreOff) {
  const Arguments octree = {"flow",    "--sample", "sphere", "--detail", "24",
                            "--quiet", "--method", "octree", "--image",  path("a.png")};
  expect_failure(nacre(octree + Arguments{"--octree", "banyan"}), 2, {"banyan", "brick"});
  expect_failure(nacre(octree + Arguments{"--radius", "0.5"}), 1, {"--radius"});
  expect_failure(nacre(octree + Arguments{"--resolution", "2000000"}), 2, {"1048576"});
  expect_failure(nacre(octree + Arguments{"--resolution", "16", "--radius", "9"}), 1, {"too coarse", "--resolution"});
}

TEST_F(OctreeCommandLine, TheNeighbourIndexChangesNothingButTheTime) {
  const Arguments source = small_flow + Arguments{"--method", "octree", "--octree", "source"};
  ASSERT_EQ(nacre(source + Arguments{"--out", path("walk.vtp")}).status, 0);
  ASSERT_EQ(nacre(source + Arguments{"--set", "neighbour_index=1", "--out", path("index.vtp")}).status, 0);
  EXPECT_EQ(bare("walk.vtp"), bare("index.vtp"));
}

TEST_F(OctreeCommandLine, MemoryPerCellIsWhatWasPromised) {
  for (const int ttl : {1, 8}) {  // the same: particles are handed over from step to step
    const Outcome run =
        nacre({"flow", "--sample", "delta-wing", "--method", "octree", "--resolution", "512", "--steps", "1", "--quiet",
               "--ttl", std::to_string(ttl), "--set", "warmup=0", "--report", path("r.json")});
    ASSERT_EQ(run.status, 0) << run.err;
    const json report = read_json("r.json");
    const double cells = report["embedding"]["cells"];
    EXPECT_LE(report["embedding"]["bytes"].get<double>() / cells, 24);
    EXPECT_LE(report["flow"]["bytes"].get<double>() / cells, 32);
    EXPECT_GE(report["flow"]["bytes"].get<double>() / cells, 8) << "the vectors alone take that";
  }
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(OctreeCommandLine, ABandThatDoesNotFitIsRefusedBeforeTheWork) {
  const Outcome run = nacre_limited("-v 2000000", {"flow", "--sample", "sphere", "--detail", "24", "--method", "octree",
                                                   "--resolution", "100000", "--quiet", "--image", path("a.png")});
  expect_failure(run, 1, {"--resolution 100000", "GiB", "use --resolution"});
}
#endif

}  // namespace
}  // namespace nacre::test
