// Nacre: pathlines through a band of cells (sec. 6.2.1): plain 3-D paths, never projected.
#pragma once

#include "compute/flow/band_velocity.hpp"
#include "compute/flow/deposit.hpp"
#include "compute/flow/surface_cells.hpp"

namespace nacre {

/// A path and what it leaves. The velocity does not change along normals (it is extended), so a path keeps its distance
/// from the surface by itself; one that starts on it stays there. Pieces are halved where two estimates of Runge and
/// Kutta's disagree, which happens where the surface bends within a step.
template <class View>
struct BandPath {
  BandFlowField<View> field;

  static constexpr float straight = 0.5f;       // cells that both velocities of the midpoint rule may lead apart
  static constexpr float tolerance = 0.3f;      // cells that the estimates of a piece may differ by
  static constexpr float longest = 12;          // cells of a piece
  static constexpr float shortest = 1.0f / 64;  // of a step
  static constexpr float at_rest = 1.0f / 32;   // cells a step

  using Cursor = typename View::Cursor;

  /// Moves `p` over step `j` and adds `word` to the surface cells on the way; returns how many were hit.
  NACRE_HD int walk(int j, BandPoint& p, std::uint64_t* sums, std::uint64_t word, Cursor& cursor,
                    Cursor& drawing) const {
    int hits = 0;
    float u = 0, h = 1;
    while (u < 1) {
      h = h < 1 - u ? h : 1 - u;
      Vec3f displacement;
      float doubt;
      const bool moved = follow(cursor, p, j, u, h, displacement, doubt);
      if (!moved || doubt > tolerance * tolerance || dot(displacement, displacement) > longest * longest) {
        if (h > shortest) {
          h *= 0.5f;
          continue;
        }
        if (!moved) break;  // out of the band: the path ends there
      }
      if (dot(displacement, displacement) >= at_rest * at_rest * h * h)
        hits += draw(drawing, sums, p, displacement, word);
      p = p + displacement;
      u += h;
      h *= 2;
    }
    return hits;
  }

 private:
  /// The displacement in the fraction `h` of step `j` from time `u` in it: by the midpoint rule where both of its
  /// velocities agree, else by Runge and Kutta's fourth order. `doubt`: squared distance between the two estimates of
  /// its middle, in cells.
  NACRE_HD_INLINE bool follow(Cursor& cursor, const BandPoint& p, int j, float u, float h, Vec3f& displacement,
                              float& doubt) const {
    Vec3f k1, k2, k3, k4;
    const float middle = u + 0.5f * h, last = u + h < 1 ? u + h : 1;
    if (!field.velocity(cursor, p, j, u, k1)) return false;
    if (!field.velocity(cursor, p + k1 * (0.5f * h), j, middle, k2)) return false;
    const Vec3f turn = (k2 - k1) * h;
    if (dot(turn, turn) < straight * straight) {
      displacement = k2 * h;
      doubt = 0;
      return true;
    }
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
                                  std::uint64_t word) {
    const int n = cells_crossed((p + displacement).cell() - p.cell());
    const Vec3f step = displacement * (1.0f / float(n > 0 ? n : 1));
    int hits = 0;
    for (int i = 1; i <= n; ++i) {
      const CellIndex cell = cursor.find_surface((p + step * float(i)).cell());
      if (cell == no_cell) continue;
      atomic_add(sums + cell, word);
      ++hits;
    }
    return hits;
  }
};

/// Moves all particles of the octree of bricks through a step, as MoveParticles does on the grid.
struct MoveBrickParticles {
  BandPath<BrickOctreeView> path;
  const float* carried;            ///< by new particles, per surface cell, 0..1
  const std::uint64_t* arrived;    ///< per surface cell: Deposit of the particles that begin the step there
  std::uint64_t *crossed, *ended;  ///< what paths leave, and where they end; zero before
  int ttl;
  Vec3f rounding;

  NACRE_HD void operator()(CellIndex home, CellIndex cell, const Int3& position,
                           BrickOctreeView::Cursor& cursor) const {
    const BrickOctreeView& view = path.field.view;
    const std::uint64_t word = Deposit::beginning(arrived[home], carried[home], ttl);
    const BandPoint start = closest_point_of(position, view.point[cell], view.quantum);
    BandPoint p = start;
    BrickOctreeView::Cursor drawing = cursor;
    path.walk(0, p, crossed, word, cursor, drawing);
    const BrickSurface surface{view};
    BrickSurface::Cursor ends(surface, drawing);
    const BandPoint rounded{position, Vec3f(0.5f) + (p.local - start.local) + rounding};
    CellIndex end = ends.find(rounded.cell()).cell;
    if (end == no_cell) end = ends.find(p.cell()).cell;
    atomic_add(ended + (end == no_cell ? home : end), word);
  }
};

}  // namespace nacre
