// Nacre: numbers that meet a condition, links along curves, and items with their rims, each against what a plain loop
// finds.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <tuple>
#include <vector>

#include "compute/meshing/list_items.hpp"
#include "tests/compute/meshing/star_clouds.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/small_cases.hpp"

namespace nacre::test::list_items {

struct IsSet {
  const std::uint32_t* mark;
  NACRE_HD bool operator()(std::int64_t i) const { return mark[i] != 0; }
};

template <class Backend>
void what_is_listed_is_marked(Executor<Backend>& exec) {
  std::mt19937 generator(3);
  for (const std::uint32_t count : {1u, 2u, 7u, 300u, small_cases() ? 700u : 70000u})
    for (const std::uint32_t one_in : {0u, 1u, 2u, 50u}) {
      std::vector<std::uint32_t> mark(count), expected;
      for (std::uint32_t i = 0; i < count; ++i)
        if (one_in > 0 && generator() % one_in == 0) mark[i] = 1, expected.push_back(i);
      Arena::Scope scope(exec.arena());
      auto marks = exec.arena().template temporary<std::uint32_t>(count);
      marks.upload(mark);
      EXPECT_EQ(list_where(exec, count, IsSet{marks.data()}).download(), expected) << count << ", one in " << one_in;
    }
}
NACRE_DEVICE_TEST(ListWhere, what_is_listed_is_marked)

/// Particles on a device, for as long as the object lives.
template <class Backend>
class OnDevice {
 public:
  OnDevice(Executor<Backend>& exec, const Cloud& cloud) : exec_(exec), scope_(exec.arena()) {
    const StarParticles p = cloud.view();
    std::vector<std::uint32_t> before(p.count(), 0);
    for (std::size_t i = 1; i < p.count(); ++i) before[i] = before[i - 1] + (p.junction[i - 1].order() < 2);
    view_ = {copy(p.position), copy(p.direction), copy(p.junction), copy(p.gradient),
             copy(std::span<const std::uint32_t>(before))};
  }
  const StarParticlesView& view() const { return view_; }

 private:
  template <class T>
  const T* copy(std::span<const T> host) {
    auto array = exec_.arena().template temporary<T>(host.size());
    array.upload(host);
    return array.data();
  }

  Executor<Backend>& exec_;
  Arena::Scope scope_;
  StarParticlesView view_{};
};

/// The links of nodes, made one after the other, the shortest first.
inline void link_one_by_one(const Cloud& cloud, std::vector<CurveNode>& nodes) {
  const auto point = [&](const CurveNode& n) {
    const Float4 p = cloud.position[n.particle];
    return Vec3d(p.x, p.y, p.z);
  };
  const auto tangent = [&](const CurveNode& n) {
    const Junction j = cloud.junction[n.particle];
    std::vector<Vec3d> to;  // from the first material, of those on the curve
    for (int k = 0; k < j.materials(); ++k) {
      Junction curve;
      curve.packed = n.curve;
      if (curve.has(j.material(k)))
        to.push_back(k == 0 ? Vec3d() : Vec3d(cloud.gradient[n.particle].from_first[k - 1]));
    }
    return normalized(cross(to[1] - to[0], to[2] - to[1]));
  };
  for (const detail::LinkReach& reach : detail::link_reaches) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> links;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (i == k || nodes[i].curve != nodes[k].curve || !nodes[i].lacks_next() || !nodes[k].lacks_previous())
          continue;
        const Vec3d step = point(nodes[k]) - point(nodes[i]);
        const double radius = reach.sizes * cloud.position[nodes[i].particle].w, d = std::sqrt(dot(step, step));
        if (dot(step, step) <= radius * radius &&
            std::min(dot(step, tangent(nodes[i])), dot(step, tangent(nodes[k]))) >= reach.cosine * d)
          links.push_back({d, i, k});
      }
    std::sort(links.begin(), links.end());
    for (const auto& [d, i, k] : links)
      if (nodes[i].lacks_next() && nodes[k].lacks_previous())
        nodes[i].next = std::uint32_t(k), nodes[k].previous = std::uint32_t(i);
  }
  for (std::uint32_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].lacks_previous()) continue;
    std::uint32_t last = i;
    while (nodes[last].next != none) last = nodes[last].next;
    if (nodes[last].lacks_next() &&
        length(point(nodes[last]) - point(nodes[i])) <= detail::widest_gap * cloud.position[nodes[i].particle].w)
      nodes[last].next = i, nodes[i].previous = last;
  }
}

