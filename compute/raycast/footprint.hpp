// Nacre: the texture as it is seen from afar: the mean over what a ray stands for, so that nothing shimmers when the
// camera moves.
#pragma once

#include <cmath>

#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/refined_grid.hpp"
#include "compute/embedding/thesis_octree.hpp"

namespace nacre {

/// A parallelogram of the surface around a hit.
struct Footprint {
  Vec3f across{}, up{};

  NACRE_HD_INLINE Footprint operator*(float s) const { return {across * s, up * s}; }

  /// Moves its sides along a ray onto the plane with this unit normal.
  NACRE_HD Footprint on_surface(const Vec3f& along, const Vec3f& normal) const {
    constexpr float grazing = 0.1f;  // so flat is what is nearly parallel to the ray
    float slope = dot(normal, along);
    slope = slope < 0 ? min(slope, -grazing * length(along)) : max(slope, grazing * length(along));
    return {across - along * (dot(normal, across) / slope), up - along * (dot(normal, up) / slope)};
  }
};

inline constexpr float no_value = -1;  ///< where a look-up finds none; values are 0..1

namespace detail {

NACRE_HD_INLINE int taps(float length, int most) {
  const int n = int(std::ceil(length - 0.25f));
  return n < 1 ? 1 : n < most ? n : most;
}

/// The mean of what `at` finds on a lattice of nx by ny points of the footprint.
template <class At>
NACRE_HD float mean_of(const Footprint& f, int nx, int ny, const At& at) {
  float sum = 0;
  int count = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const float x = (float(i) + 0.5f) / float(nx) - 0.5f, y = (float(j) + 0.5f) / float(ny) - 0.5f;
      const float value = at(f.across * x + f.up * y);
      if (value < 0) continue;
      sum += value;
      ++count;
    }
  return count ? sum / float(count) : 0.5f;
}

}  // namespace detail

/// The shown value over a footprint (in texture cells): the mean of samples a cell apart or less; where a cell is far
/// smaller than the footprint, of samples of the means over cubes `width` cells wide (0: there are none). Both are
/// blended where the one passes over into the other. `fine` and `coarse` look up at an offset from the footprint's
/// middle.
template <class Fine, class Coarse>
NACRE_HD float filtered(const Footprint& f, float width, const Fine& fine, const Coarse& coarse) {
  constexpr int most = 8;
  const float a = length(f.across), b = length(f.up), narrow = min(a, b);
  const float share = width > 1 ? (narrow - 0.5f * width) / (0.25f * width) : 0.0f;
  const float blend = share < 0 ? 0.0f : share > 1 ? 1.0f : share;
  float value = 0;
  if (blend < 1) value += (1 - blend) * detail::mean_of(f, detail::taps(a, most), detail::taps(b, most), fine);
  if (blend > 0)
    value += blend * detail::mean_of(f, detail::taps(a / width, most), detail::taps(b / width, most), coarse);
  return value;
}

/// The mean of the values in each block of the grid; `no_value` where no surface cell is in it.
struct BlockMeans {
  RefinedGridView texture;
  const float* value;
  float* mean;
  NACRE_HD void operator()(std::int64_t b) const {
    const int count = texture.surface_cells_in(b);
    const float* values = value + texture.first_surface_cell[b];
    float sum = 0;
    for (int k = 0; k < count; ++k) sum += values[k];
    mean[b] = count ? sum / float(count) : no_value;
  }
};

/// Means of blocks at a point in closest-point cells, linear among the eight around it of those that have one.
NACRE_HD inline float sample_means(const RefinedGridView& texture, const float* mean, const Vec3f& p) {
  const Int3 first = floor_cell(p - Vec3f(0.5f));
  const Vec3f f = p - cell_centre(first);
  float sum = 0, weight = 0;
  for (int k = 0; k < 8; ++k) {
    const int x = k & 1, y = k >> 1 & 1, z = k >> 2;
    const std::uint32_t block = texture.block_of(first + Int3(x, y, z));
    const float value = block == none ? no_value : mean[block];
    if (value < 0) continue;
    const float w = (x ? f.x : 1 - f.x) * (y ? f.y : 1 - f.y) * (z ? f.z : 1 - f.z);
    sum += w * value;
    weight += w;
  }
  return weight > 1e-3f ? sum / weight : no_value;
}

inline constexpr float brick_means_width = BrickOctreeView::width;

/// The mean of the values in each brick of the octree.
struct BrickMeans {
  BrickOctreeView view;
  const float* value;
  float* mean;
  NACRE_HD void operator()(std::int64_t b) const {
    const CellMask& mask = view.brick[b].surface;
    float sum = 0;
    int count = 0;
    for (int z = 0; z < BrickOctreeView::width; ++z) count += count_bits(mask.word[z]);
    for (int k = 0; k < count; ++k) sum += value[mask.first + k];
    mean[b] = count ? sum / float(count) : no_value;
  }
};

/// Means of bricks, linear among the eight around a point.
NACRE_HD inline float sample_brick_means(const BrickOctreeView& view, const float* mean, const BandPoint& p) {
  constexpr int width = BrickOctreeView::width;
  const Int3 corner = p.cell() - Int3(width / 2);
  const Int3 first{corner.x >> 3, corner.y >> 3, corner.z >> 3};
  const Vec3f f = (Vec3f(p.base - first * Int3(width)) + p.local) * (1.0f / width) - Vec3f(0.5f);
  BrickOctreeView::Cursor cursor(view);
  float sum = 0, weight = 0;
  for (int k = 0; k < 8; ++k) {
    const Int3 bit{k & 1, k >> 1 & 1, k >> 2};
    const std::uint32_t brick = cursor.brick_of((first + bit) * Int3(width));
    const float value = brick == none ? no_value : mean[brick];
    if (value < 0) continue;
    const float w = (bit.x ? f.x : 1 - f.x) * (bit.y ? f.y : 1 - f.y) * (bit.z ? f.z : 1 - f.z);
    sum += w * value;
    weight += w;
  }
  return weight > 1e-3f ? sum / weight : no_value;
}

/// The octree of the thesis keeps none.
NACRE_HD_INLINE float sample_brick_means(const ThesisOctreeView&, const float*, const BandPoint&) { return no_value; }

}  // namespace nacre
