// Nacre: the indicator functions of all materials in bricks of 8^3 voxels near the interfaces, and how they are read.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/backend.hpp"
#include "compute/field/cubic.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

/// A function's value and gradient, per voxel (the smallest voxel edge).
struct FieldSample {
  float value = 0;
  Vec3f gradient;
};

/// ... and its second derivatives.
struct FieldCurvature : FieldSample {
  float xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;
};

inline constexpr int block_size = 8;  ///< voxels per block and axis
inline constexpr int brick_voxels = block_size * block_size * block_size;
inline constexpr int volume_padding = 8;  ///< voxels of outside around the volume

/// Material m's indicator function f_m: material i is where f_i is the largest (sec. 3.6, with > for the misprinted <).
/// A block lists those materials that occur within 4 voxels of it, if there are two or more, and has a brick of values
/// for each. Two bricks serve all others: number 0 holds the value of a material that is absent, 1 of one that fills a
/// block. Points are in voxels, isotropic: the smallest spacing is 1; voxel (i, j, k) of the padded volume has its
/// centre at ((i, j, k) + 0.5) / cells_per_unit.
struct MaterialBricksView {
  Int3 blocks{};
  Vec3f cells_per_unit{1, 1, 1};  ///< at most 1, per axis
  CubicKernel kernel = CubicKernel::catmull_rom;
  const std::uint32_t* block_start = nullptr;     ///< per block, and one more: where its bricks begin
  const std::uint16_t* brick_material = nullptr;  ///< ascending within a block
  const float* value = nullptr;                   ///< brick_voxels per brick, x fastest
  /// Per block: `one_material` and the material of all that is within 4 voxels of it; of a block with a list the number
  /// of its brick of voxels.
  const std::uint32_t* block_content = nullptr;
  const std::uint16_t* voxel_material = nullptr;  ///< materials, brick_voxels per brick of voxels, x fastest
  static constexpr std::uint32_t one_material = 1u << 31;

  NACRE_HD Int3 voxels() const { return blocks * Int3(block_size); }
  NACRE_HD std::int64_t block_number(int x, int y, int z) const {
    return (std::int64_t(z) * blocks.y + y) * blocks.x + x;
  }
  NACRE_HD Int3 block(std::int64_t number) const {
    return {int(number % blocks.x), int(number / blocks.x % blocks.y), int(number / blocks.x / blocks.y)};
  }
  NACRE_HD bool is_listed(std::int64_t block) const { return block_start[block] != block_start[block + 1]; }
  /// Of the voxels of a block with a list.
  NACRE_HD const std::uint16_t* materials_in(std::int64_t block) const {
    return voxel_material + std::size_t(brick_voxels) * block_content[block];
  }

  /// Of a voxel of the padded volume.
  NACRE_HD std::uint16_t material(const Int3& v) const {
    const auto x = unsigned(v.x), y = unsigned(v.y), z = unsigned(v.z);
    constexpr unsigned n = block_size;
    const std::uint32_t content = block_content[block_number(int(x / n), int(y / n), int(z / n))];
    if (content & one_material) return std::uint16_t(content);
    return voxel_material[std::size_t(brick_voxels) * content + (z % n * n + y % n) * n + x % n];
  }

  /// Materials of the eight voxels of a block from `v` on, the first of a row.
  NACRE_HD void row_of_block(const Int3& v, std::uint16_t* material) const {
    const std::uint32_t content = block_content[block_number(v.x / block_size, v.y / block_size, v.z / block_size)];
    if (content & one_material) {
      for (int k = 0; k < block_size; ++k) material[k] = std::uint16_t(content);
      return;
    }
    const std::uint16_t* row = voxel_material + std::size_t(brick_voxels) * content +
                               (v.z % block_size * block_size + v.y % block_size) * block_size;
    for (int k = 0; k < block_size; ++k) material[k] = row[k];
  }

