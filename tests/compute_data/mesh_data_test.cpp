// Nacre: meshes of real volumes: no label lost, closed, near the interfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/scene/volume/materials.hpp"
#include "tests/evidence/mesh_measures.hpp"
#include "tests/paths.hpp"

namespace nacre::test {
namespace {

/// The mesh of a data set and what is asked of each: sound, every label there, close to the interface.
MeshRun mesh_of(const MeshVolume& volume, const char* name, const MeshParameters& parameters = {}) {
  const auto device = make_cpu_device();
  MeshRun run = run_mesh(*device, volume, parameters);
  const TopologyReport report = check_topology(run.mesh, volume.materials());
  EXPECT_TRUE(report.sound()) << name << ": " << report.boundary_edges << " boundary, " << report.nonmanifold_edges
                              << " non-manifold, " << report.inconsistent_edges << " inconsistent edges, "
                              << report.nonmanifold_vertices << " non-manifold vertices";
  for (int m = 0; m < volume.materials(); ++m) {
    EXPECT_TRUE(report.materials[m].closed) << name << ", label " << volume.labels[m];
    EXPECT_GT(report.materials[m].facets, 0) << name << " has lost label " << volume.labels[m];
  }
  const SurfaceQuality q = surface_quality(run.mesh);
  std::printf(
      "%s: %zu triangles, %d surfaces, %d curves, %d points (%d crowded), ratio mean %.4f min %.3f, away %.4f %.3f, "
      "under 25 %.3f%%, distance vertex %.4f facet %.4f, max %.3f\n",
      name, run.mesh.triangles.size(), run.info.surfaces, run.info.curves, run.info.points, run.info.crowded_points,
      q.all.radius_ratio_mean, q.all.radius_ratio_min, q.away_from_junctions.radius_ratio_mean,
      q.away_from_junctions.radius_ratio_min, 100 * q.away_from_junctions.share_under_25, run.distance.vertex_mean,
      run.distance.facet_mean, run.distance.facet_max);
  EXPECT_LE(run.distance.vertex_mean, 0.1) << name;
  EXPECT_LE(run.distance.facet_mean, 0.1) << name;
  return run;
}

MeshVolume read(const std::vector<std::string>& files, const MaterialOptions& options = {}) {
  std::vector<Volume> volumes;
  for (const std::string& file : files) volumes.push_back(read_volume(shared_data("labels/" + file)));
  return make_mesh_volume(volumes, options);
}

/// Images of 2 x 2 x 2 voxels around which curves of three materials end in points of four, or do not. Among four
/// materials the number of points is even: at each, one curve of every three materials ends.
TEST(MeshData, TinyImagesHaveTheirJunctions) {
  NACRE_NEEDS_SHARED_DATA("labels/junctions");
  const struct {
    const char* name;
    int surfaces, curves, points;
  } images[] = {{"420", 3, 1, 0},    // 2 between 4 and the outside's corner: one curve around
                {"40420", 3, 1, 0},  // the same with a notch
                {"12323", 6, 4, 2},  // 1 touches 2 and 3, all meet the outside
                {"20012323", 6, 4, 2}};
  for (const auto& image : images) {
    SCOPED_TRACE(image.name);
    const MeshRun run = mesh_of(read({std::string("junctions/") + image.name + ".inr"}), image.name);
    EXPECT_EQ(run.info.surfaces, image.surfaces);
    EXPECT_EQ(run.info.curves, image.curves);
    EXPECT_EQ(run.info.points, image.points);
  }
}

/// A cube of four quadrants, whose axis is a line where four materials meet: it survives as curves of three. Triangles
/// along the axis may be slivers: no curve of four materials is stable.
TEST(MeshData, FourQuadrants) {
  NACRE_NEEDS_SHARED_DATA("labels/junctions");
  const MeshVolume volume = read({"junctions/quadDomainCube.inr"});
  const MeshRun run = mesh_of(volume, "quadrants");
  const TopologyReport report = check_topology(run.mesh, 5);
  EXPECT_TRUE(report.sound());
  for (int m = 1; m < 5; ++m) {
    const double voxels = double(volume.material.counts(volume.materials())[std::size_t(m)]);
    const double cell = volume.spacing.x * volume.spacing.y * volume.spacing.z;
    EXPECT_EQ(report.materials[m].euler, 2) << m;
    EXPECT_NEAR(report.materials[m].volume, voxels * cell, 0.04 * voxels * cell) << m;
  }
  EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.95);
}

/// Its smallest label has 27 voxels, 3 to an edge: smoothing takes its corners.
TEST(MeshData, Mickey) {
  NACRE_NEEDS_SHARED_DATA("labels/cleaver");
  const MeshVolume volume = read({"cleaver/mickey.nrrd"});
  const MeshRun run = mesh_of(volume, "mickey");
  expect_good_shapes(run, 0.97);
  const TopologyReport report = check_topology(run.mesh, volume.materials());
  for (int m = 1; m < volume.materials(); ++m) {
    const double voxels = double(volume.material.counts(volume.materials())[std::size_t(m)]);
    EXPECT_NEAR(report.materials[m].volume, voxels, 0.04 * voxels + 12) << "label " << volume.labels[m];
  }
}

TEST(MeshData, FourSpheresAsIndicators) {  // they fill the volume: all interfaces end at its faces
  NACRE_NEEDS_SHARED_DATA("labels/cleaver");
  const MeshVolume volume =
      read({"cleaver/spheres1.nrrd", "cleaver/spheres2.nrrd", "cleaver/spheres3.nrrd", "cleaver/spheres4.nrrd"});
  const MeshRun run = mesh_of(volume, "four spheres");
  expect_good_shapes(run);
  const TopologyReport report = check_topology(run.mesh, volume.materials());
  for (int m = 1; m < volume.materials(); ++m) EXPECT_EQ(report.materials[m].components, 1) << m;
  EXPECT_NEAR(-report.materials[0].volume, 28 * 28 * 28, 0.01 * 28 * 28 * 28);
}

TEST(MeshData, NestedHead) {  // shells that touch in a few positions at most
  NACRE_NEEDS_SHARED_DATA("labels/nested-head");
  MeshParameters parameters;
  parameters.min_size = 2;
  parameters.max_size = 4;
  const MeshVolume volume = read({"nested-head/standard_seg.nrrd"});
  const MeshRun run = mesh_of(volume, "nested head", parameters);
  EXPECT_GE(run.info.surfaces, 3);
  expect_good_shapes(run);
}

/// A CT volume and an iso-value, at the default's sizes.
TEST(MeshData, Skull) {
  NACRE_NEEDS_SHARED_DATA("labels/../scalar/skull_2.9.inr");
  MaterialOptions options;
  options.isovalues = {2.9};
  const MeshRun run = mesh_of(read({"../scalar/skull_2.9.inr"}, options), "skull");
  EXPECT_NEAR(double(run.mesh.triangles.size()), 42800, 2000);
  expect_good_shapes(run, 0.97);
}

}  // namespace
}  // namespace nacre::test
