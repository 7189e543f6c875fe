// Nacre: a tree solver with particles of interfaces with formulas, for tests.
#pragma once

#include <string>
#include <vector>

#include "compute/particles/tree_solver.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/particles/analytic_projector.hpp"

namespace nacre::test {

/// A tree solver with particles of some interfaces. `bounds`: interface k + 1 is the rim of interface k.
template <class Backend>
struct TreeSolverRun {
  Executor<Backend>& exec;
  TreeSolver solver;
  Array<std::uint32_t> start, related;
  Array<std::uint8_t> order;
  RelatedView view;
  TreeRule rule;

  TreeSolverRun(Executor<Backend>& e, std::int64_t capacity, const std::vector<std::uint8_t>& orders,
                const std::vector<std::vector<std::uint32_t>>& relations)
      : exec(e), solver(e, capacity, std::int64_t(orders.size()), 64) {
    std::vector<std::uint32_t> first{0}, all;
    for (const auto& of_one : relations) {
      all.insert(all.end(), of_one.begin(), of_one.end());
      first.push_back(std::uint32_t(all.size()));
    }
    start = exec.arena().template permanent_copy<std::uint32_t>(first);
    related = exec.arena().template permanent_copy<std::uint32_t>(all);
    order = exec.arena().template permanent_copy<std::uint8_t>(orders);
    view = {start.data(), related.data(), order.data()};
  }

  void put(const std::vector<Float4>& position, const std::vector<Float4>& direction,
           const std::vector<std::uint32_t>& interface) {
    ParticleSet& set = solver.particles();
    set.count = std::int64_t(position.size());
    set.position.upload(position);
    set.direction.upload(direction);
    set.interface.upload(interface);
    solver.velocity().upload(std::vector<Float4>(position.size(), Float4{0, 0, 0, 0}));
  }

  /// Puts points onto their interfaces and makes them the particles.
  template <class Projector>
  void seed(const Projector& projector, const std::vector<Vec3f>& points, const std::vector<std::uint32_t>& interface) {
    std::vector<Float4> position, direction;
    for (std::size_t k = 0; k < points.size(); ++k) {
      EmbeddedPoint on;
      ASSERT_TRUE(projector.project(interface[k], points[k], 1, on)) << k;
      position.push_back({on.p.x, on.p.y, on.p.z, on.h});
      direction.push_back({on.direction.x, on.direction.y, on.direction.z, 0});
    }
    put(position, direction, interface);
  }

  /// One iteration as the pipeline makes it; returns the mean energy before the step.
  template <class Projector>
  double step(const Projector& projector, int of_order) {
    solver.rebuild(exec);
    return solver.iterate(exec, projector, view, of_order, rule, solver.movers(exec, view, of_order));
  }

  std::size_t count() const { return std::size_t(solver.particles().count); }
  std::vector<Float4> positions() const { return solver.particles().position.download(0, count()); }
  std::vector<Float4> directions() const { return solver.particles().direction.download(0, count()); }
  std::vector<std::uint32_t> interfaces() const { return solver.particles().interface.download(0, count()); }
  std::vector<Float4> velocities() { return solver.velocity().download(0, count()); }
};

template <class Backend>
TreeSolverRun<Backend> one_surface(Executor<Backend>& exec, std::int64_t capacity) {
  return {exec, capacity, {2}, {{0}}};
}

}  // namespace nacre::test
