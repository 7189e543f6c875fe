// Nacre: too many materials in one place.
#include "compute/field/thin_materials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include "compute/meshing/topology.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

/// Materials of `count` random positions: each voxel has that of the nearest.
std::vector<std::uint16_t> cells_of(const Int3& dims, int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> x(0, dims.x), y(0, dims.y), z(0, dims.z);
  std::vector<Vec3d> positions;
  for (int i = 0; i < count; ++i) positions.push_back({x(generator), y(generator), z(generator)});
  std::vector<std::uint16_t> material;
  for (int k = 0; k < dims.z; ++k)
    for (int j = 0; j < dims.y; ++j)
      for (int i = 0; i < dims.x; ++i) {
        const Vec3d p(i, j, k);
        const auto nearest = std::min_element(positions.begin(), positions.end(), [&](const Vec3d& s, const Vec3d& t) {
          return dot(s - p, s - p) < dot(t - p, t - p);
        });
        material.push_back(std::uint16_t(nearest - positions.begin() + 1));
      }
  return material;
}

std::size_t most_in_a_window(const Int3& dims, const std::vector<std::uint16_t>& material) {
  std::size_t most = 0;
  for (int z = -12; z < dims.z; z += 8)
    for (int y = -12; y < dims.y; y += 8)
      for (int x = -12; x < dims.x; x += 8) {
        std::set<std::uint16_t> there;
        for (int k = z; k < z + 16; ++k)
          for (int j = y; j < y + 16; ++j)
            for (int i = x; i < x + 16; ++i) {
              const bool inside = std::min({i, j, k}) >= 0 && i < dims.x && j < dims.y && k < dims.z;
              there.insert(inside ? material[(std::size_t(k) * dims.y + j) * dims.x + i] : std::uint16_t(0));
            }
        most = std::max(most, there.size());
      }
  return most;
}

TEST(ThinMaterials, WhereFewMeetNothingChanges) {
  const Int3 dims{20, 18, 16};
  std::vector<std::uint16_t> material = cells_of(dims, 30, 1);
  const std::vector<std::uint16_t> before = material;
  EXPECT_EQ(thin_materials(dims, material, 64), 0);
  EXPECT_EQ(material, before);
}

TEST(ThinMaterials, TheRarestGiveWayAndNoMoreThanMustBe) {
  const Int3 dims{40, 24, 24};
  std::vector<std::uint16_t> material = cells_of({24, 24, 24}, 200, 2);
  // Beside them a plain half, in which nothing may change.
  std::vector<std::uint16_t> all;
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 40; ++i)
        all.push_back(i < 24 ? material[(std::size_t(k) * 24 + j) * 24 + i] : std::uint16_t(201));
  const std::vector<std::uint16_t> before = all;
  ASSERT_GT(most_in_a_window(dims, all), 64U);
  const std::int64_t changed = thin_materials(dims, all, 64);
  EXPECT_LE(most_in_a_window(dims, all), 64U);
  std::int64_t differ = 0;
  std::map<std::uint16_t, int> voxels;
  for (std::size_t i = 0; i < all.size(); ++i) {
    differ += all[i] != before[i];
    ++voxels[before[i]];
    if (i % 40 >= 28) {
      EXPECT_EQ(all[i], 201);
    }
  }
  EXPECT_GT(differ, 0);
  EXPECT_LE(differ, changed);
  EXPECT_LT(differ, std::int64_t(all.size() / 4));
  const std::uint16_t largest = std::max_element(voxels.begin(), std::prev(voxels.end()), [](auto& s, auto& t) {
                                  return s.second < t.second;
                                })->first;
  EXPECT_NE(std::find(all.begin(), all.end(), largest), all.end());
}

/// An atlas of 90 labels in a cube of 16 voxels.
TEST(LongThinMaterials, ACrowdedAtlasIsMeshedAndCounted) {
  const Int3 dims{16, 16, 16};
  MeshVolume volume = label_volume(dims, 91, [](const Vec3d&) { return 0; });
  volume.material = cells_of(dims, 90, 3);
  const auto device = make_cpu_device();
  MeshParameters coarse;
  coarse.quality = "draft";
  coarse.min_size = coarse.max_size = 1.5;
  const MeshRun run = run_mesh(*device, volume, coarse);
  EXPECT_GT(run.info.thinned_voxels, 0);
  EXPECT_GT(run.mesh.triangles.size(), 500U);
  EXPECT_EQ(check_topology(run.mesh, 91).boundary_edges, 0);
}

}  // namespace
}  // namespace nacre::test
