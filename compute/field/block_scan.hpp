// Nacre: one pass through the voxels of a volume, slab by slab, that finds the blocks near boundaries.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/field/material_array.hpp"
#include "compute/field/material_bricks.hpp"

namespace nacre {

/// Blocks of the padded volume in their order, from all of whose layers between two heights.
struct BlockSlab {
  std::int64_t first = 0;              ///< number of the first block
  std::vector<std::uint32_t> content;  ///< per block, as MaterialBricksView::block_content
  std::vector<std::uint32_t> listed;   ///< numbers of the blocks within 4 voxels of which there are two materials
  std::vector<std::uint16_t> voxels;   ///< their voxels' materials, brick_voxels each
};

/// Goes through a volume once. What is read is a slab at a time, so that the volume itself may be a file.
class BlockScan {
 public:
  /// `layers` of blocks make a slab; 0: as many as keep all cores at work. The result does not depend on it.
  BlockScan(const Int3& dims, const MaterialArray& material, int layers = 0);

  static Int3 blocks_of(const Int3& dims);
  /// The next slab; false behind the last one.
  bool next(BlockSlab& slab);

 private:
  /// A material, or `mixed`, per cube of 4^3 voxels of one layer of such cubes.
  using Cubes = std::vector<std::uint32_t>;
  static constexpr std::uint32_t mixed = 1 << 16;
  static constexpr int cube = block_size / 2;

  void summarise(int layer, Cubes& cubes) const;
  void find_listed(int z, BlockSlab& slab) const;
  void copy_voxels(BlockSlab& slab, std::uint32_t voxel_bricks) const;

  Int3 dims_, blocks_;
  const MaterialArray& material_;
  int layers_;
  int next_ = 0;              ///< layer of blocks
  std::uint32_t listed_ = 0;  ///< so far
  int first_cubes_ = 0;       ///< layer of cubes_[0]
  std::vector<Cubes> cubes_;
};

}  // namespace nacre
