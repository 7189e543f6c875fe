// Nacre: which blocks of a volume need bricks of which materials, and the functions of indicator and scalar volumes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/field/block_scan.hpp"
#include "compute/field/distance_ridges.hpp"
#include "compute/field/material_bricks.hpp"

namespace nacre {

/// A volume's bricks on a device. `brick_block` and `neighbour` serve what works on whole bricks.
struct MaterialBricks {
  Int3 dims{};    ///< voxels of the volume itself
  Int3 blocks{};  ///< of the padded volume
  Vec3f cells_per_unit{1, 1, 1};
  CubicKernel kernel = CubicKernel::catmull_rom;
  std::int64_t bricks = 0;  ///< the two constant ones included
  Array<std::uint32_t> block_start;
  Array<std::uint16_t> brick_material;
  Array<std::uint32_t> brick_block;
  Array<std::uint32_t> block_content;
  Array<std::uint32_t> listed;  ///< the blocks with a list, ascending: per brick of voxels
  Array<std::uint16_t> voxel_material;
  Array<float> value;

  MaterialBricksView view() const {
    return {blocks,
            cells_per_unit,
            kernel,
            block_start.data(),
            brick_material.data(),
            value.data(),
            block_content.data(),
            voxel_material.data()};
  }
  std::int64_t block_count() const { return std::int64_t(blocks.x) * blocks.y * blocks.z; }
  std::int64_t voxel_count() const { return block_count() * brick_voxels; }
  std::int64_t bytes() const {
    return std::int64_t(block_start.bytes() + brick_material.bytes() + brick_block.bytes() + block_content.bytes() +
                        listed.bytes() + voxel_material.bytes() + value.bytes());
  }
};

/// Most materials within 4 voxels of one block.
inline constexpr int max_block_materials = 64;

namespace detail {

/// `count` elements of an array from `first` on.
template <class T>
Array<T> part_of(Arena& arena, const Array<T>& array, std::size_t first, std::size_t count) {
  return {arena.device(), array.data() + first, count};
}

/// Position of an element of the padded volume in the file's; outside of it material 0 begins.
struct PaddedVolume {
  Int3 dims, padded;
  NACRE_HD Int3 voxel(std::int64_t i) const {
    return Int3(int(i % padded.x), int(i / padded.x % padded.y), int(i / padded.x / padded.y)) - Int3(volume_padding);
  }
  NACRE_HD bool inside(const Int3& v) const { return is_within(v, dims); }
  NACRE_HD std::int64_t number(const Int3& v) const { return (std::int64_t(v.z) * dims.y + v.y) * dims.x + v.x; }
  NACRE_HD std::int64_t nearest(Int3 v) const {
    for (int axis = 0; axis < 3; ++axis) v[axis] = v[axis] < 0 ? 0 : v[axis] >= dims[axis] ? dims[axis] - 1 : v[axis];
    return number(v);
  }
  /// Half of the most that `contrast(number)` is at the file's voxels around the one nearest to a voxel outside of the
  /// volume, and 0 in the first layer outside.
  template <class Contrast>
  NACRE_HD float half_most_around(const Int3& v, const Contrast& contrast) const {
    if (is_within(v + Int3(1), dims + Int3(2))) return 0;
    float most = 0;
    for (int k = 0; k < 27; ++k)
      most = std::fmax(most, contrast(nearest(v + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1))));
    return 0.5f * most;
  }
};

/// The materials within 4 voxels of a block with a list, ascending, as visit(material). Returns how many there are.
struct BlockMaterials {
  MaterialBricksView field;

