// Nacre: signed distances made readable between voxels where two parts of a surface face each other (method 14).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/math/vec.hpp"

namespace nacre {
namespace detail {

/// What makes a distance of values, in units of the smallest spacing: positive on one side of a level.
struct LevelSide {
  float level;
  float scale;  ///< 1 or -1 over the slope of the values
};

/// A scalar volume whose values grow like a distance from a level.
struct DistanceSamples {
  const float* value;
  Int3 dims;
  Vec3f spacing;  ///< per axis, in units of the smallest
  float slope;    ///< of the values

  NACRE_HD bool inside(const Int3& v) const { return is_within(v, dims); }
  NACRE_HD std::int64_t number(const Int3& v) const { return (std::int64_t(v.z) * dims.y + v.y) * dims.x + v.x; }
  NACRE_HD Int3 voxel(std::int64_t i) const {
    return {int(i % dims.x), int(i / dims.x % dims.y), int(i / dims.x / dims.y)};
  }
  NACRE_HD float largest() const { return max(spacing.x, max(spacing.y, spacing.z)); }
  NACRE_HD float at(const Int3& v, const LevelSide& side) const { return (value[number(v)] - side.level) * side.scale; }

  /// Gradient of the distance at voxel `v`, from those of its neighbours that lie on the same side of a ridge: in the
  /// octant that falls most. Of second order where that is nearer to the slope of a distance. False at the volume's
  /// faces and where the neighbours are no such octant.
  NACRE_HD bool gradient(const Int3& v, const LevelSide& side, Vec3f& g) const {
    if (!inside(v - Int3(1)) || !inside(v + Int3(1))) return false;
    Int3 down;
    float lowest = 3e38f;
    for (int k = 0; k < 8; ++k) {
      const Int3 s{k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1};
      const float u = at(v + s, side);
      if (u < lowest) lowest = u, down = s;
    }
    const float here = at(v, side);
    if (here - lowest < 0.5f) return false;  // level ground, where distances were cut off
    Vec3f first, second;
    for (int axis = 0; axis < 3; ++axis) {
      Int3 step{};
      step[axis] = down[axis];
      const float to = float(down[axis]) / spacing[axis], rise = at(v + step, side) - here;
      if (rise > 0.1f * spacing[axis]) return false;
      first[axis] = rise * to;
      second[axis] = first[axis];
      if (inside(v + step + step)) second[axis] = (2 * rise - 0.5f * (at(v + step + step, side) - here)) * to;
    }
    const float first_length = length(first), second_length = length(second);
    g = std::fabs(second_length - 1) <= std::fabs(first_length - 1) ? second : first;
    return length(g) > 0;
  }

  /// The same as a unit vector. False, too, where it is not that of a distance.
  NACRE_HD bool normal(const Int3& v, const LevelSide& side, Vec3f& n) const {
    if (!gradient(v, side, n)) return false;
    const float l = length(n);
    n = n / l;
    return std::fabs(l - 1) < 0.25f;
  }
};

/// How far the sheet that faces a voxel's own is from it: the width of the gap or wall between the two, at this voxel.
struct FacingSheet {
  float width = 0;
  float opposed = 0;  ///< minus the cosine of the angle between the gradients
  Vec3f direction;    ///< to the other sheet
  bool found = false;
};

/// Looks for a ridge near each voxel, and how strongly the distance bends there: 1 / width of what lies between the two
/// sheets, positive between insides, negative between outsides. `unknown` where none is found.
struct MeasureRidge {
  static constexpr float unknown = 1e30f;
  static constexpr float band = 3;                 ///< voxels from the interface: no stencil there reaches farther
  static constexpr float wide = 4, wide_from = 3;  ///< voxels: ridges farther apart than half of it do no harm
  static constexpr float opposed_from = 0.7f, opposed = 0.9f;  ///< a wide wedge's are left alone

  DistanceSamples samples;
  float level;
  float* ridge;  ///< out

  NACRE_HD void operator()(std::int64_t i) const {
    ridge[i] = unknown;
    if (std::fabs(samples.value[i] - level) >= band * samples.largest() * samples.slope) return;
    const Int3 v = samples.voxel(i);
    float strongest = unknown;
    for (const float sign : {1.0f, -1.0f}) {
      const float k = sign * strength(v, {level, sign / samples.slope});
      if (std::fabs(k) < unknown && (strongest == unknown || std::fabs(k) > std::fabs(strongest))) strongest = k;
    }
    ridge[i] = strongest;
  }

