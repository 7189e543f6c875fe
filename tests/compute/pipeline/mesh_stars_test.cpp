// Nacre: meshes of stars through the whole pipeline, beside those of Delaunay cells.
#include <gtest/gtest.h>

#include "compute/device/error.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/mesh_choices.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

MeshRun run_with(const char* triangles, const MeshVolume& volume, int threads = 0, const MeshParameters& base = {}) {
  const auto device = make_cpu_device(threads);
  MeshParameters parameters = base;
  parameters.triangles = triangles;
  return run_mesh(*device, volume, parameters);
}

TEST(MeshStars, AreAsGoodAsCells) {
  for (const MeshVolume& volume : {three_materials(), three_balls(), label_balls()}) {
    const int materials = int(volume.labels.size());
    const MeshRun stars = run_with("stars", volume), cells = run_with("delaunay", volume);
    EXPECT_GT(stars.info.stars.meshes, 0);
    EXPECT_EQ(stars.info.stars.fallbacks, 0);
    EXPECT_EQ(cells.info.stars.meshes + cells.info.stars.fallbacks, 0);
    const TopologyReport mine = check_topology(stars.mesh, materials), other = check_topology(cells.mesh, materials);
    EXPECT_TRUE(mine.sound());
    for (int m = 0; m < materials; ++m) {
      const auto i = std::size_t(m);
      EXPECT_EQ(mine.materials[i].euler, other.materials[i].euler) << m;
      EXPECT_NEAR(mine.materials[i].volume, other.materials[i].volume, 0.005 * std::abs(other.materials[i].volume));
    }
    EXPECT_NEAR(double(mine.triangles), double(other.triangles), 0.01 * double(other.triangles));
    EXPECT_GT(surface_quality(stars.mesh).all.radius_ratio_mean,
              surface_quality(cells.mesh).all.radius_ratio_mean - 0.005);
    EXPECT_LT(stars.distance.facet_mean, 1.05 * cells.distance.facet_mean);
  }
}

TEST(MeshStars, OneSeedGivesOneMeshOnAnyNumberOfThreads) {
  const MeshRun one = run_with("stars", three_balls(), 1);
  ASSERT_GT(one.info.stars.meshes, 0);
  expect_same(one.mesh, run_with("stars", three_balls(), 2).mesh);
}

TEST(MeshStars, InAMirroredWorldTooNormalsPointOutwards) {
  MeshVolume volume = three_balls();
  volume.axes[0] = -1.0 * volume.axes[0];
  const MeshRun stars = run_with("stars", volume);
  ASSERT_GT(stars.info.stars.meshes, 0);
  const TopologyReport topology = check_topology(stars.mesh, 4);
  EXPECT_TRUE(topology.sound());
  for (std::size_t m = 1; m < 4; ++m) EXPECT_GT(topology.materials[m].volume, 100);
}

/// Cubes of three voxels, with particles as far apart: more junctions than anything else.
TEST(MeshStars, WhatTheyCannotMeshIsMadeOfCellsInPatchesOrAltogether) {
  MeshParameters coarse;
  coarse.min_size = coarse.max_size = 3;
  const MeshVolume volume = label_volume({30, 30, 30}, 3, [](const Vec3d& p) {
    return std::min({p.x, p.y, p.z}) < 5 || std::max({p.x, p.y, p.z}) > 24
               ? 0
               : (int(p.x) / 3 + int(p.y) / 3 + int(p.z) / 3) % 3;
  });
  const MeshRun stars = run_with("stars", volume, 0, coarse);
  EXPECT_GT(stars.info.stars.fallbacks + stars.info.stars.last.in_patches, 0);
  EXPECT_GT(stars.mesh.triangles.size(), 0);
  EXPECT_EQ(check_topology(stars.mesh, 3).boundary_edges, 0);
}

