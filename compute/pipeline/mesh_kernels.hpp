// Nacre: the mesh pipeline's own kernels: last projection, labels of points, distances.
#pragma once

#include "compute/embedding/interface_grid.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/sizing.hpp"

namespace nacre::detail {

/// Puts the particles onto the fields themselves after the last move, and marks those that have no interface nearby.
struct PolishParticle {
  MaterialBricksView field;
  const Junction* junction;
  const std::uint32_t* interface;
  Float4* place;
  Float4* direction;
  std::uint8_t* lost;
  NACRE_HD void operator()(std::int64_t i) const {
    const Float4 at = place[i];
    const Junction j = junction[interface[i]];
    lost[i] = 0;
    if (j.order() == 0) return;
    JunctionPoint on;
    lost[i] = 1;
    if (!project(field, j, {at.x, at.y, at.z}, 0.7f, on)) return;
    if (junction_margin(field, j, on.p, on.steepness) < -0.02f) return;
    lost[i] = 0;
    place[i] = {on.p.x, on.p.y, on.p.z, at.w};
    direction[i] = {on.direction.x, on.direction.y, on.direction.z, direction[i].w};
  }
};

struct MaterialAt {
  MaterialBricksView field;
  const Vec3f* point;
  std::uint16_t* material;
  NACRE_HD void operator()(std::int64_t i) const { material[i] = std::uint16_t(material_at(field, point[i])); }
};

struct SizeAt {
  SizingFieldView size;
  const Vec3f* point;
  float* h;
  NACRE_HD void operator()(std::int64_t i) const { h[i] = size(point[i]); }
};

/// Distance of a point from the interface of a facet's two materials, in voxels; negative where it cannot be found.
struct DistanceToInterface {
  MaterialBricksView field;
  const Vec3f* point;
  const Junction* junction;
  float* distance;
  NACRE_HD void operator()(std::int64_t i) const {
    JunctionPoint on;
    distance[i] = -1;
    if (!field.inside(point[i], 3) || !project(field, junction[i], point[i], 3, on)) return;
    distance[i] = length(on.p - point[i]);
  }
};

}  // namespace nacre::detail
