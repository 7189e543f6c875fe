// Nacre: smooth indicator functions for binary labels that keep every voxel on its side.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/field/build_material_bricks.hpp"
#include "compute/field/share_along_slopes.hpp"
#include "compute/math/eight.hpp"

namespace nacre {

/// Taps of a Gaussian along one axis, -Reach .. Reach.
template <int Reach>
struct GaussianTaps {
  float tap[2 * Reach + 1];
  float sum = 0;  ///< added up in the order of the taps: what ones are smoothed to

  /// `width`: standard deviation in voxels.
  explicit GaussianTaps(double width) {
    double all = 0;
    for (int k = -Reach; k <= Reach; ++k) all += std::exp(-0.5 * k * k / (width * width));
    for (int k = -Reach; k <= Reach; ++k) tap[k + Reach] = float(std::exp(-0.5 * k * k / (width * width)) / all);
    for (const float t : tap) sum += t;
  }
};

namespace detail {

/// What of each voxel belongs to the material of a brick: all or nothing.
struct FillBinary {
  MaterialBricksView field;
  const std::uint32_t* brick_block;
  float* value;

  NACRE_HD void operator()(std::int64_t i) const {  // rows of bricks
    const std::uint32_t brick = std::uint32_t(i / (block_size * block_size)) + 2;
    const std::uint16_t own = field.brick_material[brick];
    const std::int64_t row = i % (block_size * block_size) * block_size;
    const std::uint16_t* material = field.materials_in(brick_block[brick]) + row;
    float* to = value + std::size_t(brick) * brick_voxels + row;
    for (int k = 0; k < block_size; ++k) to[k] = material[k] == own ? 1.0f : 0.0f;
  }
};

/// A brick and those around it, by the offsets of their blocks: 13 is the brick itself.
NACRE_HD inline Int3 step_to_brick(int k) { return {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}; }

/// The bits of those with voxels no more than `reach` away along each axis from one of the brick's.
NACRE_HD inline std::uint64_t bricks_within(int position, int reach) {
  const Int3 v(position % block_size, position / block_size % block_size, position / (block_size * block_size));
  std::uint64_t bits = 0;
  for (int k = 0; k < 27; ++k) {
    const Int3 step = step_to_brick(k);
    bool near = true;
    for (int axis = 0; axis < 3; ++axis)
      near = near && (step[axis] == 0 || (step[axis] < 0 ? v[axis] < reach : v[axis] >= block_size - reach));
    bits |= std::uint64_t(near) << k;
  }
  return bits;
}

/// Marks the bricks of the same material that changes reach.
struct MarkReached {
  MaterialBricksView field;
  const std::uint32_t* brick_block;
  const std::uint64_t* changed;  ///< per brick: bits of the bricks around that its changes reach
  std::uint32_t* marked;         ///< per brick

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t brick = std::uint32_t(i) + 2;
    if (!changed[brick]) return;
    const Int3 b = field.block(brick_block[brick]);
    for (int k = 0; k < 27; ++k) {
      const Int3 c = b + step_to_brick(k);
      if ((changed[brick] >> k & 1) && is_within(c, field.blocks))
        relaxed_store(marked + field.brick(field.block_number(c.x, c.y, c.z), field.brick_material[brick]), 1);
    }
  }
};

/// Bricks of two materials that are alone in their block and in all around it: what one has, the other lacks.
enum class Pairing : std::uint8_t { none, first, second };

struct FindPairs {
  MaterialBricksView field;
  const std::uint32_t* listed;
  Pairing* pairing;  ///< per brick; none before

  NACRE_HD void operator()(std::int64_t i) const {  // blocks with a list
    const std::uint32_t block = listed[i], first = field.block_start[block];
    if (field.block_start[block + 1] - first != 2) return;
    const std::uint32_t a = field.brick_material[first], b = field.brick_material[first + 1];
    const Int3 at = field.block(block);
    for (int k = 0; k < 27; ++k)
      if (!has_no_other(at + step_to_brick(k), a, b)) return;
    pairing[first] = Pairing::first, pairing[first + 1] = Pairing::second;
  }

 private:
  NACRE_HD bool has_no_other(const Int3& at, std::uint32_t a, std::uint32_t b) const {
    if (!is_within(at, field.blocks)) return a == 0;  // the lower one: material 0 is outside
    const std::int64_t block = field.block_number(at.x, at.y, at.z);
    if (!field.is_listed(block)) {
      const std::uint16_t only = std::uint16_t(field.block_content[block]);
      return only == a || only == b;
    }
    for (std::uint32_t k = field.block_start[block]; k < field.block_start[block + 1]; ++k)
      if (field.brick_material[k] != a && field.brick_material[k] != b) return false;
    return true;
  }
};

/// Adds a brick smoothed with what surrounds it, `share[k]` times by each of the Gaussians. Of a pair, the first one
/// smooths for both.
template <int Reach, int Gaussians>
struct SmoothBrick {
  static constexpr int wide = block_size + 2 * Reach;

