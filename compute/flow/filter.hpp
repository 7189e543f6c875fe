// Nacre: noise, contrast, sharpening and jitter of the texture (sec. 5.2.3).
#pragma once

#include "compute/device/executor.hpp"
#include "compute/device/random.hpp"
#include "compute/device/ranks.hpp"
#include "compute/flow/deposit.hpp"

namespace nacre {

/// White noise to begin with.
struct FillNoise {
  std::uint32_t seed;
  float* value;
  NACRE_HD void operator()(std::int64_t i) const { value[i] = uniform_random(seed, std::uint32_t(i), 0); }
};

/// Sum and sum of squares of 16-bit values: exact, hence the same on any number of threads.
struct Moments {
  std::uint64_t sum = 0, squares = 0;

  NACRE_HD float mean(std::int64_t n) const { return n ? float(double(sum) / double(n) / 65535.0) : 0.5f; }
  NACRE_HD float deviation(std::int64_t n) const {
    if (n == 0) return 0;
    const double m = double(sum) / double(n);
    const double variance = double(squares) / double(n) - m * m;
    return float(std::sqrt(variance > 0 ? variance : 0) / 65535.0);
  }
};

struct MomentsOf {
  const float* value;
  NACRE_HD Moments operator()(std::int64_t i) const {
    const std::uint64_t v = Deposit::quantise(value[i]);
    return {v, v * v};
  }
};

struct AddMoments {
  NACRE_HD Moments operator()(const Moments& a, const Moments& b) const {
    return {a.sum + b.sum, a.squares + b.squares};
  }
};

/// Mean and deviation of a whole texture; the deviation is above 0.
struct TextureSpread {
  float mean, deviation;
};

/// ... from its moments, where these are: the host need not wait for them.
struct SpreadOf {
  const Moments* moments;
  std::int64_t n;
  TextureSpread* spread;
  NACRE_HD void operator()(std::int64_t) const {
    const float deviation = moments->deviation(n);
    *spread = {moments->mean(n), deviation > 1e-4f ? deviation : 1e-4f};
  }
};

/// Of `n` values; lasts as long as the caller's scope in the arena.
template <class Backend>
const TextureSpread* measure_spread(Executor<Backend>& exec, std::int64_t n, const float* value) {
  Arena& arena = exec.arena();
  const Array<Moments> moments = arena.template temporary<Moments>(1);
  const Array<TextureSpread> spread = arena.template temporary<TextureSpread>(1);
  exec.reduce_into(moments.data(), n, Moments{}, MomentsOf{value}, AddMoments{});
  exec.for_each(1, SpreadOf{moments.data(), n, spread.data()});
  return spread.data();
}

/// The same of the values of several processes, of which this one has `n`. Collective.
template <class Backend>
const TextureSpread* measure_spread(Executor<Backend>& exec, std::int64_t n, const float* value, Ranks& ranks) {
  Arena& arena = exec.arena();
  const Moments own = exec.reduce(n, Moments{}, MomentsOf{value}, AddMoments{});
  std::uint64_t all[] = {own.sum, own.squares, std::uint64_t(n)};
  ranks.sum(all);
  Array<Moments> moments = arena.template temporary<Moments>(1);
  const Moments sum{all[0], all[1]};
  moments.upload({&sum, 1});
  const Array<TextureSpread> spread = arena.template temporary<TextureSpread>(1);
  exec.for_each(1, SpreadOf{moments.data(), std::int64_t(all[2]), spread.data()});
  return spread.data();
}

NACRE_HD inline float clamp01(float x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

/// Number, sum and sum of squares of the values in each closest-point cell: the raw material of local contrast.
struct LocalMoments {
  RefinedGridView texture;
  const float* value;
  Float4* moments;  ///< per closest-point cell: count, sum, sum of squares
  NACRE_HD void operator()(std::int64_t cell) const {
    const std::uint32_t b = texture.block[cell];
    Float4 m{0, 0, 0, 0};
    const int n = b == none ? 0 : texture.cells_per_block();
    for (int k = 0; k < n; ++k) {
      const std::uint32_t s = texture.texel[b * n + k];
      if (s & RefinedGridView::extended) continue;  // beside the surface, or nothing
      const float v = value[s];
      m = {m.x + 1, m.y + v, m.z + v * v, 0};
    }
    moments[cell] = m;
  }
};

/// Moments of the 27 closest-point cells around one; nothing where there is none.
class MomentsAround {
 public:
  NACRE_HD_INLINE MomentsAround(const ClosestPointGridView& grid, const Int3& cell, const Float4* moments)
      : grid_(grid), lowest_(cell - Int3(1)), moments_(moments), whole_(stencil_.find(grid, lowest_)) {}

  NACRE_HD_INLINE Float4 at(int x, int y, int z) const {
    const std::uint32_t at = whole_ ? stencil_.address(grid_, x, y, z) : grid_.address(lowest_ + Int3(x, y, z));
    return at == none ? Float4{0, 0, 0, 0} : moments_[at];
  }

 private:
  const ClosestPointGridView& grid_;
  Int3 lowest_;
  const Float4* moments_;
  Stencil<3> stencil_{};
  bool whole_;  ///< all bricks around are there
};

/// One pass of a (1 2 1)^3 filter over the moments, to widen their window. Cells without a block hold no value and are
/// never asked: they stay empty.
struct BlurMoments {
  RefinedGridView texture;
  const Float4* from;
  Float4* to;
  NACRE_HD void operator()(std::int64_t b) const {
    const std::uint32_t i = texture.block_cell[b];
    const MomentsAround around(texture.grid, texture.grid.cell(i), from);
    Lanes sum = lanes(0, 0, 0);
    for (int z = 0; z < 3; ++z)
      for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
          sum = sum + load(around.at(x, y, z)) * float((x & 1 ? 2 : 1) * (y & 1 ? 2 : 1) * (z & 1 ? 2 : 1));
    to[i] = store(sum);
  }
};

/// How far `value` is from the mean, in standard deviations; mean and deviation are the local ones (`around`: number,
/// sum and sum of squares of the values around) to the share `local`, else those of the whole texture. Otherwise what a
/// diverging flow stretches would grow into blotches, step by step.
NACRE_HD_INLINE float equalised(float value, const Vec3f& around, const TextureSpread& whole, float local) {
  float mean = whole.mean, deviation = whole.deviation;
  if (around.x > 0) {
    const float local_mean = around.y / around.x, variance = around.z / around.x - local_mean * local_mean;
    const float local_deviation = std::sqrt(variance > 0 ? variance : 0);
    const float least = 0.25f * whole.deviation;  // a plain region stays plain
    mean += local * (local_mean - whole.mean);
    deviation += local * ((local_deviation > least ? local_deviation : least) - whole.deviation);
  }
  return (value - mean) / deviation;
}

/// `equalised` on the grid: a team per block, with the moments in the closest-point cells around it.
struct Equalise {
  RefinedGridView texture;
  const float* value;
  const Float4* moments;  ///< of the values in each closest-point cell and around
  const TextureSpread* whole;
  float local;
  float* detail;

  static constexpr std::size_t scratch_bytes() { return 27 * sizeof(Float4); }

  NACRE_HD void operator()(Team& team, std::int64_t b) const {
    auto* near = reinterpret_cast<Float4*>(team.scratch());
    {
      const MomentsAround around(texture.grid, texture.grid.cell(texture.block_cell[b]), moments);
      team.each(27, [&](int k) { near[k] = around.at(k % 3, k / 3 % 3, k / 9); });
    }
    const int refine = texture.refine, cells = texture.cells_per_block();
    team.each(cells, [&](int k) {
      const std::uint32_t s = texture.texel[b * cells + k];
      if (s & RefinedGridView::extended) return;  // beside the surface, or nothing
      const int row = texture.divide(k), layer = texture.divide(row);
      const Int3 in{k - row * refine, row - layer * refine, layer};
      detail[s] = equalised(value[s], interpolated(near, (cell_centre(in)) * texture.inverse_refine), *whole, local);
    });
  }

  /// Linear among the 27, at `p` from the lowest corner of the middle one.
  NACRE_HD_INLINE static Vec3f interpolated(const Float4* near, const Vec3f& p) {
    const Int3 first{p.x < 0.5f ? 0 : 1, p.y < 0.5f ? 0 : 1, p.z < 0.5f ? 0 : 1};
    const Vec3f f = p + Vec3f(0.5f) - Vec3f(first);
    const Float4* low = near + (first.z * 3 + first.y) * 3 + first.x;
    const auto row = [&](int y, int z) {
      const Float4* two = low + (z * 3 + y) * 3;
      return load(two[0]) + (load(two[1]) - load(two[0])) * f.x;
    };
    const auto layer = [&](int z) { return row(0, z) + (row(1, z) - row(0, z)) * f.y; };
    return xyz(layer(0) + (layer(1) - layer(0)) * f.z);
  }
};

/// The frame for the eye: contrast stretched.
struct Show {
  const float* detail;  ///< how far a value is from the mean, in standard deviations
  float contrast;
  float* shown;
  float* output;  ///< the same, for whoever draws it; null: nobody does
  NACRE_HD void operator()(std::int64_t i) const {
    const float frame = clamp01(0.5f + contrast * detail[i]);
    shown[i] = frame;
    if (output) output[i] = frame;
  }
};

/// What the next step's particles carry: sharpened by the Laplacian over the neighbour index, with the spread of white
/// noise, clamped, and jittered by fresh noise that takes the share `jitter`.
struct SharpenAndJitter {
  RefinedGridView texture;
  const float* detail;
  float sharpen, jitter;
  std::uint32_t seed, step;
  float* carried;

  NACRE_HD void operator()(std::int64_t i) const {
    const float white_noise = 0.28867513f;  // its standard deviation
    const std::uint32_t* n = texture.neighbour + 6 * i;
    const float own = detail[i];
    float laplacian = 0;
    for (int k = 0; k < 6; ++k) laplacian += detail[n[k]] - own;  // a neighbour that projects back adds nothing
    const float sharp = clamp01(0.5f + white_noise * (own - sharpen * laplacian));
    const float noise = uniform_random(seed, std::uint32_t(i), step + 1);
    carried[i] = sharp + jitter * (noise - sharp);
  }
};

}  // namespace nacre
