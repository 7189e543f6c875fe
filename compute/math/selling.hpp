// Nacre: Selling's decomposition: a diffusion tensor as a sum of non-negative weights along steps of the grid.
#pragma once

#include "compute/math/vec.hpp"

namespace nacre {

/// The 26 cells around a cell. Number n is the step (n % 3, n / 3 % 3, n / 9) - 1, as in a 3^3 stencil; 13 is the cell
/// itself, and 26 - n the opposite step. Of each pair the upper one is direction n - 14.
struct GridSteps {
  static constexpr int middle = 13, directions = 13, neighbours = 26;
  NACRE_HD static constexpr Int3 step(int n) { return {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1}; }
  NACRE_HD static constexpr int number(const Int3& step) { return (step.z + 1) * 9 + (step.y + 1) * 3 + step.x + 1; }
  NACRE_HD static constexpr bool is_along_axis(int n) {
    return n == 4 || n == 10 || n == 12 || n == 14 || n == 16 || n == 22;
  }
  /// Of a step and its opposite.
  NACRE_HD static constexpr int direction(int n) { return (n > middle ? n : neighbours - n) - middle - 1; }
};

/// Greatest ratio of lengths (square root of that of the diffusivities) whose decomposition, whatever the direction,
/// needs no step beyond the 26 neighbours. Found by trying 200,000 directions: at 2.5 a few need steps of two cells.
inline constexpr double most_stretch = 2.4;

/// Weights w of the 13 directions e, none negative, so that I + extra t t^T = sum of w e e^T (Selling 1874; as a
/// stencil Fehrenbach & Mirebeau, J. Math. Imaging Vis. 49, 2014). Their sum is at most 3 + extra. `t` has unit length,
/// or is zero; `extra` is at most most_stretch^2 - 1.
NACRE_HD inline void selling_weights(const Vec3f& t, float extra, float* weight) {
  Vec3f base[4] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, -1, -1}};
  const auto product = [&](const Vec3f& a, const Vec3f& b) { return dot(a, b) + extra * dot(a, t) * dot(b, t); };
  constexpr int most_rounds = 16;  // 7 suffice up to `most_stretch`
  bool obtuse = false;
  for (int round = 0; round < most_rounds && !obtuse; ++round) {
    obtuse = true;
    for (int i = 0; i < 3 && obtuse; ++i)
      for (int j = i + 1; j < 4 && obtuse; ++j) {
        if (product(base[i], base[j]) <= 1e-5f) continue;
        obtuse = false;
        const Vec3f turned = base[i];
        for (int k = 0; k < 4; ++k)
          if (k != i && k != j) base[k] = base[k] + turned;
        base[i] = -turned;
      }
  }
  for (int d = 0; d < GridSteps::directions; ++d) weight[d] = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i + 1; j < 4; ++j) {
      int others[2] = {}, n = 0;
      for (int k = 0; k < 4; ++k)
        if (k != i && k != j) others[n++] = k;
      const Vec3f e = cross(base[others[0]], base[others[1]]);
      const float w = -product(base[i], base[j]);
      if (w <= 0) continue;  // rounding
      const Int3 step{int(e.x), int(e.y), int(e.z)};
      if (is_within(step + Int3(1), Int3(3))) weight[GridSteps::direction(GridSteps::number(step))] += w;
    }
}

}  // namespace nacre
