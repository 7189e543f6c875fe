// Nacre: how the tree solver's particles get back onto their interface after a step in its tangent space.
#pragma once

#include "compute/embedding/interface_grid.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/sizing.hpp"

namespace nacre {

/// By how much a margin may change over a way of one voxel.
inline constexpr float margin_slope = 3;

/// How particles get back onto their interface: by Newton's method on the fields themselves, for the last steps ...
/// Where the margin is known to be at least `known` > 0 voxels, the other materials are not looked at.
struct FieldProjector {
  MaterialBricksView field;
  const Junction* junction;
  SizingFieldView size;
  float last_step = 0.01f;  ///< of Newton's, voxels; what is left is about its square times the curvature
  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float, EmbeddedPoint& on, float known = 0) const {
    JunctionPoint at;
    if (!nacre::project(field, junction[interface], p, 1, at, last_step)) return false;
    on = {at.p, at.direction, size(at.p),
          known > 0 ? known : junction_margin(field, junction[interface], at.p, at.steepness)};
    return true;
  }
};

/// ... or by the closest points of the embedding (sec. 4.2.1), if it has the cells for that, wherever particles are
/// farther apart than these.
struct EmbeddedProjector {
  InterfaceGridView grid;
  FieldProjector fields;
  const float* spacing = nullptr;  ///< per interface: particles are to be so many times as far apart; null: 1
  NACRE_HD bool project(std::uint32_t interface, const Vec3f& p, float h, EmbeddedPoint& on, float known = 0) const {
    const bool near = grid.seeds_only || h * grid.cells_per_voxel < 0.9f ? fields.project(interface, p, h, on, known)
                                                                         : nacre::project(grid, interface, p, on);
    if (near && spacing) on.h *= spacing[interface];
    return near;
  }
};

}  // namespace nacre
