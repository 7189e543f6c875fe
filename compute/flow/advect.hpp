// Nacre: particles that carry the texture along pathlines on the surface (sec. 5.2.2).
#pragma once

#include "compute/flow/deposit.hpp"
#include "compute/flow/velocity.hpp"

namespace nacre {

/// Fourth-order Runge-Kutta in space and time over the fraction `h` of step `j` from time `u` in it. False where a
/// stage leaves the band.
NACRE_HD inline bool runge_kutta4(const FlowField& field, const Vec3f& p, int j, float u, float h, Vec3f& end) {
  Vec3f k1, k2, k3, k4;
  const float middle = u + 0.5f * h, last = u + h < 1 ? u + h : 1;
  if (!field.velocity(p, j, u, k1)) return false;
  if (!field.velocity(p + k1 * (0.5f * h), j, middle, k2)) return false;
  if (!field.velocity(p + k2 * (0.5f * h), j, middle, k3)) return false;
  if (!field.velocity(p + k3 * h, j, last, k4)) return false;
  end = p + (k1 + (k2 + k3) * 2.0f + k4) * (h / 6.0f);
  return true;
}

/// Releases a particle from every surface cell at the beginning of a step and lets it live `ttl` steps; what it carries
/// goes to the cells under its path, in step j of its life to the buffer of that step (Shen & Kao 1997). A piece of the
/// path that ends off the surface is halved until it ends near it, projected (WENO4), drawn; then the rest of the path
/// follows, so that its total length is kept (Fig. 5.5).
struct ReleaseParticles {
  FlowField field;
  RefinedGridView texture;
  const float* carried;          ///< per surface cell, 0..1
  std::uint64_t* sums[max_ttl];  ///< buffers of the coming steps
  int ttl;

  static constexpr float near_surface = 0.6f;   // texture cells that a projection may move a point
  static constexpr float shortest = 1.0f / 64;  // of a step; shorter pieces are projected from wherever they end
  static constexpr float at_rest = 1.0f / 32;   // texture cells a step

  NACRE_HD void operator()(std::int64_t i) const {
    const auto home = std::uint32_t(i);
    const std::uint32_t value16 = Deposit::quantise(carried[home]);
    Vec3f p = texture.seed_point(home) * texture.inverse_refine;
    atomic_add(sums[0] + home, Deposit::pack(value16));
    std::uint32_t here = home;
    for (int j = 0; j < ttl; ++j) {
      const int hits = walk(j, p, value16);
      if (hits > 0 || j == 0) continue;
      const std::uint32_t cell = texture.surface_cell(floor_cell(p * float(texture.refine)));
      here = cell == none ? here : cell;
      atomic_add(sums[j] + here, Deposit::pack(value16));
    }
  }

  /// Moves `p` over step `j`; returns how many cells were hit.
  NACRE_HD int walk(int j, Vec3f& p, std::uint32_t value16) const {
    const float scale = float(texture.refine);
    int hits = 0;
    float u = 0, h = 1;
    while (u < 1) {
      h = h < 1 - u ? h : 1 - u;
      Vec3f end, landed;
      bool moved = runge_kutta4(field, p, j, u, h, end);
      const Vec3f displacement = moved ? end - p : Vec3f{};
      if (moved && dot(displacement, displacement) * scale * scale < at_rest * at_rest * h * h) {
        u += h;
        continue;
      }
      moved = moved && project(field.grid, end, landed);
      const Vec3f off = moved ? landed - end : Vec3f{};
      if (!moved || dot(off, off) * scale * scale > near_surface * near_surface) {
        if (h > shortest) {
          h *= 0.5f;
          continue;
        }
        if (!moved) break;  // off the rim of an open surface: the path ends there
      }
      hits += deposit_line(texture, sums[j], p * scale, landed * scale, value16);
      p = landed;
      u += h;
      h = 1;
    }
    return hits;
  }
};

}  // namespace nacre