  MaterialBricksView source;  ///< `value` is the unsmoothed function
  const std::uint32_t* brick_block;
  const std::uint32_t* smoothed;  ///< per brick: whether it is smoothed now; both of a pair are, or none
  const Pairing* pairing;         ///< per brick
  float pair_sum;                 ///< of both functions of a pair, anywhere
  GaussianTaps<Reach> taps[Gaussians];
  float share[Gaussians];
  float* smooth;

  static constexpr std::size_t scratch_bytes() {
    return sizeof(float) * (Gaussians * wide * wide * block_size + wide * block_size * block_size) +
           27 * sizeof(std::uint32_t);
  }

  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    const std::uint32_t brick = std::uint32_t(i) + 2;
    float* all_rows = reinterpret_cast<float*>(team.scratch());  // per Gaussian, in a wide stack of wide slabs
    float* slabs = all_rows + Gaussians * wide * wide * block_size;
    auto* around = reinterpret_cast<std::uint32_t*>(slabs + wide * block_size * block_size);
    if (!smoothed[brick] || pairing[brick] == Pairing::second) return;
    find_neighbours(team, brick, around);
    team.each(wide * wide, [&](int line) {
      float values[wide];
      load_line(around, line % wide, line / wide, values);
      const bool same = is_constant(values) && (values[0] == 0 || values[0] == 1);
      for (int g = 0; g < Gaussians; ++g)
        store_eight(all_rows + (g * wide * wide + line) * block_size,
                    same ? eight(values[0] * taps[g].sum) : weighted(taps[g].tap, values, 1));
    });
    float* to = smooth + std::size_t(brick) * brick_voxels;
    for (int g = 0; g < Gaussians; ++g) {
      const float smooth_sum = pair_sum * taps[g].sum * taps[g].sum * taps[g].sum;
      const float *tap = taps[g].tap, *rows = all_rows + g * wide * wide * block_size;
      team.each(wide * block_size, [&](int line) {  // (y, z) of the result in a wide stack of slabs
        const int y = line % block_size, z = line / block_size;
        store_eight(slabs + line * block_size, weighted(tap, rows + (z * wide + y) * block_size, block_size));
      });
      team.each(block_size * block_size, [&](int line) {
        const Eight sum = weighted(tap, slabs + line * block_size, block_size * block_size);
        float* at = to + line * block_size;
        store_eight(at, load_eight(at) + sum * share[g]);
        if (pairing[brick] != Pairing::first) return;
        float* other = at + brick_voxels;
        store_eight(other, load_eight(other) + (eight(smooth_sum) - sum) * share[g]);
      });
    }
  }

 private:
  static_assert(block_size == 8);

  /// The sum of the eight values `stride` apart from each other, times the taps.
  NACRE_HD_INLINE static Eight weighted(const float* tap, const float* from, int stride) {
    Eight sum = eight(0);
    for (int k = 0; k <= 2 * Reach; ++k) sum = sum + load_eight(from + k * stride) * tap[k];
    return sum;
  }

  /// Most lines are: what the labels started as is 0 or 1 but for slopes.
  NACRE_HD_INLINE static bool is_constant(const float* line) {
    static_assert(wide <= 3 * block_size);
    const Eight first = eight(line[0]), low = load_eight(line), middle = load_eight(line + (wide - block_size) / 2),
                high = load_eight(line + wide - block_size);
    const Eight least = min(min(low, middle), high), most = max(max(low, middle), high);
    return (at_most(most, first) & at_most(first, least)) == 0xff;
  }

  /// Numbers of the 27 bricks of the same material around.
  NACRE_HD void find_neighbours(Team& team, std::uint32_t brick, std::uint32_t* around) const {
    const std::uint32_t block = brick_block[brick];
    const Int3 n = source.blocks, b = source.block(block);
    team.each(27, [&](int k) {
      const Int3 c = b + step_to_brick(k);
      around[k] = is_within(c, n) ? source.brick(source.block_number(c.x, c.y, c.z), source.brick_material[brick])
                  : source.brick_material[brick] == 0 ? 1
                                                      : 0;
    });
  }

