// Nacre: where too many materials meet for one place, the rarest give way.
#include "compute/field/thin_materials.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compute/field/material_bricks.hpp"

namespace nacre {
namespace {

constexpr int thinning_rounds = 8;
constexpr int block_reach = 4;  // voxels around a block whose materials count
constexpr int spare = 4;        // as many more go, so that blocks around may put some back

/// What is within reach of one block, clipped to the volume.
class Block {
 public:
  Block(const Int3& dims, const Int3& block) : dims_(dims) {
    for (int axis = 0; axis < 3; ++axis) {
      const int begin = block[axis] * block_size - volume_padding - block_reach;
      const int end = begin + block_size + 2 * block_reach;
      low_[axis] = std::clamp(begin, 0, dims[axis]);
      size_[axis] = std::clamp(end, 0, dims[axis]) - low_[axis];
      beyond_ = beyond_ || begin < 0 || end > dims[axis];
    }
  }

  std::size_t count() const { return std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z); }
  bool reaches_beyond() const { return beyond_; }

  std::size_t voxel(std::size_t i) const {
    const auto nx = std::size_t(size_.x), ny = std::size_t(size_.y);
    const std::size_t x = i % nx + std::size_t(low_.x), y = i / nx % ny + std::size_t(low_.y),
                      z = i / nx / ny + std::size_t(low_.z);
    return (z * std::size_t(dims_.y) + y) * std::size_t(dims_.x) + x;
  }

  /// Calls visit(number here) for the up to six neighbours.
  template <class Visit>
  void neighbours(std::size_t i, const Visit& visit) const {
    const auto nx = std::size_t(size_.x), ny = std::size_t(size_.y), nz = std::size_t(size_.z);
    const std::size_t x = i % nx, y = i / nx % ny, z = i / nx / ny;
    if (x > 0) visit(i - 1);
    if (x + 1 < nx) visit(i + 1);
    if (y > 0) visit(i - nx);
    if (y + 1 < ny) visit(i + nx);
    if (z > 0) visit(i - nx * ny);
    if (z + 1 < nz) visit(i + nx * ny);
  }

 private:
  Int3 dims_, low_, size_;
  bool beyond_ = false;
};

/// Materials there with their numbers of voxels, ascending by material.
std::vector<std::pair<std::uint16_t, int>> list_materials(const Block& block,
                                                          const std::vector<std::uint16_t>& material) {
  std::vector<std::uint16_t> all;
  all.reserve(block.count() + 1);
  for (std::size_t i = 0; i < block.count(); ++i) all.push_back(material[block.voxel(i)]);
  if (block.reaches_beyond()) all.push_back(0);
  std::sort(all.begin(), all.end());
  std::vector<std::pair<std::uint16_t, int>> counted;
  for (const std::uint16_t m : all)
    if (counted.empty() || counted.back().first != m)
      counted.push_back({m, 1});
    else
      ++counted.back().second;
  return counted;
}

std::int64_t thin_block(const Block& block, std::vector<std::uint16_t>& material, int most) {
  auto counted = list_materials(block, material);
  if (int(counted.size()) <= most) return 0;
  std::sort(counted.begin(), counted.end(), [](const auto& s, const auto& t) {
    if ((s.first == 0) != (t.first == 0)) return s.first == 0;
    return s.second != t.second ? s.second > t.second : s.first < t.first;
  });
  counted.resize(std::size_t(std::max(1, most - spare)));
  std::vector<std::uint16_t> kept;
  for (const auto& [m, voxels] : counted) kept.push_back(m);
  std::sort(kept.begin(), kept.end());
  std::vector<std::uint8_t> known(block.count(), 0);
  std::vector<std::size_t> front, next;
  for (std::size_t i = 0; i < block.count(); ++i)
    if (std::binary_search(kept.begin(), kept.end(), material[block.voxel(i)])) known[i] = 1, front.push_back(i);
  std::int64_t changed = 0;
  for (; !front.empty(); front.swap(next)) {
    next.clear();
    for (const std::size_t i : front)
      block.neighbours(i, [&](std::size_t k) {
        if (known[k]) return;
        known[k] = 1;
        material[block.voxel(k)] = material[block.voxel(i)];
        ++changed;
        next.push_back(k);
      });
  }
  return changed;
}

}  // namespace

std::int64_t thin_materials(const Int3& dims, std::vector<std::uint16_t>& material, int most) {
  Int3 blocks;
  for (int axis = 0; axis < 3; ++axis) blocks[axis] = (dims[axis] + 2 * volume_padding + block_size - 1) / block_size;
  const std::size_t count = std::size_t(blocks.x) * std::size_t(blocks.y) * std::size_t(blocks.z);
  const auto block_of = [&](std::size_t b) {
    const auto nx = std::size_t(blocks.x), ny = std::size_t(blocks.y);
    return Block(dims, {int(b % nx), int(b / nx % ny), int(b / nx / ny)});
  };
  std::int64_t changed = 0;
  for (int round = 0; round < thinning_rounds; ++round) {
    std::vector<std::uint8_t> crowded(count, 0);
    tbb::parallel_for(std::size_t(0), count,
                      [&](std::size_t b) { crowded[b] = int(list_materials(block_of(b), material).size()) > most; });
    std::int64_t now = 0;
    for (std::size_t b = 0; b < count; ++b)
      if (crowded[b]) now += thin_block(block_of(b), material, most);
    if (now == 0) break;
    changed += now;
  }
  return changed;
}

}  // namespace nacre
