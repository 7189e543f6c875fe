// Nacre: bins and neighbourhoods of particles: complete, disjoint, and independent where they must be.
#include "compute/particles/bins.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "compute/device/executor_cpu.hpp"
#include "compute/particles/neighbourhoods.hpp"
#include "tests/compute/particles/analytic_surfaces.hpp"

namespace nacre::test {
namespace {

TEST(BinGrid, NumbersAreOneToOne) {
  const BinGrid grid = make_bin_grid({0, 0, 0}, {10, 20, 5}, 1.5f, 1 << 20);
  EXPECT_FLOAT_EQ(grid.edge, 1.5f);
  std::set<std::uint32_t> seen;
  for (int z = 0; z < 3 * grid.blocks.z; ++z)
    for (int y = 0; y < 3 * grid.blocks.y; ++y)
      for (int x = 0; x < 3 * grid.blocks.x; ++x) {
        const std::uint32_t n = grid.number({x, y, z});
        EXPECT_LT(n, grid.bins());
        EXPECT_EQ(grid.bin_of(n), Int3(x, y, z));
        EXPECT_EQ(BinGrid::colour(n), x % 3 + 3 * (y % 3) + 9 * (z % 3));
        seen.insert(n);
      }
  EXPECT_EQ(std::int64_t(seen.size()), grid.bins());
}

TEST(BinGrid, PlacesBeyondItBelongToItsRim) {
  const BinGrid grid = make_bin_grid({0, 0, 0}, {10, 10, 10}, 1, 1 << 20);
  EXPECT_EQ(grid.bin({-5, 4.5f, 1e30f}), Int3(0, 4, 3 * grid.blocks.z - 1));
  EXPECT_EQ(grid.bin({std::nanf(""), 0, 0}), Int3(0, 0, 0));
}

TEST(BinGrid, TheEdgeGrowsUntilTheBinsFit) {
  const BinGrid grid = make_bin_grid({0, 0, 0}, {1e4f, 1e4f, 1e4f}, 0.01f, 1 << 20);
  EXPECT_LE(grid.bins(), 1 << 20);
  EXPECT_GT(grid.edge, 50);
  EXPECT_LE(make_bin_grid({0, 0, 0}, {1, 1, 1}, 0, 1000).bins(), 1000);  // particles without a size
}

TEST(BinGrid, TheEdgeHoldsAllNeighboursOfATrialPosition) {  // (1 + sqrt 3) h for steps of up to h/2
  EXPECT_NEAR(bin_edge(1, 0.5f), 1 + std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(bin_edge(2, 1), 2 * (2 + std::sqrt(3.0)), 1e-5);
  // Particles of bins three apart move towards each other by a step each, and still do not feel each other; a particle
  // that left its bin by a step is still in the 27 bins around any trial position that feels it.
  for (const float step : {0.5f, 1.0f}) {
    const float edge = bin_edge(1, step);
    EXPECT_GE(2 * edge - 2 * step, support);
    EXPECT_GE(edge - 2 * step, support - 1e-5f);
  }
}

/// Many particles, half of them fixed, in a box.
template <class Backend>
ParticleSet boxful(Executor<Backend>& exec, std::int64_t count, float extent, float h) {
  std::vector<Float4> position;
  for (std::int64_t k = 0; k < count; ++k) {
    const auto at = [&](std::uint32_t axis) { return extent * uniform_random(9, std::uint32_t(k), axis); };
    position.push_back({at(0), at(1), 0.3f * at(2), h * (0.5f + 0.5f * uniform_random(9, std::uint32_t(k), 3))});
  }
  ParticleSet set = make_particle_set(exec, count);
  set.position.upload(position);
  set.direction.fill_bytes(0);
  set.interface.fill_bytes(0);
  set.count = count, set.fixed = count / 2;
  return set;
}

TEST(Bins, HoldEveryParticleOnceAndInOrder) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  const ParticleSet set = boxful(exec, 5000, 30, 1);
  Arena::Scope scope(exec.arena());
  const Bins bins = build_bins(exec, set, 0.5f);
  const auto order = bins.order.download(), first = bins.first.download(), last = bins.last.download();
  const auto position = set.position.download();
  std::set<std::uint32_t> seen;
  std::vector<std::uint32_t> with_movers;
  for (std::uint32_t b = 0; b < bins.grid.bins(); ++b) {
    bool moving = false;
    for (std::uint32_t k = first[b]; k < last[b]; ++k) {
      const Float4 p = position[order[k]];
      EXPECT_EQ(bins.grid.number(bins.grid.bin({p.x, p.y, p.z})), b);
      if (k > first[b]) {
        EXPECT_LT(order[k - 1], order[k]);
      }
      moving = moving || order[k] >= set.fixed;
      seen.insert(order[k]);
    }
    if (moving) with_movers.push_back(b);
  }
  EXPECT_EQ(seen.size(), 5000u);
  const auto all = bins.occupied.download(0, std::size_t(bins.colour[27]));
  for (int c = 0; c < 27; ++c)
    for (std::int64_t k = bins.colour[c]; k < bins.colour[c + 1]; ++k) EXPECT_EQ(BinGrid::colour(all[k]), c);
  std::vector<std::uint32_t> sorted = all;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted, with_movers);
}

/// Notes, for every particle, which bin's neighbourhood each of its copies came from, and counts them per colour.
struct CountCopies {
  std::uint32_t* copies;  ///< per particle
  std::uint64_t* own;
  std::size_t scratch_bytes() const { return 0; }
  NACRE_HD void operator()(Team& team, const Neighbourhood& around) const {
    team.each(around.count, [&](int k) { relaxed_store(copies + around.rows.particle[k], around.rows.tag[k] >> 31); });
    team.each(around.own, [&](int k) { atomic_add(own + around.rows.particle[k], 1); });
  }
};

TEST(Neighbourhoods, EveryMovingParticleHasItsTurnOnce) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  const ParticleSet set = boxful(exec, 4000, 25, 1);
  Arena::Scope scope(exec.arena());
  Array<std::uint32_t> copies = exec.arena().temporary<std::uint32_t>(4000);
  Array<std::uint64_t> own = exec.arena().temporary<std::uint64_t>(4000);
  copies.fill_bytes(0xff);
  own.fill_bytes(0);
  Neighbourhoods<Cpu> neighbourhoods(exec, set, 0.5f);
  neighbourhoods.for_each(CountCopies{copies.data(), own.data()});
  const auto tag = copies.download();
  const auto turns = own.download();
  for (std::int64_t k = 0; k < 4000; ++k) {
    if (k >= set.fixed) {
      EXPECT_EQ(turns[k], 1u);
    }
    if (tag[k] != 0xffffffffu) {
      EXPECT_EQ(tag[k], k < set.fixed ? 1u : 0u);
    }
  }
}

