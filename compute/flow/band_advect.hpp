// Nacre: particles that carry the texture through a band of cells (sec. 6.2.1): plain 3-D paths, never projected.
#pragma once

#include "compute/flow/band_velocity.hpp"
#include "compute/flow/deposit.hpp"

namespace nacre {

/// Releases a particle for every surface cell at the beginning of a step and lets it live `ttl` steps, as
/// ReleaseParticles does on the grid. The velocity does not change along normals (it is extended), so a path keeps its
/// distance from the surface by itself; one that starts on it stays there. Pieces are halved where two estimates of
/// Runge and Kutta's disagree, which happens where the surface bends within a step.
template <class View>
struct ReleaseBandParticles {
  BandFlowField<View> field;
  const float* carried;          ///< per surface cell, 0..1
  std::uint64_t* sums[max_ttl];  ///< buffers of the coming steps
  int ttl;
  bool from_centres;  ///< start at the cells' centres, as the thesis does, not at their closest points

  static constexpr float tolerance = 0.3f;      // cells that the estimates of a piece may differ by
  static constexpr float longest = 12;          // cells of a piece
  static constexpr float shortest = 1.0f / 64;  // of a step
  static constexpr float at_rest = 1.0f / 32;   // cells a step

  using Cursor = typename View::Cursor;

  NACRE_HD void operator()(CellIndex home, CellIndex cell, const Int3& position, Cursor& cursor) const {
    const std::uint32_t value16 = Deposit::quantise(carried[home]);
    BandPoint p{position, Vec3f(0.5f)};
    if (!from_centres) p = closest_point_of(position, field.view.point[cell], field.view.quantum);
    Cursor drawing = cursor;
    atomic_add(sums[0] + home, Deposit::pack(value16));
    CellIndex here = home;
    for (int j = 0; j < ttl; ++j) {
      const int hits = walk(j, p, value16, cursor, drawing);
      if (hits > 0 || j == 0) continue;
      const CellIndex found = drawing.find_surface(p.cell());
      here = found == no_cell ? here : found;
      atomic_add(sums[j] + here, Deposit::pack(value16));
    }
  }

  /// Moves `p` over step `j`; returns how many cells were hit.
  NACRE_HD int walk(int j, BandPoint& p, std::uint32_t value16, Cursor& cursor, Cursor& drawing) const {
    int hits = 0;
    float u = 0, h = 1;
    while (u < 1) {
      h = h < 1 - u ? h : 1 - u;
      Vec3f displacement;
      float doubt;
      const bool moved = runge_kutta4(cursor, p, j, u, h, displacement, doubt);
      if (!moved || doubt > tolerance * tolerance || dot(displacement, displacement) > longest * longest) {
        if (h > shortest) {
          h *= 0.5f;
          continue;
        }
        if (!moved) break;  // out of the band: the path ends there
      }
      if (dot(displacement, displacement) >= at_rest * at_rest * h * h) {
        hits += draw(drawing, sums[j], p, displacement, value16);
        p = p + displacement;
      }
      u += h;
      h *= 2;
    }
    return hits;
  }

  /// The displacement in the fraction `h` of step `j` from time `u` in it; `doubt`: squared distance between the two
  /// estimates of its middle, in cells.
  NACRE_HD_INLINE bool runge_kutta4(Cursor& cursor, const BandPoint& p, int j, float u, float h, Vec3f& displacement,
                                    float& doubt) const {
    Vec3f k1, k2, k3, k4;
    const float middle = u + 0.5f * h, last = u + h < 1 ? u + h : 1;
    if (!field.velocity(cursor, p, j, u, k1)) return false;
    if (!field.velocity(cursor, p + k1 * (0.5f * h), j, middle, k2)) return false;
    if (!field.velocity(cursor, p + k2 * (0.5f * h), j, middle, k3)) return false;
    if (!field.velocity(cursor, p + k3 * h, j, last, k4)) return false;
    displacement = (k1 + (k2 + k3) * 2.0f + k4) * (h / 6.0f);
    const Vec3f d = (k3 - k2) * h;
    doubt = dot(d, d);
    return true;
  }

  /// The line of cells from `p` to `p + displacement`, without the cell of `p` (as deposit_line). Returns how many were
  /// hit.
  NACRE_HD_INLINE static int draw(Cursor& cursor, std::uint64_t* sums, const BandPoint& p, const Vec3f& displacement,
                                  std::uint32_t value16) {
    const Int3 cells = (p + displacement).cell() - p.cell();
    const int x = cells.x < 0 ? -cells.x : cells.x, y = cells.y < 0 ? -cells.y : cells.y;
    const int z = cells.z < 0 ? -cells.z : cells.z, xy = x > y ? x : y, n = xy > z ? xy : z;
    const Vec3f step = displacement * (1.0f / float(n > 0 ? n : 1));
    int hits = 0;
    for (int i = 1; i <= n; ++i) {
      const CellIndex cell = cursor.find_surface((p + step * float(i)).cell());
      if (cell == no_cell) continue;
      atomic_add(sums + cell, Deposit::pack(value16));
      ++hits;
    }
    return hits;
  }
};

}  // namespace nacre
