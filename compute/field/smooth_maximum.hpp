// Nacre: a smooth maximum of several functions, how far each is inside of the others, and how far a point is from where
// all of them meet (sec. 3.6, Eq. 3.7-3.12).
#pragma once

#include <cmath>

#include "compute/device/backend.hpp"
#include "compute/field/material_bricks.hpp"

namespace nacre {

/// Functions that differ by much more than this do not mix. The maximum of two is at most 0.15 times as much too small,
/// which leaves the cell indicator below its tolerance of 1e-5 on a surface that passes close by a third material.
inline constexpr float maximum_smoothing = 0.01f;

/// The share of one function in the smooth maximum, and in its gradient. Shares are added up in any order.
struct SmoothShare {
  float weight = 0;  ///< P_i, the product of g(v_i - v_j) over j != i
  float value = 0;   ///< P_i v_i
  Vec3f slope;       ///< P_i grad v_i + v_i grad P_i
  Vec3f drift;       ///< grad P_i

  NACRE_HD friend SmoothShare operator+(const SmoothShare& a, const SmoothShare& b) {
    return {a.weight + b.weight, a.value + b.value, a.slope + b.slope, a.drift + b.drift};
  }
};

/// The share of f[i] among f[0] .. f[m - 1] without f[skip] (-1: all of them). Eq. 3.10 and 3.11 with g(x) = 1 + s(x),
/// s(x) = x / sqrt(x^2 + smoothing^2), and the product over k != i, j that is misprinted as a sum: each of its terms is
/// P_i g'/g. Values are taken relative to `reference`, so that little is lost when the shares are put together.
NACRE_HD inline SmoothShare smooth_share(const FieldSample* f, int m, int skip, int i, float reference) {
  constexpr float ee = maximum_smoothing * maximum_smoothing;
  float product = 1;
  Vec3f relative;  // grad P_i / P_i
  for (int j = 0; j < m; ++j) {
    if (j == i || j == skip) continue;
    const float x = f[i].value - f[j].value;
    const float rr = x * x + ee, r = std::sqrt(rr);
    // r + x and r - x are each other's inverses but for ee: the larger one is computed, the other follows without loss.
    const float larger = r + std::fabs(x), smaller = ee / larger;
    product *= (x > 0 ? larger : smaller) / r;
    relative += (f[i].gradient - f[j].gradient) * ((x > 0 ? smaller : larger) / rr);
  }
  const float v = f[i].value - reference;
  const Vec3f drift = relative * product;
  return {product, product * v, f[i].gradient * product + drift * v, drift};
}

/// The maximum that the shares of all functions add up to. Divided by the sum of the products, not by 2^(m-1): right
/// where several functions are equal, too.
NACRE_HD inline FieldSample smooth_maximum(const SmoothShare& all, float reference) {
  const float value = all.value / all.weight;
  return {reference + value, (all.slope - all.drift * value) / all.weight};
}

/// Smooth maximum of f[0] .. f[m - 1] without f[skip]; at least one must be left. Never above the largest, and equal to
/// it where all that matter are equal.
NACRE_HD inline FieldSample smooth_maximum(const FieldSample* f, int m, int skip = -1) {
  const float reference = f[skip == 0 ? 1 : 0].value;
  SmoothShare all;
  for (int i = 0; i < m; ++i)
    if (i != skip) all = all + smooth_share(f, m, skip, i, reference);
  return smooth_maximum(all, reference);
}

/// Inside/outside function of material i (Eq. 3.7): above zero in the material, below zero elsewhere. m >= 2.
NACRE_HD inline FieldSample inside_outside(const FieldSample* f, int m, int i) {
  const FieldSample others = smooth_maximum(f, m, i);
  return {f[i].value - others.value, f[i].gradient - others.gradient};
}

/// Cell indicator J of a junction and its gradient (Eq. 3.8, 3.9): the sum of the squares of its materials'
/// inside/outside functions; zero on the junction and nowhere else.
NACRE_HD inline FieldSample cell_indicator(const FieldSample* inside, int count) {
  FieldSample j;
  for (int k = 0; k < count; ++k) {
    j.value += inside[k].value * inside[k].value;
    j.gradient += inside[k].gradient * (2 * inside[k].value);
  }
  return j;
}

}  // namespace nacre
