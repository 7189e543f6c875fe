// Nacre: which points of a mesh are measured, and what is made of their distances.
#include "compute/pipeline/mesh_distance.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

TEST(MeshDistance, VerticesInUseAndCentresOfFacetsAreMeasured) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {9, 9, 9}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}};
  mesh.triangles = {{0, 2, 3}, {0, 3, 4}};
  mesh.materials = {{0, 1}, {1, 2}};
  const DistanceSamples samples = distance_samples(mesh);
  EXPECT_EQ(samples.vertices, 4u);
  ASSERT_EQ(samples.points.size(), 6u);
  EXPECT_EQ(samples.points[1], Vec3d(3, 0, 0));
  EXPECT_EQ(samples.points[4], Vec3d(1, 1, 0));
  EXPECT_EQ(samples.interfaces[0], Junction(1, 2));
  EXPECT_EQ(samples.interfaces[1], Junction(0, 1));
  EXPECT_EQ(samples.interfaces[5], Junction(1, 2));
}

TEST(MeshDistance, WhatCouldNotBeMeasuredIsLeftOut) {
  DistanceSamples samples;
  samples.vertices = 3;
  const std::vector<float> distance{0.25f, -1, 0.75f, -1, -1};
  const SurfaceDistance d = summarise_distances(samples, distance);
  EXPECT_EQ(d.vertex_mean, 0.5);
  EXPECT_EQ(d.vertex_max, 0.75);
  EXPECT_EQ(d.facet_mean, 0);
  EXPECT_EQ(d.facet_max, 0);
}

}  // namespace
}  // namespace nacre
