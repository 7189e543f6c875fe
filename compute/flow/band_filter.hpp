// Nacre: noise, extension, contrast, sharpening and jitter on a band of cells (sec. 6.2.1): plain 3-D operators.
#pragma once

#include "compute/device/random.hpp"
#include "compute/embedding/band.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/flow/filter.hpp"
#include "compute/flow/sample_band.hpp"
#include "compute/math/morton.hpp"

namespace nacre {

/// White noise of the cell that holds a cell's closest point: it does not change along normals, as if it were extended.
template <class View>
NACRE_HD_INLINE float extended_noise(const View& view, const Int3& position, CellIndex cell, std::uint32_t seed,
                                     std::uint32_t step) {
  const Int3 home = closest_point_of(position, view.point[cell], view.quantum).cell();
  const std::uint64_t code = morton(home);
  return float(philox(std::uint32_t(code), std::uint32_t(code >> 32), seed ^ (step * 0x85EBCA6Bu)).a >> 8) *
         (1.0f / 16777216.0f);
}

/// Noise to begin with, in several arrays at once.
template <class View>
struct FillBandNoise {
  View view;
  std::uint32_t seed;
  float *value, *carried;
  NACRE_HD void operator()(CellIndex s, CellIndex cell, const Int3& position, typename View::Cursor&) const {
    value[s] = carried[s] = extended_noise(view, position, cell, seed, 0);
  }
};

/// Normalises the thesis's deposits and extends the result: in each surface cell the mean of what was deposited around
/// its closest point, sums and hits both weighted by a quadratic B-spline, so that the mean is exact. This filters the
/// lines as antialiasing does; linear weights would smooth more between cells than at them, and leave beads.
template <class View>
struct NormaliseAndExtend {
  View view;
  const std::uint64_t* sums;
  const float* otherwise;  ///< the value of a cell around which nothing was deposited: nothing goes black
  float share;             ///< of the mean in the result; the rest is `otherwise`
  float* value;            ///< 0..1; may be `otherwise` itself

  NACRE_HD void operator()(CellIndex s, CellIndex cell, const Int3& position, typename View::Cursor& cursor) const {
    float sum = 0, hits = 0;
    const SplineWeights weights(closest_point_of(position, view.point[cell], view.quantum));
    cursor.each_surface_of_27(weights.first, [&](int k, CellIndex at) {
      const std::uint64_t d = sums[at];
      const float w = weights.w[0][k % 3] * weights.w[1][k / 3 % 3] * weights.w[2][k / 9];
      sum += w * float(Deposit::value(d));
      hits += w * float(Deposit::weight(d));
    });
    const float before = otherwise[s], mean = hits > 1e-6f ? clamp01(sum / (65535.0f * hits)) : before;
    value[s] = before + (mean - before) * share;
  }
};

/// Number, sum and sum of squares of the values in each brick: the raw material of local contrast.
struct BrickMoments {
  BrickOctreeView view;
  const float* value;
  Float4* moments;  ///< per brick
  std::size_t scratch_bytes() const { return 0; }

  struct Sum {
    float n = 0, sum = 0, squares = 0;
    NACRE_HD Sum operator+(const Sum& b) const { return {n + b.n, sum + b.sum, squares + b.squares}; }
  };

  NACRE_HD void operator()(Team& team, std::int64_t b) const {
    const CellMask& mask = view.brick[b].surface;
    const Sum sum = team.sum(mask.count(), Sum{}, [&](int k) {
      const float v = value[mask.first + k];
      return Sum{1, v, v * v};
    });
    if (team.first()) moments[b] = {sum.n, sum.sum, sum.squares, 0};
  }
};

/// Local moments around a cell, linear between the centres of the bricks.
struct LocalBrickMoments {
  const Float4* moments;

  NACRE_HD Vec3f at(const BrickOctreeView& view, const Int3& position, BrickOctreeView::Cursor& cursor) const {
    const std::uint32_t* neighbour = view.neighbour + 27 * std::size_t(cursor.brick_of(position));
    int side[3];
    float f[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float x = (float(position[axis] & 7) + 0.5f) / 8 - 0.5f;  // from the brick's centre, in bricks
      side[axis] = x < 0 ? -1 : 1;
      f[axis] = std::fabs(x);
    }
    Vec3f sum{};
    for (int k = 0; k < 8; ++k) {
      const int x = k & 1 ? side[0] : 0, y = k & 2 ? side[1] : 0, z = k & 4 ? side[2] : 0;
      const std::uint32_t b = neighbour[13 + x + 3 * y + 9 * z];
      if (b == none) continue;
      const float w = (k & 1 ? f[0] : 1 - f[0]) * (k & 2 ? f[1] : 1 - f[1]) * (k & 4 ? f[2] : 1 - f[2]);
      sum += Vec3f(moments[b].x, moments[b].y, moments[b].z) * w;
    }
    return sum;
  }
};

/// Without bricks there is no local window: only the whole texture counts.
struct NoLocalMoments {
  template <class View>
  NACRE_HD Vec3f at(const View&, const Int3&, typename View::Cursor&) const {
    return {};
  }
};

/// `equalised` on a band. `detail` may be `value` itself.
template <class View, class Local>
struct EqualiseBand {
  View view;
  const float* value;
  Local moments;
  const TextureSpread* whole;
  float local;
  float* detail;

  NACRE_HD void operator()(CellIndex s, CellIndex, const Int3& position, typename View::Cursor& cursor) const {
    detail[s] = equalised(value[s], moments.at(view, position, cursor), *whole, local);
  }
};

/// What the next step's particles carry: sharpened by the plain 3-D Laplacian of the extended values, clamped,
/// jittered. A neighbour that the surface does not pass through has the value at its own closest point.
template <class View>
struct SharpenBand {
  View view;
  const float* detail;
  float sharpen, jitter;
  std::uint32_t seed, step;
  float* carried;

  NACRE_HD void operator()(CellIndex s, CellIndex cell, const Int3& position, typename View::Cursor& cursor) const {
    const float white_noise = 0.28867513f;  // its standard deviation
    const float own = detail[s];
    float laplacian = 0;
    for (int k = 0; k < 6 && sharpen > 0; ++k) {
      Int3 next = position;
      next[k / 2] += k & 1 ? 1 : -1;
      laplacian += extended(next, own, cursor) - own;
    }
    const float sharp = clamp01(0.5f + white_noise * (own - sharpen * laplacian));
    carried[s] = sharp + jitter * (extended_noise(view, position, cell, seed, step + 1) - sharp);
  }

  NACRE_HD_INLINE float extended(const Int3& position, float missing, typename View::Cursor& cursor) const {
    const CellIndex surface = cursor.find_surface(position);
    if (surface != no_cell) return detail[surface];
    const CellIndex cell = cursor.find(position);
    if (cell == no_cell) return missing;
    return sample_near(cursor, detail, closest_point_of(position, view.point[cell], view.quantum), missing);
  }
};

}  // namespace nacre