  /// visit(material) for the voxels from `low` to before `high`, x fastest, until it returns false; once for several
  /// in one row of a block that is of one material. Returns whether all were visited.
  template <class Visit>
  NACRE_HD bool each_material(const Int3& low, const Int3& high, const Visit& visit) const {
    for (int z = low.z; z < high.z; ++z)
      for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x;) {
          const int bx = x / block_size, ahead = (bx + 1) * block_size, end = ahead < high.x ? ahead : high.x;
          const std::uint32_t content = block_content[block_number(bx, y / block_size, z / block_size)];
          if (content & one_material) {
            if (!visit(std::uint16_t(content))) return false;
          } else {
            const std::uint16_t* row = voxel_material + std::size_t(brick_voxels) * content +
                                       (z % block_size * block_size + y % block_size) * block_size - bx * block_size;
            for (int k = x; k < end; ++k)
              if (!visit(row[k])) return false;
          }
          x = end;
        }
    return true;
  }

  /// The brick that holds `material` in a block.
  NACRE_HD std::uint32_t brick(std::int64_t block, std::uint32_t material) const {
    const std::uint32_t first = block_start[block], last = block_start[block + 1];
    for (std::uint32_t k = first; k < last; ++k)
      if (brick_material[k] == material) return k;
    if (first != last) return 0;
    return std::uint16_t(block_content[block]) == material ? 1 : 0;
  }

  /// The block of a point that is inside of the volume.
  NACRE_HD std::int64_t block_at(const Vec3f& p) const {
    const Vec3f u = p * cells_per_unit;
    return block_number(int(u.x) / block_size, int(u.y) / block_size, int(u.z) / block_size);
  }

  NACRE_HD bool inside(const Vec3f& p, float margin) const {
    const Vec3f u = p * cells_per_unit;
    const Int3 n = voxels();
    return u.x >= margin && u.y >= margin && u.z >= margin && u.x < n.x - margin && u.y < n.y - margin &&
           u.z < n.z - margin;
  }
};

/// The 4^3 voxels around a point: found once, then read for as many materials as needed.
class CubicStencil {
 public:
  /// `p` at least two voxels inside of the padded volume.
  NACRE_HD CubicStencil(const MaterialBricksView& field, const Vec3f& p)
      : CubicStencil(field, p * field.cells_per_unit - Vec3f(0.5f), 0) {}

  NACRE_HD FieldSample sample(const MaterialBricksView& field, std::uint32_t material) const {
    const Rows rows(*this, field, material);
    return sample_rows(field, [&](int b, int c) { return rows(b, c); });
  }

  /// f_a - f_b, for little more than one of them.
  NACRE_HD FieldSample difference(const MaterialBricksView& field, std::uint32_t a, std::uint32_t b) const {
    const Rows first(*this, field, a), second(*this, field, b);
    return sample_rows(field, [&](int y, int z) { return first(y, z) - second(y, z); });
  }

  NACRE_HD float value(const MaterialBricksView& field, std::uint32_t material) const {
    Rows rows(*this, field, material);
    Lanes v = lanes(0, 0, 0);
    for (int c = 0; c < 4; ++c)
      for (int b = 0; b < 4; ++b) v = v + rows(b, c) * (wy_[b] * wz_[c]);
    return sum(v * x_.value);
  }

  NACRE_HD FieldCurvature curvature(const MaterialBricksView& field, std::uint32_t material) const {
    Rows rows(*this, field, material);
    Lanes v = lanes(0, 0, 0), dy = v, dz = v, dyy = v, dzz = v, dyz = v;
    for (int c = 0; c < 4; ++c)
      for (int b = 0; b < 4; ++b) {
        const Lanes r = rows(b, c);
        v = v + r * (wy_[b] * wz_[c]);
        dy = dy + r * (sy_[b] * wz_[c]);
        dz = dz + r * (wy_[b] * sz_[c]);
        dyy = dyy + r * (cy_[b] * wz_[c]);
        dyz = dyz + r * (sy_[b] * sz_[c]);
        dzz = dzz + r * (wy_[b] * cz_[c]);
      }
    const Vec3f s = field.cells_per_unit;
    FieldCurvature result;
    result.value = sum(v * x_.value);
    result.gradient = Vec3f(sum(v * x_.slope), sum(dy * x_.value), sum(dz * x_.value)) * s;
    result.xx = sum(v * x_.curve) * s.x * s.x;
    result.yy = sum(dyy * x_.value) * s.y * s.y;
    result.zz = sum(dzz * x_.value) * s.z * s.z;
    result.xy = sum(dy * x_.slope) * s.x * s.y;
    result.yz = sum(dyz * x_.value) * s.y * s.z;
    result.zx = sum(dz * x_.slope) * s.z * s.x;
    return result;
  }

 private:
  template <class Row>
  NACRE_HD_INLINE FieldSample sample_rows(const MaterialBricksView& field, const Row& row) const {
    Lanes v = lanes(0, 0, 0), dy = v, dz = v;
    for (int c = 0; c < 4; ++c) {
      Lanes line = lanes(0, 0, 0), slope = line;
      for (int b = 0; b < 4; ++b) {
        const Lanes r = row(b, c);
        line = line + r * wy_[b];
        slope = slope + r * sy_[b];
      }
      v = v + line * wz_[c];
      dy = dy + slope * wz_[c];
      dz = dz + line * sz_[c];
    }
    return {sum(v * x_.value), Vec3f(sum(v * x_.slope), sum(dy * x_.value), sum(dz * x_.value)) * field.cells_per_unit};
  }

