// Nacre: noise, contrast, sharpening and jitter of the texture (sec. 5.2.3).
#pragma once

#include "compute/device/executor.hpp"
#include "compute/device/random.hpp"
#include "compute/device/ranks.hpp"
#include "compute/flow/deposit.hpp"
#include "compute/math/packet.hpp"

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
    const int n = b == none ? 0 : texture.surface_cells_in(b);
    for (int k = 0; k < n; ++k) {
      const float v = value[texture.first_surface_cell[b] + k];
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
/// diverging flow stretches would grow into blotches, step by step. Of one value or several.
template <class Float>
NACRE_HD_INLINE Float equalised(const Float& value, const Vec3<Float>& around, const TextureSpread& whole,
                                float local) {
  const Float zero = around.x * 0.0f, one = zero + 1.0f;
  const auto values = around.x > 0.0f;
  const Float share = select(values, zero + local, zero), inverse = one / select(values, around.x, one);
  const Float mean = around.y * inverse, variance = multiply_add(-mean, mean, around.z * inverse);
  const Float deviation = square_root(select(variance > 0.0f, variance, zero));
  const Float least = zero + 0.25f * whole.deviation;  // a plain region stays plain
  const Float spread = select(deviation > least, deviation, least);
  return (value - multiply_add(share, mean - whole.mean, zero + whole.mean)) /
         multiply_add(share, spread - whole.deviation, zero + whole.deviation);
}

/// `equalised` on the grid: a team per block, with the moments in the closest-point cells around it.
struct Equalise {
  RefinedGridView texture;
  const float* value;
  const Float4* moments;  ///< of the values in each closest-point cell and around
  const TextureSpread* whole;
  float local;
  float* detail;

  using Wide = Widest;
  using Float = Wide::Float;
  using Int = Wide::Int;

  struct Near {
    float number[32], sum[32], squares[32];  ///< 27 each
  };
  static constexpr std::size_t scratch_bytes() { return sizeof(Near); }

  NACRE_HD void operator()(Team& team, std::int64_t b) const {
    const int count = texture.surface_cells_in(b);
    if (count == 0) return;
    Near& near = *reinterpret_cast<Near*>(team.scratch());
    {
      const MomentsAround around(texture.grid, texture.grid.cell(texture.block_cell[b]), moments);
      team.each(27, [&](int k) {
        const Float4 m = around.at(k % 3, k / 3 % 3, k / 9);
        near.number[k] = m.x, near.sum[k] = m.y, near.squares[k] = m.z;
      });
    }
    const std::uint32_t first = texture.first_surface_cell[b], corner = std::uint32_t(b) * texture.cells_per_block();
    team.each((count + Wide::lanes - 1) / Wide::lanes, [&](int packet) {
      const int begin = packet * Wide::lanes;
      const Int s = counted<Wide>(begin, count - 1);
      const Int in = gather(texture.position + first, s, Wide::nothing_masked()) - std::int32_t(corner);
      const Int row = texture.divide(in), layer = texture.divide(row);
      const Vec3<Float> p = Vec3<Float>{to_float(in - row * texture.refine) + 0.5f,
                                        to_float(row - layer * texture.refine) + 0.5f, to_float(layer) + 0.5f} *
                            Wide::all(texture.inverse_refine);
      const Float result = equalised(gather(value + first, s), interpolated(near, p), *whole, local);
      for (int lane = 0; lane < Wide::lanes && begin + lane < count; ++lane)
        detail[first + begin + lane] = element(result, lane);
    });
  }

  /// Linear among the 27, at `p` from the lowest corner of the middle one.
  NACRE_HD_INLINE static Vec3<Float> interpolated(const Near& near, const Vec3<Float>& p) {
    const auto low = [](const Float& x) { return select(x < 0.5f, Wide::all(0), Wide::all(1)); };
    const Vec3<Int> first{low(p.x), low(p.y), low(p.z)};
    const auto part = [](const Float& x, const Int& i) { return x + 0.5f - to_float(i); };
    const Vec3<Float> f{part(p.x, first.x), part(p.y, first.y), part(p.z, first.z)};
    const Int at = (first.z * 3 + first.y) * 3 + first.x;
    const auto of = [&](const float* moment) {
      const auto row = [&](int k) {
        const Float a = gather_of_32(moment, at + k);
        return multiply_add(gather_of_32(moment, at + (k + 1)) - a, f.x, a);
      };
      const auto layer = [&](int k) {
        const Float a = row(k);
        return multiply_add(row(k + 3) - a, f.y, a);
      };
      const Float a = layer(0);
      return multiply_add(layer(9) - a, f.z, a);
    };
    return {of(near.number), of(near.sum), of(near.squares)};
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
