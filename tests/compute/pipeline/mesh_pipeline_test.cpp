// Nacre: the mesh pipeline as a whole: determinism, stopping, repeated steps, errors.
#include "compute/pipeline/mesh_pipeline.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "compute/device/error.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

MeshRun on_threads(int threads, bool remote, std::uint32_t seed, const std::string& solver = "tree") {
  const auto device = make_cpu_device(threads, remote);
  MeshParameters parameters;
  parameters.seed = seed;
  parameters.solver = solver;
  parameters.iterations = 40;
  return run_mesh(*device, three_materials(), parameters);
}

TEST(MeshPipeline, OneSeedGivesOneMeshOnAnyNumberOfThreads) {
  const MeshRun one = on_threads(1, false, 1);
  const TopologyReport report = check_topology(one.mesh, 4);
  EXPECT_TRUE(report.sound());
  EXPECT_EQ(report.materials[3].euler, 2);  // the voxel alone
  expect_same(one.mesh, on_threads(2, false, 1).mesh);
  expect_same(one.mesh, on_threads(2, true, 1).mesh);  // memory that the host cannot look into
}

TEST(MeshPipeline, SoDoTheOtherSolvers) {
  for (const char* solver : {"redblack", "serial"}) {
    const MeshRun one = on_threads(1, false, 1, solver);
    expect_same(one.mesh, on_threads(2, false, 1, solver).mesh);
    EXPECT_TRUE(check_topology(one.mesh, 4).sound()) << solver;
  }
}

TEST(MeshPipeline, EachSolverGoesItsOwnWay) {
  const MeshRun tree = on_threads(2, false, 1), redblack = on_threads(2, false, 1, "redblack"),
                serial = on_threads(2, false, 1, "serial");
  EXPECT_NE(tree.info.energy, redblack.info.energy);
  EXPECT_NE(tree.info.energy, serial.info.energy);
  EXPECT_NE(redblack.info.energy, serial.info.energy);
  EXPECT_NEAR(double(redblack.info.final), double(tree.info.final), 0.1 * double(tree.info.final));
  EXPECT_NEAR(double(serial.info.final), double(tree.info.final), 0.1 * double(tree.info.final));
}

TEST(MeshPipeline, StopsSoonAndKeepsWhatThereIs) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  const MeshVolume volume = three_materials();
  pipeline->parameters.min_size = pipeline->parameters.max_size = 0.35;
  pipeline->parameters.subcells = 3;
  pipeline->parameters.stagnation = 0;
  pipeline->parameters.iterations = 100000;
  pipeline->load(volume);
  pipeline->build_fields();
  std::atomic<bool> stop = false;
  std::chrono::steady_clock::time_point asked;
  int iterations = 0;
  pipeline->progress = [&](const MeshProgress& p) {
    if (p.stage != "relax" || ++iterations != 12) return;
    asked = std::chrono::steady_clock::now();
    stop = true;
  };
  pipeline->watch(&stop);
  EXPECT_THROW(pipeline->relax(), Interrupted);
  EXPECT_GE(iterations, 12);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count(), 2);
  pipeline->watch(nullptr);
  const SurfaceMesh mesh = pipeline->triangulate();
  const TopologyReport report = check_topology(mesh, 4);
  for (int m = 0; m < 4; ++m) EXPECT_GT(report.materials[m].facets, 0) << m;
  EXPECT_EQ(report.boundary_edges, 0);
}

TEST(MeshPipeline, StopsInTheFieldsToo) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  const MeshVolume volume = three_materials();
  pipeline->load(volume);
  std::atomic<bool> stop = true;
  pipeline->watch(&stop);
  EXPECT_THROW(pipeline->build_fields(), Interrupted);
  pipeline->watch(nullptr);
  EXPECT_THROW(pipeline->relax(), Error) << "no fields";
  pipeline->build_fields();
  pipeline->relax();
  EXPECT_TRUE(check_topology(pipeline->triangulate(), 4).sound());
}

/// Steps may be repeated without those before them, and give what a fresh pipeline gives.
TEST(MeshPipeline, StepsCanBeRepeated) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  const MeshVolume volume = three_materials();
  pipeline->load(volume);
  pipeline->build_fields();
  pipeline->relax();
  const SurfaceMesh first = pipeline->triangulate();
  const double expected = pipeline->info().expected_particles;
  pipeline->parameters.max_size = pipeline->parameters.min_size = 0.8;
  pipeline->build_fields();
  EXPECT_NE(pipeline->info().expected_particles, expected);
  pipeline->relax();
  const SurfaceMesh finer = pipeline->triangulate();
  MeshParameters parameters;
  parameters.min_size = parameters.max_size = 0.8;
  expect_same(finer, run_mesh(*device, volume, parameters).mesh);
  pipeline->parameters = {};
  pipeline->build_fields();
  pipeline->relax();
  expect_same(first, pipeline->triangulate());
  pipeline->load(scalar_volume({20, 20, 20}, ball({9, 9.5, 10}, 6)));
  EXPECT_THROW(pipeline->triangulate(), Error) << "the particles were those of the last volume";
}

