// Nacre: test bodies for population control.
#pragma once

#include <vector>

#include "tests/compute/on_devices.hpp"
#include "tests/compute/particles/solver_cases.hpp"
#include "tests/compute/small_cases.hpp"

namespace nacre::test {

inline double sphere_count() { return ideal_count(4 * M_PI * 100); }

template <class Backend>
void CountsSettleFromAnyStart(Executor<Backend>& exec) {
  const std::vector<double> shares = small_cases() ? std::vector{0.7} : std::vector{0.3, 0.7, 1.0, 1.5, 2.3};
  for (const double share : shares) {
    Relaxation<Backend, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(share), plain_table(1), 4000);
    run.iterate(30, 10);
    EXPECT_NEAR(double(run.set.count), sphere_count(), 0.04 * sphere_count()) << "seeded with the share " << share;
    const std::int64_t before = run.set.count;
    run.iterate(20, 10);
    EXPECT_NEAR(double(run.set.count), double(before), 0.025 * double(before)) << "seeded with the share " << share;
    EXPECT_LT(run.energy.back(), 1.1 * hexagonal_energy);
  }
}

/// The thesis's own constants: control after every iteration, 0.75 and 1.35 of the ideal, the original random
/// rule.
template <class Backend>
void TheOriginalRuleSettlesToo(Executor<Backend>& exec) {
  SolverParameters parameters;
  parameters.population.by_density = false;
  parameters.population.add_below = 0.75f, parameters.population.delete_above = 1.35f;
  parameters.step = 1;
  const std::vector<double> shares = small_cases() ? std::vector{2.0} : std::vector{0.5, 2.0};
  for (const double share : shares) {
    Relaxation<Backend, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(share), plain_table(1), 4000,
                                     parameters);
    run.iterate(30, 1);
    EXPECT_NEAR(double(run.set.count), sphere_count(), 0.06 * sphere_count()) << "seeded with the share " << share;
    const std::int64_t before = run.set.count;
    run.iterate(5, 1);
    EXPECT_NEAR(double(run.set.count), double(before), 0.005 * double(before)) << "seeded with the share " << share;
  }
}

template <class Backend>
void OneParticleFillsASphere(Executor<Backend>& exec) {
  const Seeds one{{{4, 0, 0}}, {0}, 0};
  Relaxation<Backend, Spheres> run(exec, {{4}, 1}, PlainSolver::redblack, one, plain_table(1), 2000);
  const IterationResult first = run.control();
  EXPECT_EQ(run.set.count, 4);  // a particle without neighbours makes four
  EXPECT_EQ(first.added, 3);
  run.iterate(80, 4);
  EXPECT_NEAR(double(run.set.count), ideal_count(4 * M_PI * 16), 0.06 * ideal_count(4 * M_PI * 16));
}

template <class Backend>
void ALonelyParticleOnACurveMakesThree(Executor<Backend>& exec) {
  const Seeds one{{{8, 0, 0}}, {1}, 0};
  Relaxation<Backend, Disc> run(exec, {8, 1}, PlainSolver::redblack, one, {Junction(0, 1), Junction(0, 1, 2)}, 100);
  run.control();
  ASSERT_EQ(run.set.count, 3);
  const auto positions = run.positions();
  EXPECT_NEAR(positions[1].y, -positions[2].y, 1e-5);
  EXPECT_NEAR(std::fabs(positions[1].y), 1, 0.02);
}

template <class Backend>
void NoneIsAddedWhereNoneMayBe(Executor<Backend>& exec) {
  SolverParameters parameters;
  parameters.population.may_add = false;
  Relaxation<Backend, Spheres> few(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(0.3), plain_table(1), 4000,
                                   parameters);
  const std::int64_t before = few.set.count;
  few.iterate(10, 5);
  EXPECT_EQ(few.set.count, before);
  Relaxation<Backend, Spheres> many(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(1.6), plain_table(1), 4000,
                                    parameters);
  many.iterate(30, 10);
  EXPECT_NEAR(double(many.set.count), sphere_count(), 0.04 * sphere_count());  // deletion goes on (sec. 3.4.3)
}

template <class Backend>
void TooManyParticlesAreRefused(Executor<Backend>& exec) {
  const Seeds seeds = sphere_seeds(0.3);
  Relaxation<Backend, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, seeds, plain_table(1),
                                   std::int64_t(seeds.points.size()) + 10);
  run.iterate(5);
  const auto before = run.positions();
  try {
    run.control();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("at most"), std::string::npos) << error.what();
    EXPECT_FALSE(error.advice().empty());
  }
  const auto after = run.positions();
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(xyz_of(before[k]), xyz_of(after[k]));
}

/// Marks particles by their damping, which travels with them, and fixed ones by their interface.
template <class Backend>
void WhatParticlesCarryGoesWithThem(Executor<Backend>& exec) {
  Seeds seeds = sphere_seeds(2);
  seeds.fixed = 100;
  Relaxation<Backend, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, seeds, plain_table(1), 8000);
  const auto before = run.positions();
  std::vector<float> mark(before.size());
  for (std::size_t k = 0; k < mark.size(); ++k) mark[k] = before[k].x + 3 * before[k].y;  // tells who is who
  run.state.damping.upload(mark);
  const IterationResult result = run.control();
  EXPECT_GT(result.deleted, 300);
  EXPECT_EQ(run.set.count, std::int64_t(before.size()) - result.deleted + result.added);
  const auto after = run.positions();
  const auto carried = run.state.damping.download(0, after.size());
  std::int64_t fresh = 0;
  for (std::size_t k = 0; k < after.size(); ++k) {
    if (k < 100) {
      EXPECT_EQ(xyz_of(after[k]), xyz_of(before[k]));
    }
    if (carried[k] == run.parameters.first_damping)
      ++fresh;
    else
      EXPECT_EQ(carried[k], after[k].x + 3 * after[k].y);
  }
  EXPECT_EQ(fresh, result.added);
}

NACRE_DEVICE_TEST(Population, CountsSettleFromAnyStart)
NACRE_DEVICE_TEST(Population, TheOriginalRuleSettlesToo)
NACRE_DEVICE_TEST(Population, OneParticleFillsASphere)
NACRE_DEVICE_TEST(Population, ALonelyParticleOnACurveMakesThree)
NACRE_DEVICE_TEST(Population, NoneIsAddedWhereNoneMayBe)
NACRE_DEVICE_TEST(Population, TooManyParticlesAreRefused)
NACRE_DEVICE_TEST(Population, WhatParticlesCarryGoesWithThem)

}  // namespace nacre::test
