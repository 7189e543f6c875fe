// Nacre: how large the boundaries between materials are, and how thin materials are there, from voxels alone: before
// any field is made.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/field/build_material_bricks.hpp"
#include "compute/field/voxel_edges.hpp"

namespace nacre {

/// Of all boundaries between materials, in squares of the smallest spacing.
struct BoundaryArea {
  double least = 0;  ///< a bound from below
  double usual = 0;  ///< what boundaries of all directions have
  /// Parts of `usual` beside a material that is thin there. The thickness is in smallest spacings, not exact.
  struct Thin {
    double thickness = 0, area = 0;
  };
  std::vector<Thin> thin;
};

namespace detail {

/// A material is thin beside a face of voxels where so many of its voxels, or fewer, lie in a row across the face.
inline constexpr int thin_voxels = 8;

/// Faces of voxels between different materials, by the axis that they are normal to, and of those the ones beside so
/// many voxels of one material in a row, less one.
struct FaceCount {
  std::uint64_t all[3] = {};
  std::uint64_t thin[3][thin_voxels] = {};
};

struct AddFaceCounts {
  NACRE_HD FaceCount operator()(FaceCount a, const FaceCount& b) const {
    for (int axis = 0; axis < 3; ++axis) {
      a.all[axis] += b.all[axis];
      for (int k = 0; k < thin_voxels; ++k) a.thin[axis][k] += b.thin[axis][k];
    }
    return a;
  }
};

struct FacesOfRow {
  VoxelEdges edges;

  /// Voxels of one material from `v` on, at most one more than `most`.
  NACRE_HD int row(Int3 v, int axis, int step, int most) const {
    const std::uint16_t material = edges.field.material(v);
    for (int length = 1; length <= most; ++length) {
      v[axis] += step;
      const bool inside = v[axis] >= 0 && v[axis] < edges.field.voxels()[axis];
      if (!inside) return most + 1;  // the outside has no end
      if (edges.field.material(v) != material) return length;
    }
    return most + 1;
  }

  NACRE_HD FaceCount operator()(std::int64_t i) const {
    FaceCount count;
    edges(i, [&](const Int3& v, int axis) {
      ++count.all[axis];
      Int3 next = v;
      ++next[axis];
      const int below = row(v, axis, -1, thin_voxels);
      const int thinnest = row(next, axis, 1, below - 1);  // or `below`, if that is not more
      if (thinnest <= thin_voxels) ++count.thin[axis][thinnest - 1];
    });
    return count;
  }
};

}  // namespace detail

/// From below: a plane has at most sqrt(3) times its area in faces of voxels; what smoothing takes off single voxels
/// and the like is a tenth more. Boundaries of all directions have one and a half times their area. A row of voxels
/// across a plate is as long as the plate is thick, or longer: of plates of all directions, the inverse square of the
/// thickness is twice the mean of that of the rows, so a thickness is taken to be sqrt(1/2) of the row.
template <class Backend>
BoundaryArea boundary_area(Executor<Backend>& exec, const MaterialBricks& b) {
  const VoxelEdges edges(b);
  const detail::FaceCount faces =
      exec.reduce(edges.rows(), detail::FaceCount{}, detail::FacesOfRow{edges}, detail::AddFaceCounts{});
  const double spacing[] = {1 / double(b.cells_per_unit.x), 1 / double(b.cells_per_unit.y),
                            1 / double(b.cells_per_unit.z)};
  BoundaryArea area;
  for (int axis = 0; axis < 3; ++axis) {
    const double face = spacing[(axis + 1) % 3] * spacing[(axis + 2) % 3];
    area.least += double(faces.all[axis]) * face / (1.1 * std::sqrt(3.0));
    area.usual += double(faces.all[axis]) * face / 1.5;
    for (int k = 0; k < detail::thin_voxels; ++k)
      if (const std::uint64_t count = faces.thin[axis][k]; count > 0)
        area.thin.push_back({(k + 1) * spacing[axis] * std::sqrt(0.5), double(count) * face / 1.5});
  }
  return area;
}

}  // namespace nacre
