// Nacre: meshes of particles that were stopped early (--keep-on-interrupt), in either junction order.
#include <gtest/gtest.h>

#include <atomic>
#include <string>

#include "compute/device/error.hpp"
#include "compute/meshing/topology.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

/// A ball whose halves are two materials: three surfaces that end at one circle.
MeshVolume halves() {
  return label_volume({22, 21, 22}, 3, [](const Vec3d& p) {
    const double r = length(p - Vec3d(10.4, 10.1, 10.7));
    return r > 7.2 ? 0 : p.x < 10 ? 1 : 2;
  });
}

class MeshInterrupt : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    pipeline_->parameters.solver = GetParam();
    pipeline_->parameters.coarse_iterations = 0;
    pipeline_->parameters.stagnation = 0;
    pipeline_->parameters.iterations = 200;
    pipeline_->load(volume_);
    pipeline_->build_fields();
    pipeline_->watch(&stop_);
  }

  /// Stops at the `nth` iteration of all; how many of them were made.
  int stop_at(int nth) {
    int iterations = 0;
    pipeline_->progress = [&, nth](const MeshProgress& p) {
      if (p.stage == "relax" && ++iterations == nth) stop_ = true;
    };
    EXPECT_THROW(pipeline_->relax(), Interrupted);
    pipeline_->watch(nullptr);
    return iterations;
  }

  void expect_whole(const SurfaceMesh& mesh) {
    const TopologyReport report = check_topology(mesh, 3);
    EXPECT_TRUE(report.sound());
    for (int m = 1; m < 3; ++m) {
      EXPECT_TRUE(report.materials[m].closed) << m;
      EXPECT_EQ(report.materials[m].euler, 2) << m;
    }
    EXPECT_NEAR(report.materials[1].volume + report.materials[2].volume, 4 * M_PI / 3 * 7.2 * 7.2 * 7.2, 80);
    EXPECT_GT(report.junction_edges, 30);
    EXPECT_LT(pipeline_->surface_distance(mesh).vertex_max, 0.1);
    for (const float size : pipeline_->particles().size) EXPECT_GT(size, 0.4f);  // of those that remeshing added, too
  }

  const std::unique_ptr<Device> device_ = make_cpu_device();
  const std::unique_ptr<MeshPipeline> pipeline_ = make_mesh_pipeline(*device_);
  const MeshVolume volume_ = halves();
  std::atomic<bool> stop_ = false;
};

TEST_P(MeshInterrupt, WhileCurvesMoveSurfacesAreMadeOfTheirSeeds) {
  EXPECT_LT(stop_at(12), 16) << "only what was under way is finished";
  EXPECT_EQ(pipeline_->info().iterations, 0) << "no surface has moved yet";
  const SurfaceMesh mesh = pipeline_->triangulate();
  expect_whole(mesh);
  EXPECT_GT(pipeline_->info().curves_final, 30);
  EXPECT_GT(pipeline_->info().surfaces_final, 500);
}

/// Between the orders, when curves are at rest and surfaces have no seeds yet.
TEST_P(MeshInterrupt, WhileSeedingTheRestIsSeeded) {
  pipeline_->parameters.iterations = 20;
  EXPECT_EQ(stop_at(20), 20);  // the next launch seeds surfaces
  EXPECT_EQ(pipeline_->info().seeded_on_surfaces, 0);
  expect_whole(pipeline_->triangulate());
  EXPECT_GT(pipeline_->info().curves_final, 30);
}

TEST_P(MeshInterrupt, WhileSurfacesMoveTheyStayWhereTheyAre) {
  stop_at(212);
  EXPECT_GE(pipeline_->info().iterations, 1);
  EXPECT_LT(pipeline_->info().iterations, 20);
  expect_whole(pipeline_->triangulate());
}

INSTANTIATE_TEST_SUITE_P(By, MeshInterrupt, ::testing::Values("tree", "redblack", "serial"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace nacre::test
