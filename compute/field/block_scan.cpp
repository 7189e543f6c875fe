// Nacre: one pass through the voxels of a volume, slab by slab, that finds the blocks near boundaries.
#include "compute/field/block_scan.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace nacre {
namespace {

/// Whether the four values from `v` on are `first`.
template <class T>
bool are_four(const T* v, T first) {
  using Word = std::conditional_t<sizeof(T) == 1, std::uint32_t, std::uint64_t>;
  Word word;
  std::memcpy(&word, v, sizeof(word));
  return word == Word(first) * (Word(~Word(0)) / Word(T(~T(0))));
}

/// The cube of voxels of a volume that begins at `low` (which may lie outside), if it is of one material.
template <class T>
class CubeOfVoxels {
 public:
  CubeOfVoxels(const T* values, const std::uint16_t* table, const Int3& dims)
      : values_(values), table_(table), dims_(dims) {}

  /// Its material; `otherwise` where there are several.
  std::uint32_t material(const Int3& low, int edge, std::uint32_t otherwise) const {
    if (is_alike(low, edge)) return meaning(values_[number(low)]);
    const std::uint32_t first = at(low);
    for (int z = 0; z < edge; ++z)
      for (int y = 0; y < edge; ++y)
        for (int x = 0; x < edge; ++x)
          if (at(low + Int3(x, y, z)) != first) return otherwise;
    return first;
  }

  std::uint16_t at(const Int3& v) const { return is_within(v, dims_) ? meaning(values_[number(v)]) : std::uint16_t(0); }

 private:
  std::uint16_t meaning(T value) const { return table_ ? table_[value] : std::uint16_t(value); }
  std::size_t number(const Int3& v) const {
    return (std::size_t(v.z) * std::size_t(dims_.y) + std::size_t(v.y)) * std::size_t(dims_.x) + std::size_t(v.x);
  }

  /// All of it lies inside and has one value.
  bool is_alike(const Int3& low, int edge) const {
    if (edge != 4 || !is_within(low, dims_) || !is_within(low + Int3(edge - 1), dims_)) return false;
    const T first = values_[number(low)];
    for (int z = 0; z < edge; ++z) {
      const T* row = values_ + number(low + Int3(0, 0, z));
      for (int y = 0; y < edge; ++y, row += dims_.x)
        if (!are_four(row, first)) return false;
    }
    return true;
  }

  const T* values_;
  const std::uint16_t* table_;
  Int3 dims_;
};

}  // namespace

Int3 BlockScan::blocks_of(const Int3& dims) {
  Int3 blocks;
  for (int axis = 0; axis < 3; ++axis) blocks[axis] = (dims[axis] + 2 * volume_padding + block_size - 1) / block_size;
  return blocks;
}

BlockScan::BlockScan(const Int3& dims, const MaterialArray& material, int layers)
    : dims_(dims), blocks_(blocks_of(dims)), material_(material), layers_(layers) {
  constexpr std::int64_t enough = std::int64_t(1) << 15;  // blocks of a slab
  if (layers_ <= 0)
    layers_ = int(std::max<std::int64_t>(1, enough / std::max<std::int64_t>(1, std::int64_t(blocks_.x) * blocks_.y)));
}

/// Layer `layer` of cubes of 4^3 voxels, of which a block has two along each axis.
void BlockScan::summarise(int layer, Cubes& cubes) const {
  const int nx = 2 * blocks_.x, ny = 2 * blocks_.y, z = layer * cube - volume_padding;
  cubes.assign(std::size_t(nx) * std::size_t(ny), 0);
  if (z + cube <= 0 || z >= dims_.z) return;
  material_.visit([&](const auto* values, const std::uint16_t* table) {
    const CubeOfVoxels voxels(values, table, dims_);
    tbb::parallel_for(0, ny, [&](int j) {
      const int y = j * cube - volume_padding;
      if (y + cube <= 0 || y >= dims_.y) return;
      std::uint32_t* row = cubes.data() + std::size_t(j) * std::size_t(nx);
      const int last = std::min(nx, (dims_.x + volume_padding + cube - 1) / cube);
      for (int i = volume_padding / cube; i < last; ++i)
        row[i] = voxels.material({i * cube - volume_padding, y, z}, cube, mixed);
    });
  });
}

