// Nacre: test bodies for the first particles.
#pragma once

#include <algorithm>
#include <cmath>
#include <tuple>

#include "compute/particles/embedding_seeds.hpp"
#include "compute/particles/marching_cubes_seeds.hpp"
#include "compute/particles/solver_state.hpp"
#include "tests/compute/embedding/embedding_cases.hpp"

namespace nacre::test {

enum class SeedsFrom { embedding, marching_cubes };
inline constexpr SeedsFrom both_sources[] = {SeedsFrom::embedding, SeedsFrom::marching_cubes};

/// What comes of a source of seeds.
struct SeededPlaces {
  double expected = 0;
  std::vector<Float4> position, direction;
  std::vector<std::uint32_t> interface;
};

/// Seeds of one junction order on a volume's interfaces.
template <class Backend>
SeededPlaces seeds_of(Executor<Backend>& exec, const Embedding& e, SeedsFrom from, int order, double scale,
                      std::uint32_t random = 1) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  SeededPlaces result;
  const auto put = [&](const auto& source) {
    result.expected = expected_particles(exec, source);
    ParticleSet set = make_particle_set(exec, std::int64_t(2 * scale * result.expected) + 100);
    Array<Float4> velocity = arena.template permanent<Float4>(std::size_t(set.capacity()));
    const std::int64_t n = seed_particles(exec, source, scale, random, set, velocity);
    EXPECT_EQ(n, set.count);
    result.position = set.position.download(0, std::size_t(n));
    result.direction = set.direction.download(0, std::size_t(n));
    result.interface = set.interface.download(0, std::size_t(n));
  };
  std::vector<std::uint8_t> orders;
  for (const Junction& j : e.grid.junctions) orders.push_back(std::uint8_t(j.order()));
  const Array<std::uint8_t> on_device = arena.template permanent_copy<std::uint8_t>(orders);
  if (from == SeedsFrom::embedding)
    put(EmbeddingSeeds(e.grid, on_device.data(), order));
  else
    put(marching_cubes(exec, e.bricks, e.size, e.grid.junction));
  return result;
}

/// An embedding for seeds alone takes most closest points from the planes at known points: there are as many seeds as
/// in one of fine cells with exact points, and they are on the interface, nearly.
template <class Backend>
void SeedsNeedNoExactEmbedding(Executor<Backend>& exec) {
  const Vec3d c(13.2, 12.7, 13.1);
  struct Case {
    MeshVolume volume;
    int order;
    double share;  ///< by which the number may differ: large cells tell rims less exactly
    double off;    ///< at most, of seeds from the sphere; 0: there is none
  };
  const Case cases[] = {
      {scalar_volume({27, 26, 27}, ball(c, 8.3)), 2, 0.01, 0.15},
      {label_volume({27, 26, 27}, 2, [&](const Vec3d& p) { return length(p - c) < 8.3; }), 2, 0.02, 0.6},
      {sectors(), 1, 0.04, 0},
      {sectors(), 2, 0.04, 0}};
  for (const auto& [volume, order, share, off] : cases) {
    const auto seeds = [&](double cells_per_voxel, bool seeds_only) {
      const std::size_t mark = exec.arena().mark();
      const Embedding e = embedding_of(exec, volume, {}, cells_per_voxel, seeds_only);
      const SeededPlaces found = seeds_of(exec, e, SeedsFrom::embedding, order, 1);
      exec.arena().rewind(mark);
      return found;
    };
    const double wanted = seeds(2, false).expected;
    for (const double cells_per_voxel : {0.6, 1.0, 2.0}) {
      const SeededPlaces found = seeds(cells_per_voxel, true);
      EXPECT_NEAR(found.expected, wanted, share * wanted) << order << ' ' << off << ' ' << cells_per_voxel;
      EXPECT_NEAR(double(found.position.size()), found.expected, 0.01 * found.expected + 2);
      for (const Float4& p : found.position) {
        if (off == 0) break;
        ASSERT_NEAR(length(Vec3f(p.x, p.y, p.z) - in_fields(c)), 8.3, off) << cells_per_voxel;
      }
    }
  }
}

