// Nacre: which stages run again after which knob, that what they leave is what a fresh run gives, and stops anywhere.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "compute/device/error.hpp"
#include "compute/pipeline/mesh_rerun.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

using Names = std::vector<std::string>;

/// The stages that ran during `call`, in the order of their first run ever.
Names stages_of(MeshPipeline& pipeline, const std::function<void()>& call) {
  const std::vector<StageTimers::Stage> before = pipeline.timers().stages();
  call();
  Names names;
  const std::vector<StageTimers::Stage>& after = pipeline.timers().stages();
  for (std::size_t k = 0; k < after.size(); ++k)
    if (k >= before.size() || after[k].calls > before[k].calls) names.push_back(after[k].name);
  return names;
}

/// Materials, distances and sizes all over the volume and a little beyond it; -1 where there are none.
std::vector<float> fields_of(MeshPipeline& pipeline) {
  std::vector<Vec3d> points;
  for (double z = -3; z < 28; z += 1.37)
    for (double y = -3; y < 28; y += 1.29)
      for (double x = -3; x < 28; x += 1.41) points.push_back({x, y, z});
  std::vector<float> values;
  for (const MeshField field : {MeshField::material, MeshField::distance, MeshField::size}) {
    for (const float v : pipeline.field_at(field, points)) values.push_back(std::isnan(v) ? -1 : v);
  }
  return values;
}

MeshParameters few_iterations() {
  MeshParameters parameters;
  parameters.iterations = 30;
  return parameters;
}

std::vector<float> fresh_fields(Device& device, const MeshVolume& volume, const MeshParameters& parameters) {
  const auto pipeline = make_mesh_pipeline(device);
  pipeline->parameters = parameters;
  pipeline->load(volume);
  pipeline->build_fields();
  return fields_of(*pipeline);
}

struct Change {
  const char* what;
  std::function<void(MeshParameters&)> change;
  Names stages;  ///< of build_fields
};

const Names sizes{"sizing", "embed"}, distances{"distance", "sizing", "embed"},
    all{"tighten", "distance", "sizing", "embed"};

/// Each on top of those before it.
const std::vector<Change>& changes() {
  using P = MeshParameters;
  static const std::vector<Change> list{
      {"nothing", [](P&) {}, {}},
      {"theta", [](P& p) { p.theta = 0.8; }, {}},
      {"iterations", [](P& p) { p.iterations = 20; }, {}},
      {"remesh", [](P& p) { p.remesh = 1; }, {}},
      {"delta", [](P& p) { p.delta = 0.2; }, sizes},
      {"epsilon, which bounds the medial balls", [](P& p) { p.epsilon = 0.3; }, distances},
      {"epsilon, beyond what bounds them", [](P& p) { p.epsilon = 2; }, distances},
      {"epsilon, still beyond it", [](P& p) { p.epsilon = 2.5; }, sizes},
      {"min_size, finer than voxels", [](P& p) { p.min_size = 0.6; }, sizes},
      {"max_size", [](P& p) { p.max_size = 1.3; }, distances},
      {"curvature", [](P& p) { p.curvature = true; }, sizes},
      {"subcells", [](P& p) { p.subcells = 2; }, {"embed"}},
      {"subcells, one again", [](P& p) { p.subcells = 1; }, {"embed"}},
      {"kernel", [](P& p) { p.kernel = "b-spline"; }, distances},
      {"tighten", [](P& p) { p.tighten = 0.8; }, all},
      {"stairs", [](P& p) { p.stairs = 8; }, all},
      {"tighten, none", [](P& p) { p.tighten = 0; }, all},
      {"stairs, where nothing is tightened", [](P& p) { p.stairs = 0; }, {}},
      {"a coarser lattice", [](P& p) { p.min_size = 1.2, p.max_size = 1.4; }, distances},
      {"subcells, limited by the sizes", [](P& p) { p.subcells = 8; }, {"embed"}},
      {"subcells, as limited as before", [](P& p) { p.subcells = 7; }, {}},
      {"all back", [](P& p) { p = few_iterations(); }, all},
  };
  return list;
}

