// Nacre: test bodies for the simultaneous steps of the tree solver and its control of the population.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "tests/compute/embedding/embedding_cases.hpp"
#include "tests/compute/particles/solver_cases.hpp"
#include "tests/compute/particles/tree_solver_run.hpp"

namespace nacre::test {

template <class Backend>
void AnIterationIsForcesAndAMove(Executor<Backend>& exec) {
  const AnalyticProjector<Plane> projector{{1}};
  std::vector<Vec3f> points;
  for (int k = 0; k < 500; ++k) points.push_back({20 + 0.7f * float(k % 25), 20 + 0.9f * float(k / 25), 0});
  const std::vector<std::uint32_t> interface(points.size(), 0);
  TreeSolverRun<Backend> at_once = one_surface(exec, 600), apart = one_surface(exec, 600);
  at_once.seed(projector, points, interface);
  apart.seed(projector, points, interface);
  for (int k = 0; k < 4; ++k) {
    if (k != 2) at_once.solver.rebuild(exec), apart.solver.rebuild(exec);
    const double energy = at_once.solver.iterate(exec, projector, at_once.view, 2, at_once.rule, 500);
    EXPECT_EQ(energy, apart.solver.forces(exec, apart.view, 2, apart.rule.theta, 500)) << k;
    apart.solver.move(exec, projector, apart.view, 2, apart.rule);
    const auto bytes = [](const std::vector<Float4>& v) {
      return std::string(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(Float4));
    };
    EXPECT_EQ(bytes(at_once.positions()), bytes(apart.positions())) << k;
    EXPECT_EQ(bytes(at_once.directions()), bytes(apart.directions())) << k;
    EXPECT_NE(bytes(at_once.velocities()), std::string(500 * sizeof(Float4), 0)) << k;
  }
}

/// Two particles on a plane: the Newton step along the line between them, half of it for the stiffness that two
/// directions share, and no longer than a share of h.
template <class Backend>
void APairStepsApartAsTheFormulaSays(Executor<Backend>& exec) {
  const AnalyticProjector<Plane> projector{{1}};
  for (const float distance : {0.5f, 1.1f, 1.6f}) {
    TreeSolverRun<Backend> run = one_surface(exec, 100);
    const Vec3f a(20, 20, 0), b(20 + distance, 20, 0);
    run.seed(projector, {a, b}, {0, 0});
    const PairForce force = pair_force(a, 1, b, 1);
    for (const float longest : {0.3f, 0.05f}) {
      run.rule.longest = longest;
      run.seed(projector, {a, b}, {0, 0});
      const double energy = run.step(projector, 2);
      EXPECT_NEAR(energy, force.energy, 1e-4 * force.energy + 1e-6);
      const float newton = run.rule.step / (0.5f * force.stiffness) * std::fabs(force.gradient.x);
      const float expected = std::min(newton, longest);
      std::vector<Float4> position = run.positions();
      if (position[0].x > position[1].x) std::swap(position[0], position[1]);
      EXPECT_NEAR(position[0].x, a.x - expected, 1e-4) << distance;
      EXPECT_NEAR(position[1].x, b.x + expected, 1e-4) << distance;
      EXPECT_NEAR(position[0].y, 20, 1e-6);
      for (const Float4& d : run.directions()) EXPECT_NEAR(d.w, force.energy, 1e-4 * force.energy + 1e-6);
    }
    // The second step carries the share `momentum` of the first along.
    run.rule = {};
    run.rule.step = 0.1f;
    run.seed(projector, {a, b}, {0, 0});
    run.step(projector, 2);
    const std::vector<Float4> once = run.positions(), first = run.velocities();
    run.step(projector, 2);
    const float gap = std::fabs(once[0].x - once[1].x);
    const PairForce next = pair_force({0, 0, 0}, 1, {gap, 0, 0}, 1);
    const float expected =
        run.rule.momentum * std::fabs(first[0].x) + 0.1f / (0.5f * next.stiffness) * std::fabs(next.gradient.x);
    EXPECT_NEAR(std::fabs(run.velocities()[0].x), std::min(expected, 0.3f), 1e-4) << distance;
  }
}

/// Particle 1 would push particle 0 over the rim: a quarter of the step, or none.
template <class Backend>
void NobodyStepsOverTheRim(Executor<Backend>& exec) {
  const Vec3f pushed(9.9f, 0, 0), pusher(9.4f, 0, 0);
  for (const float rim : {10.5f, 10.0f, 9.95f}) {  // the step is 0.3 long
    const AnalyticProjector<Plane> projector{{1}, rim};
    TreeSolverRun<Backend> run = one_surface(exec, 100);
    run.seed(projector, {pushed, pusher}, {0, 0});
    run.step(projector, 2);
    const std::vector<Float4> position = run.positions(), velocity = run.velocities();
    const std::size_t k = position[0].x > position[1].x ? 0 : 1;
    const float expected = rim > 10.2f ? 0.3f : rim > 9.98f ? 0.075f : 0;
    EXPECT_NEAR(position[k].x, 9.9f + expected, 1e-5) << rim;
    EXPECT_NEAR(velocity[k].x, expected, 1e-5) << rim;
    EXPECT_NEAR(position[1 - k].x, 9.1f, 1e-5) << "the other one has room";
    EXPECT_GT(run.directions()[k].w, 0) << "the energy is kept up to date";
  }
}

/// A crowd spreads over a disc, momentum and all, and the rim stops it, though not each step looks up the margin.
template <class Backend>
void ACrowdStopsAtTheRim(Executor<Backend>& exec) {
  const AnalyticProjector<Plane> projector{{1}, 6};
  std::vector<Vec3f> crowd;
  for (const Vec3f& p : scattered_on_sphere(4, 400, 9)) crowd.push_back({p.x, p.y, 0});
  TreeSolverRun<Backend> run = one_surface(exec, 400);
  run.seed(projector, crowd, std::vector<std::uint32_t>(crowd.size(), 0));
  for (int k = 0; k < 60; ++k) {
    if (k % 5 == 0) run.solver.rebuild(exec);
    run.solver.iterate(exec, projector, run.view, 2, run.rule, 400);
  }
  float farthest = 0;
  for (const Float4& p : run.positions()) farthest = std::max(farthest, std::sqrt(p.x * p.x + p.y * p.y));
  EXPECT_LE(farthest, 6);
  EXPECT_GT(farthest, 5.7);
}

template <class Backend>
void RandomParticlesSpreadEvenlyOnASphere(Executor<Backend>& exec) {
  const AnalyticProjector<Spheres> projector{{{10}, 1}};
  const int n = int(ideal_count(4 * M_PI * 100));
  TreeSolverRun<Backend> run = one_surface(exec, n);
  run.seed(projector, scattered_on_sphere(10, n, 7), std::vector<std::uint32_t>(std::size_t(n), 0));
  std::vector<double> energy;
  for (int k = 0; k < 120; ++k) energy.push_back(run.step(projector, 2));
  EXPECT_GT(energy.front(), 4 * hexagonal_energy);
  for (std::size_t k = 20; k < energy.size(); ++k) EXPECT_LT(energy[k], 1.005 * energy[k - 1]) << k;
  EXPECT_NEAR(energy.back(), hexagonal_energy, 0.05 * hexagonal_energy);
  EXPECT_EQ(run.count(), std::size_t(n));
  const std::vector<double> nearest = spacings(run.positions());
  EXPECT_GT(*std::min_element(nearest.begin(), nearest.end()), 0.7);
  EXPECT_GT(mean(nearest), 0.93);
  const std::vector<Float4> position = run.positions(), direction = run.directions();
  for (std::size_t k = 0; k < position.size(); ++k) {
    ASSERT_NEAR(length(xyz_of(position[k])), 10, 1e-4) << k;
    ASSERT_LT(length(xyz_of(direction[k]) - normalized(xyz_of(position[k]))), 1e-5) << k;
    ASSERT_EQ(position[k].w, 1);
  }
}

/// A disc and its rim: the particles of the rim move alone first, along it, to equal distances; then those on the disc
/// feel them, and they stay.
template <class Backend>
void LowerOrdersAreFeltAndStay(Executor<Backend>& exec) {
  const AnalyticProjector<Disc> projector{{6, 1}};
  TreeSolverRun<Backend> run(exec, 400, {2, 1}, {{0, 1}, {1}});
  std::vector<Vec3f> points;
  std::vector<std::uint32_t> interface;
  const int on_rim = 44, inside = 118;
  for (int k = 0; k < on_rim; ++k) {  // crowded on one side
    const float t = float(k) / on_rim, a = 2 * pi * (t + 0.12f * std::sin(2 * pi * t));
    points.push_back({6 * std::cos(a), 6 * std::sin(a), 0});
    interface.push_back(1);
  }
  for (int k = 0; k < inside; ++k) {
    const float r = 5.5f * std::sqrt(uniform_random(5, k, 0)), a = 2 * pi * uniform_random(5, k, 1);
    points.push_back({r * std::cos(a), r * std::sin(a), 0});
    interface.push_back(0);
  }
  run.seed(projector, points, interface);
  EXPECT_EQ(run.solver.movers(exec, run.view, 1), on_rim);
  EXPECT_EQ(run.solver.movers(exec, run.view, 2), inside);
  const auto of_interface = [&](std::uint32_t which) {
    std::vector<Vec3f> result;
    const std::vector<Float4> position = run.positions();
    const std::vector<std::uint32_t> on = run.interfaces();
    for (std::size_t k = 0; k < position.size(); ++k)
      if (on[k] == which) result.push_back(xyz_of(position[k]));
    const auto angle = [](const Vec3f& p) { return std::atan2(p.y, p.x); };
    std::sort(result.begin(), result.end(), [&](const Vec3f& p, const Vec3f& q) { return angle(p) < angle(q); });
    return result;
  };
  const std::vector<Vec3f> disc_before = of_interface(0);
  double energy = 0;
  for (int k = 0; k < 300; ++k) energy = run.step(projector, 1);
  EXPECT_EQ(of_interface(0), disc_before) << "order 2 waits for its turn";
  const std::vector<Vec3f> rim = of_interface(1);
  const double step = 2 * 6 * std::sin(M_PI / on_rim);
  for (int k = 0; k < on_rim; ++k)
    EXPECT_NEAR(length(rim[std::size_t(k)] - rim[std::size_t((k + 1) % on_rim)]), step, 0.01);
  const double expected = 2 * cotangent_energy(float(step) / support).energy;  // of its two neighbours
  EXPECT_NEAR(energy, expected, 0.01 * expected);
  for (int k = 0; k < 120; ++k) run.step(projector, 2);
  EXPECT_EQ(of_interface(1), rim) << "order 1 is done";
  const std::vector<double> nearest = spacings(run.positions());
  EXPECT_GT(*std::min_element(nearest.begin(), nearest.end()), 0.65) << "from the rim, too";
}

/// A ball of radius 8 in a scalar volume, embedded: what EmbeddedGround needs.
template <class Backend>
struct BallCase {
  static constexpr double radius = 8;
  Vec3d centre{12.2, 11.8, 12.1};
  Embedding e;

