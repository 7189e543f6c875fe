// Nacre: test bodies for the particles' octree and the forces that are gathered through it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "compute/particles/tree_solver.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/particles/analytic_surfaces.hpp"

namespace nacre::test {

constexpr float tree_extent = 40;  ///< edge of the volume

/// A sphere of particles with sizes from 0.6 to 1.6, its equator (which bounds it) and a second sphere, in random
/// order.
struct TreeCase {
  std::vector<Float4> position, direction;
  std::vector<std::uint32_t> interface;
};

inline void add_particle(TreeCase& c, const Vec3f& p, const Vec3f& n, std::uint32_t interface) {
  c.position.push_back({p.x + 20, p.y + 20, p.z + 20, 1.1f + 0.05f * p.x});
  c.direction.push_back({n.x, n.y, n.z, 0});
  c.interface.push_back(interface);
}

inline TreeCase graded_case(int count) {
  TreeCase c;
  for (const Vec3f& p : scattered_on_sphere(10, count, 3)) add_particle(c, p, normalized(p), 0);
  for (int k = 0; k < 60; ++k) {
    const float a = 2 * pi * float(k) / 60;
    add_particle(c, {10 * std::cos(a), 10 * std::sin(a), 0}, {-std::sin(a), std::cos(a), 0}, 1);
  }
  for (const Vec3f& p : scattered_on_sphere(10.5f, count / 2, 4)) add_particle(c, p, normalized(p), 2);
  return c;
}

/// A solver that holds a case's particles, and what concerns what: surface 0 ends at curve 1, surface 2 is alone.
template <class Backend>
struct TreeRun {
  Executor<Backend>& exec;
  TreeSolver solver;
  Array<std::uint32_t> start, related;
  Array<std::uint8_t> order;
  RelatedView view;

  TreeRun(Executor<Backend>& e, const TreeCase& c)
      : exec(e), solver(e, std::int64_t(c.position.size()) + 100, 3, tree_extent) {
    Arena& arena = exec.arena();
    start = arena.template permanent_copy<std::uint32_t>(std::vector<std::uint32_t>{0, 2, 3, 4});
    related = arena.template permanent_copy<std::uint32_t>(std::vector<std::uint32_t>{0, 1, 1, 2});
    order = arena.template permanent_copy<std::uint8_t>(std::vector<std::uint8_t>{2, 1, 2});
    view = {start.data(), related.data(), order.data()};
    ParticleSet& set = solver.particles();
    set.count = std::int64_t(c.position.size());
    set.position.upload(c.position);
    set.direction.upload(c.direction);
    set.interface.upload(c.interface);
    solver.velocity().upload(std::vector<Float4>(c.position.size(), Float4{0, 0, 0, 0}));
    solver.rebuild(exec);
  }

  std::size_t count() const { return std::size_t(solver.particles().count); }
  std::vector<Float4> positions() const { return solver.particles().position.download(0, count()); }
  std::vector<Float4> directions() const { return solver.particles().direction.download(0, count()); }
  std::vector<std::uint32_t> interfaces() const { return solver.particles().interface.download(0, count()); }

