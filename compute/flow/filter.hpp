// Nacre: noise, contrast, sharpening and jitter of the texture (sec. 5.2.3).
#pragma once

#include "compute/device/executor.hpp"
#include "compute/device/random.hpp"
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

/// One pass of a (1 2 1)^3 filter over the moments, to widen their window. Cells without a block hold no value and are
/// never asked: they stay empty.
struct BlurMoments {
  RefinedGridView texture;
  const Float4* from;
  Float4* to;
  NACRE_HD void operator()(std::int64_t b) const {
    const std::uint32_t i = texture.block_cell[b];
    const Int3 cell = texture.grid.cell(i);
    Lanes sum = lanes(0, 0, 0);
    for (int k = 0; k < 27; ++k) {
      const int x = k % 3 - 1, y = k / 3 % 3 - 1, z = k / 9 - 1;
      const std::uint32_t at = texture.grid.address(cell + Int3(x, y, z));
      if (at != none) sum = sum + load(from[at]) * float((2 - x * x) * (2 - y * y) * (2 - z * z));
    }
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

/// `equalised` on the grid.
struct Equalise {
  RefinedGridView texture;
  const float* value;
  const Float4* moments;  ///< of the values in each closest-point cell and around
  const TextureSpread* whole;
  float local;
  float* detail;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f p = cell_centre(texture.cell(std::uint32_t(i))) * texture.inverse_refine;
    Lanes around;
    const bool known = interpolate_linear(texture.grid, moments, p, around);
    detail[i] = equalised(value[i], known ? xyz(around) : Vec3f{}, *whole, local);
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
