// Nacre: an octree of a flow on the graphics device: gives the shown value at a position of the surface.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/render/sparse_texture.hpp"

namespace nacre {

/// The arrays of FlowLookup that describe an octree: those of bricks, or `child` alone for the octree of the thesis.
struct OctreeLookup {
  int levels = 0;
  Vec3d origin{};        ///< world
  double cell_size = 1;  ///< of a texture cell, world units
  std::span<const std::uint32_t> node, level_start, layer;
  std::span<const std::uint32_t> child = {};
};

/// Immutable: made once per embedding. The functions are those of SparseTexture.
class OctreeTexture {
 public:
  OctreeTexture() = default;
  /// Throws Error if memory is insufficient. `page`: as for PagedArray.
  explicit OctreeTexture(const OctreeLookup& lookup, std::size_t page = 0);

  explicit operator bool() const { return node_.pages() > 0; }
  /// The GLSL that shaders/octree_texture.glsl is based on.
  std::string prelude() const;
  int bind(const Program& program, const BufferTexture& shown, int unit) const;

  const Vec3d& origin() const { return origin_; }
  double texture_cell() const { return cell_size_; }

 private:
  PagedArray node_, layer_;
  std::vector<std::uint32_t> level_start_;
  std::size_t thesis_nodes_ = 0;  ///< of the octree of the thesis; 0: it is one of bricks
  int levels_ = 0;
  Vec3d origin_{};
  double cell_size_ = 1;
};

}  // namespace nacre