  template <class Visit>
  NACRE_HD int operator()(std::int64_t block, const Visit& visit) const {
    constexpr int reach = 4;
    const Int3 low = field.block(block) * Int3(block_size);
    std::uint16_t found[max_block_materials] = {};
    int count = 0, last = -1;
    const bool all = field.each_material(max(low - Int3(reach), Int3(0)),
                                         min(low + Int3(block_size + reach), field.voxels()), [&](std::uint16_t m) {
                                           if (m == last) return true;
                                           last = m;
                                           int position = 0;
                                           while (position < count && found[position] < m) ++position;
                                           if (position < count && found[position] == m) return true;
                                           if (count == max_block_materials) return false;
                                           for (int k = count; k > position; --k) found[k] = found[k - 1];
                                           found[position] = m;
                                           ++count;
                                           return true;
                                         });
    if (!all) return max_block_materials + 1;
    for (int k = 0; k < count; ++k) visit(found[k]);
    return count;
  }
};

struct CountBlockMaterials {
  BlockMaterials materials;
  const std::uint32_t* listed;
  std::uint32_t* count;  ///< per block
  std::uint32_t* crowded;
  NACRE_HD void operator()(std::int64_t i) const {
    const int n = materials(listed[i], [](std::uint16_t) {});
    if (n > max_block_materials) relaxed_store(crowded, 1);
    count[listed[i]] = std::uint32_t(n);
  }
};

struct ListBlockMaterials {
  BlockMaterials materials;
  const std::uint32_t* listed;
  const std::uint32_t* start;
  std::uint16_t* brick_material;
  std::uint32_t* brick_block;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint32_t at = start[listed[i]];
    materials(listed[i], [&](std::uint16_t m) {
      brick_material[at] = m;
      brick_block[at] = listed[i];
      ++at;
    });
  }
};

/// The two constant bricks come before all others.
struct LeaveConstantBricks {
  std::uint32_t* start;
  NACRE_HD void operator()(std::int64_t i) const { start[i] += 2; }
};

struct FillConstantBricks {
  float* value;
  float absent, present;
  NACRE_HD void operator()(std::int64_t i) const { value[i] = i < brick_voxels ? absent : present; }
};

/// Where the value of a brick's voxel comes from.
struct BrickVoxels {
  PaddedVolume volume;
  MaterialBricksView field;
  const std::uint32_t* brick_block;

  /// The voxel of the padded volume behind element i of the bricks after the constant ones.
  NACRE_HD Int3 operator()(std::int64_t i) const {
    const std::uint32_t block = brick_block[i / brick_voxels + 2];
    const int k = int(i % brick_voxels);
    const Int3 b{int(block % field.blocks.x), int(block / field.blocks.x % field.blocks.y),
                 int(block / field.blocks.x / field.blocks.y)};
    return b * Int3(block_size) + Int3(k % block_size, k / block_size % block_size, k / (block_size * block_size));
  }
};

/// Values of one material: how far it is behind the winner, cut off at 1. Beyond the volume's faces all functions go on
/// as they end, but the outside's, which is mirrored at the winner's: the face lies half a voxel outside of the last
/// centres, and interfaces that run into it stay straight. Where one of the outside does, this alone would be a tie all
/// the way out, and the interpolation's overshoot would make fins of it: hence `half_most_around`.
struct FillIndicator {
  BrickVoxels voxels;
  const float* rival;  ///< per voxel of the file: the highest value, or of the other materials' for the outside
  const float* from;
  std::uint32_t from_material;
  float scale;
  float* value;

  NACRE_HD void operator()(std::int64_t i) const {
    if (voxels.field.brick_material[i / brick_voxels + 2] != from_material) return;
    const PaddedVolume& volume = voxels.volume;
    const Int3 v = voxels(i) - Int3(volume_padding);
    const auto contrast = [&](std::int64_t at) { return std::fabs(from[at] - rival[at]); };
    const std::int64_t at = volume.nearest(v);
    float ahead = std::fmin(from[at] - rival[at], 0.0f);
    if (from_material == 0 && !volume.inside(v)) ahead = std::fmax(-ahead, volume.half_most_around(v, contrast));
    value[i + 2 * brick_voxels] = std::fmin(std::fmax(ahead * scale, -1.0f), 1.0f);
  }
};

/// Material m of a scalar volume lies between levels[m - 1] and levels[m].
struct FillScalar {
  BrickVoxels voxels;
  const float* from;
  const float* levels;
  int level_count;
  float scale;
  float* value;

