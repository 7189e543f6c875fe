// Nacre: parts that are repeated: as graphs and launched one by one they do the same, and nothing harms the next call.
#include <algorithm>
#include <cstdlib>

#include "compute/device/random.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "tests/compute/pipeline/choose_embedding.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"
#include "tests/gpu/each_backend.hpp"
#include "tests/gpu/shapes.hpp"

namespace nacre::gpu_tests {
namespace {

class Repeat : public EachBackend {};
INSTANTIATE_TEST_SUITE_P(On, Repeat, testing::Values("cpu", "cuda"), backend_name);

const std::vector<std::int64_t> all_alike(5, 4000);
const std::vector<std::int64_t> all_kinds{4000, 4000, 300'000, 1, 0, 0, 4000, 300'000};

/// On the host.
std::vector<std::uint64_t> expected(std::int64_t n) {
  std::vector<std::uint64_t> sums(n + 1, 0);
  for (std::int64_t i = 0; i < n; ++i) sums[i + 1] = sums[i] + philox(std::uint32_t(i), 0, 7).a;
  return sums;
}

TEST_P(Repeat, EachCallDoesItsWork) {
  for (const auto& sizes : {all_alike, all_kinds}) {
    const auto results = runs->repeat(sizes);
    for (std::size_t k = 0; k < sizes.size(); ++k) EXPECT_EQ(results[k], expected(sizes[k])) << k;
  }
}

TEST_P(Repeat, OneGraphServesAllThatAreAlike) {
  runs->repeat(all_alike);
  EXPECT_EQ(runs->graphs_made(), GetParam() == "cuda" ? 1 : 0);
  runs->repeat(all_kinds);  // without elements some launches are missing: another graph, and again one after that
  EXPECT_GE(runs->graphs_made(), GetParam() == "cuda" ? 3 : 0);
  EXPECT_LE(runs->graphs_made(), 8);
}

TEST_P(Repeat, InterruptedInsideItWorksOn) {
  EXPECT_EQ(runs->stop_inside(3), 3);
  EXPECT_EQ(runs->repeat(all_alike).back(), expected(4000));
  EXPECT_EQ(runs->stop_inside(3), 3);
  EXPECT_EQ(runs->repeat(all_alike).back(), expected(4000));
}

TEST_P(Repeat, StagesInsideAreTimed) {
  runs->repeat(all_alike);
  runs->stop_inside(2);
  runs->repeat(all_alike);
  const StageTimers timers = runs->timers();
  for (const StageTimers::Stage& stage : timers.stages()) {
    if (stage.name != "repeat") continue;
    EXPECT_EQ(stage.calls, 10);
    EXPECT_EQ(stage.launches, 30);
    EXPECT_GT(stage.seconds, 0);
    EXPECT_LT(stage.seconds, 10);
  }
  EXPECT_GT(timers.seconds("repeat"), 0);
}

/// While it lives, NACRE_GRAPHS has a value.
struct Graphs {
  explicit Graphs(const char* value) { setenv("NACRE_GRAPHS", value, 1); }
  ~Graphs() { unsetenv("NACRE_GRAPHS"); }
};

std::vector<float> flow_frames(Device& device, const std::string& embedding, const char* graphs) {
  const Graphs chosen(graphs);
  const Shape shape = torus(120, 48);
  const auto pipeline = make_flow_pipeline(device);
  const int steps = small_cases() ? 6 : 12;
  pipeline->parameters.resolution = small_cases() ? 72 : 120;
  test::choose_embedding(pipeline->parameters, embedding);
  pipeline->parameters.steps = steps;
  pipeline->embed(shape.mesh());
  FlowVectors vectors;
  vectors.at = [&](double t, std::span<Vec3f> out) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = Vec3f(Vec3d(-shape.points[i].y, shape.points[i].x, 0.3 * t));
  };
  vectors.end = 2;
  pipeline->flow().start(vectors);
  std::vector<float> all;
  for (int k = 0; k < steps; ++k) {
    pipeline->flow().step();
    const std::vector<float> frame = pipeline->flow().shown();
    all.insert(all.end(), frame.begin(), frame.end());
  }
  return all;
}

TEST(RepeatOnCuda, StepsOfTheFlowAreTheSameAsGraphs) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto gpu = make_cuda_device(arena_limit);
  for (const char* embedding : {"grid", "brick", "thesis"}) {
    const std::vector<float> graphs = flow_frames(*gpu, embedding, "strict");
    EXPECT_GT(graphs.size(), 10000u);
    EXPECT_EQ(graphs, flow_frames(*gpu, embedding, "0")) << embedding;
  }
}

SurfaceMesh relaxed_mesh(Device& device, const char* graphs) {
  const Graphs chosen(graphs);
  const auto pipeline = make_mesh_pipeline(device);
  pipeline->parameters.iterations = 30;
  pipeline->parameters.control_every = 7;
  pipeline->load(test::indicator_volume(
      {33, 33, 33},
      {[](const Vec3d&) { return 0.0; }, test::ball(Vec3d(14, 16, 16), 8), test::ball(Vec3d(20, 17, 16), 8)}));
  pipeline->build_fields();
  pipeline->relax();
  return pipeline->triangulate();
}

TEST(RepeatOnCuda, IterationsOfTheTreeSolverAreTheSameAsGraphs) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
  const auto gpu = make_cuda_device(arena_limit);
  const SurfaceMesh graphs = relaxed_mesh(*gpu, "strict"), single = relaxed_mesh(*gpu, "0");
  EXPECT_GT(graphs.points.size(), 500u);
  ASSERT_EQ(graphs.points.size(), single.points.size());
  EXPECT_TRUE(std::equal(graphs.points.begin(), graphs.points.end(), single.points.begin()));
  EXPECT_TRUE(graphs.triangles == single.triangles);
}

}  // namespace
}  // namespace nacre::gpu_tests