/// Notes for each block of layer `z` the material of all that is within 4 voxels of it, or that there are several.
void BlockScan::find_listed(int z, BlockSlab& slab) const {
  const int nx = 2 * blocks_.x, ny = 2 * blocks_.y, nz = 2 * blocks_.z;
  std::uint32_t* const content = slab.content.data() + std::size_t(z - next_) * std::size_t(blocks_.x * blocks_.y);
  tbb::parallel_for(0, blocks_.y, [&](int y) {
    std::vector<std::uint32_t> row;  // of the four by four rows around
    for (int k = std::max(0, 2 * z - 1); k < std::min(nz, 2 * z + 3); ++k)
      for (int j = std::max(0, 2 * y - 1); j < std::min(ny, 2 * y + 3); ++j) {
        const std::uint32_t* from = cubes_[std::size_t(k - first_cubes_)].data() + std::size_t(j) * std::size_t(nx);
        if (row.empty())
          row.assign(from, from + nx);
        else
          for (int i = 0; i < nx; ++i) row[std::size_t(i)] = row[std::size_t(i)] == from[i] ? from[i] : mixed;
      }
    for (int x = 0; x < blocks_.x; ++x) {
      std::uint32_t all = row[std::size_t(2 * x)];
      for (int i = std::max(0, 2 * x - 1); i < std::min(nx, 2 * x + 3); ++i)
        if (row[std::size_t(i)] != all) all = mixed;
      content[std::size_t(y) * std::size_t(blocks_.x) + std::size_t(x)] = all;
    }
  });
}

/// The materials of the voxels of the blocks in `listed`, whose numbers go on from `voxel_bricks`.
void BlockScan::copy_voxels(BlockSlab& slab, std::uint32_t voxel_bricks) const {
  slab.voxels.resize(slab.listed.size() * brick_voxels);
  material_.visit([&](const auto* values, const std::uint16_t* table) {
    const CubeOfVoxels voxels(values, table, dims_);
    tbb::parallel_for(std::size_t(0), slab.listed.size(), [&](std::size_t k) {
      const std::int64_t block = slab.listed[k];
      const Int3 low =
          Int3(int(block % blocks_.x), int(block / blocks_.x % blocks_.y), int(block / blocks_.x / blocks_.y)) *
              Int3(block_size) -
          Int3(volume_padding);
      std::uint16_t* to = slab.voxels.data() + k * brick_voxels;
      for (int i = 0; i < brick_voxels; ++i)
        to[i] = voxels.at(low + Int3(i % block_size, i / block_size % block_size, i / (block_size * block_size)));
      slab.content[std::size_t(block - slab.first)] = voxel_bricks + std::uint32_t(k);
    });
  });
}

bool BlockScan::next(BlockSlab& slab) {
  if (next_ >= blocks_.z) return false;
  const int last = std::min(blocks_.z, next_ + layers_);
  const int first_cubes = std::max(0, 2 * next_ - 1), last_cubes = std::min(2 * blocks_.z, 2 * last + 1);
  std::vector<Cubes> cubes(std::size_t(last_cubes - first_cubes));
  for (int k = first_cubes; k < last_cubes; ++k) {
    const int known = k - first_cubes_;
    Cubes& to = cubes[std::size_t(k - first_cubes)];
    if (known >= 0 && known < int(cubes_.size()))
      to = std::move(cubes_[std::size_t(known)]);
    else
      summarise(k, to);
  }
  cubes_ = std::move(cubes);
  first_cubes_ = first_cubes;

  const std::int64_t layer = std::int64_t(blocks_.x) * blocks_.y;
  slab.first = next_ * layer;
  slab.content.resize(std::size_t((last - next_) * layer));
  for (int z = next_; z < last; ++z) find_listed(z, slab);
  slab.listed.clear();
  for (std::size_t b = 0; b < slab.content.size(); ++b)
    if (slab.content[b] == mixed)
      slab.listed.push_back(std::uint32_t(slab.first + std::int64_t(b)));
    else
      slab.content[b] |= MaterialBricksView::one_material;
  copy_voxels(slab, listed_);
  listed_ += std::uint32_t(slab.listed.size());

  const auto voxels_below = [&](int z) {
    return std::size_t(std::clamp(z * block_size - volume_padding, 0, dims_.z)) * std::size_t(dims_.x) *
           std::size_t(dims_.y);
  };
  material_.let_go(voxels_below(next_), voxels_below(last));
  next_ = last;
  return true;
}

}  // namespace nacre
