// Nacre: the energy of pairs against its formula, and forces against finite differences of energies.
#include "compute/particles/energy.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "compute/device/random.hpp"
#include "compute/field/inside_outside.hpp"
#include "compute/particles/near_list.hpp"
#include "tests/compute/particles/lattice_spacing.hpp"

namespace nacre {
namespace {

double cot(double x) { return 1 / std::tan(x); }
double energy(double d) { return cot(d * M_PI / 2) + d * M_PI / 2 - M_PI / 2; }

TEST(CotangentEnergy, IsTheFormula) {
  for (int k = 25; k < 1000; ++k) {
    const double d = k / 1000.0, c = cot(d * M_PI / 2), s = std::sin(d * M_PI / 2);
    const PairEnergy e = cotangent_energy(float(d));
    EXPECT_NEAR(e.energy, energy(d), 2e-5 + 1e-6 * energy(d)) << d;
    EXPECT_NEAR(e.slope, M_PI / 2 * (1 - 1 / (s * s)), 2e-4 * (M_PI / 2) * c * c + 3e-5 * c + 1e-6) << d;  // Eq. 3.4
    EXPECT_NEAR(e.curve, M_PI * M_PI / 2 * c / (s * s), 2e-4 * c / (s * s) * 5 + 1e-4) << d;
  }
}

TEST(CotangentEnergy, EndsAtOne) {
  for (const float d : {1.0f, 1.0001f, 2.0f, 1e9f}) {
    const PairEnergy e = cotangent_energy(d);
    EXPECT_EQ(e.energy, 0);
    EXPECT_EQ(e.slope, 0);
    EXPECT_EQ(e.curve, 0);
  }
  EXPECT_LT(cotangent_energy(0.999f).energy, 1e-4f);
  EXPECT_GT(cotangent_energy(0).energy, 25);
  EXPECT_TRUE(std::isfinite(cotangent_energy(0).energy));
}

TEST(CotangentEnergy, TheIdealIsAHexagonalLatticeWithSpacingH) {
  EXPECT_NEAR(6 * energy(1 / std::sqrt(3.0)), hexagonal_energy, 1e-4);
  EXPECT_NEAR(2 * energy(1 / std::sqrt(3.0)), row_energy, 1e-4);
  EXPECT_NEAR(test::lattice_spacing(hexagonal_energy), 1, 1e-3);
  EXPECT_NEAR(test::lattice_spacing(row_energy, true), 1, 1e-3);
  // The thesis's figure is six distances, and as an energy asks for 2.3 times the particles.
  EXPECT_NEAR(6 / std::sqrt(3.0), 3.462, 3e-3);
  EXPECT_NEAR(test::lattice_spacing(3.462), 0.657, 1e-3);
}

TEST(NormalWeight, FallsFromOneToZero) {
  for (const float d : {0.35f, 0.6f, 1.0f}) {
    EXPECT_EQ(normal_weight(1, d), 1);
    EXPECT_EQ(normal_weight(1.0001f, d), 1);
    EXPECT_EQ(normal_weight(0, d), 1);
    EXPECT_EQ(normal_weight(-0.25f, d), 0.5f);
    EXPECT_EQ(normal_weight(-0.5f, d), 0);
    EXPECT_EQ(normal_weight(-1, d), 0);
  }
}

TEST(NormalWeight, IsOneForThoseThatAreVeryClose) {
  for (const float cosine : {-1.0f, 0.0f, 0.3f, 1.0f}) EXPECT_EQ(normal_weight(cosine, 0.17f), 1);
  for (float d = 0; d < 1; d += 0.01f) EXPECT_GE(normal_weight(-0.5f, d), normal_weight(-0.5f, d + 0.01f));
}

TEST(PairForce, IsTheSlopeOfTheEnergy) {  // with the chain factor that Eq. 3.3 leaves out
  const Vec3f p(0.3f, 0.1f, -0.2f);
  for (const float h_p : {0.5f, 1.0f, 2.0f})
    for (const float h_q : {0.7f, 1.0f})
      for (const Vec3f& q : {Vec3f(0, 0, 0), Vec3f(0.5f, 0.6f, 0.1f), Vec3f(-0.3f, 0.2f, 0)}) {
        const PairForce f = pair_force(p, h_p, q, h_q);
        const double unit = 1 / (2 * std::cos(M_PI / 6) * (h_p + h_q) / 2);
        const auto at = [&](const Vec3d& x) {
          const double d = length(x - Vec3d(q)) * unit;
          return d < 1 ? energy(d) : 0;
        };
        EXPECT_NEAR(f.energy, at(Vec3d(p)), 3e-5);
        for (int axis = 0; axis < 3; ++axis) {
          Vec3d low(p), high(p);
          low[axis] -= 1e-5, high[axis] += 1e-5;
          const double slope = (at(high) - at(low)) / 2e-5;
          EXPECT_NEAR(f.gradient[axis], slope, 3e-4 * (1 + std::fabs(slope)));
        }
      }
}

/// Particles around the origin within `spread`, their sizes near 1 and normals near z, in a list of its own.
struct Crowd {
  std::vector<float> memory;
  NearList list;