  NACRE_HD void load_line(const std::uint32_t* around, int y, int z, float* line) const {
    y -= Reach, z -= Reach;
    const int by = y < 0 ? 0 : y < block_size ? 1 : 2, bz = z < 0 ? 0 : z < block_size ? 1 : 2;
    const int offset = ((z + block_size) % block_size * block_size + (y + block_size) % block_size) * block_size;
    const float* part[3];
    for (int k = 0; k < 3; ++k)
      part[k] = source.value + std::size_t(around[(bz * 3 + by) * 3 + k]) * brick_voxels + offset;
    for (int x = 0; x < Reach; ++x) line[x] = part[0][block_size - Reach + x];
    for (int x = 0; x < block_size; ++x) line[Reach + x] = part[1][x];
    for (int x = 0; x < Reach; ++x) line[Reach + block_size + x] = part[2][x];
  }
};

/// Of the bricks that have some.
struct ClearCorrections {
  const std::uint64_t* changed;
  float* correction;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t brick = std::uint32_t(i) + 2;
    if (!changed[brick]) return;
    float* here = correction + std::size_t(brick) * brick_voxels;
    for (int k = 0; k < brick_voxels; ++k) here[k] = 0;
  }
};

/// At voxels that smoothing puts on the wrong side of the boundary, asks for more of their own material and for less of
/// its strongest rival. Looks at a brick's voxels of its own material, if a brick of its block was smoothed again.
struct HoldVoxels {
  MaterialBricksView smooth;
  const std::uint32_t* brick_block;
  const std::uint32_t* smoothed;  ///< per brick
  float margin, thin_margin;      ///< by how much a voxel's own material shall win; the latter is the larger
  float gain;                     ///< what to ask for a unit of smoothed value
  int reach;                      ///< of the Gaussian that smooths corrections
  float* correction;
  std::uint64_t* changed;  ///< per brick: bits of the bricks around that its corrections reach
  std::uint64_t* held;

  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t brick = std::uint32_t(i) + 2, block = brick_block[brick], own = smooth.brick_material[brick];
    const std::uint32_t first = smooth.block_start[block], last = smooth.block_start[block + 1];
    bool any = false;
    for (std::uint32_t k = first; k < last; ++k) any = any || smoothed[k];
    if (!any) return;
    const Int3 low = smooth.block(block) * Int3(block_size);
    const std::uint16_t* material = smooth.materials_in(block);
    std::uint64_t count = 0;
    for (int row = 0; row < brick_voxels; row += block_size) {
      const unsigned close = not_far_ahead(row, brick, first, last);
      for (int x = 0; x < block_size; ++x) {
        const int position = row + x;
        if (!(close >> x & 1) || material[position] != own) continue;
        const Int3 v = low + Int3(x, row / block_size % block_size, row / (block_size * block_size));
        count += hold(v, position, brick, first, last) ? 1 : 0;
      }
    }
    if (count > 0) atomic_add(held, count);
  }

 private:
  /// A bit for each voxel of a row: whether the brick's material is at most `thin_margin` ahead of all others.
  NACRE_HD unsigned not_far_ahead(int row, std::uint32_t mine, std::uint32_t first, std::uint32_t last) const {
    Eight most = eight(-3e38f);
    for (std::uint32_t k = first; k < last; ++k)
      if (k != mine) most = max(most, load_eight(smooth.value + std::size_t(k) * brick_voxels + row));
    return at_most(load_eight(smooth.value + std::size_t(mine) * brick_voxels + row) - most, eight(thin_margin));
  }

  NACRE_HD bool hold(const Int3& v, int position, std::uint32_t mine, std::uint32_t first, std::uint32_t last) const {
    std::uint32_t rival = first;
    float most = -3e38f;
    for (std::uint32_t k = first; k < last; ++k) {
      const float f = smooth.value[std::size_t(k) * brick_voxels + position];
      if (k != mine && f > most) most = f, rival = k;
    }
    const float lead = smooth.value[std::size_t(mine) * brick_voxels + position] - most;
    if (lead >= thin_margin) return false;
    const float wanted = is_thin(v, smooth.brick_material[mine]) ? thin_margin : margin;
    if (lead >= wanted) return false;
    const float share = 0.5f * gain * (1.2f * wanted - lead);  // a little more, so that rounds come to an end
    correction[std::size_t(mine) * brick_voxels + position] = share;
    const std::uint64_t reached = bricks_within(position, reach);
    atomic_or(changed + mine, reached);
    // Nobody else writes to this voxel of the rival's brick: it is processed once.
    correction[std::size_t(rival) * brick_voxels + position] = -share;
    atomic_or(changed + rival, reached);
    return true;
  }

  /// No 2^3 voxels of the same material hold this one.
  NACRE_HD bool is_thin(const Int3& v, std::uint32_t own) const {
    const Int3 n = smooth.voxels();
    for (int corner = 0; corner < 8; ++corner) {
      const Int3 low = v - Int3(corner & 1, corner >> 1 & 1, corner >> 2);
      if (low.x < 0 || low.y < 0 || low.z < 0 || low.x + 1 >= n.x || low.y + 1 >= n.y || low.z + 1 >= n.z) return false;
      if (smooth.each_material(low, low + Int3(2), [&](std::uint16_t m) { return m == own; })) return false;
    }
    return true;
  }
};

}  // namespace detail

