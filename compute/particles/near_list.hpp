// Nacre: the particles that one particle may feel, side by side in fast memory, and the sums over its pairs with them.
#pragma once

#include <cstdint>

#include "compute/device/team.hpp"
#include "compute/field/interface.hpp"
#include "compute/particles/particle_set.hpp"

namespace nacre {

/// A particle while it is being worked on.
struct Mover {
  Vec3f p;
  float h = 0;
  Vec3f direction;  ///< normal or tangent
};

/// Energy of a particle, its gradient and its second derivatives with respect to the particle's position, and
/// `stiffness`, half of the sum of the pairs' second derivatives along their own lines: a scale for damping.
struct PairSums {
  float energy = 0;
  Vec3f gradient;
  float xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
  float stiffness = 0;
  float neighbours = 0;  ///< within the support

  NACRE_HD friend PairSums operator+(const PairSums& a, const PairSums& b) {
    return {a.energy + b.energy,
            a.gradient + b.gradient,
            a.xx + b.xx,
            a.yy + b.yy,
            a.zz + b.zz,
            a.xy + b.xy,
            a.yz + b.yz,
            a.zx + b.zx,
            a.stiffness + b.stiffness,
            a.neighbours + b.neighbours};
  }
};

/// Which particles concern one of interface `mine`: its own kind (weighted by normals), and the fixed ones on its rim.
struct Relation {
  static constexpr std::uint32_t fixed = 1u << 31;  ///< in the tag of a particle: its interface and whether it is fixed
  const Junction* table;
  std::uint32_t mine;

  NACRE_HD bool on_rim(std::uint32_t tag) const {
    const std::uint32_t other = tag & ~fixed;
    return (tag & fixed) != 0 && other != mine && table[other].bounds(table[mine]);
  }
};

/// Arrays of `capacity` floats, one after the other.
struct NearList {
  static constexpr int arrays = 8;
  static constexpr int block =
      16;  ///< capacity is a multiple of it; what is behind `count` is far away up to the next one

  float* memory = nullptr;
  int capacity = 0, count = 0;

  NACRE_HD float* x() const { return memory; }
  NACRE_HD float* y() const { return memory + capacity; }
  NACRE_HD float* z() const { return memory + 2 * std::ptrdiff_t(capacity); }
  NACRE_HD float* h() const { return memory + 3 * std::ptrdiff_t(capacity); }
  NACRE_HD float* nx() const { return memory + 4 * std::ptrdiff_t(capacity); }
  NACRE_HD float* ny() const { return memory + 5 * std::ptrdiff_t(capacity); }
  NACRE_HD float* nz() const { return memory + 6 * std::ptrdiff_t(capacity); }
  NACRE_HD float* always() const { return memory + 7 * std::ptrdiff_t(capacity); }  ///< 1: felt whatever the normals

  NACRE_HD_INLINE void put(int k, float px, float py, float pz, float size, float dx, float dy, float dz,
                           bool rim) const {
    x()[k] = px, y()[k] = py, z()[k] = pz, h()[k] = size;
    nx()[k] = dx, ny()[k] = dy, nz()[k] = dz, always()[k] = rim ? 1.0f : 0.0f;
  }
  NACRE_HD int padded() const { return (count + block - 1) / block * block; }
  /// Fills up the last block with what no one feels.
  NACRE_HD void pad() const {
    for (int k = count; k < padded(); ++k) put(k, 1e9f, 1e9f, 1e9f, 1, 0, 0, 0, false);
  }
};

namespace detail {

/// A NearList's arrays as restricted pointers: the compiler keeps whole blocks of pairs in registers.
struct NearRows {
  const float *x, *y, *z, *h, *nx, *ny, *nz, *always;
  NACRE_HD explicit NearRows(const NearList& list)
      : x(list.x()),
        y(list.y()),
        z(list.z()),
        h(list.h()),
        nx(list.nx()),
        ny(list.ny()),
        nz(list.nz()),
        always(list.always()) {}