TEST(MeshStages, ThoseRunAgainThatAKnobConcerns) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  const MeshVolume volume = three_materials();
  pipeline->parameters = few_iterations();
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->load(volume); }), Names{"materials"});
  EXPECT_EQ(stages_of(*pipeline, [&] { EXPECT_TRUE(pipeline->build_fields()); }), all);
  for (const Change& c : changes()) {
    SCOPED_TRACE(c.what);
    const MeshParameters before = pipeline->parameters;
    c.change(pipeline->parameters);
    bool ran = false;
    EXPECT_EQ(stages_of(*pipeline, [&] { ran = pipeline->build_fields(); }), c.stages);
    EXPECT_EQ(ran, !c.stages.empty());
    EXPECT_TRUE(!ran || mesh_rerun(before, pipeline->parameters) == MeshRerun::fields);
    EXPECT_EQ(fields_of(*pipeline), fresh_fields(*device, volume, pipeline->parameters));
  }
}

TEST(MeshStages, ScalarsAreNotTightened) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  pipeline->load(scalar_volume({20, 20, 20}, ball({9, 9.5, 10}, 6)));  // not needed after it
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->build_fields(); }), distances);
  pipeline->parameters.tighten = 0.5;
  EXPECT_FALSE(pipeline->build_fields());
  pipeline->parameters.kernel = "b-spline";
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->build_fields(); }), distances);
}

TEST(MeshStages, TheStepsBehindTheFieldsRunWhole) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  const MeshVolume volume = three_materials();
  pipeline->parameters = few_iterations();
  pipeline->load(volume);
  pipeline->build_fields();
  const Names moves{"seed", "relax", "population"}, meshes{"triangulate", "remesh", "smooth"};
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->relax(); }), moves);
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->triangulate(); }), meshes);
  pipeline->parameters.theta = 0.8;
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->build_fields(); }), Names{});
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->relax(); }), moves);
  EXPECT_EQ(stages_of(*pipeline, [&] { pipeline->triangulate(); }), meshes);
}

/// The same knobs by several ways give the same mesh.
TEST(MeshStages, TheWayToTheKnobsDoesNotMatter) {
  const auto device = make_cpu_device();
  for (const MeshVolume& volume : {three_materials(), three_balls()}) {
    MeshParameters wanted = few_iterations();
    wanted.epsilon = 0.4, wanted.max_size = 1.2, wanted.theta = 0.7, wanted.kernel = "b-spline";
    const SurfaceMesh mesh = run_mesh(*device, volume, wanted).mesh;
    const std::vector<std::function<void(MeshParameters&)>> steps{
        [&](MeshParameters& p) { p.epsilon = wanted.epsilon; },
        [&](MeshParameters& p) { p.max_size = wanted.max_size; }, [&](MeshParameters& p) { p.theta = wanted.theta; },
        [&](MeshParameters& p) { p.kernel = wanted.kernel; }};
    for (const std::vector<int>& order : std::vector<std::vector<int>>{{0, 1, 2, 3}, {2, 3, 1, 0}}) {
      const auto pipeline = make_mesh_pipeline(*device);
      pipeline->parameters = few_iterations();
      pipeline->load(volume);
      for (const int k : order) {
        pipeline->build_fields();
        if (k % 2 == 0) pipeline->relax();
        steps[std::size_t(k)](pipeline->parameters);
      }
      pipeline->build_fields();
      pipeline->relax();
      expect_same(pipeline->triangulate(), mesh);
    }
  }
}

/// So few iterations that there is much to remesh.
MeshParameters hasty() {
  MeshParameters parameters;
  parameters.iterations = 4;
  return parameters;
}

TEST(MeshStages, TriangulatingAgainBeginsWithTheParticlesBeforeMending) {
  const auto device = make_cpu_device();
  const MeshVolume volume = three_balls();
  MeshParameters parameters = hasty();
  parameters.remesh = 0;
  const SurfaceMesh unremeshed = run_mesh(*device, volume, parameters).mesh;
  const auto pipeline = make_mesh_pipeline(*device);
  pipeline->parameters = hasty();
  pipeline->load(volume);
  pipeline->build_fields();
  pipeline->relax();
  const SurfaceMesh remeshed = pipeline->triangulate();
  EXPECT_FALSE(remeshed.triangles == unremeshed.triangles) << "nothing to remesh: this test would show nothing";
  expect_same(pipeline->triangulate(), remeshed);
  pipeline->parameters.remesh = 0;
  expect_same(pipeline->triangulate(), unremeshed);
  pipeline->parameters.remesh = hasty().remesh;
  expect_same(pipeline->triangulate(), remeshed);
}