  Crowd(int count, float spread) : memory(std::size_t(NearList::arrays) * 256) {
    list.memory = memory.data();
    list.capacity = 256, list.count = count;
    const auto r = [](int k, int step) { return 2 * uniform_random(11, k, step) - 1; };
    for (int k = 0; k < count; ++k) {
      const Vec3f n = normalized(Vec3f(0.5f * r(k, 3), 0.5f * r(k, 4), 1 + r(k, 5)));
      const float h = 1 + 0.3f * r(k, 6);
      list.put(k, spread * r(k, 0), spread * r(k, 1), 0.2f * r(k, 2), h, n.x, n.y, n.z, k % 5 == 0);
    }
    list.pad();
  }
};

/// Energy at p, with the pairs' weights held at what they are where the particle is.
double reference_energy(const NearList& list, const Vec3d& p, const Mover& at) {
  double sum = 0;
  for (int k = 0; k < list.count; ++k) {
    const Vec3d q(list.x()[k], list.y()[k], list.z()[k]);
    const double unit = 1 / (std::sqrt(3.0) * std::min(at.h, list.h()[k]));
    const float cosine = dot(at.direction, Vec3f(list.nx()[k], list.ny()[k], list.nz()[k]));
    const float apart = float(length(Vec3d(at.p) - q) * unit);
    const double weight = list.always()[k] > 0 ? 1 : normal_weight(cosine, apart), d = length(p - q) * unit;
    if (d < 1) sum += weight * energy(d);
  }
  return sum;
}

TEST(PairSums, AreThoseOfTheFormula) {
  OneLane lane;
  for (const int count : {0, 1, 15, 16, 17, 60}) {
    const Crowd crowd(count, 2.5f);
    const Mover at{{0.1f, -0.2f, 0.05f}, 1.1f, normalized(Vec3f(0.1f, 0.2f, 1))};
    const PairSums s = pair_sums(lane, crowd.list, at);
    const auto energy_at = [&](const Vec3d& p) { return reference_energy(crowd.list, p, at); };
    EXPECT_NEAR(s.energy, energy_at(Vec3d(at.p)), 1e-4 * (1 + s.energy));
    EXPECT_EQ(pair_energy_sum(lane, crowd.list, at), s.energy);
    const double e = 1e-4;
    const auto slope = [&](const Vec3d& p, int axis) {
      Vec3d low = p, high = p;
      low[axis] -= e, high[axis] += e;
      return (energy_at(high) - energy_at(low)) / (2 * e);
    };
    const float second[3][3] = {{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}};
    for (int a = 0; a < 3; ++a) {
      EXPECT_NEAR(s.gradient[a], slope(Vec3d(at.p), a), 2e-3 * (1 + length(s.gradient)));
      for (int b = 0; b < 3; ++b) {
        Vec3d low(at.p), high(at.p);
        low[b] -= e, high[b] += e;
        EXPECT_NEAR(second[a][b], (slope(high, a) - slope(low, a)) / (2 * e), 5e-3 * (1 + s.stiffness)) << a << b;
      }
    }
    int neighbours = 0;
    for (int k = 0; k < count; ++k) {
      const Vec3f r = Vec3f(crowd.list.x()[k], crowd.list.y()[k], crowd.list.z()[k]) - at.p;
      const float weight = dot(at.direction, Vec3f(crowd.list.nx()[k], crowd.list.ny()[k], crowd.list.nz()[k]));
      if (length(r) < support * std::min(at.h, crowd.list.h()[k]) && (weight > -0.5f || crowd.list.always()[k] > 0))
        ++neighbours;
    }
    EXPECT_EQ(s.neighbours, float(neighbours));
  }
}

TEST(PairSums, AgreeWithPairForce) {
  OneLane lane;
  const Crowd crowd(40, 2);
  const Mover at{{0.2f, 0.1f, 0}, 0.9f, {0, 0, 1}};
  Vec3f gradient;
  for (int k = 0; k < 40; ++k) {
    const NearList& l = crowd.list;
    const Vec3f q(l.x()[k], l.y()[k], l.z()[k]);
    const float h = std::min(at.h, l.h()[k]), d = length(at.p - q) / (support * h);  // Eq. 3.2; the tree takes the mean
    const float w = l.always()[k] > 0 ? 1 : normal_weight(l.nz()[k], d);
    gradient += pair_force(at.p, h, q, h).gradient * w;
  }
  EXPECT_LT(length(pair_sums(lane, crowd.list, at).gradient - gradient), 1e-4f * length(gradient));
}

}  // namespace
}  // namespace nacre