  NACRE_HD void operator()(std::int64_t i) const {
    const int m = voxels.field.brick_material[i / brick_voxels + 2];
    const Int3 v = voxels(i) - Int3(volume_padding);
    const auto contrast = [&](std::int64_t at) { return std::fabs(from[at] - levels[0]); };
    const std::int64_t at = voxels.volume.nearest(v);
    float x = from[at];
    if (!voxels.volume.inside(v)) x = levels[0] - std::fmax(contrast(at), voxels.volume.half_most_around(v, contrast));
    float f = 3e38f;
    if (m > 0) f = x - levels[m - 1];
    if (m < level_count) f = std::fmin(f, levels[m] - x);
    value[i + 2 * brick_voxels] = f * scale;
  }
};

/// Puts what of the volume lies near boundaries on the device, slab by slab.
template <class Backend>
void take_voxels(Executor<Backend>& exec, MaterialBricks& b, const MaterialArray& material, int layers) {
  Arena& arena = exec.arena();
  const std::int64_t blocks = b.block_count();
  b.block_start = arena.permanent<std::uint32_t>(blocks + 1);
  b.block_content = arena.permanent<std::uint32_t>(blocks);
  b.voxel_material = arena.permanent<std::uint16_t>(0);
  std::vector<std::uint32_t> listed;
  BlockScan scan(b.dims, material, layers);
  for (BlockSlab slab; scan.next(slab); exec.check_stop()) {
    part_of(arena, b.block_content, std::size_t(slab.first), slab.content.size()).upload(slab.content);
    const std::size_t before = b.voxel_material.size();
    arena.resize_last(b.voxel_material, before + slab.voxels.size());
    part_of(arena, b.voxel_material, before, slab.voxels.size()).upload(slab.voxels);
    listed.insert(listed.end(), slab.listed.begin(), slab.listed.end());
  }
  b.listed = arena.permanent_copy<std::uint32_t>(listed);
}

/// Finds which materials have bricks in which blocks.
template <class Backend>
void list_materials(Executor<Backend>& exec, MaterialBricks& b) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  const std::int64_t blocks = b.block_count(), listed = std::int64_t(b.listed.size());
  const BlockMaterials materials{b.view()};
  Array<std::uint32_t> crowded = arena.temporary<std::uint32_t>(1);
  crowded.fill_bytes(0);
  b.block_start.fill_bytes(0);
  exec.for_each(listed, CountBlockMaterials{materials, b.listed.data(), b.block_start.data(), crowded.data()});
  if (crowded.download()[0])
    throw Error(
        "too many materials in one place", "more than " + std::to_string(max_block_materials) + " within a few voxels",
        "merge some with `merge`, drop speckle with `min_component`, or name the ones to keep with `materials`");
  b.bricks = std::int64_t(exec.exclusive_scan(b.block_start.data(), b.block_start.data(), blocks + 1)) + 2;
  exec.for_each(blocks + 1, LeaveConstantBricks{b.block_start.data()});
  b.brick_material = arena.permanent<std::uint16_t>(b.bricks);
  b.brick_block = arena.permanent<std::uint32_t>(b.bricks);
  b.brick_material.fill_bytes(0xff);
  b.brick_block.fill_bytes(0);
  exec.for_each(listed, ListBlockMaterials{materials, b.listed.data(), b.block_start.data(), b.brick_material.data(),
                                           b.brick_block.data()});
}

}  // namespace detail

/// Lays out the bricks: blocks, lists of materials, voxels' materials; `value` is not filled yet. `material`: per voxel
/// of the file, read once, `layers` of blocks at a time (0: by itself). `kernel` and `spacing` (per axis, in units of
/// the smallest) are kept. Throws Error where more than max_block_materials lie within 4 voxels of one block.
template <class Backend>
MaterialBricks lay_out_bricks(Executor<Backend>& exec, const Int3& dims, const Vec3d& spacing, CubicKernel kernel,
                              const MaterialArray& material, int layers = 0) {
  MaterialBricks b;
  b.dims = dims;
  b.blocks = BlockScan::blocks_of(dims);
  b.cells_per_unit = Vec3f(float(1 / spacing.x), float(1 / spacing.y), float(1 / spacing.z));
  b.kernel = kernel;
  if (b.voxel_count() >= std::int64_t(1) << 40) throw Error("volume too large", "more than 2^40 voxels", "crop it");
  detail::take_voxels(exec, b, material, layers);
  detail::list_materials(exec, b);
  b.value = exec.arena().template permanent<float>(std::size_t(b.bricks) * brick_voxels);
  return b;
}