  NACRE_HD_INLINE CubicStencil(const MaterialBricksView& field, const Vec3f& u, int)
      : local_{int(std::floor(u.x)) - 1, int(std::floor(u.y)) - 1, int(std::floor(u.z)) - 1},
        x_(field.kernel, u.x - float(local_.x + 1)) {
    const CubicWeights y(field.kernel, u.y - float(local_.y + 1)), z(field.kernel, u.z - float(local_.z + 1));
    put(y, wy_, sy_, cy_);
    put(z, wz_, sz_, cz_);
    for (int axis = 0; axis < 3; ++axis) {
      block_[axis] = local_[axis] / block_size;
      local_[axis] %= block_size;
    }
  }

  NACRE_HD_INLINE static void put(const CubicWeights& from, float* value, float* slope, float* curve) {
    store4(from.value, value);
    store4(from.slope, slope);
    store4(from.curve, curve);
  }
  NACRE_HD_INLINE static void store4(Lanes from, float* to) {
    const Float4 f = store(from);
    to[0] = f.x, to[1] = f.y, to[2] = f.z, to[3] = f.w;
  }

  /// The stencil's rows of one material, wherever its up to eight bricks lie.
  class Rows {
   public:
    NACRE_HD_INLINE Rows(const CubicStencil& stencil, const MaterialBricksView& field, std::uint32_t material)
        : value_(field.value),
          rows_(block_size - stencil.local_.y),
          layers_(block_size - stencil.local_.z),
          first_(stencil.local_.x > 4 ? stencil.local_.x - 4 : 0) {
      const Int3 &local = stencil.local_, &b = stencil.block_;
      for (int z = 0; z < (local.z > 4 ? 2 : 1); ++z)
        for (int y = 0; y < (local.y > 4 ? 2 : 1); ++y) {
          const std::int64_t block = field.block_number(b.x, b.y + y, b.z + z);
          const int line = ((local.z - z * block_size) * block_size + local.y - y * block_size) * block_size;
          const std::int64_t in_brick = std::int64_t(brick_voxels) * field.brick(block, material) + line;
          low_[z][y] = in_brick + local.x - first_;
          high_[z][y] = first_ == 0 ? low_[z][y] : std::int64_t(brick_voxels) * field.brick(block + 1, material) + line;
        }
    }

    NACRE_HD_INLINE Lanes operator()(int b, int c) const {
      const bool y = b >= rows_, z = c >= layers_;
      const int line = (c * block_size + b) * block_size;
      return four_of(value_ + (low_[z][y] + line), value_ + (high_[z][y] + line), first_);
    }

   private:
    const float* value_;
    int rows_, layers_;  ///< how many are in the lower bricks along y, along z
    int first_;          ///< of the eight voxels from low_ and high_
    /// Per brick along z and y, of the first row of the first layer, were it in this brick: numbers of four of its
    /// values, and of the next four.
    std::int64_t low_[2][2], high_[2][2];
  };

  Int3 local_, block_;  ///< the lowest voxel: its position in its block
  CubicWeights x_;
  float wy_[4], sy_[4], cy_[4], wz_[4], sz_[4], cz_[4];
};

/// The material of a point: the one whose function is the largest there; ties go to the lower number.
NACRE_HD inline std::uint32_t material_at(const MaterialBricksView& field, const Vec3f& p) {
  if (!field.inside(p, 2)) return 0;
  const std::int64_t block = field.block_at(p);
  const std::uint32_t first = field.block_start[block], last = field.block_start[block + 1];
  if (first == last) return std::uint16_t(field.block_content[block]);
  const CubicStencil stencil(field, p);
  std::uint32_t best = field.brick_material[first];
  float most = stencil.value(field, best);
  for (std::uint32_t k = first + 1; k < last; ++k) {
    const float v = stencil.value(field, field.brick_material[k]);
    if (v > most) most = v, best = field.brick_material[k];
  }
  return best;
}

/// The materials of a block with a list, and of what is around it.
class BlockVoxels {
 public:
  NACRE_HD BlockVoxels(const MaterialBricksView& field, std::int64_t block)
      : field_(field), low_(field.block(block) * Int3(block_size)), own_(field.materials_in(block)) {}

  NACRE_HD std::uint16_t operator()(const Int3& v) const {
    const Int3 at = v - low_;
    if (unsigned(at.x | at.y | at.z) < unsigned(block_size))
      return own_[(at.z * block_size + at.y) * block_size + at.x];
    return field_.material(v);
  }

 private:
  const MaterialBricksView& field_;
  Int3 low_;
  const std::uint16_t* own_;
};

}  // namespace nacre
