// Nacre: the serial solver on surfaces with a formula.
#include "compute/particles/serial.hpp"

#include <gtest/gtest.h>

#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/solver_cases.hpp"

namespace nacre::test {
namespace {

TEST(Serial, EnergyFallsOnASphere) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, PlainSolver::serial, sphere_seeds(1), plain_table(1));
  run.iterate(30);
  for (std::size_t k = 1; k < run.energy.size(); ++k) EXPECT_LT(run.energy[k], run.energy[k - 1]) << k;
  EXPECT_LT(run.energy.back(), 1.05 * hexagonal_energy);
  const std::vector<double> spacing = spacings(run.positions());
  EXPECT_GT(*std::min_element(spacing.begin(), spacing.end()), 0.6);
}

TEST(Serial, ReadsAndWritesTheDevicesMemoryOnlyInLaunches) {
  const auto device = make_cpu_device(0, true);  // its memory is closed to the host
  Executor<Cpu> exec(*device);
  Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, PlainSolver::serial, sphere_seeds(0.3), plain_table(1));
  run.iterate(3, 1);
  EXPECT_GT(run.set.count, 0);
}

TEST(Serial, LeavesEachParticleTheEnergyThatItHas) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  Relaxation<Cpu, Spheres> run(exec, {{4}, 1}, PlainSolver::serial, sphere_seeds(1, 4), plain_table(1));
  run.iterate(200);  // until nothing moves
  const auto positions = run.positions(), directions = run.directions();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    double energy = 0;
    for (std::size_t j = 0; j < positions.size(); ++j)
      if (j != i) {
        const float d = length(xyz_of(positions[i]) - xyz_of(positions[j])) / support;
        energy += normal_weight(dot(xyz_of(directions[i]), xyz_of(directions[j])), d) * cotangent_energy(d).energy;
      }
    EXPECT_NEAR(directions[i].w, energy, 0.02 * energy + 1e-3);
  }
}

TEST(Serial, EachMoveLowersTheMoversEnergy) {  // two particles on a plane push each other out of their support
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  const Seeds seeds{{{-0.3f, 0, 0}, {0.3f, 0.1f, 0}}, {0, 0}, 0};
  Relaxation<Cpu, Disc> run(exec, {20, 1}, PlainSolver::serial, seeds, plain_table(1), 10);
  run.iterate(40);
  for (std::size_t k = 1; k < run.energy.size(); ++k) EXPECT_LE(run.energy[k], run.energy[k - 1]);
  const auto positions = run.positions();
  EXPECT_GT(length(xyz_of(positions[0]) - xyz_of(positions[1])), 0.9f * support);
  EXPECT_NEAR((positions[0].y - positions[1].y) / (positions[0].x - positions[1].x), 1.0 / 6,
              1e-3);  // along their line
}

TEST(Serial, StepsAreAsShortAsTheyMustBe) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  SolverParameters parameters;
  parameters.step = 0.1f;
  const Seeds seeds = sphere_seeds(2);
  Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, PlainSolver::serial, seeds, plain_table(1), 0, parameters);
  const auto before = run.positions();
  run.iterate(1);
  const auto after = run.positions();
  bool moved = false;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const float displacement = length(xyz_of(after[k]) - xyz_of(before[k]));
    EXPECT_LE(displacement, 0.1001f);
    moved = moved || displacement > 0.05f;
  }
  EXPECT_TRUE(moved);
}

TEST(Serial, StopsWhenAsked) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, PlainSolver::serial, sphere_seeds(1), plain_table(1));
  std::atomic<bool> stop = true;
  exec.watch(&stop);
  EXPECT_THROW(run.iterate(1), Interrupted);
}

/// A surface of which only a stretch is left: what a step beyond a junction curve meets.
struct Strip {
  float half;
  NACRE_HD bool project(std::uint32_t, const Vec3f& p, float, Vec3f& on, Vec3f& direction) const {
    on = {p.x, p.y, 0};
    direction = {0, 0, 1};
    return std::fabs(p.x) <= half;
  }
  NACRE_HD float size(const Vec3f&) const { return 1; }
};

TEST(Serial, StaysWhereTheSurfaceIs) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  const Seeds seeds{{{0, 0, 0}, {0.2f, 0, 0}}, {0, 0}, 0};
  Relaxation<Cpu, Strip> run(exec, {0.5f}, PlainSolver::serial, seeds, plain_table(1), 10);
  run.iterate(30);
  for (const Float4& p : run.positions()) EXPECT_LE(std::fabs(p.x), 0.5f);
}

}  // namespace
}  // namespace nacre::test
