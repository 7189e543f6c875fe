// Nacre: volumes whose materials have formulas, for tests of fields and meshes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "compute/field/material_bricks.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre::test {

/// A function of a place in the volume, in units of the index: voxel (i, j, k) has its centre at (i, j, k).
using PlaceFunction = std::function<double(const Vec3d&)>;

inline MeshVolume empty_volume(const Int3& dims, int materials, MeshVolume::Kind kind) {
  MeshVolume volume;
  volume.kind = kind;
  volume.dims = dims;
  for (int m = 0; m < materials; ++m) volume.labels.push_back(m);
  return volume;
}

/// Calls visit(number, centre) for every voxel, x fastest.
template <class Visit>
void for_each_voxel(const Int3& dims, const Visit& visit) {
  std::size_t at = 0;
  for (int k = 0; k < dims.z; ++k)
    for (int j = 0; j < dims.y; ++j)
      for (int i = 0; i < dims.x; ++i) visit(at++, Vec3d(i, j, k));
}

/// Labels below `materials`.
inline MeshVolume label_volume(const Int3& dims, int materials, const PlaceFunction& label) {
  MeshVolume volume = empty_volume(dims, materials, MeshVolume::Kind::labels);
  volume.material.own().resize(volume.voxels());
  for_each_voxel(dims, [&](std::size_t at, const Vec3d& p) { volume.material.own()[at] = std::uint16_t(label(p)); });
  return volume;
}

/// One function, cut at `levels`.
inline MeshVolume scalar_volume(const Int3& dims, const PlaceFunction& value, const std::vector<float>& levels = {0}) {
  MeshVolume volume = empty_volume(dims, int(levels.size()) + 1, MeshVolume::Kind::scalar);
  volume.levels = levels;
  volume.values.emplace_back(volume.voxels());
  volume.material.own().resize(volume.voxels());
  for_each_voxel(dims, [&](std::size_t at, const Vec3d& p) {
    const float v = float(value(p));
    volume.values[0][at] = v;
    volume.material.own()[at] = std::uint16_t(std::upper_bound(levels.begin(), levels.end(), v) - levels.begin());
  });
  return volume;
}

/// A function per material, the outside's first: the largest wins.
inline MeshVolume indicator_volume(const Int3& dims, const std::vector<PlaceFunction>& functions) {
  MeshVolume volume = empty_volume(dims, int(functions.size()), MeshVolume::Kind::indicators);
  volume.values.assign(functions.size(), std::vector<float>(volume.voxels()));
  volume.material.own().resize(volume.voxels());
  for_each_voxel(dims, [&](std::size_t at, const Vec3d& p) {
    for (std::size_t m = 0; m < functions.size(); ++m) {
      volume.values[m][at] = float(functions[m](p));
      if (volume.values[m][at] > volume.values[volume.material[at]][at]) volume.material.own()[at] = std::uint16_t(m);
    }
  });
  return volume;
}

/// A ball and half a shell around it, and a voxel alone: surfaces, a curve, an island.
inline MeshVolume three_materials() {
  const Vec3d c(12.2, 11.7, 12.4);
  return label_volume({26, 25, 26}, 4, [=](const Vec3d& p) {
    const double r = length(p - c);
    return p == Vec3d(23, 3, 2) ? 3 : r < 6.3 ? 1 : r < 9.8 && p.x > 11 ? 2 : 0;
  });
}

/// Three overlapping balls, each with its own material: curves that meet in two points.
inline MeshVolume three_balls() {
  const Vec3d c(12.2, 11.7, 12.4);
  std::vector<PlaceFunction> functions{[](const Vec3d&) { return 0.0; }};
  for (const double a : {0.3, 0.3 + 2 * M_PI / 3, 0.3 + 4 * M_PI / 3}) {
    const Vec3d centre = c + Vec3d(std::cos(a), std::sin(a), 0.2) * 4.0;
    functions.push_back([=](const Vec3d& p) { return 6 - length(p - centre); });
  }
  return indicator_volume({26, 25, 26}, functions);
}

/// The same as labels.
inline MeshVolume label_balls() {
  MeshVolume volume = three_balls();
  volume.kind = MeshVolume::Kind::labels;
  volume.values.clear();
  return volume;
}

/// Signed distance to a sphere, positive inside.
inline PlaceFunction ball(const Vec3d& centre, double radius) {
  return [=](const Vec3d& p) { return radius - length(p - centre); };
}

/// Where a position of the volume is in the fields' voxels, at a spacing of one.
inline Vec3f in_fields(const Vec3d& position) { return Vec3f(position + Vec3d(volume_padding + 0.5)); }

/// Directions spread evenly over the sphere (a spiral of golden angles).
inline std::vector<Vec3d> even_directions(int count) {
  std::vector<Vec3d> directions;
  for (int k = 0; k < count; ++k) {
    const double z = 1 - (2 * k + 1.0) / count, a = k * 2.399963229728653, r = std::sqrt(1 - z * z);
    directions.push_back({r * std::cos(a), r * std::sin(a), z});
  }
  return directions;
}

/// A mesh and what was found on the way to it.
struct MeshRun {
  SurfaceMesh mesh;
  MeshInfo info;
  SurfaceDistance distance;
};

inline void expect_same(const SurfaceMesh& a, const SurfaceMesh& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  EXPECT_TRUE(std::equal(a.points.begin(), a.points.end(), b.points.begin()));
  EXPECT_TRUE(a.triangles == b.triangles);
  EXPECT_EQ(a.materials, b.materials);
}

inline MeshRun run_mesh(Device& device, const MeshVolume& volume, const MeshParameters& parameters = {}) {
  const auto pipeline = make_mesh_pipeline(device);
  pipeline->parameters = parameters;
  pipeline->load(volume);
  pipeline->build_fields();
  pipeline->relax();
  MeshRun run;
  run.mesh = pipeline->triangulate();
  run.distance = pipeline->surface_distance(run.mesh);
  run.info = pipeline->info();
  return run;
}

}  // namespace nacre::test