 private:
  NACRE_HD float strength(const Int3& v, const LevelSide& side) const {
    const float u = samples.at(v, side);
    Vec3f n;
    if (!samples.normal(v, side, n)) return unknown;
    const float size = length(n * samples.spacing);  // of a voxel, across the sheet
    if (std::fabs(u) >= band * size) return unknown;
    FacingSheet sheet = find_sheet(v, u, n, n, size, side);
    if (sheet.found) sheet = find_sheet(v, u, n, sheet.direction, size, side);  // straight at it
    if (!sheet.found) return unknown;
    const float near = min(max((wide - sheet.width / size) / (wide - wide_from), 0.0f), 1.0f);
    const float flat = min(max((sheet.opposed - opposed_from) / (opposed - opposed_from), 0.0f), 1.0f);
    return near * flat / max(sheet.width, 2 * u);  // the other sheet is no nearer than its own
  }

  /// Goes from `v` along `direction` and takes what voxels beyond a ridge say about the sheet that is nearest to them,
  /// those the most from which the line to `v` runs across it. `n`: own normal, `u`: own distance.
  NACRE_HD FacingSheet find_sheet(const Int3& v, float u, const Vec3f& n, const Vec3f& direction, float size,
                                  const LevelSide& side) const {
    const Vec3f spacing = samples.spacing;
    constexpr int steps = 10;  // half a voxel each: to the far side of what is `wide`
    float weights = 0, width = 0, opposed = 0;
    Vec3f towards;
    for (int k = steps; k > 0; --k) {
      const Vec3f displacement = direction * (0.5f * float(k) * size);
      Int3 step;
      for (int axis = 0; axis < 3; ++axis) step[axis] = int(std::floor(displacement[axis] / spacing[axis] + 0.5f));
      const Int3 other = v + step;
      if (!samples.inside(other)) continue;
      const Vec3f d = Vec3f(step) * spacing;
      const float there = samples.at(other, side);
      if (u + dot(d, n) - there < 0.3f * size) break;  // it has only grown up to here: the own sheet's
      Vec3f m;
      if (!samples.normal(other, side, m)) continue;
      const float against = -dot(m, n), across = dot(m, d), w = u + there - across;
      if (against < opposed_from || w < 0.05f * size) continue;
      const float beside = 0.05f + (dot(d, d) - across * across) / (size * size), weight = 1 / (beside * beside);
      weights += weight;
      width += weight * w;
      opposed += weight * against;
      towards = towards - m * weight;
    }
    if (!(weights > 0)) return {};
    return {width / weights, opposed / weights, normalized(towards), true};
  }
};

/// Takes the distance's ridge out: f - f^2 / width is the product of the distances from both sheets over their sum,
/// which is as smooth as they are, has the same zeros, and the same slope there.
struct SmoothRidge {
  static constexpr float farthest = 2.5f;  ///< voxels: what is added grows no more

  DistanceSamples samples;
  float level;
  const float* ridge;
  float* value;  ///< in and out

  NACRE_HD void operator()(std::int64_t i) const {
    const float f = (value[i] - level) / samples.slope, voxel = samples.largest();
    if (f == 0 || std::fabs(f) >= MeasureRidge::band * voxel) return;
    const float k = around(samples.voxel(i), ridge[i]);
    const float most = farthest * voxel, bend = min(k * f, 0.5f);  // no more: the voxel stays on its side
    value[i] -= bend * f * min(1.0f, most * most / (f * f)) * samples.slope;
  }

