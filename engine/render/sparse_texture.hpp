// Nacre: the look-up arrays of the flow's grid on the graphics device: give the shown value at a position of the
// surface.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compute/math/vec.hpp"
#include "engine/gl/buffer.hpp"
#include "engine/gl/shader.hpp"
#include "engine/gl/texture.hpp"

namespace nacre {

/// An array of numbers that a shader reads. If it is larger than the driver allows, it is divided into several pages.
class PagedArray {
 public:
  PagedArray() = default;
  /// `most`: elements per page, a power of two; 0: what the driver allows.
  explicit PagedArray(std::span<const std::uint32_t> values, std::size_t most = 0);

  std::size_t pages() const { return pages_.size(); }
  /// GLSL code: samplers NAME_0.. and `uint fetch_NAME(uint)`.
  std::string source(std::string_view name) const;
  /// Binds the pages from texture unit `unit` on and informs `program`; returns the next free unit.
  int bind(const Program& program, std::string_view name, int unit) const;

 private:
  struct Page {
    Buffer buffer;
    BufferTexture texture;
  };
  std::vector<Page> pages_;
  int shift_ = 31;  ///< log2 of the elements of a page
};

/// What the look-up needs: the arrays of RefinedGridView, and the position of its grid.
struct SparseLookup {
  Int3 bricks{};
  int subcells = 4, refine = 4;
  Vec3d origin{};        ///< world
  double cell_size = 1;  ///< of a closest-point cell, world units
  std::span<const std::uint32_t> brick_index, block, texel;
};

/// Blocks of (R + 1)^3 texels, in the order of the look-up's blocks: R^3 of their own and, at their upper sides, the
/// first ones of the blocks there, so that all eight texels around a position are in one block. Each is a surface cell
/// or `none`. Host only, on any thread.
std::vector<std::uint32_t> with_rims(const SparseLookup& lookup);

/// The arrays on the graphics device. Immutable: made once per embedding.
class SparseTexture {
 public:
  SparseTexture() = default;
  /// `rimmed`: what `with_rims` makes of `lookup`. Throws Error if memory is insufficient. `page`: as for PagedArray.
  SparseTexture(const SparseLookup& lookup, std::span<const std::uint32_t> rimmed, std::size_t page = 0);

  explicit operator bool() const { return refine_ > 0; }
  /// The GLSL that shaders/sparse_texture.glsl is based on.
  std::string prelude() const;
  /// Binds all arrays, and the values of `shown`, from `unit` on; returns the next free unit.
  int bind(const Program& program, const BufferTexture& shown, int unit) const;

  const Vec3d& origin() const { return origin_; }
  double texture_cell() const { return cell_size_ / refine_; }  ///< edge, world units

 private:
  PagedArray brick_, block_, texel_;
  Int3 bricks_{};
  int subcells_ = 0, refine_ = 0;
  Vec3d origin_{};
  double cell_size_ = 1;
};

}  // namespace nacre