  /// Gradient, stiffness, and energy of all surface particles.
  void forces(float theta, std::vector<Float4>& gradient, std::vector<float>& energy) {
    Arena::Scope scope(exec.arena());
    Array<Float4> g = exec.arena().template temporary<Float4>(count());
    Array<float> e = exec.arena().template temporary<float>(count());
    g.fill_bytes(0), e.fill_bytes(0);
    exec.for_each_team(solver.tree().leaf_count(),
                       LeafForces{solver.view(theta), view, solver.particles().interface.data(), solver.tree().leaves(),
                                  2, g.data(), e.data()});
    gradient = g.download(), energy = e.download();
  }
};

struct ExactForce {
  double energy = 0, stiffness = 0;
  Vec3d gradient;
};

/// All pairs, in double: the oracle.
inline std::vector<ExactForce> all_pairs(const std::vector<Float4>& position, const std::vector<Float4>& direction,
                                         const std::vector<std::uint32_t>& interface) {
  std::vector<ExactForce> result(position.size());
  for (std::size_t i = 0; i < position.size(); ++i)
    for (std::size_t j = 0; j < position.size(); ++j) {
      const bool own = interface[i] == interface[j], rim = interface[i] == 0 && interface[j] == 1;
      if (i == j || interface[i] == 1 || !(own || rim)) continue;
      const Vec3d r(position[i].x - position[j].x, position[i].y - position[j].y, position[i].z - position[j].z);
      const double unit = 2 / (double(support) * (position[i].w + position[j].w)), d = length(r) * unit;
      if (d >= 1 || d == 0) continue;
      const double x = std::max(d, 0.02) * M_PI / 2, cot = 1 / std::tan(x);
      const double cosine =
          direction[i].x * direction[j].x + direction[i].y * direction[j].y + direction[i].z * direction[j].z;
      const double w = own ? normal_weight(float(cosine), float(d)) : 1;
      result[i].energy += w * (cot + x - M_PI / 2);
      result[i].gradient += normalized(r) * (-w * M_PI / 2 * cot * cot * unit);
      result[i].stiffness += w * M_PI * M_PI / 2 * cot * (1 + cot * cot) * unit * unit;
    }
  return result;
}

template <class Backend>
void WithoutThetaTheWalkMissesNothing(Executor<Backend>& exec) {
  TreeRun<Backend> run(exec, graded_case(1500));
  std::vector<Float4> gradient;
  std::vector<float> energy;
  run.forces(0, gradient, energy);
  const auto exact = all_pairs(run.positions(), run.directions(), run.interfaces());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    ASSERT_NEAR(energy[i], exact[i].energy, 2e-4 * exact[i].energy + 2e-4) << i;
    const Vec3d g(gradient[i].x, gradient[i].y, gradient[i].z);
    ASSERT_LT(length(g - exact[i].gradient), 1e-3 * std::sqrt(exact[i].stiffness * exact[i].energy) + 1e-3) << i;
    ASSERT_NEAR(gradient[i].w, exact[i].stiffness, 2e-3 * exact[i].stiffness + 1e-3) << i;
  }
  const double mean = run.solver.forces(exec, run.view, 2, 0, 1500 + 750);
  double sum = 0;
  for (const ExactForce& f : exact) sum += f.energy;
  EXPECT_NEAR(mean, sum / 2250, 1e-3 * mean);
}

/// Root mean square error of the forces, over that of the forces.
template <class Backend>
double force_error(TreeRun<Backend>& run, const std::vector<ExactForce>& exact, float theta, double& energy_error) {
  std::vector<Float4> gradient;
  std::vector<float> energy;
  run.forces(theta, gradient, energy);
  double off = 0, all = 0, sum = 0, exact_sum = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const Vec3d g(gradient[i].x, gradient[i].y, gradient[i].z), e = g - exact[i].gradient;
    off += dot(e, e), all += dot(exact[i].gradient, exact[i].gradient);
    sum += energy[i], exact_sum += exact[i].energy;
  }
  energy_error = std::fabs(sum - exact_sum) / exact_sum;
  return std::sqrt(off / all);
}

template <class Backend>
void ErrorsGrowWithTheta(Executor<Backend>& exec) {
  // Dense: many particles within a support, so that there are nodes to stand for them.
  TreeRun<Backend> run(exec, graded_case(8000));
  const auto exact = all_pairs(run.positions(), run.directions(), run.interfaces());
  double before = 0;
  const struct {
    float theta;
    double force, energy;
  } bounds[] = {{0, 1e-4, 1e-4}, {0.25f, 2e-4, 1e-4}, {0.5f, 1e-3, 1e-3}, {0.75f, 4e-3, 2e-3}, {1, 0.02, 0.01}};
  for (const auto& b : bounds) {
    double energy = 0;
    const double force = force_error(run, exact, b.theta, energy);
    std::printf("theta %.2f: forces off by %.5f, mean energy by %.5f\n", b.theta, force, energy);
    EXPECT_LE(force, b.force);
    EXPECT_LE(energy, b.energy);
    EXPECT_GE(force, before);
    before = force;
  }
}

struct CopyLeaf {
  const std::uint32_t* from;
  std::uint32_t* to;
  NACRE_HD void operator()(std::int64_t i) const { to[i] = from[i]; }
};

template <class Backend>
std::vector<std::uint32_t> leaves_of(TreeRun<Backend>& run) {
  Arena::Scope scope(run.exec.arena());
  const Tree& tree = run.solver.tree();
  Array<std::uint32_t> to = run.exec.arena().template temporary<std::uint32_t>(std::size_t(tree.leaf_count()));
  run.exec.for_each(tree.leaf_count(), CopyLeaf{tree.leaves(), to.data()});
  return to.download();
}