TEST(MeshPipeline, ANumberOfParticlesIsSeededAndNoneAdded) {
  const auto device = make_cpu_device();
  const MeshVolume volume = scalar_volume({27, 26, 27}, ball({13.2, 12.7, 13.1}, 8.3));  // asks for about 1000
  MeshParameters parameters;
  parameters.particles = 800;
  const MeshRun few = run_mesh(*device, volume, parameters);
  EXPECT_NEAR(double(few.info.seeded), 800, 8);
  EXPECT_LE(few.info.final, few.info.seeded);
  EXPECT_GE(few.info.final, few.info.seeded * 95 / 100);
  parameters.particles = 3000;
  const MeshRun many = run_mesh(*device, volume, parameters);
  EXPECT_NEAR(double(many.info.seeded), 3000, 30);
  for (std::size_t k = 1; k < many.info.count.size(); ++k) EXPECT_LE(many.info.count[k], many.info.count[k - 1]);
  parameters.particles = 15000;  // more than the embedding has cells along the surface
  const MeshRun most = run_mesh(*device, volume, parameters);
  EXPECT_NEAR(double(most.info.seeded), 15000, 150);
  EXPECT_GE(most.info.final, 13000) << "the crowded may go";
}

TEST(MeshPipeline, SizesFarBelowTheCellsOfTheEmbeddingAreHeld) {
  const auto device = make_cpu_device();
  MeshParameters parameters;
  parameters.min_size = parameters.max_size = 0.2;
  const MeshRun run = run_mesh(*device, scalar_volume({14, 14, 14}, ball({6.3, 6.2, 6.4}, 4.2)), parameters);
  EXPECT_NEAR(double(run.info.final), run.info.expected_particles, 0.05 * run.info.expected_particles);
  EXPECT_NEAR(double(run.info.final), 4 * M_PI * 4.2 * 4.2 * 1.1547 / 0.04, 0.06 * double(run.info.final));
  EXPECT_GT(surface_quality(run.mesh).all.radius_ratio_mean, 0.98);
}

TEST(MeshPipeline, TellsHowFarItIs) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  double last = 0;
  int calls = 0;
  std::int64_t particles = 0;
  pipeline->progress = [&](const MeshProgress& p) {
    EXPECT_GE(p.fraction, last - 0.08) << p.stage;  // remeshing goes back a little
    last = p.fraction;
    EXPECT_LE(p.fraction, 1);
    particles = std::max(particles, p.particles);
    ++calls;
  };
  const MeshVolume volume = three_materials();
  pipeline->load(volume);
  pipeline->build_fields();
  pipeline->relax();
  const SurfaceMesh mesh = pipeline->triangulate();
  EXPECT_GT(calls, 20);
  EXPECT_GT(particles, 1000);
  const MeshInfo& info = pipeline->info();
  EXPECT_EQ(info.final, info.points_final + info.curves_final + info.surfaces_final);
  EXPECT_GT(info.curves_final, 10);
  EXPECT_EQ(info.surfaces, 4);
  const MeshParticles set = pipeline->particles();
  EXPECT_EQ(std::int64_t(set.points.size()), info.final);
  EXPECT_GT(pipeline->peak_bytes(), std::size_t(info.field_bytes));
}

void expect_error(const std::function<void()>& call, const std::string& part) {
  try {
    call();
    FAIL() << "no error about " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

/// Also where the number of particles on surfaces is given and there are more on the junctions.
TEST(MeshPipeline, TellsForHowManyParticlesItHasRoom) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  expect_error([&] { pipeline->particle_capacity(); }, "no fields");
  pipeline->load(three_balls());
  pipeline->build_fields();
  const std::int64_t capacity = pipeline->particle_capacity();
  EXPECT_EQ(capacity, std::int64_t(1.6 * pipeline->info().expected_particles + 20000));
  pipeline->parameters.particles = 1;
  EXPECT_LT(pipeline->particle_capacity(), capacity);
  EXPECT_GT(pipeline->particle_capacity(), 20000 + 1.6 * 20) << "for those on junctions, too";
  pipeline->parameters.particles = 1000000;
  EXPECT_GT(pipeline->particle_capacity(), 1600000 + 20000);
}

TEST(MeshPipeline, SaysWhatItCannotDo) {
  const auto device = make_cpu_device();
  const auto pipeline = make_mesh_pipeline(*device);
  expect_error([&] { pipeline->build_fields(); }, "no volume");
  expect_error([&] { pipeline->relax(); }, "no fields");
  expect_error([&] { pipeline->triangulate(); }, "no particles");
  const MeshVolume nothing = label_volume({9, 9, 9}, 2, [](const Vec3d&) { return 0; });
  expect_error([&] { pipeline->load(nothing); }, "one material only");
  const MeshVolume volume = three_materials();
  pipeline->load(volume);
  pipeline->build_fields();
  pipeline->parameters.particles = 2000000000;
  expect_error([&] { pipeline->relax(); }, "too many particles");
  pipeline->parameters.particles = 0;
  pipeline->relax();  // the pipeline works on
  EXPECT_FALSE(pipeline->triangulate().triangles.empty());
}

}  // namespace
}  // namespace nacre::test
