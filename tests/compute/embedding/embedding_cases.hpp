// Nacre: volumes embedded on a device, and projections onto them from there.
#pragma once

#include "compute/embedding/build_interface_grid.hpp"
#include "tests/compute/field/field_cases.hpp"

namespace nacre::test {

/// A volume with its fields and its embedding.
struct Embedding {
  MaterialBricks bricks;
  DistanceField distance;
  SizingField size;
  InterfaceGrid grid;

  std::uint32_t number_of(const Junction& j) const {
    for (std::size_t k = 0; k < grid.junctions.size(); ++k)
      if (grid.junctions[k] == j) return std::uint32_t(k);
    return none;
  }
};

template <class Backend>
Embedding embedding_of(Executor<Backend>& exec, const MeshVolume& volume, const SizingRule& rule = {},
                       double cells_per_voxel = 2, bool seeds_only = false) {
  Embedding e;
  e.bricks = bricks_of(exec, volume);
  e.distance = distance_field(exec, e.bricks, 0.5f * rule.min_size, std::min(rule.reach() + 2, 64.0f));
  e.size = sizing_field(exec, e.distance, rule);
  e.grid = embed_interfaces(exec, e.bricks, e.distance, e.size, cells_per_voxel, seeds_only);
  return e;
}

struct Embed {
  InterfaceGridView grid;
  std::uint32_t interface;
  const Vec3f* point;
  EmbeddedPoint* on;  ///< h: -1 where there is none
  NACRE_HD void operator()(std::int64_t i) const {
    if (!project(grid, interface, point[i], on[i])) on[i].h = -1;
  }
};

template <class Backend>
std::vector<EmbeddedPoint> embed_all(Executor<Backend>& exec, const Embedding& e, const Junction& junction,
                                     const std::vector<Vec3f>& points) {
  Arena::Scope scope(exec.arena());
  Array<Vec3f> in = exec.arena().template temporary<Vec3f>(points.size());
  in.upload(points);
  Array<EmbeddedPoint> out = exec.arena().template temporary<EmbeddedPoint>(points.size());
  exec.for_each(std::int64_t(points.size()), Embed{e.grid.view(), e.number_of(junction), in.data(), out.data()});
  return out.download();
}

const Vec3d sector_centre(14.3, 13.8, 14.1);
constexpr double sector_radius = 8.2;

inline Vec3d sector_direction(int k) {
  const double a = 0.4 + k * 2 * M_PI / 3;
  return {std::cos(a), std::sin(a), 0};
}

/// A body in three sectors about an axis along z. Planes part the sectors; all four materials meet on the axis, where
/// the body ends above and below.
inline MeshVolume sectors(const Vec3d& centre = sector_centre, double radius = sector_radius) {
  std::vector<PlaceFunction> functions{[](const Vec3d&) { return 0.0; }};
  for (int k = 0; k < 3; ++k)
    functions.push_back([=](const Vec3d& p) {
      const Vec3d r = p - centre;
      return radius - length(r) + 0.5 * dot(sector_direction(k), r);
    });
  return indicator_volume({30, 29, 30}, functions);
}

}  // namespace nacre::test
