// Nacre: where the boundary of labels lies between two voxels: staircases of labels are read as the slopes they stand
// for.
#pragma once

#include <cstdint>
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

  /// Where a tread ends: by how many voxels the boundary rises (towards the other material) or falls there; 0 where
  /// none is within reach, or what is there is no step.
  struct End {
    std::int16_t step = 0;
    std::int16_t steps = 0;  ///< to the first voxel that is not of the tread
    std::int16_t next = 0;   ///< as many voxels of the next tread; 0: it goes on beyond reach

    NACRE_HD bool operator==(const End& other) const {
      return step == other.step && steps == other.steps && next == other.next;
    }
  };
  /// Of the tread of one face: along the axis after the face's, along the one after that, and back along both.
  static constexpr int ends_of_face = 4;

  /// Ends of the treads of eight faces in a line, between voxel `v` and the next one along `axis`, and so on along
  /// `along`: ends ahead to `ahead[0]`, `ahead[stride]` ..., those behind to `behind`. Faces of one tread share theirs.
  /// `boundary`: a bit for each face between two materials; the others have no ends, and nothing is written for them.
  template <class Label>
  NACRE_HD void find_ends(const Label& label, unsigned boundary, const Int3& v, int axis, int along, int stride,
                          End* ahead, End* behind) const {
    constexpr int count = 8;
    Int3 up{}, on{};
    up[axis] = 1, on[along] = 1;
    std::uint16_t own[count], other[count];
    for (int face = 0; face < count; ++face) {
      if (!(boundary >> face & 1)) continue;
      const Int3 at = v + on * Int3(face);
      own[face] = label(at), other[face] = label(at + up);
    }
    const float voxel = 1 / field.cells_per_unit[along];
    const auto find = [&](int face, int before, const Int3& direction, End* to) {
      if (!(boundary >> face & 1)) return;
      const bool goes_on = before >= 0 && before < count && (boundary >> before & 1) && own[face] == own[before] &&
                           other[face] == other[before];
      to[face * stride] = goes_on
                              ? one_step_before(to[before * stride], voxel)
                              : find_end(label, {v + on * Int3(face), up, own[face], other[face]}, direction, voxel);
    };
    for (int face = count; face-- > 0;) find(face, face + 1, on, ahead);
    for (int face = 0; face < count; ++face) find(face, face - 1, Int3(0) - on, behind);
  }

  /// How far the boundary between two voxels, of different materials and one after the other along `axis`, is from the
  /// middle between both, in voxels: -0.5 to 0.5, less than zero where it is nearer to the next one. `end`: of their
  /// face, `stride` apart from each other.
  NACRE_HD float offset(const End* end, int stride, int axis) const {
    Ends rising, falling, other_rising, other_falling;
    float bend = 0;
    for (int k = 1; k <= 2; ++k) {
      const float voxel = 1 / field.cells_per_unit[(axis + k) % 3];
      const End &a = end[(k - 1) * stride], &b = end[(k + 1) * stride];
      const bool through = a.step * b.step < 0;  // the slope runs along this axis
      for (const End& e : {a, b}) {
        if (e.step > 0) (through ? rising : other_rising).add(distance(e, voxel));
        if (e.step < 0) (through ? falling : other_falling).add(distance(e, voxel));
      }
      if (through) bend += (1 / distance(a, voxel) + 1 / distance(b, voxel)) * bend_between(a, b, voxel);
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

  NACRE_HD static float distance(const End& end, float voxel) { return (float(end.steps) - 0.5f) * voxel; }
  NACRE_HD float next_length(const End& end, float voxel) const {
    return end.next > 0 ? float(end.next) * voxel : reach;
  }

  /// How far a parabola between a rising and a falling end is above the straight line, seen towards the other material.
  NACRE_HD float bend_between(const End& a, const End& b, float voxel) const {
    const float to_a = distance(a, voxel), to_b = distance(b, voxel), length = to_a + to_b;
    const float slope_at_a = 2 * float(a.step) / (length + next_length(a, voxel)),
                slope_at_b = -2 * float(b.step) / (length + next_length(b, voxel));
    return 0.5f * (slope_at_b - slope_at_a) / length * to_a * to_b;
  }

  NACRE_HD bool inside(const Int3& v) const { return is_within(v, field.voxels()); }
  NACRE_HD bool within_reach(int steps, float voxel) const {
    return steps <= most_steps && float(steps) * voxel <= reach;
  }
  static constexpr int most_steps = 0x7fff;

  /// The end of a tread, seen from the face before.
  NACRE_HD End one_step_before(End end, float voxel) const {
    if (end.step == 0 || !within_reach(end.steps + 1, voxel)) return {};
    ++end.steps;
    return end;
  }

  /// The first voxel along a direction that is not of the tread, and how many steps away it is; 0 where none is within
  /// reach.
  template <class Label>
  NACRE_HD int leave(const Label& label, Tread& tread, const Int3& direction, float voxel) const {
    for (int k = 1; within_reach(k, voxel); ++k) {
      tread.at = tread.at + direction;
      if (!inside(tread.at) || !inside(tread.at + tread.up)) return 0;
      if (label(tread.at) != tread.own || label(tread.at + tread.up) != tread.other) return k;
    }
    return 0;
  }

  template <class Label>
  NACRE_HD End find_end(const Label& label, Tread tread, const Int3& direction, float voxel) const {
    const int steps = leave(label, tread, direction, voxel);
    if (steps == 0) return {};
    const std::uint16_t here = label(tread.at), beyond = label(tread.at + tread.up);
    int step = 0;
    if (here == tread.own && beyond == tread.own)
      step = height(label, tread.at + tread.up, tread.up, tread.own, tread.other);
    else if (here == tread.other && beyond == tread.other)
      step = -height(label, tread.at, Int3(0) - tread.up, tread.other, tread.own);
    if (step == 0) return {};
    tread.at = tread.at + tread.up * Int3(step);
    return {std::int16_t(step), std::int16_t(steps), std::int16_t(leave(label, tread, direction, voxel))};
  }

  /// How many voxels of material `from` there are before one of `to`; 0 where they are too many, or another one
  /// follows.
  template <class Label>
  NACRE_HD int height(const Label& label, Int3 at, const Int3& towards, std::uint16_t from, std::uint16_t to) const {
    for (int k = 1; k <= highest_step; ++k) {
      at = at + towards;
      if (!inside(at)) return 0;
      if (label(at) != from) return label(at) == to ? k : 0;
    }
    return 0;
  }
};

}  // namespace nacre