  explicit BallCase(Executor<Backend>& exec)
      : e(embedding_of(exec, scalar_volume({25, 24, 25}, ball({12.2, 11.8, 12.1}, radius)))) {}
  FieldProjector fields() const { return {e.bricks.view(), e.grid.junction.data(), e.size.view()}; }
  EmbeddedProjector projector() const { return {e.grid.view(), fields()}; }
  double ideal() const { return ideal_count(4 * M_PI * radius * radius); }  // h is 1

  /// Random particles on it, put there by the formula.
  void seed(TreeSolverRun<Backend>& run, double share) const {
    std::vector<Float4> position, direction;
    for (const Vec3f& p : scattered_on_sphere(float(radius), int(share * ideal()), 11)) {
      const Vec3f at = p + in_fields(centre), n = normalized(p);
      position.push_back({at.x, at.y, at.z, 1});
      direction.push_back({n.x, n.y, n.z, 0});
    }
    run.put(position, direction, std::vector<std::uint32_t>(position.size(), 0));
  }
  double off(const Float4& p) const { return std::fabs(length(xyz_of(p) - in_fields(centre)) - radius); }
};

template <class Backend>
IterationResult control_once(TreeSolverRun<Backend>& run, const BallCase<Backend>& ball, const PopulationRule& rule,
                             int round) {
  run.solver.rebuild(run.exec);
  run.solver.forces(run.exec, run.view, 2, run.rule.theta, run.solver.movers(run.exec, run.view, 2));
  return run.solver.control(run.exec, ball.projector(), run.view, 2, run.rule.theta, rule, std::int64_t(run.count()),
                            round);
}

template <class Backend>
void BothProjectorsLandOnTheSurface(Executor<Backend>& exec) {
  const BallCase<Backend> ball(exec);
  TreeSolverRun<Backend> run = one_surface(exec, 2000), exact = one_surface(exec, 2000);
  ball.seed(run, 1);
  ball.seed(exact, 1);
  for (int k = 0; k < 10; ++k) run.step(ball.projector(), 2), exact.step(ball.fields(), 2);
  double embedded = 0, fields = 0;
  for (const Float4& p : run.positions()) embedded = std::max(embedded, ball.off(p));
  for (const Float4& p : exact.positions()) fields = std::max(fields, ball.off(p));
  EXPECT_LT(embedded, 0.03);
  EXPECT_LT(fields, 0.02);
  EXPECT_GT(embedded, 0);
}

/// Holes fill, crowds thin out, and the count stays where it ends: within a quarter of a hexagonal lattice's, since
/// energies within the thresholds are left alone, wherever the start was; next to it from a start that was right, or
/// where the number is known.
template <class Backend>
void TheTreesPopulationSettlesFromAnyStart(Executor<Backend>& exec) {
  const BallCase<Backend> ball(exec);
  for (const auto& [share, known] : {std::pair(0.5, false), {1.0, false}, {1.7, false}, {0.5, true}, {1.7, true}}) {
    SCOPED_TRACE(testing::Message() << share << (known ? ", known" : ""));
    TreeSolverRun<Backend> run = one_surface(exec, 4000);
    ball.seed(run, share);
    PopulationRule rule;
    if (known) rule.target = std::int64_t(ball.ideal());
    std::int64_t added = 0, deleted = 0, last = 1;
    for (int k = 1; k <= 100; ++k) {
      run.step(ball.projector(), 2);
      if (k % 10 != 0 || k > 80) continue;
      const IterationResult changed = control_once(run, ball, rule, k);
      added += changed.added, deleted += changed.deleted, last = changed.added + changed.deleted;
    }
    const double allowed = share == 1 ? 0.04 : known ? 0.06 : 0.25;
    EXPECT_NEAR(double(run.count()), ball.ideal(), allowed * ball.ideal());
    EXPECT_LE(last, std::int64_t(0.01 * ball.ideal()));
    EXPECT_EQ(std::int64_t(run.count()), std::int64_t(share * ball.ideal()) + added - deleted);
    EXPECT_TRUE(share == 1 || (share < 1 ? added > 3 * deleted : deleted > 3 * added)) << added << ' ' << deleted;
    const std::vector<double> nearest = spacings(run.positions());
    EXPECT_GT(*std::min_element(nearest.begin(), nearest.end()), 0.6);
  }
}

/// One control of a set that is far too sparse: new particles lie on the surface, at rest, not on top of each other or
/// of old ones, and old ones are where they were.
template <class Backend>
void NewParticlesKeepTheirDistance(Executor<Backend>& exec) {
  const BallCase<Backend> ball(exec);
  TreeSolverRun<Backend> run = one_surface(exec, 4000);
  ball.seed(run, 0.4);
  for (int k = 0; k < 20; ++k) run.step(ball.fields(), 2);
  const auto before = run.positions();
  const IterationResult changed = control_once(run, ball, PopulationRule(), 1);
  EXPECT_GT(changed.added, 20);
  EXPECT_EQ(changed.deleted, 0);
  ASSERT_EQ(run.count(), before.size() + std::size_t(changed.added));
  const auto same = [](const Float4& a, const Float4& b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
  std::vector<Float4> born;
  const std::vector<Float4> after = run.positions(), velocity = run.velocities();
  for (std::size_t k = 0; k < after.size(); ++k) {
    if (std::any_of(before.begin(), before.end(), [&](const Float4& p) { return same(p, after[k]); })) continue;
    born.push_back(after[k]);
    EXPECT_LT(ball.off(after[k]), 0.03);
    EXPECT_EQ(length(xyz_of(velocity[k])), 0);
    for (const Float4& p : before) EXPECT_GT(length(xyz_of(p) - xyz_of(after[k])), 0.35f);
  }
  EXPECT_EQ(std::int64_t(born.size()), changed.added);
  for (std::size_t k = 0; k < born.size(); ++k)
    for (std::size_t l = 0; l < k; ++l) EXPECT_GE(length(xyz_of(born[k]) - xyz_of(born[l])), 0.699f);
}

/// Of those that would go, no two neighbours do in one turn; the rest stays as it is.
template <class Backend>
void DeletedParticlesWereNoNeighbours(Executor<Backend>& exec) {
  const BallCase<Backend> ball(exec);
  TreeSolverRun<Backend> run = one_surface(exec, 4000);
  ball.seed(run, 2.5);
  const auto before = run.positions();
  const IterationResult changed = control_once(run, ball, PopulationRule(), 1);
  EXPECT_GT(changed.deleted, 50);
  const auto after = run.positions();
  std::vector<Float4> gone;
  for (const Float4& p : before)
    if (std::none_of(after.begin(), after.end(),
                     [&](const Float4& q) { return p.x == q.x && p.y == q.y && p.z == q.z; }))
      gone.push_back(p);
  EXPECT_EQ(std::int64_t(gone.size()), changed.deleted);
  for (std::size_t k = 0; k < gone.size(); ++k)
    for (std::size_t l = 0; l < k; ++l) EXPECT_GE(length(xyz_of(gone[k]) - xyz_of(gone[l])), 0.899f);
}

template <class Backend>
void IslandsKeepTheirParticlesAndRulesAreKept(Executor<Backend>& exec) {
  const BallCase<Backend> ball(exec);
  TreeSolverRun<Backend> island = one_surface(exec, 100);
  std::vector<Vec3f> points;  // 24 within a tenth of a voxel
  for (int k = 0; k < 24; ++k)
    points.push_back(in_fields(ball.centre) + Vec3f(8, 0.02f * float(k % 5), 0.02f * float(k / 5)));
  const auto crowd = [&] {
    std::vector<Float4> position, direction;
    for (const Vec3f& p : points) position.push_back({p.x, p.y, p.z, 1}), direction.push_back({1, 0, 0, 0});
    island.put(position, direction, std::vector<std::uint32_t>(position.size(), 0));
  };
  crowd();
  EXPECT_EQ(control_once(island, ball, PopulationRule(), 1).deleted, 0);
  points.push_back(points.front() + Vec3f(0, 0.05f, 0.05f));
  crowd();
  EXPECT_GT(control_once(island, ball, PopulationRule(), 1).deleted, 0) << "25 are no island";

  TreeSolverRun<Backend> sparse = one_surface(exec, 4000);
  ball.seed(sparse, 0.4);
  PopulationRule none;
  none.may_add = false;
  EXPECT_EQ(control_once(sparse, ball, none, 1).added, 0);
  TreeSolverRun<Backend> full = one_surface(exec, std::int64_t(0.4 * ball.ideal()) + 5);
  ball.seed(full, 0.4);
  EXPECT_THROW(control_once(full, ball, PopulationRule(), 1), Error) << "there is no room for them";
}

NACRE_DEVICE_TEST(TreeSolver, AnIterationIsForcesAndAMove)
NACRE_DEVICE_TEST(TreeSolver, APairStepsApartAsTheFormulaSays)
NACRE_DEVICE_TEST(TreeSolver, NobodyStepsOverTheRim)
NACRE_DEVICE_TEST(TreeSolver, ACrowdStopsAtTheRim)
NACRE_DEVICE_TEST(TreeSolver, RandomParticlesSpreadEvenlyOnASphere)
NACRE_DEVICE_TEST(TreeSolver, LowerOrdersAreFeltAndStay)
NACRE_DEVICE_TEST(TreeSolver, BothProjectorsLandOnTheSurface)
NACRE_DEVICE_TEST(TreeSolver, TheTreesPopulationSettlesFromAnyStart)
NACRE_DEVICE_TEST(TreeSolver, NewParticlesKeepTheirDistance)
NACRE_DEVICE_TEST(TreeSolver, DeletedParticlesWereNoNeighbours)
NACRE_DEVICE_TEST(TreeSolver, IslandsKeepTheirParticlesAndRulesAreKept)

}  // namespace nacre::test
