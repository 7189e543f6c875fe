// Nacre: particles that carry the texture along pathlines on the surface (sec. 5.2.2), on the grid.
#pragma once

#include "compute/flow/deposit.hpp"
#include "compute/flow/velocity.hpp"

namespace nacre {

/// The end of a path from `p` over the fraction `h` of a step from time `u` in it: by the midpoint rule where both of
/// its velocities agree to `straight` cells over the path, else by Runge and Kutta's fourth order. False where a stage
/// leaves the band.
NACRE_HD inline bool follow(const FlowField& field, const Vec3f& p, float u, float h, float straight, Vec3f& end) {
  Vec3f k1, k2, k3, k4;
  const float middle = u + 0.5f * h, last = u + h < 1 ? u + h : 1;
  if (!field.velocity(p, u, k1)) return false;
  if (!field.velocity(p + k1 * (0.5f * h), middle, k2)) return false;
  const Vec3f turn = (k2 - k1) * h;
  if (dot(turn, turn) < straight * straight) {
    end = p + k2 * h;
    return true;
  }
  if (!field.velocity(p + k2 * (0.5f * h), middle, k3)) return false;
  if (!field.velocity(p + k3 * h, last, k4)) return false;
  end = p + (k1 + (k2 + k3) * 2.0f + k4) * (h / 6.0f);
  return true;
}

/// Moves all particles through a step. A cell holds those that arrived there and outlived the step before, and a new
/// one. They move along one path, from the cell's closest point, leave what they carry in the cells under it (Shen &
/// Kao 1997), and are handed over to the cell where it ends: so one path serves all ages (as in Liu & Moorhead 2005).
///
/// A piece of the path that ends off the surface is halved until it ends near it, projected (WENO4), drawn; then the
/// rest of the path follows, so that its total length is kept (Fig. 5.5). The end of the last piece is not projected
/// where a surface cell holds it.
struct MoveParticles {
  FlowField field;
  RefinedGridView texture;
  const float* carried;            ///< by new particles, per surface cell, 0..1
  const std::uint64_t* arrived;    ///< per surface cell: Deposit of the particles that begin the step there
  std::uint64_t *crossed, *ended;  ///< what paths leave, and where they end; zero before
  int ttl;
  Vec3f rounding;  ///< how displacements are rounded to cells; see FlowMethodOn::rounding_of

  static constexpr float straight = 0.5f;       // texture cells
  static constexpr float near_surface = 0.6f;   // texture cells that a projection may move a point
  static constexpr float shortest = 1.0f / 64;  // of a step; shorter pieces are projected from wherever they end

  NACRE_HD void operator()(std::int64_t i) const {
    const auto home = std::uint32_t(i);
    const std::uint64_t word = Deposit::beginning(arrived[home], carried[home], ttl);
    const Vec3f centre = cell_centre(texture.cell(home));
    const Vec3f start = centre + Vec3f(texture.seed[home].x, texture.seed[home].y, texture.seed[home].z);
    const Vec3f end = walk(start, word);
    std::uint32_t cell = texture.surface_cell(floor_cell(centre + (end - start) + rounding));
    if (cell == none) cell = texture.surface_cell(floor_cell(end));
    atomic_add(ended + (cell == none ? home : cell), word);
  }

  /// Where the path from `start` ends; both in texture cells.
  NACRE_HD Vec3f walk(const Vec3f& start, std::uint64_t word) const {
    const float scale = float(texture.refine);
    Vec3f p = start * texture.inverse_refine;
    float u = 0, h = 1;
    while (u < 1) {
      h = h < 1 - u ? h : 1 - u;
      Vec3f end;
      bool moved = follow(field, p, u, h, straight * texture.inverse_refine, end);
      Vec3f landed = end;
      bool near = moved && u + h >= 1 && is_on_surface(end * scale);
      if (!near) {
        moved = moved && project(field.grid, end, landed);
        const Vec3f off = (landed - end) * scale;
        near = moved && dot(off, off) <= near_surface * near_surface;
      }
      if (!near) {
        if (h > shortest) {
          h *= 0.5f;
          continue;
        }
        if (!moved) break;  // off the rim of an open surface: the path ends there
      }
      deposit_line(texture, crossed, p * scale, landed * scale, word);
      p = landed;
      u += h;
      h = 1;
    }
    return p * scale;
  }

  NACRE_HD bool is_on_surface(const Vec3f& p) const {
    const std::uint32_t at = texture.entry(floor_cell(p));
    return at != none && !(texture.texel[at] & RefinedGridView::extended);
  }
};

}  // namespace nacre
