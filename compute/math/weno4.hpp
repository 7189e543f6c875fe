// Nacre: WENO4 interpolation (thesis, Alg. 5.2, 5.3; Macdonald & Ruuth 2008).
#pragma once

#include "compute/device/backend.hpp"

namespace nacre {

/// Value at `x` in [0, 1] between f2 (x = 0) and f3 (x = 1) from four equidistant samples: the two parabolas through f1
/// f2 f3 and f2 f3 f4, weighted by the smoothness IS = Fx (Fx + Fxx) + 4/3 Fxx^2 (Alg. 5.3; Alg. 4.2, line 3, is
/// misprinted). It is third order in general and fourth order where smooth, with no significant overshoot across a
/// jump. `V` is a float or lanes of floats. The epsilon of the smoothness is absolute, so values must be in units of a
/// cell. The two quotients w_i v_i / (w_1 + w_2) are put over one denominator, so there is one division.
template <class V>
NACRE_HD_INLINE V weno4(V f1, V f2, V f3, V f4, float x) {
  const float epsilon = 1e-6f;
  const V left_slope = (f3 - f1) * 0.5f;
  const V left_curve = f1 - f2 * 2.0f + f3;
  const V right_slope = (f2 - f4) * 0.5f;  // mirrored: seen from f3 towards f2
  const V right_curve = f4 - f3 * 2.0f + f2;
  V left = left_slope * (left_slope + left_curve) + left_curve * left_curve * (4.0f / 3.0f) + epsilon;
  V right = right_slope * (right_slope + right_curve) + right_curve * right_curve * (4.0f / 3.0f) + epsilon;
  const float y = 1.0f - x;
  const V left_value = f2 + (left_slope + left_curve * (0.5f * x)) * x;
  const V right_value = f3 + (right_slope + right_curve * (0.5f * y)) * y;
  const V left_weight = right * right * (2.0f - x);  // (2 - x) / left^2, times left^2 right^2
  const V right_weight = left * left * (1.0f + x);
  return (left_weight * left_value + right_weight * right_value) / (left_weight + right_weight);
}

}  // namespace nacre
