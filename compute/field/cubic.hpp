// Nacre: weights of cubic reconstruction along one axis: values, first and second derivatives.
#pragma once

#include "compute/math/lanes.hpp"

namespace nacre {

/// Catmull-Rom goes through the samples; the B-spline smooths them a little and has continuous second derivatives.
enum class CubicKernel { catmull_rom, b_spline };

/// Weights of the four samples at -1, 0, 1, 2 for a point at f in [0, 1): of the value, of the first and of the second
/// derivative per sample distance (Mitchell & Netravali 1988 with B, C = 0, 1/2 and 1, 0).
struct CubicWeights {
  Lanes value, slope, curve;

  NACRE_HD_INLINE CubicWeights(CubicKernel kernel, float f) {
    const float g = 1 - f;
    if (kernel == CubicKernel::catmull_rom) {
      value = lanes(-0.5f * f * g * g, 1 + f * f * (1.5f * f - 2.5f), 1 + g * g * (1.5f * g - 2.5f), -0.5f * g * f * f);
      slope = lanes(-0.5f * g * (1 - 3 * f), f * (4.5f * f - 5), -g * (4.5f * g - 5), 0.5f * f * (1 - 3 * g));
      curve = lanes(2 - 3 * f, 9 * f - 5, 9 * g - 5, 2 - 3 * g);
    } else {
      const float sixth = 1.0f / 6;
      value = lanes(sixth * g * g * g, sixth * (4 + f * f * (3 * f - 6)), sixth * (4 + g * g * (3 * g - 6)),
                    sixth * f * f * f);
      slope = lanes(-0.5f * g * g, f * (1.5f * f - 2), -g * (1.5f * g - 2), 0.5f * f * f);
      curve = lanes(g, 3 * f - 2, 3 * g - 2, f);
    }
  }
};

}  // namespace nacre