/// What tightening came to.
struct TightenResult {
  std::int64_t held = 0;  ///< most voxels that had to be held in one round
  std::int64_t left = 0;  ///< of the last round: still off by more than nothing
};

/// Fills the bricks of a label volume. Whitaker 2000 moves the binary boundary by its curvature and holds it in the
/// shell between the inner and outer voxel centres. Here the indicators of all materials are diffused at once, which is
/// that motion (Merriman, Bence & Osher 1992), by 2 G - G G, which leaves quadratics alone, so that boundaries do not
/// shrink with their curvature to leading order. Voxels that would change sides are then held by narrow Gaussians: the
/// result is smooth everywhere, and every voxel's centre stays in its material, thin ones by a wider margin. `width`:
/// of G in voxels, up to 1.5; 0: the binary functions as they are. `stairs`: the reach of LabelSlopes, voxels; 0: all
/// of a voxel is of its label.
template <class Backend>
TightenResult tighten(Executor<Backend>& exec, MaterialBricks& b, double width, double stairs) {
  constexpr int reach = 6, narrow_reach = 2;
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  TightenResult result;
  const std::int64_t bricks = b.bricks - 2;
  constexpr int rows = block_size * block_size;
  exec.for_each(2 * brick_voxels, detail::FillConstantBricks{b.value.data(), 0, 1});
  if (width <= 0) {
    exec.for_each(bricks * rows, detail::FillBinary{b.view(), b.brick_block.data(), b.value.data()});
    return result;
  }
  Array<float> source = arena.temporary<float>(b.value.size());
  Array<std::uint64_t> changed = arena.temporary<std::uint64_t>(b.bricks);
  Array<std::uint32_t> smoothed = arena.temporary<std::uint32_t>(b.bricks);
  Array<detail::Pairing> pairing = arena.temporary<detail::Pairing>(b.bricks);
  Array<std::uint64_t> held = arena.temporary<std::uint64_t>(1);
  MaterialBricksView from = b.view();
  from.value = source.data();
  b.value.fill_bytes(0);
  exec.for_each(2 * brick_voxels, detail::FillConstantBricks{source.data(), 0, 1});
  exec.for_each(bricks * rows, detail::FillBinary{b.view(), b.brick_block.data(), source.data()});
  if (stairs > 0)
    exec.for_each_team(std::int64_t(b.listed.size()),
                       detail::ShareAlongSlopes{{b.view(), float(stairs)}, b.listed.data(), source.data()});
  smoothed.fill_bytes(1);
  pairing.fill_bytes(0);
  exec.for_each(std::int64_t(b.listed.size()), detail::FindPairs{b.view(), b.listed.data(), pairing.data()});
  exec.for_each_team(
      bricks, detail::SmoothBrick<reach, 2>{from,
                                            b.brick_block.data(),
                                            smoothed.data(),
                                            pairing.data(),
                                            1,
                                            {GaussianTaps<reach>(width), GaussianTaps<reach>(width * std::sqrt(2.0))},
                                            {2, -1},
                                            b.value.data()});
  exec.for_each(2 * brick_voxels, detail::FillConstantBricks{b.value.data(), 0, 1});
  const GaussianTaps<narrow_reach> narrow(0.6);
  const float gain = 0.9f / (narrow.tap[narrow_reach] * narrow.tap[narrow_reach] * narrow.tap[narrow_reach]);
  source.fill_bytes(0);  // from now on corrections
  for (int round = 0; round < 60; ++round) {
    changed.fill_bytes(0);
    held.fill_bytes(0);
    exec.for_each(bricks, detail::HoldVoxels{b.view(), b.brick_block.data(), smoothed.data(), 0.04f, 0.25f, gain,
                                             narrow_reach, source.data(), changed.data(), held.data()});
    result.left = std::int64_t(held.download()[0]);
    result.held = std::max(result.held, result.left);
    if (result.left == 0) break;
    smoothed.fill_bytes(0);
    exec.for_each(bricks, detail::MarkReached{b.view(), b.brick_block.data(), changed.data(), smoothed.data()});
    exec.for_each_team(
        bricks, detail::SmoothBrick<narrow_reach, 1>{
                    from, b.brick_block.data(), smoothed.data(), pairing.data(), 0, {narrow}, {1}, b.value.data()});
    exec.for_each(bricks, detail::ClearCorrections{changed.data(), source.data()});
  }
  return result;
}

}  // namespace nacre
