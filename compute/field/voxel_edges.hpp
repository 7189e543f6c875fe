// Nacre: edges between neighbouring voxels of different materials, which boundaries cross.
#pragma once

#include <cstdint>

#include "compute/field/material_bricks.hpp"

namespace nacre {

/// The edges from the voxels of a row of one block (`block_size` voxels along x) to the next ones along x, y and z.
struct VoxelEdges {
  MaterialBricksView field;

  NACRE_HD std::int64_t rows() const {
    return std::int64_t(field.blocks.x) * field.blocks.y * field.blocks.z * block_size * block_size;
  }

  /// visit(voxel, axis) for those between different materials. Blocks without a list of materials have none.
  template <class Visit>
  NACRE_HD void operator()(std::int64_t row, const Visit& visit) const {
    const std::int64_t block = row / (block_size * block_size);
    if (field.block_start[block] == field.block_start[block + 1]) return;
    const int in_block = int(row % (block_size * block_size));
    const Int3 n = field.voxels();
    const Int3 low = Int3(int(block % field.blocks.x), int(block / field.blocks.x % field.blocks.y),
                          int(block / field.blocks.x / field.blocks.y)) *
                         Int3(block_size) +
                     Int3(0, in_block % block_size, in_block / block_size);
    const std::int64_t step[] = {1, n.x, std::int64_t(n.x) * n.y};
    for (int k = 0; k < block_size; ++k) {
      const Int3 v = low + Int3(k, 0, 0);
      const std::uint16_t* at = field.voxel_material + field.voxel_number(v.x, v.y, v.z);
      for (int axis = 0; axis < 3; ++axis)
        if (v[axis] + 1 < n[axis] && *at != at[step[axis]]) visit(v, axis);
    }
  }
};

}  // namespace nacre