/// Values of indicator functions, one array per material. Only how far each is behind the winner matters: that is
/// stored, in units of `range` and cut off at -1, since a function that is far behind would ring through the
/// interpolation.
template <class Backend>
void fill_indicators(Executor<Backend>& exec, MaterialBricks& b, std::span<const std::uint16_t> material,
                     std::span<const std::vector<float>> values, float range) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  std::vector<float> rival(material.size(), std::numeric_limits<float>::lowest());
  for (const std::vector<float>& v : values.subspan(1))
    for (std::size_t i = 0; i < v.size(); ++i) rival[i] = std::max(rival[i], v[i]);
  Array<float> from = arena.temporary<float>(rival.size()), rivals = arena.temporary<float>(rival.size());
  rivals.upload(rival);
  exec.for_each(2 * brick_voxels, detail::FillConstantBricks{b.value.data(), -1, 0});
  const detail::BrickVoxels voxels{{b.dims, b.blocks * Int3(block_size)}, b.view(), b.brick_block.data()};
  const auto fill = [&](std::size_t m) {
    from.upload(values[m]);
    exec.for_each((b.bricks - 2) * brick_voxels, detail::FillIndicator{voxels, rivals.data(), from.data(),
                                                                       std::uint32_t(m), 1 / range, b.value.data()});
  };
  fill(0);
  for (std::size_t i = 0; i < rival.size(); ++i) rival[i] = values[material[i]][i];
  rivals.upload(rival);
  for (std::size_t m = 1; m < values.size(); ++m) fill(m);
}

/// Two and a half times the mean jump of the difference of two functions from a voxel to the next, where the winner
/// changes between them: the range in which indicator functions are worth knowing.
inline float indicator_range(const Int3& dims, std::span<const std::uint16_t> material,
                             std::span<const std::vector<float>> values) {
  double sum = 0;
  std::int64_t count = 0;
  for (std::int64_t row = 0; row < std::int64_t(dims.y) * dims.z; ++row)
    for (std::int64_t i = row * dims.x + 1; i < (row + 1) * dims.x; ++i) {
      const std::uint16_t a = material[i - 1], b = material[i];
      if (a == b || a == 0 || b == 0) continue;
      sum += std::fabs(double(values[a][i - 1]) - values[b][i - 1] - values[a][i] + values[b][i]);
      ++count;
    }
  if (count > 0 && sum > 0) return float(2.5 * sum / double(count));
  double most = 0;
  for (const std::vector<float>& v : values.subspan(std::min<std::size_t>(1, values.size())))
    for (const float x : v) most = std::max(most, std::fabs(double(x)));
  return most > 0 ? float(most) : 1.0f;
}

/// Functions of the layers between the levels of a scalar volume, divided by `scale`. Where the values are a signed
/// distance with this `slope` (0: they are not) and there is one level, its ridges are taken out; returns in how many
/// voxels.
template <class Backend>
std::int64_t fill_scalar(Executor<Backend>& exec, MaterialBricks& b, std::span<const float> values,
                         std::span<const float> levels, float scale, float slope) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  Array<float> from = arena.temporary<float>(values.size()), cuts = arena.temporary<float>(levels.size());
  from.upload(values);
  cuts.upload(levels);
  const Vec3f cells = b.cells_per_unit, spacing{1 / cells.x, 1 / cells.y, 1 / cells.z};
  const std::int64_t on_ridge =
      slope > 0 && levels.size() == 1 ? smooth_ridges(exec, b.dims, spacing, from, levels[0], slope) : 0;
  exec.for_each(2 * brick_voxels, detail::FillConstantBricks{b.value.data(), -1, 1});
  const detail::BrickVoxels voxels{{b.dims, b.blocks * Int3(block_size)}, b.view(), b.brick_block.data()};
  exec.for_each((b.bricks - 2) * brick_voxels,
                detail::FillScalar{voxels, from.data(), cuts.data(), int(levels.size()), 1 / scale, b.value.data()});
  return on_ridge;
}

}  // namespace nacre
