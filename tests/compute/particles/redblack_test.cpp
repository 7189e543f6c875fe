// Nacre: the red-black solver on the CPU, on any number of threads, and with fields for surfaces.
#include <cstring>

#include "compute/device/executor_cpu.hpp"
#include "compute/particles/field_surface.hpp"
#include "tests/compute/field/host_field.hpp"
#include "tests/compute/particles/redblack_body.hpp"

namespace nacre::test {
namespace {

TEST(Redblack, OneThreadAndTwoGiveTheSame) {
  std::vector<Float4> positions[2];
  for (const int threads : {1, 2}) {
    const auto device = make_cpu_device(threads);
    Executor<Cpu> exec(*device);
    Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(1.4), plain_table(1));
    run.iterate(12, 4);
    positions[threads - 1] = run.positions();
  }
  ASSERT_EQ(positions[0].size(), positions[1].size());
  EXPECT_EQ(std::memcmp(positions[0].data(), positions[1].data(), positions[0].size() * sizeof(Float4)), 0);
}

TEST(Redblack, AgreesWithTheSerialSolver) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  double energy[2];
  std::int64_t count[2];
  for (const PlainSolver solver : {PlainSolver::serial, PlainSolver::redblack}) {
    Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, solver, sphere_seeds(1.2), plain_table(1));
    run.iterate(30, 10);
    energy[int(solver)] = run.energy.back(), count[int(solver)] = run.set.count;
  }
  EXPECT_NEAR(energy[1], energy[0], 0.02 * energy[0]);
  EXPECT_NEAR(double(count[1]), double(count[0]), 0.02 * double(count[0]));
}

TEST(Redblack, AStepOfHNeedsLargerBinsAndWorks) {  // the thesis's own limit
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  SolverParameters parameters;
  parameters.step = 1;
  Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(1), plain_table(1), 5000,
                               parameters);
  run.iterate(30);
  EXPECT_LT(run.energy.back(), 1.05 * hexagonal_energy);
}

TEST(Redblack, StopsWhenAsked) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  Relaxation<Cpu, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(1), plain_table(1));
  std::atomic<bool> stop = true;
  exec.watch(&stop);
  EXPECT_THROW(run.iterate(1), Interrupted);
  stop = false;
  EXPECT_NO_THROW(run.iterate(1));
}

/// Two balls that share a wall, x = 12: three materials, three surfaces, one curve.
HostField two_balls() {
  const auto ball = [](const Vec3f& p, float x) { return 6 - length(p - Vec3f(x, 12, 12)); };
  const auto wall = [](const Vec3f& p) { return p.x - 12; };
  const auto left = [=](const Vec3f& p) { return std::fmin(ball(p, 9), -wall(p)); };
  const auto right = [=](const Vec3f& p) { return std::fmin(ball(p, 15), wall(p)); };
  return {{3, 3, 3},
          {1, 1, 1},
          CubicKernel::catmull_rom,
          {[=](const Vec3f& p) { return -std::fmax(ball(p, 9), ball(p, 15)); }, left, right}};
}

struct OneEverywhere {
  float operator()(const Vec3f&) const { return 1; }
};
using BallsSurface = FieldSurface<OneEverywhere>;

/// Surface particles of two balls, with the curve where they meet already fixed.
Seeds two_balls_seeds(const BallsSurface& surface) {
  Seeds seeds;
  const float rim = std::sqrt(36.0f - 9.0f);
  const int around = int(2 * pi * rim / 0.87f);
  const auto add = [&](std::uint32_t interface, const Vec3f& p) {
    Vec3f on, direction;
    if (!surface.project(interface, p, 2, on, direction)) return;
    seeds.points.push_back(on);
    seeds.interface.push_back(interface);
  };
  for (int k = 0; k < around; ++k) {
    const float a = 2 * pi * float(k) / float(around);
    add(3, {12, 12 + rim * std::cos(a), 12 + rim * std::sin(a)});
  }
  seeds.fixed = std::int64_t(seeds.points.size());
  for (const Vec3f& p : scattered_on_sphere(6, 500, 3)) {
    if (p.x < 2.7f) add(0, p + Vec3f(9, 12, 12));
    if (p.x > -2.7f) add(1, p + Vec3f(15, 12, 12));
    if (p.y * p.y + p.z * p.z < 25) add(2, {12, 12 + p.y, 12 + p.z});
  }
  return seeds;
}

TEST(Redblack, MovesOnTheInterfacesOfAField) {
  const HostField host = two_balls();
  const std::vector<Junction> table{Junction(0, 1), Junction(0, 2), Junction(1, 2), Junction(0, 1, 2)};
  const BallsSurface surface{host.view(), {}, table.data()};
  const Seeds seeds = two_balls_seeds(surface);
  ASSERT_GT(seeds.fixed, 30);
  ASSERT_GT(seeds.points.size(), 800u);
  double energy[2];
  std::int64_t count[2];
  for (const PlainSolver solver : {PlainSolver::serial, PlainSolver::redblack}) {
    const auto device = make_cpu_device();
    Executor<Cpu> exec(*device);
    Relaxation<Cpu, BallsSurface> run(exec, surface, solver, seeds, table);
    run.iterate(60, 10);
    energy[int(solver)] = run.energy.back(), count[int(solver)] = run.set.count;
    EXPECT_LT(run.energy.back(), run.energy.front());
    const auto positions = run.positions();
    const auto interface = run.set.interface.download(0, positions.size());
    for (std::size_t k = std::size_t(run.set.fixed); k < positions.size(); ++k) {
      const Vec3f p = xyz_of(positions[k]);
      JunctionPoint at;
      ASSERT_TRUE(project_by_indicator(host.view(), table[interface[k]], p, 0.1f, at)) << k;
      if (interface[k] == 2) {
        EXPECT_NEAR(p.x, 12, 0.02f);
        EXPECT_LT(std::hypot(p.y - 12, p.z - 12), 5.3f);
      } else if (std::fabs(p.x - 12) > 2) {  // away from the edge, which the samples round off
        EXPECT_NEAR(length(p - Vec3f(interface[k] == 0 ? 9 : 15, 12, 12)), 6, 0.05f);
      }
    }
    const std::vector<double> spacing = spacings(positions, std::size_t(run.set.fixed));
    EXPECT_GT(*std::min_element(spacing.begin(), spacing.end()),
              0.5);  // a seed between two of the rim is deleted in the end
    const double area = 2 * 2 * M_PI * 6 * 9 + M_PI * 27, inside = ideal_count(area) - 1.5 * double(run.set.fixed);
    EXPECT_NEAR(double(run.set.count - run.set.fixed), inside, 0.1 * inside);
  }
  EXPECT_NEAR(energy[1], energy[0], 0.05 * energy[0]);  // with 2% more or fewer particles
  EXPECT_NEAR(double(count[1]), double(count[0]), 0.03 * double(count[0]));
}

}  // namespace
}  // namespace nacre::test