/// On a tube that is thin beside the cells, planes at known points would make too many.
template <class Backend>
void AThinTubeGetsNoMoreSeedsFromPlanes(Executor<Backend>& exec) {
  const MeshVolume tube =
      scalar_volume({40, 20, 20}, [](const Vec3d& p) { return 1.4 - std::hypot(p.y - 9.6, p.z - 10.3); });
  for (const double cells_per_voxel : {1.0, 2.0}) {
    double number[2];
    for (const bool seeds_only : {false, true}) {
      const std::size_t mark = exec.arena().mark();
      const Embedding e = embedding_of(exec, tube, {}, cells_per_voxel, seeds_only);
      number[seeds_only] = seeds_of(exec, e, SeedsFrom::embedding, 2, 1).expected;
      exec.arena().rewind(mark);
    }
    EXPECT_NEAR(number[1], number[0], 0.01 * number[0]) << cells_per_voxel;
  }
}

template <class Backend>
void AsManyAsTheSizingFieldAsksFor(Executor<Backend>& exec) {
  const Vec3d c(13.2, 12.7, 13.1);
  SizingRule rule;
  rule.min_size = rule.max_size = 0.8f;
  const Embedding e = embedding_of(exec, scalar_volume({27, 26, 27}, ball(c, 8.3)), rule);
  const double wanted = 4 * M_PI * 8.3 * 8.3 * hexagonal_density / (0.8 * 0.8);
  for (const SeedsFrom from : both_sources)
    for (const double scale : {1.0, 0.5, 1.5, 20.0}) {  // at last, far more than there are cells
      const SeededPlaces seeds = seeds_of(exec, e, from, 2, scale);
      EXPECT_NEAR(seeds.expected, wanted, 0.03 * wanted) << int(from);
      EXPECT_NEAR(double(seeds.position.size()), scale * seeds.expected, 0.01 * scale * seeds.expected);
      double above = 0;
      for (const Float4& p : seeds.position) {
        const Vec3f r = Vec3f(p.x, p.y, p.z) - in_fields(c);
        ASSERT_NEAR(length(r), 8.3, 0.05);
        ASSERT_NEAR(p.w, 0.8, 1e-3);
        above += r.x + r.y > 0 ? 1 : 0;
      }
      EXPECT_NEAR(above / double(seeds.position.size()), 0.5, 0.03);  // spread evenly
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
  for (const SeedsFrom from : both_sources) {
    const SeededPlaces seeds = seeds_of(exec, e, from, 2, 1);
    for (const Vec3d& i : islands) {
      const Vec3f at = in_fields(i);
      const auto there = std::count_if(seeds.position.begin(), seeds.position.end(),
                                       [&](const Float4& p) { return length(Vec3f(p.x, p.y, p.z) - at) < 1.2f; });
      EXPECT_GE(there, 6) << int(from) << ": " << i.x << ' ' << i.y << ' ' << i.z;
    }
  }
}

template <class Backend>
void CurvesAreSeededByTheirLength(Executor<Backend>& exec) {
  const Embedding e = embedding_of(exec, sectors());
  const auto [expected, position, direction, interface] = seeds_of(exec, e, SeedsFrom::embedding, 1, 1);
  EXPECT_NEAR(double(position.size()), expected, 2);
  const std::uint32_t axis = e.number_of(Junction(1, 2, 3));
  double covered = 0;
  for (std::size_t k = 0; k < position.size(); ++k) {
    EXPECT_EQ(e.grid.junctions[interface[k]].order(), 1);
    if (interface[k] != axis) continue;
    const Vec3f r = Vec3f(position[k].x, position[k].y, position[k].z) - in_fields(sector_centre);
    EXPECT_LT(std::hypot(r.x, r.y), 0.02);
    covered += position[k].w;  // h apart
  }
  EXPECT_NEAR(covered, 2 * sector_radius, 0.06 * 2 * sector_radius);
}

/// Places are the same, but particles do not stand at the same points: another seed is another mesh.
template <class Backend>
void AnotherSeedIsAnotherStart(Executor<Backend>& exec) {
  const Embedding e = embedding_of(exec, sectors());
  const auto positions = [&](std::uint32_t random) {
    return seeds_of(exec, e, SeedsFrom::embedding, 2, 1, random).position;
  };
  const std::vector<Float4> one = positions(1), two = positions(2), again = positions(1);
  ASSERT_EQ(one.size(), two.size());
  std::size_t alike = 0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].x, again[k].x);
    alike += one[k].x == two[k].x;
  }
  EXPECT_LT(alike, one.size() / 10);
}

