// Nacre: how large the boundaries between materials are at least, from voxels alone: before any field is made.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/field/build_material_bricks.hpp"
#include "compute/field/voxel_edges.hpp"

namespace nacre {

namespace detail {

/// Faces of voxels between different materials, by the axis that they are normal to.
struct FaceCount {
  std::uint64_t x = 0, y = 0, z = 0;
};

struct AddFaceCounts {
  NACRE_HD FaceCount operator()(const FaceCount& a, const FaceCount& b) const {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
};

struct FacesOfRow {
  VoxelEdges edges;

  NACRE_HD FaceCount operator()(std::int64_t i) const {
    FaceCount count;
    edges(i, [&](const Int3&, int axis) { ++(axis == 0 ? count.x : axis == 1 ? count.y : count.z); });
    return count;
  }
};

}  // namespace detail

/// What boundaries of all directions have of it: their faces of voxels are one and a half times their area.
inline constexpr double usual_over_least_area = 1.1 * 1.7320508 / 1.5;

/// A bound for the area of all boundaries, in squares of the smallest spacing, from below: a plane has at most sqrt(3)
/// times its area in faces of voxels; what smoothing takes off single voxels and the like is a tenth more.
template <class Backend>
double least_boundary_area(Executor<Backend>& exec, const MaterialBricks& b) {
  const VoxelEdges edges(b);
  const detail::FaceCount faces =
      exec.reduce(edges.rows(), detail::FaceCount{}, detail::FacesOfRow{edges}, detail::AddFaceCounts{});
  const Vec3d spacing{1 / double(b.cells_per_unit.x), 1 / double(b.cells_per_unit.y), 1 / double(b.cells_per_unit.z)};
  return (double(faces.x) * spacing.y * spacing.z + double(faces.y) * spacing.z * spacing.x +
          double(faces.z) * spacing.x * spacing.y) /
         (1.1 * std::sqrt(3.0));
}

}  // namespace nacre
