// Nacre: the spacing of a lattice of particles by their energy, which tests compare with.
#pragma once

#include <cmath>

#include "compute/particles/energy.hpp"

namespace nacre::test {

/// Distance, in h, of the particles of a hexagonal lattice (`row`: of a row) in which each has this energy.
inline double lattice_spacing(double energy, bool row = false) {
  const auto of = [&](double spacing) {
    const double lattice_rings[] = {1, std::sqrt(3.0), 2}, row_rings[] = {1, 2, 3};
    double sum = 0;
    for (const double r : row ? row_rings : lattice_rings) {
      const double d = spacing * r / support;
      if (d < 1) sum += (row ? 2 : 6) * (1 / std::tan(d * pi / 2) + d * pi / 2 - pi / 2);
    }
    return sum;
  };
  double low = 0.2, high = 1.8;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (of(middle) > energy ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace nacre::test