class MeshStops : public ::testing::Test {
 protected:
  void SetUp() override {
    pipeline_->parameters = few_iterations();
    pipeline_->load(volume_);
  }

  /// Makes the mesh as a viewer would that had no idea what was stopped.
  SurfaceMesh finish() {
    pipeline_->progress = nullptr;
    pipeline_->watch(nullptr);
    pipeline_->build_fields();
    pipeline_->relax();
    return pipeline_->triangulate();
  }

  const std::unique_ptr<Device> device_ = make_cpu_device();
  const std::unique_ptr<MeshPipeline> pipeline_ = make_mesh_pipeline(*device_);
  const MeshVolume volume_ = label_balls();
  const SurfaceMesh expected_ = run_mesh(*device_, volume_, few_iterations()).mesh;
  std::atomic<bool> stop_ = false;
};

TEST_F(MeshStops, AStoppedStageBeginsAnew) {
  for (const char* stage : {"tighten", "distance", "sizing", "embed", "relax"}) {
    SCOPED_TRACE(stage);
    pipeline_->parameters.tighten = 0.3;  // so that all have to run
    pipeline_->progress = [&](const MeshProgress& p) { stop_ = stop_ || p.stage == stage; };
    stop_ = false;
    pipeline_->watch(&stop_);
    EXPECT_THROW(
        {
          pipeline_->build_fields();
          pipeline_->relax();
        },
        Interrupted);
    pipeline_->parameters = few_iterations();
    expect_same(finish(), expected_);
  }
}

TEST_F(MeshStops, AfterAStopWithTheSameKnobsOnlyTheRestRuns) {
  pipeline_->progress = [&](const MeshProgress& p) { stop_ = stop_ || p.stage == "sizing"; };
  pipeline_->watch(&stop_);
  EXPECT_THROW(pipeline_->build_fields(), Interrupted);
  EXPECT_THROW(fields_of(*pipeline_), Error) << "half of the fields are those of nothing";
  pipeline_->progress = nullptr;
  pipeline_->watch(nullptr);
  EXPECT_EQ(stages_of(*pipeline_, [&] { pipeline_->build_fields(); }), sizes);
  EXPECT_EQ(fields_of(*pipeline_), fresh_fields(*device_, volume_, few_iterations()));
}

/// Stops at times that fall anywhere, also in the middle of a launch.
TEST_F(MeshStops, AnywhereInTheFields) {
  const std::vector<float> expected = fresh_fields(*device_, volume_, few_iterations());
  int stopped = 0;
  for (int microseconds = 50; microseconds < 60000; microseconds = microseconds * 3 / 2) {
    pipeline_->parameters.tighten = 1.2 + 1e-9 * microseconds;
    stop_ = false;
    pipeline_->watch(&stop_);
    std::thread other([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
      stop_ = true;
    });
    try {
      pipeline_->build_fields();
    } catch (const Interrupted&) {
      ++stopped;
    }
    other.join();
    pipeline_->watch(nullptr);
    pipeline_->parameters = few_iterations();
    pipeline_->build_fields();
    ASSERT_EQ(fields_of(*pipeline_), expected) << microseconds;
  }
  EXPECT_GT(stopped, 3);
  expect_same(finish(), expected_);
}

TEST_F(MeshStops, WhileMendingAndTriangulatesAgain) {
  const SurfaceMesh expected = run_mesh(*device_, volume_, hasty()).mesh;
  pipeline_->parameters = hasty();
  pipeline_->build_fields();
  pipeline_->relax();
  for (const int nth : {1, 3, 5}) {
    int told = 0;
    pipeline_->progress = [&](const MeshProgress& p) { stop_ = stop_ || (p.stage == "smooth" && ++told == nth); };
    stop_ = false;
    pipeline_->watch(&stop_);
    EXPECT_THROW(pipeline_->triangulate(), Interrupted);
    pipeline_->progress = nullptr;
    pipeline_->watch(nullptr);
    expect_same(pipeline_->triangulate(), expected);
  }
}

TEST_F(MeshStops, AStoppedLoadLeavesNoVolume) {
  stop_ = true;
  pipeline_->watch(&stop_);
  EXPECT_THROW(pipeline_->load(volume_), Interrupted);
  pipeline_->watch(nullptr);
  EXPECT_THROW(pipeline_->build_fields(), Error);
  pipeline_->load(volume_);
  expect_same(finish(), expected_);
}

}  // namespace
}  // namespace nacre::test