/// Cells on both sides of a flat interface have the same closest points; particles at one place would never part.
template <class Backend>
void NoTwoAtOnePlaceOfAFlatInterface(Executor<Backend>& exec) {
  const MeshVolume volume = label_volume({20, 20, 20}, 2, [](const Vec3d&) { return 1; });  // its faces alone
  SizingRule rule;
  rule.min_size = rule.max_size = 0.6f;
  const Embedding e = embedding_of(exec, volume, rule);
  const auto along_x = [](const Float4& a, const Float4& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  for (const SeedsFrom from : both_sources) {
    std::vector<Float4> position = seeds_of(exec, e, from, 2, 1).position;
    std::sort(position.begin(), position.end(), along_x);
    ASSERT_GT(position.size(), 4000u) << int(from);
    for (std::size_t i = 0; i < position.size(); ++i)
      for (std::size_t k = i + 1; k < position.size() && position[k].x - position[i].x < 1e-3f; ++k)
        ASSERT_GT(std::hypot(position[k].y - position[i].y, position[k].z - position[i].z), 1e-3f);
  }
}

/// Vertices of marching cubes are on their own interfaces, each of which has some; with the anisotropic voxels of a CT,
/// too.
template <class Backend>
void CubesFindEveryInterface(Executor<Backend>& exec) {
  MeshVolume volume = label_volume({26, 24, 12}, 4, [](const Vec3d& p) {
    const Vec3d r = p - Vec3d(12.5, 11.5, 5.5);
    const double distance = std::hypot(r.x, r.y, 2.5 * r.z);
    return distance > 10 ? 0 : distance < 5 ? 3 : r.x < 0 ? 1 : 2;
  });
  volume.spacing = {1, 1, 2.5};
  SizingRule rule;
  rule.min_size = rule.max_size = 1;
  const Embedding e = embedding_of(exec, volume, rule);
  const SeededPlaces seeds = seeds_of(exec, e, SeedsFrom::marching_cubes, 2, 1);
  const SeededPlaces before = seeds_of(exec, e, SeedsFrom::embedding, 2, 1);
  std::vector<double> count(e.grid.junctions.size()), other = count;
  for (const std::uint32_t i : seeds.interface) ++count[i];
  for (const std::uint32_t i : before.interface) ++other[i];
  for (const Junction j : {Junction(0, 1), Junction(0, 2), Junction(1, 2), Junction(1, 3), Junction(2, 3)}) {
    const std::uint32_t k = e.number_of(j);
    ASSERT_NE(k, none);
    EXPECT_NEAR(count[k], other[k], 0.15 * other[k] + 8) << j.material(0) << ' ' << j.material(1);
  }
  for (const Float4& d : seeds.direction) EXPECT_NEAR(std::hypot(d.x, d.y, d.z), 1, 1e-4);
}

NACRE_DEVICE_TEST(Seed, CubesFindEveryInterface)
NACRE_DEVICE_TEST(Seed, AnotherSeedIsAnotherStart)
NACRE_DEVICE_TEST(Seed, NoTwoAtOnePlaceOfAFlatInterface)
NACRE_DEVICE_TEST(Seed, SeedsNeedNoExactEmbedding)
NACRE_DEVICE_TEST(Seed, AThinTubeGetsNoMoreSeedsFromPlanes)
NACRE_DEVICE_TEST(Seed, AsManyAsTheSizingFieldAsksFor)
NACRE_DEVICE_TEST(Seed, EveryComponentGetsParticles)
NACRE_DEVICE_TEST(Seed, CurvesAreSeededByTheirLength)

}  // namespace nacre::test
