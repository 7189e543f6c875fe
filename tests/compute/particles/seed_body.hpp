// Nacre: test bodies for the first particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>

#include "compute/particles/seed.hpp"
#include "compute/particles/solver_state.hpp"
#include "tests/compute/embedding/embedding_cases.hpp"

namespace nacre::test {

/// Seeds of one junction order on a volume's interfaces.
template <class Backend>
std::vector<Float4> seeds_of(Executor<Backend>& exec, const Embedding& e, int order, double scale, double& expected,
                             std::vector<std::uint32_t>* interface = nullptr) {
  Arena& arena = exec.arena();
  std::vector<std::uint8_t> orders;
  for (const Junction& j : e.grid.junctions) orders.push_back(std::uint8_t(j.order()));
  const Array<std::uint8_t> on_device = arena.template permanent_copy<std::uint8_t>(orders);
  expected = expected_particles(exec, e.grid, on_device.data(), order);
  ParticleSet set = make_particle_set(exec, std::int64_t(2 * scale * expected) + 100);
  Array<Float4> velocity = arena.template permanent<Float4>(std::size_t(set.capacity()));
  const std::int64_t n = seed_particles(exec, e.grid, on_device.data(), order, scale, set, velocity);
  EXPECT_EQ(n, set.count);
  if (interface) *interface = set.interface.download(0, std::size_t(n));
  return set.place.download(0, std::size_t(n));
}

template <class Backend>
void AsManyAsTheSizingFieldAsksFor(Executor<Backend>& exec) {
  const Vec3d c(13.2, 12.7, 13.1);
  SizingRule rule;
  rule.min_size = rule.max_size = 0.8f;
  const Embedding e = embedding_of(exec, scalar_volume({27, 26, 27}, ball(c, 8.3)), rule);
  for (const double scale : {1.0, 0.5, 1.5, 20.0}) {  // at last, far more than there are cells
    double expected = 0;
    const std::vector<Float4> seeds = seeds_of(exec, e, 2, scale, expected);
    EXPECT_NEAR(double(seeds.size()), scale * expected, 0.01 * scale * expected);
    double above = 0;
    for (const Float4& p : seeds) {
      const Vec3f r = Vec3f(p.x, p.y, p.z) - in_fields(c);
      ASSERT_NEAR(length(r), 8.3, 0.05);
      ASSERT_NEAR(p.w, 0.8, 1e-3);
      above += r.x + r.y > 0 ? 1 : 0;
    }
    EXPECT_NEAR(above / double(seeds.size()), 0.5, 0.03);  // spread evenly
  }
}

template <class Backend>
void EveryComponentGetsParticles(Executor<Backend>& exec) {
  const Vec3d islands[] = {{29, 4, 4}, {30, 12, 12}, {29, 20, 5}, {33, 3, 20}};
  const MeshVolume volume = label_volume({38, 26, 25}, 3, [&](const Vec3d& p) {
    for (const Vec3d& i : islands)
      if (p == i) return 2;
    return length(p - Vec3d(12, 12, 12)) < 10 ? 1 : 0;
  });
  SizingRule rule;
  rule.min_size = 1, rule.max_size = 2;
  const Embedding e = embedding_of(exec, volume, rule);
  double expected = 0;
  const std::vector<Float4> seeds = seeds_of(exec, e, 2, 1, expected);
  for (const Vec3d& i : islands) {
    const Vec3f at = in_fields(i);
    const auto there = std::count_if(seeds.begin(), seeds.end(),
                                     [&](const Float4& p) { return length(Vec3f(p.x, p.y, p.z) - at) < 1.2f; });
    EXPECT_GE(there, 6) << i.x << ' ' << i.y << ' ' << i.z;
  }
}

template <class Backend>
void CurvesAreSeededByTheirLength(Executor<Backend>& exec) {
  const Embedding e = embedding_of(exec, sectors());
  double expected = 0;
  std::vector<std::uint32_t> interface;
  const std::vector<Float4> seeds = seeds_of(exec, e, 1, 1, expected, &interface);
  EXPECT_NEAR(double(seeds.size()), expected, 2);
  const std::uint32_t axis = e.number_of(Junction(1, 2, 3));
  double covered = 0;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    EXPECT_EQ(e.grid.junctions[interface[k]].order(), 1);
    if (interface[k] != axis) continue;
    const Vec3f r = Vec3f(seeds[k].x, seeds[k].y, seeds[k].z) - in_fields(sector_centre);
    EXPECT_LT(std::hypot(r.x, r.y), 0.02);
    covered += seeds[k].w;  // h apart
  }
  EXPECT_NEAR(covered, 2 * sector_radius, 0.06 * 2 * sector_radius);
}

/// Cells on both sides of a flat interface have the same closest points; particles at one place would never part.
template <class Backend>
void NoTwoAtOnePlaceOfAFlatInterface(Executor<Backend>& exec) {
  const MeshVolume volume = label_volume({20, 20, 20}, 2, [](const Vec3d&) { return 1; });  // its faces alone
  SizingRule rule;
  rule.min_size = rule.max_size = 0.6f;
  const Embedding e = embedding_of(exec, volume, rule);
  double expected = 0;
  std::vector<Float4> seeds = seeds_of(exec, e, 2, 1, expected);
  const auto along_x = [](const Float4& a, const Float4& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::sort(seeds.begin(), seeds.end(), along_x);
  ASSERT_GT(seeds.size(), 6000u);
  for (std::size_t i = 0; i < seeds.size(); ++i)
    for (std::size_t k = i + 1; k < seeds.size() && seeds[k].x - seeds[i].x < 1e-3f; ++k)
      ASSERT_GT(std::hypot(seeds[k].y - seeds[i].y, seeds[k].z - seeds[i].z), 1e-3f);
}

NACRE_DEVICE_TEST(Seed, NoTwoAtOnePlaceOfAFlatInterface)
NACRE_DEVICE_TEST(Seed, AsManyAsTheSizingFieldAsksFor)
NACRE_DEVICE_TEST(Seed, EveryComponentGetsParticles)
NACRE_DEVICE_TEST(Seed, CurvesAreSeededByTheirLength)

}  // namespace nacre::test
