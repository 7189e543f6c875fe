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

  float mean(std::int64_t n) const { return n ? float(double(sum) / double(n) / 65535.0) : 0.5f; }
  float deviation(std::int64_t n) const {
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

NACRE_HD inline float clamp01(float x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

/// The shown frame: the normalised one, stretched about its mean.
struct StretchContrast {
  const float* value;
  float mean, gain;
  float* shown;
  NACRE_HD void operator()(std::int64_t i) const { shown[i] = clamp01(0.5f + (value[i] - mean) * gain); }
};

/// What the next step's particles carry: the normalised frame stretched, sharpened by the Laplacian over the neighbour
/// index, clamped, and jittered by fresh noise that takes the share `jitter`.
struct SharpenAndJitter {
  RefinedGridView texture;
  const float* value;
  float mean, gain, sharpen, jitter;
  std::uint32_t seed, step;
  float* carried;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t* n = texture.neighbour + 6 * i;
    const float own = value[i];
    float laplacian = 0;
    for (int k = 0; k < 6; ++k) laplacian += value[n[k]] - own;  // a neighbour that projects back adds nothing
    const float sharp = clamp01(0.5f + gain * (own - mean - sharpen * laplacian));
    const float noise = uniform_random(seed, std::uint32_t(i), step + 1);
    carried[i] = sharp + jitter * (noise - sharp);
  }
};

}  // namespace nacre
