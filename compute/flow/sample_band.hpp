// Nacre: a value of the texture anywhere on the surface, from the surface cells of a band.
#pragma once

#include "compute/embedding/band.hpp"

namespace nacre {

/// `values` (one per surface cell) at `p`, linear among those of the 2^3 cells around it that are surface cells, their
/// weights brought to a sum of one; `missing` where none is.
template <class Cursor>
NACRE_HD float sample_near(Cursor& cursor, const float* values, const BandPoint& p, float missing) {
  const LinearWeights weights(p);
  CellIndex at[8];
  const unsigned there = cursor.eight_surface(weights.first, at);
  float sum = 0, weight = 0;
  for (int k = 0; k < 8; ++k) {
    if (!(there >> k & 1)) continue;
    sum += weights[k] * values[at[k]];
    weight += weights[k];
  }
  return weight > 0 ? sum / weight : missing;
}

/// The same anywhere in the band.
template <class View>
NACRE_HD float sample_band(const View& view, const float* values, const BandPoint& p, float missing) {
  typename View::Cursor cursor(view);
  return sample_near(cursor, values, p, missing);
}

}  // namespace nacre