template <class Backend>
void expect_links_of_one_by_one(Executor<Backend>& exec, const Cloud& cloud, const char* what) {
  const OnDevice<Backend> particles(exec, cloud);
  Arena::Scope scope(exec.arena());
  const CurveNodes made = link_curves(exec, particles.view(), std::int64_t(cloud.position.size()));
  const std::vector<CurveNode> nodes = made.node.download();
  std::vector<CurveNode> expected = nodes;
  for (CurveNode& n : expected) n.next = n.previous = none;
  link_one_by_one(cloud, expected);
  std::size_t linked = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0;
    ASSERT_LE(std::tie(nodes[before].curve, nodes[before].particle), std::tie(nodes[i].curve, nodes[i].particle));
    ASSERT_EQ(nodes[i].next, expected[i].next) << what << ", node " << i;
    ASSERT_EQ(nodes[i].previous, expected[i].previous) << what << ", node " << i;
    linked += nodes[i].next != none;
  }
  EXPECT_GT(linked, nodes.size() / 3) << what;
}

/// Gradients of three materials around a curve along `tangent`.
inline JunctionGradients around(const Vec3d& tangent) {
  const Vec3d aside = std::abs(tangent.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d u = normalized(cross(tangent, aside)), v = cross(tangent, u);
  JunctionGradients g;
  g.from_first[0] = Vec3f(u), g.from_first[1] = Vec3f(u * -0.5 + v);
  return g;
}

/// Particles on two curves of three materials in a crowd: many are in reach, tangents are random.
inline Cloud crowd(int count, unsigned seed) {
  Cloud cloud;
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> random(0, 1);
  for (int i = 0; i < count; ++i) {
    const Vec3d p = Vec3d(random(generator), random(generator), random(generator)) * 6.0;
    const Vec3d way = normalized(Vec3d(random(generator), random(generator), random(generator)) - Vec3d(0.5, 0.5, 0.5));
    cloud.add(p, 0.5 + random(generator), {}, Junction(0, 1, 2 + std::uint32_t(i % 2)), around(way));
    if (i % 5 == 0) cloud.add(p + Vec3d(0.3, 0.1, 0), 1, {0, 0, 1});
    if (i % 9 == 0) cloud.add(p, 0.8, {}, Junction(0, 1, 2 + std::uint32_t(i % 2)), around(way));  // twice in one place
    if (i % 7 == 0) {
      JunctionGradients g;
      for (Vec3f& f : g.from_first)
        f = Vec3f(Vec3d(random(generator), random(generator), random(generator)) - Vec3d(0.5));
      cloud.add(p + Vec3d(0, 0.2, 0.2), 1, {}, Junction(0, 1, 2, 3), g);
    }
  }
  return cloud;
}

/// A ring of equal steps, of which some are missing.
inline Cloud ring(int count, int missing) {
  Cloud cloud;
  const double step = 2 * M_PI / count, radius = 1 / (2 * std::sin(step / 2));
  for (int i = 0; i < count - missing; ++i) {
    const double t = step * ((i * 7) % (count - missing));  // in no order
    cloud.add(Vec3d(std::cos(t), std::sin(t), 0) * radius, 1, {}, Junction(0, 1, 2),
              around({-std::sin(t), std::cos(t), 0}));
  }
  return cloud;
}

/// Four by four by four positions of a lattice: links of the same length everywhere.
inline Cloud cubic_lattice() {
  Cloud cloud;
  for (int i = 0; i < 64; ++i) cloud.add(Vec3d(i & 3, i >> 2 & 3, i >> 4), 1, {}, Junction(0, 1, 2), around({1, 0, 0}));
  return cloud;
}

template <class Backend>
void links_are_those_made_one_by_one(Executor<Backend>& exec) {
  for (unsigned seed = 0; seed < (small_cases() ? 2u : 20u); ++seed)
    expect_links_of_one_by_one(exec, crowd(small_cases() ? 60 : 250, seed), "crowd");
  for (const int missing : {0, 1, 2, 4, 6}) expect_links_of_one_by_one(exec, ring(29, missing), "ring");
  expect_links_of_one_by_one(exec, cubic_lattice(), "lattice");
}
NACRE_DEVICE_TEST(CurveLinks, links_are_those_made_one_by_one)

template <class Backend>
void a_ring_that_lacks_a_link_is_closed(Executor<Backend>& exec) {
  for (const int missing : {0, 4, 6}) {
    const Cloud cloud = ring(29, missing);
    const OnDevice<Backend> particles(exec, cloud);
    Arena::Scope scope(exec.arena());
    const auto nodes = link_curves(exec, particles.view(), std::int64_t(cloud.position.size())).node.download();
    const auto broken = std::count_if(nodes.begin(), nodes.end(), [](const CurveNode& n) { return n.is_broken(); });
    EXPECT_EQ(broken, missing == 6 ? 2 : 0) << missing;  // the gap is one step longer
  }
}
NACRE_DEVICE_TEST(CurveLinks, a_ring_that_lacks_a_link_is_closed)

/// What is known of an item without its number.
using Item = std::tuple<std::uint16_t, std::uint16_t, std::uint32_t>;  // two materials, particle

inline Item what_is(const StarItems& items, std::uint32_t i) {
  const auto& pair = items.materials[items.surface[i]];
  return {pair[0], pair[1], items.particle[i]};
}

template <class Backend>
void items_are_particles_once_for_each_surface(Executor<Backend>& exec) {
  for (const Cloud& cloud : {halves(small_cases() ? 3 : 8, 0.8), crowd(small_cases() ? 40 : 250, 4), ring(2, 0)}) {
    const OnDevice<Backend> particles(exec, cloud);
    const auto n = std::int64_t(cloud.position.size());
    Arena::Scope scope(exec.arena());
    const CurveNodes curves = link_curves(exec, particles.view(), n);
    const std::vector<CurveNode> nodes = curves.node.download();
    const std::size_t mark = exec.arena().mark();
    DeviceItems device(exec.arena(), 6 * cloud.position.size());
    device.list(exec, particles.view(), n);
    const StarItems items = device.seen_by_host();
    std::vector<std::uint8_t> idle(cloud.position.size(), 0);
    for (const CurveNode& node : nodes) idle[node.particle] |= node.is_idle();
    std::vector<Item> expected;
    for (std::uint32_t p = 0; p < cloud.position.size(); ++p)
      for (int a = 0; a < cloud.junction[p].materials() && !idle[p]; ++a)
        for (int b = a + 1; b < cloud.junction[p].materials(); ++b)
          expected.push_back(
              {std::uint16_t(cloud.junction[p].material(a)), std::uint16_t(cloud.junction[p].material(b)), p});
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(items.count(), expected.size());
    std::map<Item, std::uint32_t> number;
    for (std::uint32_t i = 0; i < items.count(); ++i) {
      ASSERT_EQ(what_is(items, i), expected[i]);
      const Float4 p = cloud.position[items.particle[i]];
      ASSERT_EQ(items.position[i], Vec3d(p.x, p.y, p.z));
      ASSERT_EQ(items.size[i], double(p.w));
      ASSERT_NEAR(length(items.normal[i]), 1, 1e-12);
      ASSERT_TRUE(items.first[items.surface[i]] <= i && i < items.first[items.surface[i] + 1]);
      number[expected[i]] = i;
    }
    // One link after the other, later ones over earlier ones.
    std::vector<std::uint32_t> next(items.count(), none), previous = next;
    for (const CurveNode& node : nodes) {
      if (node.next == none || node.is_idle()) continue;
      Junction curve;
      curve.packed = node.curve;
      const std::uint32_t p = node.particle, q = nodes[node.next].particle;
      for (const auto& [a, b, along] : {std::tuple(0, 1, false), {0, 2, true}, {1, 2, false}}) {
        const auto of = [&](std::uint32_t particle) {
          return number.at({std::uint16_t(curve.material(a)), std::uint16_t(curve.material(b)), particle});
        };
        const std::uint32_t from = of(along ? p : q), to = of(along ? q : p);
        next[from] = to, previous[to] = from;
      }
    }
    EXPECT_TRUE(std::ranges::equal(items.next, next));
    EXPECT_TRUE(std::ranges::equal(items.previous, previous));
    for (const std::uint32_t p : items.broken)
      EXPECT_TRUE(std::ranges::any_of(nodes, [&](const CurveNode& c) { return c.particle == p && c.is_broken(); }));
    exec.arena().rewind(mark);
  }
}
NACRE_DEVICE_TEST(ListItems, items_are_particles_once_for_each_surface)

}  // namespace nacre::test::list_items
