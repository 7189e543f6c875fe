// Nacre: test bodies for the red-black solver on surfaces with a formula.
#pragma once

#include "tests/compute/on_devices.hpp"
#include "tests/compute/particles/solver_cases.hpp"

namespace nacre::test {

template <class Backend>
void EnergyFallsOnASphere(Executor<Backend>& exec) {
  Relaxation<Backend, Spheres> run(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(1), plain_table(1));
  run.iterate(30);
  for (std::size_t k = 1; k < run.energy.size(); ++k) EXPECT_LT(run.energy[k], run.energy[k - 1]) << k;
  EXPECT_GT(run.energy.front(), 1.5);
  EXPECT_LT(run.energy.back(), 1.05 * hexagonal_energy);
  const auto positions = run.positions(), directions = run.directions();
  for (std::size_t k = 0; k < positions.size(); ++k) {
    EXPECT_NEAR(length(xyz_of(positions[k])), 10, 1e-4);
    EXPECT_LT(length(xyz_of(directions[k]) * 10 - xyz_of(positions[k])), 1e-4f);
    EXPECT_EQ(positions[k].w, 1);
  }
  const std::vector<double> spacing = spacings(positions);
  EXPECT_GT(*std::min_element(spacing.begin(), spacing.end()), 0.6);
  EXPECT_NEAR(mean(spacing), 0.95, 0.04);
}

/// One interface, two sheets: a shell between two spheres; normals point out of the shell.
struct Shell {
  float inner, outer;
  NACRE_HD bool project(std::uint32_t, const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) const {
    const Vec3f n = normalized(p);
    const bool out = length(p) > 0.5f * (inner + outer);
    on = n * (out ? outer : inner);
    direction = out ? n : -n;
    return dot(on - p, on - p) <= reach * reach;
  }
  NACRE_HD float size(const Vec3f&) const { return 1; }
};

template <class Backend>
void SheetsOneVoxelApartIgnoreEachOther(Executor<Backend>& exec) {
  Seeds both = sphere_seeds(1, 10, 1);
  const Seeds inner = sphere_seeds(1, 9, 2);
  both.points.insert(both.points.end(), inner.points.begin(), inner.points.end());
  both.interface.resize(both.points.size(), 0);
  Relaxation<Backend, Shell> shell(exec, {9, 10}, PlainSolver::redblack, both, plain_table(1));
  shell.iterate(25);
  Relaxation<Backend, Spheres> alone(exec, {{10}, 1}, PlainSolver::redblack, sphere_seeds(1, 10, 1), plain_table(1));
  alone.iterate(25);
  EXPECT_NEAR(shell.energy.back(), alone.energy.back(), 0.02);
  std::int64_t outside = 0;
  for (const Float4& p : shell.positions()) outside += length(xyz_of(p)) > 9.5f ? 1 : 0;
  EXPECT_EQ(outside, alone.set.count);  // no one has changed sheets
}

/// A disc with a rim of fixed particles one h apart, as a surface patch between junction curves.
inline Seeds disc_seeds(float radius, int count) {
  Seeds seeds;
  const int rim = int(2 * M_PI * radius);
  for (int k = 0; k < rim; ++k) {
    const float a = 2 * pi * float(k) / float(rim);
    seeds.points.push_back({radius * std::cos(a), radius * std::sin(a), 0});
    seeds.interface.push_back(1);
  }
  seeds.fixed = rim;
  for (int k = 0; k < count; ++k) {
    const float r = (radius - 0.3f) * std::sqrt(uniform_random(3, k, 0)), a = 2 * pi * uniform_random(3, k, 1);
    seeds.points.push_back({r * std::cos(a), r * std::sin(a), 0});
    seeds.interface.push_back(0);
  }
  return seeds;
}

inline std::vector<Junction> disc_table() { return {Junction(0, 1), Junction(0, 1, 2)}; }

template <class Backend>
void AFixedRimStaysAndIsFelt(Executor<Backend>& exec) {
  const float radius = 8;
  const Seeds seeds = disc_seeds(radius, int(0.9 * ideal_count(M_PI * radius * radius)) - int(M_PI * radius));
  Relaxation<Backend, Disc> run(exec, {radius, 1}, PlainSolver::redblack, seeds, disc_table());
  const std::vector<Float4> before = run.positions();
  run.iterate(40, 10);
  const std::vector<Float4> after = run.positions();
  for (std::int64_t k = 0; k < run.set.fixed; ++k) EXPECT_EQ(xyz_of(after[k]), xyz_of(before[k]));
  // Ideally the rim's particles count half; what is left belongs to the inside.
  const double inside = ideal_count(M_PI * radius * radius) - 0.5 * double(run.set.fixed);
  EXPECT_NEAR(double(run.set.count - run.set.fixed), inside, 0.06 * inside);
  for (std::size_t k = std::size_t(run.set.fixed); k < after.size(); ++k) {
    const float to_rim = radius - length(xyz_of(after[k]));
    EXPECT_GT(to_rim, 0.45f);  // a row of a lattice is 0.87 away
  }
  const std::vector<double> spacing = spacings(after, std::size_t(run.set.fixed));
  EXPECT_GT(*std::min_element(spacing.begin(), spacing.end()), 0.6);
}

template <class Backend>
void ParticlesOfOtherInterfacesAreNotFelt(Executor<Backend>& exec) {
  Seeds seeds;  // two on interface 0 far apart, between them a fixed one of interface 1, which is no rim of 0
  seeds.points = {{0.4f, 0, 0}, {0, 0, 0}};
  seeds.interface = {1, 0};
  seeds.fixed = 1;
  Relaxation<Backend, Disc> run(exec, {8, 1}, PlainSolver::redblack, seeds, {Junction(0, 1), Junction(0, 2)});
  run.iterate(3);
  EXPECT_EQ(xyz_of(run.positions()[1]), Vec3f());
  EXPECT_EQ(run.energy.back(), 0);
  Relaxation<Backend, Disc> rim(exec, {8, 1}, PlainSolver::redblack, seeds, {Junction(0, 1), Junction(0, 1, 2)});
  rim.iterate(20);
  EXPECT_GT(length(xyz_of(rim.positions()[1]) - xyz_of(rim.positions()[0])),
            1.5f);  // out of its support of 1.73, nearly
}

template <class Backend>
void GradedSizesGiveGradedSpacings(Executor<Backend>& exec) {
  const Torus torus{8, 3, 0.5f, 0.05f};  // h from 0.5 to 1.6
  double wanted = 0;
  Seeds seeds;
  const int cells = 400;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells / 2; ++j) {
      const float u = 2 * pi * float(i) / cells, v = 4 * pi * float(j) / cells,
                  w = torus.major + torus.minor * std::cos(v);
      const Vec3f p(w * std::cos(u), w * std::sin(u), torus.minor * std::sin(v));
      const double area = double(w) * torus.minor * (2 * M_PI / cells) * (4 * M_PI / cells);
      const double share = ideal_count(area, torus.size(p));
      wanted += share;
      if (uniform_random(4, i, j) < share) seeds.points.push_back(p);
    }
  seeds.interface.assign(seeds.points.size(), 0);
  Relaxation<Backend, Torus> run(exec, torus, PlainSolver::redblack, seeds, plain_table(1));
  run.iterate(40, 10);
  EXPECT_NEAR(double(run.set.count), wanted, 0.06 * wanted);
  EXPECT_LT(run.energy.back(), 1.15 * hexagonal_energy);
  EXPECT_LT(run.energy.back(), run.energy.front());
  const std::vector<Float4> positions = run.positions();
  const std::vector<double> spacing = spacings(positions);
  std::vector<double> fine, coarse;
  for (std::size_t k = 0; k < positions.size(); ++k)
    if (positions[k].w < 0.75f)
      fine.push_back(spacing[k]);
    else if (positions[k].w > 1.2f)
      coarse.push_back(spacing[k]);
  EXPECT_NEAR(mean(fine), 0.92, 0.06);  // in units of their own h, which differs by a factor of two
  EXPECT_NEAR(mean(coarse), 0.92, 0.06);
}

