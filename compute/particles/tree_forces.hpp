// Nacre: energies and forces of all particles at once, by walks through the tree (sec. 4.1).
#pragma once

#include "compute/particles/tree.hpp"

namespace nacre {

/// Which interfaces concern an interface's particles: its own, and those that bound it. Number k's are
/// related[start[k]] .. related[start[k + 1] - 1], itself first.
struct RelatedView {
  const std::uint32_t* start = nullptr;
  const std::uint32_t* related = nullptr;
  const std::uint8_t* order = nullptr;  ///< dimension of each interface
};

/// Sums over the neighbours of one particle.
struct ForceSum {
  float energy = 0;
  Vec3f gradient;       ///< of the energy with respect to the particle's position, per voxel
  float stiffness = 0;  ///< sum of second derivatives
};

namespace detail {

/// Candidates that a team gathers side by side before it computes with them, in whole blocks: what fills the last one
/// up has no mass.
struct Candidates {
  static constexpr int capacity = 512, block = 16;
  float x[capacity], y[capacity], z[capacity], h[capacity];
  float nx[capacity], ny[capacity], nz[capacity], mass[capacity];
};

/// Adds what the candidates do to a particle at p with normal n (zero: all concern it fully). Vectorises.
NACRE_HD_INLINE void add_forces(const Candidates& c, int count, const Vec3f& p, float h, const Vec3f& n, bool by_normal,
                                ForceSum& sum) {
  float energy = 0, gx = 0, gy = 0, gz = 0, stiffness = 0;
#if !defined(__CUDACC__)
#pragma omp simd reduction(+ : energy, gx, gy, gz, stiffness)
#endif
  for (int k = 0; k < count; ++k) {
    const float dx = p.x - c.x[k], dy = p.y - c.y[k], dz = p.z - c.z[k];
    const float unit = 1 / (support * pair_size(h, c.h[k]));
    const float square = dx * dx + dy * dy + dz * dz;
    const float distance = std::sqrt(square);
    const PairEnergy e = cotangent_energy(distance * unit);
    const float cosine = n.x * c.nx[k] + n.y * c.ny[k] + n.z * c.nz[k];
    float weight = c.mass[k] * (by_normal ? normal_weight(cosine, distance * unit) : 1.0f);
    weight = square > 1e-12f ? weight : 0.0f;  // itself
    const float slope = weight * e.slope * unit / (distance > 1e-6f ? distance : 1e-6f);
    energy += weight * e.energy;
    gx += slope * dx;
    gy += slope * dy;
    gz += slope * dz;
    stiffness += weight * e.curve * unit * unit;
  }
  sum.energy += energy;
  sum.gradient += Vec3f(gx, gy, gz);
  sum.stiffness += stiffness;
}

}  // namespace detail

/// A team per leaf: the leaf's particles walk the tree together.
struct LeafForces {
  TreeView tree;
  RelatedView related;
  const std::uint32_t* interface;
  const std::uint32_t* leaf;
  int order;         ///< only particles of this junction order move
  Float4* gradient;  ///< per particle: of the energy; its stiffness
  float* energy;     ///< per particle

  static constexpr std::size_t scratch_bytes() {
    return sizeof(detail::Candidates) + sizeof(ForceSum) * TreeView::leaf_size;
  }

  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    const TreeNode& own = tree.node[leaf[i]];
    const std::uint32_t group = interface[own.first];
    if (related.order[group] != order) return;
    auto& candidates = *reinterpret_cast<detail::Candidates*>(team.scratch());
    auto* sums = reinterpret_cast<ForceSum*>(team.scratch() + sizeof(detail::Candidates));
    // A leaf at the last level can hold more than leaf_size particles: in pieces, then.
    for (std::uint32_t from = own.first; from < own.last; from += TreeView::leaf_size) {
      const int targets = int(own.last - from < TreeView::leaf_size ? own.last - from : TreeView::leaf_size);
      team.each(targets, [&](int t) { sums[t] = ForceSum(); });
      for (std::uint32_t k = related.start[group]; k < related.start[group + 1]; ++k)
        gather(team, own, from, targets, related.related[k], related.related[k] == group, candidates, sums);
      team.each(targets, [&](int t) {
        const ForceSum& s = sums[t];
        gradient[from + t] = {s.gradient.x, s.gradient.y, s.gradient.z, s.stiffness};
        energy[from + t] = s.energy;
      });
    }
  }

