// Nacre: population control on the CPU, and its rule by itself.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/lattice_spacing.hpp"
#include "tests/compute/particles/population_body.hpp"

namespace nacre::test {
namespace {

/// How many of 1000 draws say so.
int share_of(Fate fate, const PopulationRule& rule, float energy, const PopulationDemand& demand = {}, int order = 2) {
  int n = 0;
  for (int k = 0; k < 1000; ++k)
    n += population_fate(rule, demand, order, energy, 6, (float(k) + 0.5f) / 1000) == fate ? 1 : 0;
  return n;
}

TEST(PopulationRule, TheOriginalOneIsARandomShareOfTheDeviation) {  // splits below -0.35, deletes above 0.75
  PopulationRule rule;
  rule.by_density = false;
  EXPECT_EQ(share_of(Fate::split, rule, 0), 650);
  EXPECT_EQ(share_of(Fate::split, rule, 0.3f * rule.ideal_energy), 500);
  EXPECT_EQ(share_of(Fate::split, rule, 0.66f * rule.ideal_energy), 0);
  EXPECT_EQ(share_of(Fate::deleted, rule, 2.5f * rule.ideal_energy), 500);
  EXPECT_EQ(share_of(Fate::deleted, rule, 1.7f * rule.ideal_energy), 0);
  EXPECT_EQ(share_of(Fate::kept, rule, rule.ideal_energy), 1000);
}

TEST(PopulationRule, ByDensityTheNumberIsRightAtOnce) {
  const PopulationRule rule;
  // Energies of hexagonal lattices with 1.6 and 0.7 of the ideal density.
  const auto lattice = [](double density) {
    double low = 0.01, high = 20;
    for (int k = 0; k < 50; ++k)
      (lattice_spacing(0.5 * (low + high)) > 1 / std::sqrt(density) ? low : high) = 0.5 * (low + high);
    return float(low);
  };
  EXPECT_NEAR(share_of(Fate::deleted, rule, lattice(1.6)), 1000 * (1 - 1 / 1.6), 40);
  EXPECT_NEAR(share_of(Fate::split, rule, lattice(0.7)), 1000 * (1 / 0.7 - 1), 60);
  EXPECT_EQ(share_of(Fate::kept, rule, lattice(1.1)), 1000);
  EXPECT_EQ(share_of(Fate::kept, rule, lattice(0.9)), 1000);
  EXPECT_GT(share_of(Fate::split, rule, 0), 900);
  EXPECT_EQ(share_of(Fate::deleted, rule, 4 * rule.ideal_energy), 1000);          // squeezed in
  EXPECT_LT(share_of(Fate::deleted, rule, 4 * rule.ideal_energy, {-0.5f}), 600);  // one of a crowd
}

TEST(PopulationRule, WhatTheWholeSetAsksForIsTakenFromItsSide) {
  const PopulationRule rule;
  const float crowded = 1.3f * rule.ideal_energy, sparse = 0.8f * rule.ideal_energy;
  const int all = share_of(Fate::deleted, rule, crowded, {-1});
  EXPECT_NEAR(all, 107, 3);  // 1.3^0.43 = 1.12
  EXPECT_NEAR(share_of(Fate::deleted, rule, crowded, {-0.5f}), all / 2, 2);
  EXPECT_EQ(share_of(Fate::kept, rule, sparse, {-1}), 1000);
  EXPECT_GT(share_of(Fate::split, rule, sparse, {1}), 80);
  EXPECT_EQ(share_of(Fate::kept, rule, crowded, {1}), 1000);
}

TEST(PopulationRule, LonelyParticlesSpreadAndPointsStay) {
  PopulationRule rule;
  EXPECT_EQ(population_fate(rule, {}, 2, 0, 0, 0.5f), Fate::spread);
  EXPECT_EQ(population_fate(rule, {}, 0, 0, 0, 0.5f), Fate::kept);
  rule.may_add = false;
  EXPECT_EQ(population_fate(rule, {}, 2, 0, 0, 0.5f), Fate::kept);
  EXPECT_EQ(population_fate(rule, {}, 2, 0.1f, 3, 0.01f), Fate::kept);
}

}  // namespace
}  // namespace nacre::test
