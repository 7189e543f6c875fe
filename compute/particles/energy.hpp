// Nacre: the energy between two particles (sec. 3.1.2.1; Meyer et al. 2005).
#pragma once

#include <cmath>

#include "compute/device/backend.hpp"

namespace nacre {

inline constexpr float pi = 3.14159265358979f;
inline constexpr float support = 1.7320508f;  ///< 2 cos(pi/6): particles feel each other within support * min(h_i, h_j)

/// E, dE/dd and d2E/dd2 of the cotangent energy at the scaled distance d.
struct PairEnergy {
  float energy, slope, curve;
};

/// Eq. 3.1 and 3.4 for 0 < d; zero from d = 1 on. With x = d pi/2: E = cot x + x - pi/2, E' = -(pi/2) cot^2 x,
/// E'' = (pi^2/2) cot x / sin^2 x. cot x = 1/x + x P(x^2), the series with an adjusted tail: E is right to 2e-5, E' to
/// 1.3e-4 of itself. d is kept above 0.02, where the energy is 30.
NACRE_HD_INLINE PairEnergy cotangent_energy(float d) {
  const float x = (d > 0.02f ? (d < 1 ? d : 1.0f) : 0.02f) * (0.5f * pi);
  const float y = x * x;
  // The series of x cot x - 1 is that of Bernoulli numbers; its tail is folded into the last coefficients.
  const float p =
      -0.333333333f +
      y * (-0.0222222222f + y * (-0.00211640212f +
                                 y * (-0.000211640212f + y * (-2.13779915e-5f + y * (-2.1644043e-6f + y * -2.4e-7f)))));
  float cot = 1 / x + x * p;
  cot = cot > 0 ? cot : 0;
  const float inside = d < 1 ? 1.0f : 0.0f;
  const float energy = cot + x - 0.5f * pi;
  return {inside * (energy > 0 ? energy : 0), inside * (-0.5f * pi) * cot * cot,
          inside * (0.5f * pi * pi) * cot * (1 + cot * cot)};
}

/// Energy of a particle among the six neighbours of a hexagonal lattice with spacing h: 6 E(1/sqrt 3) = 0.7108 (the
/// 3.462 of sec. 3.1.3 is six scaled distances).
inline constexpr float hexagonal_energy = 0.7108f;
/// ... among the two neighbours of a row with spacing h, the rim of such a lattice: 2 E(1/sqrt 3). (At a scaled
/// distance of 1/2, which would be the next round number, the rim's edges are an eighth too short for the triangles on
/// them.)
inline constexpr float row_energy = hexagonal_energy / 3;

/// How much two particles of one surface concern each other: not at all where their normals are 120 degrees apart or
/// more, so that two sheets close together (whose normals are opposite: one interface between) do not push each other
/// apart. Up to a right angle fully: were it less where a sheet bends, particles there would seem to have room for
/// more. Those nearer than a third of h (scaled distance d) are on one sheet, however much it bends there: the sizing
/// field keeps sheets farther apart.
NACRE_HD_INLINE float normal_weight(float cosine, float d) {
  const float bend = 1 + 2 * cosine;
  const float agree = bend > 0 ? (bend < 1 ? bend : 1.0f) : 0.0f;
  const float close = 2 - d * 5.7735f;  // 1 at 0.3 h, 0 at 0.6 h
  return close > agree ? (close < 1 ? close : 1.0f) : agree;
}

}  // namespace nacre
