// Nacre: words become enums at the pipeline's border, and unknown ones are refused.
#include "compute/pipeline/mesh_choices.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "compute/device/error.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

/// An Error that names the parameter, the word and those that there are.
void expect_refused(const std::function<void()>& call, const std::string& parameter, const std::string& known) {
  try {
    call();
    FAIL() << parameter << " was taken";
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("`" + parameter + "`"), std::string::npos) << text;
    EXPECT_NE(text.find("'newton'"), std::string::npos) << text;
    EXPECT_NE(text.find(known), std::string::npos) << text;
  }
}

TEST(MeshChoices, WordsGoThereAndBack) {
  for (const char* word : {"tree", "redblack", "serial"}) EXPECT_EQ(to_string(solver_from_string(word)), word);
  for (const char* word : {"catmull-rom", "b-spline"}) EXPECT_EQ(to_string(kernel_from_string(word)), word);
  EXPECT_EQ(solver_from_string("serial"), Solver::serial);
  EXPECT_EQ(kernel_from_string("b-spline"), CubicKernel::b_spline);
}

TEST(MeshChoices, SeedsFollowTheSolverWhereTheyAreToldNothing) {
  EXPECT_EQ(seeds_from_string("auto", Solver::tree), SeedOrigin::embedding);
  EXPECT_EQ(seeds_from_string("auto", Solver::redblack), SeedOrigin::marching_cubes);
  EXPECT_EQ(seeds_from_string("auto", Solver::serial), SeedOrigin::marching_cubes);
  EXPECT_EQ(seeds_from_string("marching-cubes", Solver::tree), SeedOrigin::marching_cubes);
  EXPECT_EQ(seeds_from_string("embedding", Solver::serial), SeedOrigin::embedding);
}

TEST(MeshChoices, UnknownWordsAreRefused) {
  expect_refused([] { solver_from_string("newton"); }, "solver", "tree, redblack, serial");
  expect_refused([] { kernel_from_string("newton"); }, "kernel", "catmull-rom, b-spline");
  expect_refused([] { seeds_from_string("newton", Solver::tree); }, "seeds", "auto, embedding, marching-cubes");
}

/// By every step of the pipeline that reads them; a step that is refused can be called again.
TEST(MeshChoices, ThePipelineRefusesThemToo) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  const MeshVolume volume = scalar_volume({16, 16, 16}, ball({7, 8, 7.5}, 4));
  MeshParameters& parameters = pipeline->parameters;
  parameters.iterations = 2;
  parameters.kernel = "newton";
  expect_refused([&] { pipeline->load(volume); }, "kernel", "b-spline");
  parameters.kernel = "b-spline";
  pipeline->load(volume);
  parameters.kernel = "newton";
  expect_refused([&] { pipeline->build_fields(); }, "kernel", "b-spline");
  parameters.kernel = "b-spline";
  pipeline->build_fields();
  parameters.solver = "newton";
  expect_refused([&] { pipeline->relax(); }, "solver", "serial");
  parameters.solver = "serial", parameters.seeds = "newton";
  expect_refused([&] { pipeline->relax(); }, "seeds", "auto");
  parameters.seeds = "auto";
  pipeline->relax();
  parameters.triangles = "newton";
  expect_refused([&] { pipeline->triangulate(); }, "triangulation", "stars");
  parameters.triangles = "delaunay";
  EXPECT_GT(pipeline->triangulate().triangles.size(), 100u);
}

}  // namespace
}  // namespace nacre::test