/// The rim alone.
struct Rim : Disc {
  NACRE_HD bool project(std::uint32_t, const Vec3f& p, float reach, Vec3f& on, Vec3f& direction) const {
    return Disc::project(1, p, reach, on, direction);
  }
};

template <class Backend>
void CurvesAreFilledBetweenFixedPoints(Executor<Backend>& exec) {
  Seeds seeds;  // the rim of a disc as a curve, two points of it fixed
  const float radius = 6;
  for (const float a : {0.0f, 3.0f, 0.2f, 0.5f, 1.0f, 2.2f, 3.3f, 4.1f, 4.2f, 5.9f}) {
    seeds.points.push_back({radius * std::cos(a), radius * std::sin(a), 0});
    seeds.interface.push_back(seeds.points.size() <= 2 ? 2 : 1);
  }
  seeds.fixed = 2;
  SolverParameters parameters;
  parameters.population.ideal_energy = row_energy;
  Relaxation<Backend, Rim> run(exec, {{radius, 1}}, PlainSolver::redblack, seeds,
                               {Junction(0, 1), Junction(0, 1, 2), Junction(0, 1, 2, 3)}, 1000, parameters);
  run.iterate(60, 5);
  const double wanted = 2 * M_PI * radius;
  EXPECT_NEAR(double(run.set.count), wanted, 0.08 * wanted);
  const std::vector<double> spacing = spacings(run.positions());
  EXPECT_GT(*std::min_element(spacing.begin(), spacing.end()), 0.7);
  for (const Float4& p : run.positions()) EXPECT_NEAR(length(xyz_of(p)), radius, 1e-4);
}

template <class Backend>
void NothingToMoveIsFine(Executor<Backend>& exec) {
  Relaxation<Backend, Spheres> none(exec, {{10}, 1}, PlainSolver::redblack, {}, plain_table(1), 100);
  none.iterate(2, 1);
  EXPECT_EQ(none.set.count, 0);
  Seeds seeds{{{10, 0, 0}, {0, 10, 0}}, {0, 0}, 2};
  Relaxation<Backend, Spheres> fixed(exec, {{10}, 1}, PlainSolver::redblack, seeds, plain_table(1), 100);
  fixed.iterate(2, 1);
  EXPECT_EQ(fixed.set.count, 2);
  seeds.points[1] = seeds.points[0];
  seeds.fixed = 0;
  Relaxation<Backend, Spheres> same(exec, {{10}, 1}, PlainSolver::redblack, seeds, plain_table(1), 100);
  same.iterate(3);
  for (const Float4& p : same.positions()) EXPECT_TRUE(is_finite(xyz_of(p)));
}

NACRE_DEVICE_TEST(Redblack, EnergyFallsOnASphere)
NACRE_DEVICE_TEST(Redblack, SheetsOneVoxelApartIgnoreEachOther)
NACRE_DEVICE_TEST(Redblack, AFixedRimStaysAndIsFelt)
NACRE_DEVICE_TEST(Redblack, ParticlesOfOtherInterfacesAreNotFelt)
NACRE_DEVICE_TEST(Redblack, GradedSizesGiveGradedSpacings)
NACRE_DEVICE_TEST(Redblack, CurvesAreFilledBetweenFixedPoints)
NACRE_DEVICE_TEST(Redblack, NothingToMoveIsFine)

}  // namespace nacre::test