 private:
  NACRE_HD void gather(Team& team, const TreeNode& own, std::uint32_t from, int targets, std::uint32_t root,
                       bool by_normal, detail::Candidates& c, ForceSum* sums) const {
    int count = 0;
    const auto compute = [&] {
      if (count == 0) return;  // most often on a rim, which is near few leaves
      constexpr int block = detail::Candidates::block;
      const int filled = (count + block - 1) / block * block;
      team.each(filled - count, [&](int k) { put(c, count + k, {0, 0, 0, 1}, {0, 0, 0, 0}, 0); });
      team.each(targets, [&](int t) {
        const Float4 p = tree.position[from + t], n = tree.direction[from + t];
        // A curve's tangents may point either way; its particles, and those of a rim, concern each other fully.
        detail::add_forces(c, filled, {p.x, p.y, p.z}, p.w, {n.x, n.y, n.z}, by_normal && order == 2, sums[t]);
      });
      count = 0;
    };
    tree.walk(
        root, own.low, own.high, support * own.largest,
        [&](std::uint32_t first, std::uint32_t last) {
          for (; first < last; first += Team::lanes) {
            if (count + Team::lanes > detail::Candidates::capacity) compute();
            const int n = last - first < Team::lanes ? int(last - first) : Team::lanes;
            count += team.compact(
                n,
                [&](int k) {  // some particle of the leaf may feel it
                  const Float4 p = tree.position[first + k];
                  const Vec3f at(p.x, p.y, p.z);
                  const float reach = support * pair_size(own.largest, p.w);
                  return box_distance2(at, at, own.low, own.high) < reach * reach;
                },
                [&](int k, int place) {
                  put(c, count + place, tree.position[first + k], tree.direction[first + k], 1);
                });
          }
        },
        [&](const TreeNode& node) {
          if (count == detail::Candidates::capacity) compute();
          if (team.first()) put(c, count, node.centre, node.normal, node.mass());
          ++count;
          team.wait();
        });
    compute();
  }

  NACRE_HD_INLINE static void put(detail::Candidates& c, int k, const Float4& p, const Float4& d, float mass) {
    c.x[k] = p.x, c.y[k] = p.y, c.z[k] = p.z, c.h[k] = p.w;
    c.nx[k] = d.x, c.ny[k] = d.y, c.nz[k] = d.z, c.mass[k] = mass;
  }
};

/// Energy and force at a position that need not be a particle's: one walk for one point.
NACRE_HD inline ForceSum force_at(const TreeView& tree, const RelatedView& related, std::uint32_t group, const Vec3f& p,
                                  float h, const Vec3f& n) {
  ForceSum sum;
  const bool surface = related.order[group] == 2;
  for (std::uint32_t k = related.start[group]; k < related.start[group + 1]; ++k) {
    const std::uint32_t root = related.related[k];
    const auto add = [&](const Float4& q, const Float4& d, float mass) {
      const PairForce f = pair_force(p, h, {q.x, q.y, q.z}, q.w);
      const float w = mass * (surface && root == group
                                  ? normal_weight(dot(n, Vec3f(d.x, d.y, d.z)),
                                                  length(p - Vec3f(q.x, q.y, q.z)) / (support * pair_size(h, q.w)))
                                  : 1.0f);
      sum.energy += w * f.energy;
      sum.gradient += f.gradient * w;
      sum.stiffness += w * f.stiffness;
    };
    tree.walk(
        root, p, p, support * h,
        [&](std::uint32_t first, std::uint32_t last) {
          for (std::uint32_t q = first; q < last; ++q) add(tree.position[q], tree.direction[q], 1);
        },
        [&](const TreeNode& node) { add(node.centre, node.normal, node.mass()); });
  }
  return sum;
}

}  // namespace nacre