struct CopyNode {
  const TreeNode* from;
  TreeNode* to;
  NACRE_HD void operator()(std::int64_t i) const { to[i] = from[i]; }
};

template <class Backend>
std::vector<TreeNode> nodes_of(TreeRun<Backend>& run) {
  Arena::Scope scope(run.exec.arena());
  Array<TreeNode> to = run.exec.arena().template temporary<TreeNode>(std::size_t(run.solver.tree().nodes()));
  run.exec.for_each(run.solver.tree().nodes(), CopyNode{run.solver.view(0).node, to.data()});
  return to.download();
}

template <class Backend>
void NodesHoldTheirParticles(Executor<Backend>& exec) {
  const TreeCase c = graded_case(3000);
  TreeRun<Backend> run(exec, c);
  const std::vector<Float4> position = run.positions();
  const std::vector<std::uint32_t> interface = run.interfaces();
  ASSERT_EQ(position.size(), c.position.size());
  EXPECT_TRUE(std::is_sorted(interface.begin(), interface.end()));
  std::multiset<float> before, after;
  for (const Float4& p : c.position) before.insert(p.x);
  for (const Float4& p : position) after.insert(p.x);
  EXPECT_EQ(before, after);  // none is lost, none doubled
  const std::vector<TreeNode> nodes = nodes_of(run);
  std::vector<int> leaves(position.size(), 0);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const TreeNode& n = nodes[k];
    Vec3d sum;
    float largest = 0;
    for (std::uint32_t i = n.first; i < n.last; ++i) {
      const Vec3f p(position[i].x, position[i].y, position[i].z);
      for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(p[axis] >= n.low[axis] && p[axis] <= n.high[axis]) << k;
      ASSERT_EQ(interface[i], interface[n.first]);
      sum += Vec3d(p);
      largest = std::max(largest, position[i].w);
      leaves[i] += n.children == 0 ? 1 : 0;
    }
    if (n.first == n.last) continue;
    EXPECT_LT(length(sum / double(n.last - n.first) - Vec3d(n.centre.x, n.centre.y, n.centre.z)), 1e-3);
    EXPECT_EQ(n.largest, largest);
    if (n.children == 0) {
      EXPECT_LE(n.last - n.first, std::uint32_t(TreeView::leaf_size));
      continue;
    }
    EXPECT_EQ(nodes[n.child].first, n.first);
    EXPECT_EQ(nodes[n.child + n.children - 1].last, n.last);
  }
  for (const int l : leaves) ASSERT_EQ(l, 1);  // each in one leaf
  for (std::uint32_t k = 0; k < 3; ++k)
    EXPECT_EQ(nodes[k].last - nodes[k].first, std::uint32_t(std::count(interface.begin(), interface.end(), k)));
}

template <class Backend>
void CoincidentParticlesDoNoHarm(Executor<Backend>& exec) {
  TreeCase c;
  for (int k = 0; k < 500; ++k) add_particle(c, {1, 2, 3}, {0, 0, 1}, 0);
  for (int k = 0; k < 40; ++k) add_particle(c, {1, 2, 3.5f}, {0, 0, 1}, 2);
  TreeRun<Backend> run(exec, c);
  EXPECT_EQ(run.count(), 540u);
  const double mean = run.solver.forces(exec, run.view, 2, 0.5f, 540);
  EXPECT_TRUE(std::isfinite(mean));
  TreeRun<Backend> none(exec, TreeCase());
  EXPECT_EQ(none.solver.forces(exec, none.view, 2, 0.5f, 0), 0);
}

/// Crowds of 25 at one place: each is a chain of nodes down to the last level, more than there is room for.
template <class Backend>
void TooManyNodesAreAnError(Executor<Backend>& exec) {
  TreeCase c;
  for (const Vec3f& p : scattered_on_sphere(12, 4000, 5))
    for (int k = 0; k < 25; ++k) add_particle(c, p, normalized(p), 0);
  EXPECT_THROW(TreeRun<Backend>(exec, c), Error);
}

NACRE_DEVICE_TEST(Tree, WithoutThetaTheWalkMissesNothing)
NACRE_DEVICE_TEST(Tree, ErrorsGrowWithTheta)
NACRE_DEVICE_TEST(Tree, NodesHoldTheirParticles)
NACRE_DEVICE_TEST(Tree, CoincidentParticlesDoNoHarm)
NACRE_DEVICE_TEST(Tree, TooManyNodesAreAnError)

}  // namespace nacre::test
