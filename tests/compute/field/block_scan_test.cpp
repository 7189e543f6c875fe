// Nacre: tests of the pass through a volume that finds the blocks near boundaries.
#include "compute/field/block_scan.hpp"

#include <gtest/gtest.h>

#include <set>

#include "compute/device/random.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

/// Balls of several materials, one of them cut by the faces of the volume, and single voxels.
MeshVolume scattered(const Int3& dims) {
  return label_volume(dims, 6, [](const Vec3d& p) {
    if (length(p - Vec3d(9, 8, 9)) < 5) return 1;
    if (length(p - Vec3d(31, 30, 3)) < 6) return 2;
    if (p.x > 40 && p.z < 30) return 3;
    if (length(p - Vec3d(20, 33, 40)) < 0.5) return 4;
    return p.z > 51 ? 5 : 0;
  });
}

/// All slabs behind each other.
BlockSlab scanned(const Int3& dims, const MaterialArray& material, int layers) {
  BlockSlab all;
  BlockScan scan(dims, material, layers);
  for (BlockSlab slab; scan.next(slab);) {
    EXPECT_EQ(slab.first, std::int64_t(all.content.size()));
    all.content.insert(all.content.end(), slab.content.begin(), slab.content.end());
    all.listed.insert(all.listed.end(), slab.listed.begin(), slab.listed.end());
    all.voxels.insert(all.voxels.end(), slab.voxels.begin(), slab.voxels.end());
  }
  return all;
}

/// The labels of a volume as bytes or words that others hold, each one below the label by `shift`.
template <class T>
struct HeldLabels : HeldBytes {
  std::vector<T> labels;
  mutable std::set<std::pair<std::size_t, std::size_t>> gone;
  const std::byte* data() const override { return reinterpret_cast<const std::byte*>(labels.data()); }
  void let_go(std::size_t from, std::size_t to) const override { gone.insert({from, to}); }
};

template <class T>
MaterialArray as_labels(const MaterialArray& material, int materials, int shift, std::shared_ptr<HeldLabels<T>>& held) {
  held = std::make_shared<HeldLabels<T>>();
  std::vector<std::uint16_t> table(std::size_t(1) << 8 * sizeof(T), 0);
  for (int m = 0; m < materials; ++m) table[std::size_t(m + shift)] = std::uint16_t(m);
  for (const std::uint16_t m : material.numbers()) held->labels.push_back(T(m + shift));
  return {held, int(sizeof(T)), material.size(), table, material.counts(materials)};
}

std::uint16_t material_of(const MeshVolume& volume, const Int3& padded) {
  const Int3 v = padded - Int3(volume_padding), n = volume.dims;
  return is_within(v, n) ? volume.material[(std::size_t(v.z) * n.y + v.y) * n.x + v.x] : std::uint16_t(0);
}

TEST(BlockScan, ListsWhatHasTwoMaterialsWithinFourVoxels) {
  const MeshVolume volume = scattered({45, 38, 53});
  const BlockSlab all = scanned(volume.dims, volume.material, 1);
  const Int3 n = BlockScan::blocks_of(volume.dims), padded = n * Int3(block_size);
  ASSERT_EQ(all.content.size(), std::size_t(n.x) * n.y * n.z);
  std::size_t listed = 0;
  for (std::size_t b = 0; b < all.content.size(); ++b) {
    const Int3 low = Int3(int(b) % n.x, int(b) / n.x % n.y, int(b) / n.x / n.y) * Int3(block_size);
    std::set<std::uint16_t> around;
    const Int3 from = max(low - Int3(4), Int3(0)), to = min(low + Int3(12), padded);
    for (int z = from.z; z < to.z; ++z)
      for (int y = from.y; y < to.y; ++y)
        for (int x = from.x; x < to.x; ++x) around.insert(material_of(volume, {x, y, z}));
    if (around.size() == 1) {
      ASSERT_EQ(all.content[b], MaterialBricksView::one_material | *around.begin()) << b;
      continue;
    }
    ASSERT_EQ(all.content[b], listed) << b;
    ASSERT_EQ(all.listed[listed], b);
    for (int k = 0; k < brick_voxels; ++k)
      ASSERT_EQ(all.voxels[listed * brick_voxels + std::size_t(k)],
                material_of(volume, low + Int3(k % 8, k / 8 % 8, k / 64)));
    ++listed;
  }
  EXPECT_EQ(listed, all.listed.size());
  EXPECT_GT(listed, 50u);
  EXPECT_LT(listed, all.content.size());
}

TEST(BlockScan, DoesNotDependOnTheSlabs) {
  for (const Int3& dims : {Int3(45, 38, 53), Int3(48, 40, 56), Int3(2, 3, 61), Int3(33, 4, 7)}) {
    const MeshVolume volume = scattered(dims);
    const BlockSlab whole = scanned(dims, volume.material, 1000);
    for (const int layers : {0, 1, 2, 3, 5}) {
      const BlockSlab all = scanned(dims, volume.material, layers);
      EXPECT_EQ(all.content, whole.content) << layers;
      EXPECT_EQ(all.listed, whole.listed) << layers;
      EXPECT_EQ(all.voxels, whole.voxels) << layers;
    }
  }
}

template <class T>
void expect_labels_as_materials(int shift) {
  const MeshVolume volume = scattered({45, 38, 53});
  std::shared_ptr<HeldLabels<T>> held;
  const MaterialArray labels = as_labels<T>(volume.material, 6, shift, held);
  const BlockSlab expected = scanned(volume.dims, volume.material, 0), found = scanned(volume.dims, labels, 2);
  EXPECT_EQ(found.content, expected.content);
  EXPECT_EQ(found.voxels, expected.voxels);
  EXPECT_EQ(labels.copy(), volume.material.numbers());
  EXPECT_EQ(labels.counts(6), volume.material.counts(6));
  std::size_t gone = 0;  // each voxel is let go once, in order
  for (const auto& [from, to] : held->gone) {
    EXPECT_EQ(from, gone);
    gone = to;
  }
  EXPECT_EQ(gone, held->labels.size() * sizeof(T));
}

TEST(BlockScan, ReadsLabelsInTheirOwnType) {
  expect_labels_as_materials<std::uint8_t>(200);
  expect_labels_as_materials<std::uint16_t>(40000);
}

/// Two labels that mean the same make no boundary.
TEST(BlockScan, LabelsOfOneMaterialAreOne) {
  auto held = std::make_shared<HeldLabels<std::uint8_t>>();
  for (int i = 0; i < 32 * 32 * 32; ++i) held->labels.push_back(std::uint8_t(3 + i % 2));
  std::vector<std::uint16_t> table(256, 0);
  table[3] = table[4] = 1;
  const MaterialArray material(held, 1, held->labels.size(), table, {0, 32 * 32 * 32});
  const BlockSlab all = scanned({32, 32, 32}, material, 0);
  const Int3 n = BlockScan::blocks_of({32, 32, 32});
  const std::size_t middle = (3u * std::size_t(n.y) + 3u) * std::size_t(n.x) + 3u;
  EXPECT_EQ(all.content[middle], MaterialBricksView::one_material | 1u);
}

}  // namespace
}  // namespace nacre::test
