// Nacre: time_particles on either backend; instantiated by floors_cpu.cpp and floors_cuda.cu.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "compute/device/random.hpp"
#include "compute/particles/tree_solver.hpp"
#include "tests/gpu/floors.hpp"

namespace nacre::gpu_tests {

/// Points along a spiral from pole to pole, as close as on a hexagonal lattice of spacing h = 1; their order is random.
inline std::vector<Float4> spiral_on_sphere(std::int64_t n, double radius) {
  std::vector<Float4> position(n);
  for (std::int64_t i = 0; i < n; ++i) {
    const double z = 1 - (2 * double(i) + 1) / double(n), r = std::sqrt(1 - z * z);
    const double turn = 2.399963229728653 * double(i);  // the golden angle
    position[i] = {float(radius * (1.1 + r * std::cos(turn))), float(radius * (1.1 + r * std::sin(turn))),
                   float(radius * (1.1 + z)), 1};
  }
  for (std::int64_t i = n; i-- > 1;)
    std::swap(position[i], position[(std::uint64_t(philox(std::uint32_t(i), 0, 5).a) * std::uint64_t(i + 1)) >> 32]);
  return position;
}

/// Median of `runs` calls of `body` after three that are not counted; `prepare` goes before each.
template <class Backend, class Prepare, class Body>
double median_seconds(Executor<Backend>& exec, int runs, const Prepare& prepare, const Body& body) {
  std::vector<double> seconds;
  for (int k = -3; k < runs; ++k) {
    prepare();
    exec.wait();
    const auto start = std::chrono::steady_clock::now();
    body();
    exec.wait();
    if (k >= 0) seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(seconds.begin(), seconds.end());
  return seconds[seconds.size() / 2];
}

template <class Backend>
ParticleTimes time_particles_on(Device& device, std::int64_t n, int runs) {
  Executor<Backend> exec(device);
  const double radius = std::sqrt(double(n) * std::sqrt(3.0) / 2 / (4 * M_PI));
  TreeSolver solver(exec, n, 1, float(2.2 * radius));
  Arena& arena = exec.arena();
  const auto start = arena.template permanent_copy<std::uint32_t>(std::vector<std::uint32_t>{0, 1});
  const auto related = arena.template permanent_copy<std::uint32_t>(std::vector<std::uint32_t>{0});
  const auto order = arena.template permanent_copy<std::uint8_t>(std::vector<std::uint8_t>{2});
  const RelatedView view{start.data(), related.data(), order.data()};
  const std::vector<Float4> position = spiral_on_sphere(n, radius);
  std::vector<Float4> normal(position.size());
  const auto outwards = [&](float x) { return float(x / radius - 1.1); };
  std::transform(position.begin(), position.end(), normal.begin(), [&](const Float4& p) {
    return Float4{outwards(p.x), outwards(p.y), outwards(p.z), 0};
  });
  // The solver keeps its particles in the tree's order: each build gets them in random order again.
  ParticleTimes times;
  const auto put = [&] {
    ParticleSet& set = solver.particles();
    set.count = n;
    set.position.upload(position);
    set.direction.upload(normal);
    exec.fill(set.interface, 0);
    exec.fill(solver.velocity(), 0);
  };
  times.tree_build = median_seconds(exec, runs, put, [&] { solver.rebuild(exec); });
  times.energy_pass = median_seconds(
      exec, runs, [] {}, [&] { times.mean_energy = solver.forces(exec, view, 2, TreeRule().theta, n); });
  times.nodes = solver.tree().nodes();
  return times;
}

}  // namespace nacre::gpu_tests