 private:
  /// The mean of what a voxel and its six neighbours know: one that lies on a ridge itself knows nothing, at the rim of
  /// a ridge few do, and what a single one measures is rough.
  NACRE_HD float around(const Int3& v, float own) const {
    const bool knows = own != MeasureRidge::unknown;
    float sum = knows ? own : 0, known = knows ? 1 : 0;
    for (int k = 0; k < 6; ++k) {
      Int3 other = v;
      other[k / 2] += k % 2 ? 1 : -1;
      if (!samples.inside(other)) continue;
      const float c = ridge[samples.number(other)];
      if (c != MeasureRidge::unknown) sum += c, ++known;
    }
    return known == 0 ? 0 : sum / (knows ? known : max(known, 3.0f));
  }
};

struct IsOnRidge {
  const float* ridge;
  NACRE_HD std::int64_t operator()(std::int64_t i) const {
    return ridge[i] != MeasureRidge::unknown && ridge[i] != 0 ? 1 : 0;
  }
};

/// The upper one of the two in the middle; changes their order.
inline float median(std::vector<float>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Voxels before which the level lies, along any axis.
inline std::vector<Int3> level_crossings(const Int3& dims, std::span<const float> values, float level) {
  std::vector<Int3> crossings;
  const std::array<std::int64_t, 3> ahead{1, dims.x, std::int64_t(dims.x) * dims.y};
  std::int64_t i = 0;
  for (int z = 0; z < dims.z; ++z)
    for (int y = 0; y < dims.y; ++y)
      for (int x = 0; x < dims.x; ++x, ++i) {
        const bool below = values[i] < level;
        if ((x + 1 < dims.x && (values[i + ahead[0]] < level) != below) ||
            (y + 1 < dims.y && (values[i + ahead[1]] < level) != below) ||
            (z + 1 < dims.z && (values[i + ahead[2]] < level) != below))
          crossings.push_back({x, y, z});
      }
  return crossings;
}

/// Slope at a voxel by the larger one of the two differences along each axis, which does not reach across a ridge.
inline float steepest_slope(const DistanceSamples& samples, const Int3& v) {
  Vec3f steepest;
  for (int k = 0; k < 6; ++k) {
    const int axis = k / 2;
    Int3 next = v;
    next[axis] += k % 2 ? 1 : -1;
    if (!samples.inside(next)) continue;
    const float rise = samples.value[samples.number(next)] - samples.value[samples.number(v)];
    steepest[axis] = std::max(steepest[axis], std::fabs(rise) / samples.spacing[axis]);
  }
  return length(steepest);
}

/// Slopes at a voxel and over the next two voxels downhill, on either side of the level; false where there is no
/// gradient.
inline bool slopes_downhill(const DistanceSamples& samples, const Int3& v, float level, float& here, float& downhill) {
  for (const float sign : {1.0f, -1.0f}) {
    const LevelSide side{level, sign / samples.slope};
    Vec3f g;
    if (!samples.gradient(v, side, g)) continue;
    here = length(g);
    Int3 step;
    for (int axis = 0; axis < 3; ++axis) step[axis] = int(std::lround(-2 * g[axis] / here));
    if (!samples.inside(v + step)) return false;
    const float fall = samples.at(v, side) - samples.at(v + step, side);
    downhill = -fall * here / dot(g, Vec3f(step) * samples.spacing);
    return true;
  }
  return false;
}

}  // namespace detail

/// Slope of a scalar volume that is a signed distance, of either sign and in any unit, near a level: per smallest
/// spacing. 0 if it is none: if the values beside it do not grow alike there and over two voxels (within a fifth, in
/// four fifths of the voxels), as those of scanners do not, nor distances that were made soft. `spacing` per axis, in
/// units of the smallest.
inline float distance_slope(const Int3& dims, const Vec3f& spacing, std::span<const float> values, float level) {
  const std::vector<Int3> crossings = detail::level_crossings(dims, values, level);
  if (crossings.empty()) return 0;
  detail::DistanceSamples samples{values.data(), dims, spacing, 1};
  std::vector<float> slopes;
  for (const Int3& v : crossings) slopes.push_back(detail::steepest_slope(samples, v));
  samples.slope = detail::median(slopes);
  if (!(samples.slope > 0)) return 0;
  std::vector<float> here, downhill;
  for (const Int3& v : crossings) {
    float a = 0, b = 0;
    if (!detail::slopes_downhill(samples, v, level, a, b)) continue;
    here.push_back(a);
    downhill.push_back(b);
  }
  const std::size_t measured = here.size();
  if (2 * measured < crossings.size()) return 0;  // the others are at the volume's faces, or on a ridge
  slopes = here;
  const float usual = detail::median(slopes);
  std::size_t alike = 0;
  for (std::size_t k = 0; k < measured; ++k)
    alike += std::fabs(here[k] - usual) <= 0.2f * usual && std::fabs(downhill[k] - usual) <= 0.2f * usual;
  return double(alike) >= 0.8 * double(measured) ? usual * samples.slope : 0;
}

/// Makes `value`, a signed distance on the device with this `slope`, readable between voxels where two parts of a
/// surface face each other (method 14). Returns in how many voxels such a part is seen.
template <class Backend>
std::int64_t smooth_ridges(Executor<Backend>& exec, const Int3& dims, const Vec3f& spacing, Array<float>& value,
                           float level, float slope) {
  Arena::Scope scope(exec.arena());
  Array<float> ridge = exec.arena().template temporary<float>(value.size());
  const detail::DistanceSamples samples{value.data(), dims, spacing, slope};
  const auto n = std::int64_t(value.size());
  exec.for_each(n, detail::MeasureRidge{samples, level, ridge.data()});
  exec.for_each(n, detail::SmoothRidge{samples, level, ridge.data(), value.data()});
  return exec.reduce(n, std::int64_t(0), detail::IsOnRidge{ridge.data()}, Add{});
}

}  // namespace nacre
