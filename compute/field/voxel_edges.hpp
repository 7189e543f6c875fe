// Nacre: edges between neighbouring voxels of different materials, which boundaries cross.
#pragma once

#include <cstdint>

#include "compute/field/build_material_bricks.hpp"

namespace nacre {

/// The edges from the voxels of a row of one block (`block_size` voxels along x) to the next ones along x, y and z.
/// Blocks without a list of materials have none between different ones.
struct VoxelEdges {
  MaterialBricksView field;
  const std::uint32_t* listed;  ///< the blocks with a list
  std::int64_t blocks;          ///< so many

  explicit VoxelEdges(const MaterialBricks& b)
      : field(b.view()), listed(b.listed.data()), blocks(std::int64_t(b.listed.size())) {}

  NACRE_HD std::int64_t rows() const { return blocks * block_size * block_size; }

  /// visit(voxel, axis) for those between different materials.
  template <class Visit>
  NACRE_HD void operator()(std::int64_t row, const Visit& visit) const {
    const std::int64_t block = listed[row / (block_size * block_size)];
    const int in_block = int(row % (block_size * block_size));
    const BlockVoxels material(field, block);
    const Int3 n = field.voxels();
    const Int3 low = field.block(block) * Int3(block_size) + Int3(0, in_block % block_size, in_block / block_size);
    for (int k = 0; k < block_size; ++k) {
      const Int3 v = low + Int3(k, 0, 0);
      const std::uint16_t own = material(v);
      for (int axis = 0; axis < 3; ++axis) {
        if (v[axis] + 1 >= n[axis]) continue;
        Int3 next = v;
        ++next[axis];
        if (material(next) != own) visit(v, axis);
      }
    }
  }
};

}  // namespace nacre
