// Nacre: where the boundary of labels lies between two voxels: staircases of labels are read as the slopes they stand
// for.
#pragma once

#include <initializer_list>

#include "compute/field/material_bricks.hpp"

namespace nacre {

/// A slope that is flatter than 45 degrees against an axis shows in labels as a staircase: treads, and steps where they
/// end. Here it is taken back: the boundary reaches a voxel centre where the tread ends and is in between in
/// proportion, plus the bend that the lengths of the next treads tell. So a plane's labels give the plane, however wide
/// its treads are (shape-based interpolation, Raya & Udupa 1990, along treads instead of between slices). Walls are no
/// steps: treads that end there are left as they are.
struct LabelSlopes {
  MaterialBricksView field;
  float reach = 32;  ///< the farthest end of a tread that is looked for, in voxels; 0: staircases stay

  /// How far the boundary between voxel `v` and the next one along `axis` is from the middle between both, in voxels:
  /// -0.5 to 0.5, less than zero where it is nearer to the next one; 0 where both are of one material.
  NACRE_HD float offset(const Int3& v, int axis) const {
    Int3 up{};
    up[axis] = 1;
    const Tread tread{v, up, label(v), label(v + up)};
    if (tread.own == tread.other) return 0;
    Ends rising, falling, other_rising, other_falling;
    float bend = 0;
    for (int k = 1; k <= 2; ++k) {
      Int3 along{};
      along[(axis + k) % 3] = 1;
      const float voxel = 1 / field.cells_per_unit[(axis + k) % 3];
      const End a = end(tread, along, voxel), b = end(tread, Int3(0) - along, voxel);
      const bool through = a.step * b.step < 0;  // the slope runs along this axis
      for (const End& e : {a, b}) {
        if (e.step > 0) (through ? rising : other_rising).add(e.distance);
        if (e.step < 0) (through ? falling : other_falling).add(e.distance);
      }
      if (through) bend += (1 / a.distance + 1 / b.distance) * bend_between(a, b);
    }
    if (rising.count == 0) rising = other_rising, falling = other_falling;
    const float r = rising.weight(falling), f = falling.weight(rising);
    return r + f > 0 ? min(max((0.5f * (f - r) - bend) / (r + f), -0.5f), 0.5f) : 0;
  }

 private:
  static constexpr int highest_step = 3;  ///< anything higher is a wall

  /// Voxels of one material side by side, and beyond them those of another.
  struct Tread {
    Int3 at, up;
    std::uint16_t own, other;
  };

  /// Where a tread ends: by how many voxels the boundary rises (towards the other material) or falls there, at what
  /// distance, and how long the next tread is.
  struct End {
    int step = 0;
    float distance = 0, next = 0;
  };

  /// All ends of one kind.
  struct Ends {
    int count = 0;
    float inverse = 0;  ///< sum of 1 / distance
    float farthest = 4;

    NACRE_HD void add(float distance) {
      ++count;
      inverse += 1 / distance;
      farthest = max(farthest, distance);
    }
    /// Where there is none, as on the top of a hill, the tread is thought to end as far away as the farthest of the
    /// others.
    NACRE_HD float weight(const Ends& others) const {
      return count > 0 ? inverse : float(others.count) / others.farthest;
    }
  };

  /// How far a parabola between a rising and a falling end is above the straight line, seen towards the other material.
  NACRE_HD static float bend_between(const End& a, const End& b) {
    const float length = a.distance + b.distance;
    const float slope_at_a = 2 * float(a.step) / (length + a.next), slope_at_b = -2 * float(b.step) / (length + b.next);
    return 0.5f * (slope_at_b - slope_at_a) / length * a.distance * b.distance;
  }

  NACRE_HD std::uint16_t label(const Int3& v) const { return field.material(v); }
  NACRE_HD bool inside(const Int3& v) const { return is_within(v, field.voxels()); }

  /// The first voxel along a direction that is not of the tread, and how many steps away it is; 0 where none is within
  /// reach.
  NACRE_HD int leave(Tread& tread, const Int3& direction, float voxel) const {
    for (int k = 1; float(k) * voxel <= reach; ++k) {
      tread.at = tread.at + direction;
      if (!inside(tread.at) || !inside(tread.at + tread.up)) return 0;
      if (label(tread.at) != tread.own || label(tread.at + tread.up) != tread.other) return k;
    }
    return 0;
  }

  NACRE_HD End end(Tread tread, const Int3& direction, float voxel) const {
    End result;
    const int steps = leave(tread, direction, voxel);
    if (steps == 0) return result;
    const std::uint16_t here = label(tread.at), beyond = label(tread.at + tread.up);
    if (here == tread.own && beyond == tread.own)
      result.step = height(tread.at + tread.up, tread.up, tread.own, tread.other);
    else if (here == tread.other && beyond == tread.other)
      result.step = -height(tread.at, Int3(0) - tread.up, tread.other, tread.own);
    if (result.step == 0) return result;
    result.distance = (float(steps) - 0.5f) * voxel;
    tread.at = tread.at + tread.up * Int3(result.step);
    const int next = leave(tread, direction, voxel);
    result.next = next > 0 ? float(next) * voxel : reach;
    return result;
  }

  /// How many voxels of material `from` there are before one of `to`; 0 where they are too many, or another one
  /// follows.
  NACRE_HD int height(Int3 at, const Int3& towards, std::uint16_t from, std::uint16_t to) const {
    for (int k = 1; k <= highest_step; ++k) {
      at = at + towards;
      if (!inside(at)) return 0;
      if (label(at) != from) return label(at) == to ? k : 0;
    }
    return 0;
  }
};

}  // namespace nacre