/// Meshes on the way have no patches, but the last one has, however many there are.
TEST(MeshStars, ThePatchesAreThereAfterAnyNumberOfRounds) {
  // Small cubes in a corner of a large one.
  const MeshVolume volume = label_volume({36, 36, 36}, 3, [](const Vec3d& p) {
    if (std::min({p.x, p.y, p.z}) < 5 || std::max({p.x, p.y, p.z}) > 30) return 0;
    return std::max({p.x, p.y, p.z}) > 14 ? 1 : (int(p.x) / 3 + int(p.y) / 3 + int(p.z) / 3) % 3;
  });
  int fallbacks = 0;  // such a volume has one in four or five
  for (const int smooth : {1, 2})
    for (const int remesh : {0, 4}) {
      int patched = 0;
      for (const std::uint32_t seed : {1, 2, 3, 4}) {
        MeshParameters rounds;
        rounds.min_size = rounds.max_size = 1.8;
        rounds.smooth = smooth, rounds.remesh = remesh;
        rounds.seed = seed;
        const MeshRun stars = run_with("stars", volume, 0, rounds);
        fallbacks += stars.info.stars.fallbacks;
        patched += stars.info.stars.last.in_patches > 0;
        EXPECT_EQ(check_topology(stars.mesh, 3).boundary_edges, 0) << smooth << ' ' << remesh << ' ' << seed;
      }
      EXPECT_GE(patched, 1) << smooth << ' ' << remesh;
    }
  EXPECT_LE(fallbacks, 8);
}

/// A body of one voxel may be lost in a draft (and is then named as lost); the mesh is sound without it.
TEST(MeshStars, ADraftIsSoundWhereALabelHasOneVoxel) {
  MeshParameters draft;
  draft.quality = "draft";
  const auto device = make_cpu_device();
  const TopologyReport topology = check_topology(run_mesh(*device, three_materials(), draft).mesh, 4);
  EXPECT_TRUE(topology.sound());
  EXPECT_TRUE(topology.materials[1].closed && topology.materials[2].closed);
}

/// A draft is a closed mesh of the same bodies, with triangles that are good to look at.
TEST(MeshStars, ADraftIsSound) {
  MeshParameters draft;
  draft.quality = "draft";
  for (const MeshVolume& volume : {three_balls(), label_balls()}) {
    const auto device = make_cpu_device();
    const MeshRun run = run_mesh(*device, volume, draft);
    EXPECT_GT(run.info.stars.meshes, 0);
    EXPECT_LE(run.info.iterations - run.info.coarse_iterations, 8);
    const int materials = int(volume.labels.size());
    const TopologyReport topology = check_topology(run.mesh, materials);
    EXPECT_TRUE(topology.sound());
    for (int m = 1; m < materials; ++m) EXPECT_TRUE(topology.materials[std::size_t(m)].closed) << m;
    EXPECT_GT(surface_quality(run.mesh).all.radius_ratio_mean, 0.93);
  }
}

TEST(MeshStars, ADraftTakesLessOnlyAndTheBestMore) {
  MeshParameters p;
  p.quality = "draft";
  const MeshParameters draft = at_quality(p);
  EXPECT_EQ(draft.triangles, "stars");
  EXPECT_LT(draft.iterations, p.iterations);
  EXPECT_LT(draft.coarse_iterations, p.coarse_iterations);
  EXPECT_LT(draft.smooth, p.smooth);
  p.iterations = 3, p.remesh = 0, p.triangles = "delaunay";  // said so
  p.projection = "embedding";
  EXPECT_EQ(at_quality(p).projection, "fields") << "an embedding takes longer";
  EXPECT_EQ(at_quality(p).iterations, 3);
  EXPECT_EQ(at_quality(p).remesh, 0);
  EXPECT_EQ(at_quality(p).triangles, "delaunay");
  p.quality = "best";
  EXPECT_GT(at_quality(p).iterations, MeshParameters().iterations);
  p.quality = "standard";
  EXPECT_EQ(at_quality(p).iterations, 3);
  p.quality = "good";
  EXPECT_THROW(at_quality(p), Error);
}

}  // namespace
}  // namespace nacre::test
