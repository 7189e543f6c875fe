// Nacre: where two, three or four materials meet: surfaces, junction curves, junction points, and how to get onto them.
#pragma once

#include <array>
#include <cstdint>

#include "compute/field/material_bricks.hpp"

namespace nacre {

/// Two to four materials, ascending, 16 bits each from the lowest; unused ones are 0xffff.
struct Junction {
  std::uint64_t packed = ~0ull;

  constexpr Junction() = default;
  NACRE_HD constexpr Junction(std::uint32_t a, std::uint32_t b, std::uint32_t c = 0xffff, std::uint32_t d = 0xffff)
      : packed(std::uint64_t(a) | std::uint64_t(b) << 16 | std::uint64_t(c) << 32 | std::uint64_t(d) << 48) {}

  NACRE_HD constexpr std::uint32_t material(int k) const { return std::uint32_t(packed >> 16 * k) & 0xffff; }
  /// 2 on a surface, 3 on a curve, 4 at a point.
  NACRE_HD constexpr int materials() const { return material(3) != 0xffff ? 4 : material(2) != 0xffff ? 3 : 2; }
  /// Dimension: 2 surface, 1 curve, 0 point. The junction order of the particles on it.
  NACRE_HD constexpr int order() const { return 4 - materials(); }
  NACRE_HD constexpr bool has(std::uint32_t m) const {
    return material(0) == m || material(1) == m || material(2) == m || material(3) == m;
  }
  /// All four; 0xffff where there are fewer.
  std::array<std::uint16_t, 4> all() const {
    return {std::uint16_t(material(0)), std::uint16_t(material(1)), std::uint16_t(material(2)),
            std::uint16_t(material(3))};
  }
  /// This is `other`, or a part of its rim (the curve where surface `other` ends, a point where curve `other` ends).
  NACRE_HD constexpr bool bounds(const Junction& other) const {
    for (int k = 0; k < other.materials(); ++k)
      if (!has(other.material(k))) return false;
    return true;
  }
  NACRE_HD constexpr bool operator==(const Junction& other) const { return packed == other.packed; }
};

/// Position of a junction in an ascending table that holds it; if it does not, of another one.
NACRE_HD inline std::uint32_t junction_number(const Junction* table, std::uint32_t size, const Junction& j) {
  std::uint32_t low = 0, high = size;
  while (high - low > 1) {
    const std::uint32_t middle = (low + high) / 2;
    if (table[middle].packed <= j.packed)
      low = middle;
    else
      high = middle;
  }
  return low;
}

/// At a point of a junction: the gradients of the function of its first material less that of its second, third and
/// fourth, per voxel.
struct JunctionGradients {
  Vec3f from_first[3];
};

/// A point on a junction and what holds there.
struct JunctionPoint {
  Vec3f p;
  Vec3f direction;      ///< unit: normal of a surface (towards the lower material), tangent of a curve; zero at a point
  float steepness = 0;  ///< |gradient| of the first difference of indicator functions
};

namespace detail {

/// The step that brings the differences g of the materials' functions to zero: minimum norm for one and two equations.
NACRE_HD inline bool junction_step(const FieldSample* f, int count, Vec3f& step, JunctionPoint& at) {
  const Vec3f a = f[0].gradient - f[1].gradient;
  const float g = f[0].value - f[1].value;
  const float aa = dot(a, a);
  if (!(aa > 1e-12f)) return false;
  at.steepness = std::sqrt(aa);
  if (count == 2) {
    step = a * (-g / aa);
    at.direction = a / at.steepness;
    return true;
  }
  const Vec3f b = f[1].gradient - f[2].gradient;
  const float h = f[1].value - f[2].value;
  const Vec3f t = cross(a, b);
  const float tt = dot(t, t);
  if (!(tt > 1e-4f * aa * dot(b, b))) return false;  // the two surfaces are nearly parallel
  if (count == 3) {
    step = (cross(t, b) * g + cross(a, t) * h) * (1 / tt);
    at.direction = t / std::sqrt(tt);
    return true;
  }
  const Vec3f c = f[2].gradient - f[3].gradient;
  const float k = f[2].value - f[3].value;
  const float volume = dot(t, c);
  if (!(volume * volume > 1e-4f * tt * dot(c, c))) return false;
  step = (cross(b, c) * g + cross(c, a) * h + t * k) * (-1 / volume);
  at.direction = Vec3f();
  return true;
}

}  // namespace detail

/// At most so many steps of Newton's method, of so many voxels.
inline constexpr int newton_steps = 10;
inline constexpr float newton_stride = 0.5f;

/// Newton's method onto the junction from `p` (Eq. 3.5, sign corrected, for differences of indicator functions),
/// until a step is shorter than `last_step` (what is left is about its square times the curvature). False where it does
/// not arrive within `reach` voxels of `p`.
NACRE_HD inline bool project(const MaterialBricksView& field, const Junction& junction, const Vec3f& p, float reach,
                             JunctionPoint& at, float last_step = 1e-3f) {
  const int count = junction.materials();
  at.p = p;
  for (int k = 0; k < newton_steps; ++k) {
    if (!field.inside(at.p, 2.5f)) return false;
    const CubicStencil stencil(field, at.p);
    FieldSample f[4];
    if (count == 2)
      f[0] = stencil.difference(field, junction.material(0), junction.material(1));  // f[1] is zero
    else
      for (int m = 0; m < count; ++m) f[m] = stencil.sample(field, junction.material(m));
    Vec3f step;
    if (!detail::junction_step(f, count, step, at)) return false;
    const float size = length(step);
    at.p += size > newton_stride ? step * (newton_stride / size) : step;
    if (dot(at.p - p, at.p - p) > reach * reach) return false;
    if (size < last_step) return true;
  }
  return false;
}

/// The margin of a junction that is the only one around, voxels.
inline constexpr float only_margin = 4;

/// Whether the block of a point lists materials that are not the junction's: where none are, it is the only one there.
NACRE_HD inline bool has_others(const MaterialBricksView& field, const Junction& junction, const Vec3f& p) {
  const std::int64_t block = field.block_at(p);
  for (std::uint32_t k = field.block_start[block]; k < field.block_start[block + 1]; ++k)
    if (!junction.has(field.brick_material[k])) return true;
  return false;
}

/// How far the junction's materials are ahead of all others at `p`, in voxels (divided by `steepness`): negative where
/// another material covers the position, so that the junction does not exist there.
NACRE_HD inline float junction_margin(const MaterialBricksView& field, const Junction& junction, const Vec3f& p,
                                      float steepness) {
  if (!has_others(field, junction, p)) return only_margin;  // its own materials may not be listed
  const std::int64_t block = field.block_at(p);
  const std::uint32_t first = field.block_start[block], last = field.block_start[block + 1];
  const int count = junction.materials();
  const CubicStencil stencil(field, p);
  float own = stencil.value(field, junction.material(0));
  for (int m = 1; m < count; ++m) own = min(own, stencil.value(field, junction.material(m)));
  float other = own - 4 * steepness;
  for (std::uint32_t k = first; k < last; ++k)
    if (!junction.has(field.brick_material[k])) other = max(other, stencil.value(field, field.brick_material[k]));
  return (own - other) / steepness;
}

}  // namespace nacre
