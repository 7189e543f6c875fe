// Nacre: what belongs to a cell of the texture besides its value: where it lies, its normal, the vector there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "compute/embedding/closest_point_grid.hpp"
#include "compute/pipeline/flow_domain.hpp"

namespace nacre {

/// Fills in FlowValues, on the host. All points are in cells of the domain; what is referred to must outlive it.
struct DescribeCells {
  const FlowDomain& domain;
  const std::vector<Vec3d>& points;  ///< as embedded
  std::vector<Triangle> corners;
  std::vector<Vec3f> normals;  ///< 3 per triangle
  std::vector<Vec3f> vectors;  ///< one per point, at the time of the frame
  bool moved;
  const std::vector<Vec3d>& moved_points;  ///< where the surface has moved to, if it has
  const std::vector<Vec3f>& moved_normals;
  const std::uint8_t* second_sheet;  ///< per triangle, whether it stands aside by `shift` (world); null: none does
  Vec3d shift;

  /// Entry `s`: a cell's centre and the point of triangle `t` closest to it.
  void operator()(FlowValues& values, std::size_t s, const Vec3d& centre, const Vec3d& surface, std::uint32_t t) const;
};

}  // namespace nacre
