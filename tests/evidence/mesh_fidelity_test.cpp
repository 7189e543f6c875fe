// Nacre: what a bound on the deviation costs, and how fast meshes of second order converge to a ball.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "compute/device/cpu_device.hpp"
#include "compute/meshing/second_order.hpp"
#include "compute/meshing/tetrahedra.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/mesh_deviation.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

struct Bent {
  double flat_volume, curved_volume;  ///< relative errors
  SecondOrder second;
  DeviationRange flat, curved;
};

/// A ball meshed at an even size, filled, and bent.
Bent bent_ball(Device& device, double size) {
  constexpr double radius = 20;
  MeshParameters parameters;
  parameters.min_size = parameters.max_size = size;
  parameters.triangles = "delaunay";
  const auto pipeline = make_mesh_pipeline(device);
  pipeline->parameters = parameters;
  pipeline->load(scalar_volume({52, 52, 52}, ball({25.4, 25.6, 25.3}, radius)));
  pipeline->build_fields();
  pipeline->relax();
  const SurfaceMesh mesh = pipeline->triangulate();
  const TetrahedralMesh filled = fill_with_tetrahedra(mesh);
  const auto onto = [&](bool within) {
    return [&, within](std::span<const Vec3d> points, std::span<const Junction> junctions) {
      return pipeline->onto_junctions(points, junctions, within);
    };
  };
  Bent bent;
  bent.second = second_order(mesh, &filled, onto(true));
  bent.flat = sampled_deviation(mesh, nullptr, onto(false), 1);
  bent.curved = sampled_deviation(mesh, &bent.second, onto(false), 1);
  const double exact = 4 * M_PI / 3 * radius * radius * radius;
  bent.flat_volume = check_topology(mesh, 2).materials[1].volume / exact - 1;
  bent.curved_volume = enclosed_volumes(mesh, bent.second, 2)[1] / exact - 1;
  return bent;
}

TEST(MeshFidelity, SecondOrderConvergesFasterOnABall) {
  const auto device = make_cpu_device();
  const Bent coarse = bent_ball(*device, 12), fine = bent_ball(*device, 6);
  for (const Bent* b : {&coarse, &fine})
    std::printf("volume %.2e flat, %.2e curved; deviation %.2e, %.2e; pulled back %lld of %lld, least Jacobian %.2f\n",
                b->flat_volume, b->curved_volume, b->flat.max, b->curved.max, (long long)b->second.pulled_back,
                (long long)b->second.on_surfaces, b->second.least_jacobian);
  EXPECT_GT(std::fabs(coarse.flat_volume), 20 * std::fabs(coarse.curved_volume));
  EXPECT_NEAR(coarse.flat_volume / fine.flat_volume, 4, 1);
  EXPECT_GT(std::fabs(coarse.curved_volume), 8 * std::fabs(fine.curved_volume));
  EXPECT_LT(fine.curved.max, 0.1 * fine.flat.max);
  EXPECT_GE(fine.second.least_jacobian, least_scaled_jacobian);
}

double seconds_of(const auto& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// A thin torus beside a thick ball, which an even size must make alike.
TEST(MeshFidelity, ABoundTakesFewerTrianglesThanAnEvenSize) {
  const auto device = make_cpu_device();
  const auto body = [](const Vec3d& p) {
    const Vec3d r = p - Vec3d(35.4, 35.6, 9.3);
    const double torus = 3.5 - std::hypot(std::hypot(r.x, r.y) - 28, r.z);
    return std::max(torus, 20 - length(p - Vec3d(35.2, 35.4, 40.6)));
  };
  const MeshVolume volume = scalar_volume({72, 72, 66}, body);
  MeshParameters bounded;
  bounded.max_size = 8;
  bounded.epsilon = 4;
  bounded.max_deviation = 0.03;
  MeshRun run;
  const double bounded_seconds = seconds_of([&] { run = run_mesh(*device, volume, bounded); });
  EXPECT_LE(run.info.deviation.max, 0.03);
  // The even size whose largest deviation is that bound, from above.
  MeshParameters even;
  MeshRun best;
  double even_seconds = 0;
  for (double size = 1.4; size > 0.3; size *= 0.85) {
    even.min_size = even.max_size = size;
    even.max_deviation = 1000;  // measures, and changes nothing
    even_seconds = seconds_of([&] { best = run_mesh(*device, volume, even); });
    if (best.info.deviation.first_max <= 0.03) break;
  }
  std::printf("bounded: %zu triangles, %.1f s, %d rounds, %lld particles added; even %.2f: %zu triangles, %.1f s\n",
              run.mesh.triangles.size(), bounded_seconds, run.info.deviation.rounds,
              (long long)run.info.deviation.inserted, even.max_size, best.mesh.triangles.size(), even_seconds);
  EXPECT_LT(2 * run.mesh.triangles.size(), best.mesh.triangles.size());
}

}  // namespace
}  // namespace nacre::test
