// Nacre: interfaces with formulas, as projectors.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/particles/tree_solver.hpp"

namespace nacre::test {

/// A surface with a formula as the solver's projector; `Surface` as in analytic_surfaces.hpp. Beyond `rim` from the z
/// axis the interface does not exist.
template <class Surface>
struct AnalyticProjector {
  Surface surface;
  float rim = 1e9f;
  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float, EmbeddedPoint& on, float known = 0) const {
    if (!surface.project(interface, p, 1e9f, on.p, on.direction)) return false;
    on.h = surface.size(on.p);
    on.margin = known > 0 ? known : rim - std::sqrt(p.x * p.x + p.y * p.y);
    return true;
  }
};

/// Without bounds in x and y.
struct Plane {
  float h;
  NACRE_HD bool project(std::uint32_t, const Vec3f& p, float, Vec3f& on, Vec3f& direction) const {
    on = {p.x, p.y, 0};
    direction = {0, 0, 1};
    return true;
  }
  NACRE_HD float size(const Vec3f&) const { return h; }
};

}  // namespace nacre::test