/// Energy and neighbours of every moving particle from its neighbourhood.
struct SumNear {
  const Junction* table;
  Float4* result;
  std::size_t scratch_bytes() const { return NearInNeighbourhood::bytes; }
  NACRE_HD void operator()(Team& team, const Neighbourhood& around) const {
    const NeighbourhoodMemory& r = around.rows;
    for (int k = 0; k < around.own; ++k) {
      const Mover at{{r.x[k], r.y[k], r.z[k]}, r.h[k], {r.nx[k], r.ny[k], r.nz[k]}};
      const NearInNeighbourhood near(team, team.scratch(), around, {table, 0}, k, at, 0.5f);
      const PairSums s = near.sums(team, at);
      const float again = near.energy(team, at);
      team.wait();
      if (team.first()) result[r.particle[k]] = {s.energy, s.neighbours, again, s.stiffness};
    }
  }
};

/// Against all pairs; `extent` decides how crowded it is, and so whether one list of near particles suffices.
void expect_all_pairs(float extent) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  const std::int64_t count = 1500;
  ParticleSet set = boxful(exec, count, extent, 1);
  set.fixed = 0;
  const std::vector<Float4> up(count, Float4{0, 0, 1, 0});
  set.direction.upload(up);
  const Array<Junction> table = exec.arena().permanent_copy<Junction>(plain_table(1));
  Array<Float4> result = exec.arena().permanent<Float4>(count);
  Neighbourhoods<Cpu> neighbourhoods(exec, set, 0.5f);
  neighbourhoods.for_each(SumNear{table.data(), result.data()});
  const auto position = set.position.download();
  const auto sums = result.download();
  for (std::int64_t i = 0; i < count; ++i) {
    double energy = 0;
    int neighbours = 0;
    for (std::int64_t j = 0; j < count; ++j) {
      if (j == i) continue;
      const Float4 a = position[i], b = position[j];
      const float d = length(Vec3f(a.x - b.x, a.y - b.y, a.z - b.z)) / (support * std::min(a.w, b.w));
      energy += cotangent_energy(d).energy;
      if (d < 1) ++neighbours;
    }
    ASSERT_NEAR(sums[i].x, energy, 1e-4 * (1 + energy));
    ASSERT_NEAR(sums[i].z, energy, 1e-4 * (1 + energy));
    ASSERT_NEAR(sums[i].y, neighbours, 1);  // a pair whose distance is the support, to the last bit
  }
}

TEST(Neighbourhoods, HoldEveryPair) { expect_all_pairs(15); }
TEST(Neighbourhoods, HoldEveryPairOfACrowd) { expect_all_pairs(3); }  // more than one list holds

}  // namespace
}  // namespace nacre::test
