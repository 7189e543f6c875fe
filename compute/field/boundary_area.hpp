// Nacre: how large the boundaries between materials are at least, from voxels alone: before any field is made.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/field/build_material_bricks.hpp"

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

/// Of a block, each face counted at its upper voxel. Blocks without a list of materials have none.
struct FacesOfBlock {
  MaterialBricksView field;

  NACRE_HD FaceCount operator()(std::int64_t i) const {
    FaceCount count;
    if (field.block_start[i] == field.block_start[i + 1]) return count;
    const Int3 n = field.blocks;
    const Int3 low = Int3(int(i % n.x), int(i / n.x % n.y), int(i / n.x / n.y)) * Int3(block_size);
    const std::int64_t row = std::int64_t(n.x) * block_size, slab = row * n.y * block_size;
    for (int z = low.z; z < low.z + block_size; ++z)
      for (int y = low.y; y < low.y + block_size; ++y) {
        const std::uint16_t* line = field.voxel_material + field.voxel_number(0, y, z);
        for (int x = low.x; x < low.x + block_size; ++x) {
          if (x > 0) count.x += line[x] != line[x - 1];
          if (y > 0) count.y += line[x] != line[x - row];
          if (z > 0) count.z += line[x] != line[x - slab];
        }
      }
    return count;
  }
};

}  // namespace detail

/// A bound for the area of all boundaries, in squares of the smallest spacing, from below: a plane has at most sqrt(3)
/// times its area in faces of voxels; what smoothing takes off single voxels and the like is a tenth more.
template <class Backend>
double least_boundary_area(Executor<Backend>& exec, const MaterialBricks& b) {
  const detail::FaceCount faces =
      exec.reduce(b.block_count(), detail::FaceCount{}, detail::FacesOfBlock{b.view()}, detail::AddFaceCounts{});
  const Vec3d spacing{1 / double(b.cells_per_unit.x), 1 / double(b.cells_per_unit.y), 1 / double(b.cells_per_unit.z)};
  return (double(faces.x) * spacing.y * spacing.z + double(faces.y) * spacing.z * spacing.x +
          double(faces.z) * spacing.x * spacing.y) /
         (1.1 * std::sqrt(3.0));
}

}  // namespace nacre
