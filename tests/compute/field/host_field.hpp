// Nacre: bricks of materials whose functions have a formula, in host memory.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "compute/field/material_bricks.hpp"

namespace nacre::test {

/// All blocks hold bricks of all materials: what is sampled is what the formulas say.
class HostField {
 public:
  using Function = std::function<float(const Vec3f&)>;

  /// `functions[m]` of a point in voxels is the function of material m.
  HostField(const Int3& blocks, const Vec3f& cells_per_unit, CubicKernel kernel,
            const std::vector<Function>& functions) {
    const std::int64_t count = std::int64_t(blocks.x) * blocks.y * blocks.z;
    value_.assign(std::size_t(2 + count * functions.size()) * brick_voxels, -8);
    std::fill_n(value_.begin() + brick_voxels, brick_voxels, 8.0f);  // brick 0: absent, 1: fills a block
    brick_material_.assign(2, 0xffff);
    for (std::int64_t b = 0; b < count; ++b) {
      start_.push_back(std::uint32_t(brick_material_.size()));
      const Int3 low =
          Int3(int(b % blocks.x), int(b / blocks.x % blocks.y), int(b / blocks.x / blocks.y)) * Int3(block_size);
      for (std::size_t m = 0; m < functions.size(); ++m) {
        float* to = value_.data() + brick_material_.size() * brick_voxels;
        brick_material_.push_back(std::uint16_t(m));
        for (int k = 0; k < brick_voxels; ++k) {
          const Vec3f centre = (Vec3f(low + Int3(k % 8, k / 8 % 8, k / 64)) + Vec3f(0.5f)) * reciprocal(cells_per_unit);
          to[k] = functions[m](centre);
        }
      }
    }
    start_.push_back(std::uint32_t(brick_material_.size()));
    content_.assign(std::size_t(count), MaterialBricksView::one_material);
    view_ = {blocks,        cells_per_unit,  kernel, start_.data(), brick_material_.data(),
             value_.data(), content_.data(), nullptr};
  }
  HostField(const HostField&) = delete;
  HostField& operator=(const HostField&) = delete;

  const MaterialBricksView& view() const { return view_; }

 private:
  static Vec3f reciprocal(const Vec3f& a) { return {1 / a.x, 1 / a.y, 1 / a.z}; }

  std::vector<std::uint32_t> start_, content_;
  std::vector<std::uint16_t> brick_material_;
  std::vector<float> value_;
  MaterialBricksView view_;
};

}  // namespace nacre::test
