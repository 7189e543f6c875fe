// Nacre: Turing patterns: two substances that react and diffuse, and make spots or stripes of noise.
#pragma once

#include <cmath>

#include "compute/device/random.hpp"
#include "compute/embedding/refined_grid.hpp"
#include "compute/flow/filter.hpp"
#include "compute/flow/surface_diffusion.hpp"

namespace nacre {

/// FitzHugh-Nagumo kinetics with a quadratic term, an activator u and an inhibitor v:
///   u' = u + bias u^2 - u^3 - v,   v' = feed u - decay v
/// Turing's instability (1952) makes a pattern of its zero state where the inhibitor diffuses fast enough. The
/// quadratic term decides between stripes (0) and spots (Barrio et al., Bull. Math. Biol. 61, 1999).
struct TuringReaction {
  float feed, decay, bias;

  static constexpr float most = 1.5f;  ///< |u|, |v| stay below it: patterns reach about 1

  NACRE_HD Pair operator()(const Pair& p) const {
    return {p.u * (1 + p.u * (bias - p.u)) - p.v, feed * p.u - decay * p.v};
  }

  /// The largest rates at which u and v decay by themselves, for |u| <= most: -d(u')/du and -d(v')/dv.
  double decay_of_u() const { return double(most) * (3 * double(most) + 2 * double(bias)) - 1; }
  double decay_of_v() const { return decay; }
};

/// A reaction, how it diffuses, and what it needs.
struct TuringPattern {
  TuringReaction reaction;
  double ratio;               ///< diffusivity of the inhibitor by that of the activator
  float share_u, share_v;     ///< of the tensor's extra part; see Diffusivities
  double formation, renewal;  ///< time that it takes to form from noise; time of a step of the data

  /// Wave number that grows fastest from the zero state, times sqrt(diffusivity of u): at the middle of the unstable
  /// ones, k^2 = (ratio - decay) / (2 ratio) of the linear system.
  double wave_number() const { return std::sqrt((ratio - double(reaction.decay)) / (2 * ratio)); }

  /// For a wavelength of `spacing` cells across the vectors.
  Diffusivities diffusivities(double spacing) const {
    const double root = wave_number() * spacing / (2 * 3.14159265358979323846);
    return {float(root * root), float(ratio * root * root), share_u, share_v};
  }

  /// The longest explicit step in which no value takes more than itself away: by diffusion (Gershgorin's bound of the
  /// operator at hand) and by reaction.
  double stable_step(double spacing, double largest_row) const {
    const DiffusionRates rates(diffusivities(spacing), largest_row);
    return 1 / std::fmax(rates.u + reaction.decay_of_u(), rates.v + reaction.decay_of_v());
  }
};

/// Spots are stretched as a whole: both substances diffuse along the vectors. Stripes are turned along the vectors by
/// the activator alone, which needs less (Shoji et al., J. Theor. Biol. 224, 2003).
inline TuringPattern spots_pattern() { return {{1.6f, 1.2f, 0.75f}, 4, 1, 1, 30, 3}; }
inline TuringPattern stripes_pattern() { return {{1.4f, 1.2f, 0}, 4, 0.25f, 0, 25, 3}; }

/// Noise to begin with, for the first extension.
struct FillPatternNoise {
  std::uint32_t seed;
  const std::uint32_t* inner;
  Pair* change;
  NACRE_HD void operator()(std::int64_t i) const { change[inner[i]] = {2 * uniform_random(seed, inner[i], 0) - 1, 0}; }
};

/// The activator at the closest point of each surface cell of the texture, by cubic interpolation; -most..most become
/// 0..1.
struct SamplePattern {
  RefinedGridView texture;
  const Pair* value;
  float* out;
  NACRE_HD void operator()(std::int64_t s) const {
    CubicCells cells;
    const bool found = cells.find(texture.grid, texture.seed_point(std::uint32_t(s)) * texture.inverse_refine);
    const float u = found ? cells.interpolate(texture.grid, value).u : 0.0f;
    out[s] = clamp01(0.5f + u * (0.5f / TuringReaction::most));
  }
};

/// How far each value is from the mean of all, in standard deviations, and less than that: a pattern has two levels,
/// one deviation from the mean each, and neither is to be black or white.
struct Standardise {
  static constexpr float share = 0.65f;

  const float* value;
  const TextureSpread* whole;
  float* detail;
  NACRE_HD void operator()(std::int64_t i) const { detail[i] = (value[i] - whole->mean) * (share / whole->deviation); }
};

}  // namespace nacre