  NACRE_HD_INLINE float weight(int k, const Vec3f& n, float d) const {
    return always[k] + (1 - always[k]) * normal_weight(nx[k] * n.x + ny[k] * n.y + nz[k] * n.z, d);
  }
};

/// N numbers that are added up together.
template <int N>
struct Floats {
  float v[N];
  NACRE_HD_INLINE friend Floats operator+(const Floats& a, const Floats& b) {
    Floats s;
    for (int i = 0; i < N; ++i) s.v[i] = a.v[i] + b.v[i];
    return s;
  }
};

/// Adds `term(k)` (an array of N floats) over 0 <= k < count into out. On the host in blocks of sixteen partial sums,
/// which become vector instructions; on CUDA one lane per pair and a reduction. The order depends on the count alone.
template <int N, class Group, class Term>
NACRE_HD_INLINE Floats<N> sum_pairs(Group& group, const NearList& list, const Term& term) {
#if defined(__CUDA_ARCH__)
  return group.sum(list.count, Floats<N>{}, term);
#else
  (void)group;
  constexpr int width = NearList::block;
  float partial[N][width] = {};
  for (int first = 0; first < list.padded(); first += width)
    for (int lane = 0; lane < width; ++lane) {
      const Floats<N> t = term(first + lane);
      for (int i = 0; i < N; ++i) partial[i][lane] += t.v[i];
    }
  Floats<N> total{};
  for (int i = 0; i < N; ++i)
    for (int lane = 0; lane < width; ++lane) total.v[i] += partial[i][lane];
  return total;
#endif
}

/// What one pair's geometry is made of: scaled distance, its scale, and the inverse distance.
struct PairLine {
  float rx, ry, rz, inverse, unit, d;
  NACRE_HD_INLINE PairLine(const NearRows& near, int k, const Mover& at)
      : rx(at.p.x - near.x[k]), ry(at.p.y - near.y[k]), rz(at.p.z - near.z[k]) {
    const float rr = rx * rx + ry * ry + rz * rz;
    const float size = at.h < near.h[k] ? at.h : near.h[k];
    const float distance = std::sqrt(rr);
    unit = 1 / (support * size);
    inverse = 1 / (distance > 1e-12f ? distance : 1e-12f);
    d = distance * unit;
  }
};

}  // namespace detail

/// Energy of a particle at `at` among the list's (Eq. 3.1, 3.2).
template <class Group>
NACRE_HD_INLINE float pair_energy_sum(Group& group, const NearList& list, const Mover& at) {
  const detail::NearRows near(list);
  const auto term = [&](int k) {
    const detail::PairLine line(near, k, at);
    return detail::Floats<1>{{near.weight(k, at.direction, line.d) * cotangent_energy(line.d).energy}};
  };
  return detail::sum_pairs<1>(group, list, term).v[0];
}

/// The same with derivatives: gradient E' u r/|r|, second derivatives E'' u^2 along the pair's line and E' u/|r| across
/// it, with u the scale of the distance (the chain factor that Eq. 3.3 leaves out). The normals' weight is held.
template <class Group>
NACRE_HD_INLINE PairSums pair_sums(Group& group, const NearList& list, const Mover& at) {
  const detail::NearRows near(list);
  const auto term = [&](int k) {
    const detail::PairLine line(near, k, at);
    const PairEnergy e = cotangent_energy(line.d);
    const float w = near.weight(k, at.direction, line.d);
    const float x = line.rx * line.inverse, y = line.ry * line.inverse, z = line.rz * line.inverse;
    const float pull = w * e.slope * line.unit, along = w * e.curve * line.unit * line.unit;
    const float across = pull * line.inverse, excess = along - across;
    return detail::Floats<12>{{w * e.energy, pull * x, pull * y, pull * z, across + excess * x * x,
                               across + excess * y * y, across + excess * z * z, excess * x * y, excess * y * z,
                               excess * z * x, 0.5f * along, w > 0 && line.d < 1 ? 1.0f : 0.0f}};
  };
  const detail::Floats<12> s = detail::sum_pairs<12>(group, list, term);
  return {s.v[0], Vec3f(s.v[1], s.v[2], s.v[3]), s.v[4], s.v[5], s.v[6], s.v[7], s.v[8], s.v[9], s.v[10], s.v[11]};
}

}  // namespace nacre
