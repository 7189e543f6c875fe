// Nacre: meshes of real volumes: no label lost, closed, near the interfaces.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <set>

#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/scene/materials.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

const std::filesystem::path data = std::filesystem::path(NACRE_SHARED_DATA) / "labels";

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
  std::printf("%s: %zu triangles, %d surfaces, %d curves, %d points (%d crowded), ratio mean %.4f min %.3f, away %.4f %.3f, "
              "under 25 %.3f%%, distance vertex %.4f facet %.4f, max %.3f\n",
              name, run.mesh.triangles.size(), run.info.surfaces, run.info.curves, run.info.points,
              run.info.crowded_points, q.all.radius_ratio_mean, q.all.radius_ratio_min,
              q.away_from_junctions.radius_ratio_mean, q.away_from_junctions.radius_ratio_min,
              100 * q.away_from_junctions.share_under_25, run.distance.vertex_mean, run.distance.facet_mean,
              run.distance.facet_max);
  EXPECT_LE(run.distance.vertex_mean, 0.1) << name;
  EXPECT_LE(run.distance.facet_mean, 0.1) << name;
  return run;
}

MeshVolume read(const std::vector<std::string>& files, const MaterialOptions& options = {}) {
  std::vector<Volume> volumes;
  for (const std::string& file : files) volumes.push_back(read_volume(data / file));
  return make_mesh_volume(volumes, options);
}

TEST(MeshData, Everything) {
  for (const char* f : {"420", "12323", "20012323", "40420", "quadDomainCube"}) {
    const MeshVolume v = read({std::string("junctions/") + f + ".inr"});
    std::printf("dims %d %d %d labels", v.dims.x, v.dims.y, v.dims.z);
    for (auto l : v.labels) std::printf(" %ld", long(l));
    for (auto m : v.material) if (v.material.size() < 30) std::printf(" %d", m);
    puts("");
    mesh_of(v, f);
  }
  mesh_of(read({"cleaver/mickey.nrrd"}), "mickey");
  mesh_of(read({"cleaver/spheres1.nrrd", "cleaver/spheres2.nrrd", "cleaver/spheres3.nrrd", "cleaver/spheres4.nrrd"}), "spheres");
  mesh_of(read({"nested-head/standard_seg.nrrd"}), "standard_seg");
}

}  // namespace
}  // namespace nacre::test
