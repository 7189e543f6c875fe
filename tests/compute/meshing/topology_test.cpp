// Nacre: tests of the examination of meshes.
#include "compute/meshing/topology.hpp"

#include <gtest/gtest.h>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

using Materials = std::array<std::uint16_t, 2>;

/// Adds the four outward triangles of a tetrahedron with positive volume, of material `m` in `outside`.
void add_tetrahedron(SurfaceMesh& mesh, std::array<std::uint32_t, 4> v, std::uint16_t m, std::uint16_t outside = 0) {
  for (const Triangle& t : {Triangle{v[1], v[2], v[3]}, Triangle{v[0], v[3], v[2]}, Triangle{v[0], v[1], v[3]},
                            Triangle{v[0], v[2], v[1]}}) {
    mesh.triangles.push_back(m > outside ? t : Triangle{t.a, t.c, t.b});
    mesh.materials.push_back({std::min(m, outside), std::max(m, outside)});
  }
}

SurfaceMesh tetrahedron() {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  add_tetrahedron(mesh, {0, 1, 2, 3}, 1);
  return mesh;
}

TEST(Topology, Tetrahedron) {
  SurfaceMesh mesh = tetrahedron();
  mesh.points.push_back({9, 9, 9});
  const TopologyReport r = check_topology(mesh, 3);
  EXPECT_TRUE(r.sound());
  EXPECT_EQ(r.vertices, 4);
  EXPECT_EQ(r.unused_points, 1);
  EXPECT_EQ(r.triangles, 4);
  EXPECT_EQ(r.edges, 6);
  EXPECT_EQ(r.components, 1);
  EXPECT_EQ(r.junction_edges, 0);
  ASSERT_EQ(r.materials.size(), 3u);
  EXPECT_EQ(r.materials[1].euler, 2);
  EXPECT_EQ(r.materials[1].facets, 4);
  EXPECT_TRUE(r.materials[1].closed);
  EXPECT_NEAR(r.materials[1].volume, 1. / 6, 1e-15);
  EXPECT_EQ(r.materials[0].euler, 2);
  EXPECT_FALSE(r.materials[2].closed);  // it has no surface
  EXPECT_EQ(r.materials[2].components, 0);
}

TEST(Topology, HoleDuplicateAndTurnedTriangleAreSeen) {
  SurfaceMesh open = tetrahedron();
  open.triangles.pop_back();
  open.materials.pop_back();
  TopologyReport r = check_topology(open, 2);
  EXPECT_EQ(r.boundary_edges, 3);
  EXPECT_EQ(r.inconsistent_edges, 3);
  EXPECT_FALSE(r.materials[1].closed);
  EXPECT_FALSE(r.sound());

  SurfaceMesh turned = tetrahedron();
  std::swap(turned.triangles[2].a, turned.triangles[2].b);
  r = check_topology(turned, 2);
  EXPECT_EQ(r.inconsistent_edges, 3);
  EXPECT_EQ(r.boundary_edges, 0);
  EXPECT_FALSE(r.sound());

  SurfaceMesh twice = tetrahedron();
  twice.triangles.push_back({twice.triangles[1].b, twice.triangles[1].a, twice.triangles[1].c});
  twice.materials.push_back({0, 1});
  r = check_topology(twice, 2);
  EXPECT_EQ(r.duplicate_triangles, 1);
  EXPECT_EQ(r.nonmanifold_edges, 3);

  SurfaceMesh flat = tetrahedron();
  flat.points[3] = {0.5, 0.5, 0};
  r = check_topology(flat, 2);
  EXPECT_EQ(r.degenerate_triangles, 1);  // on the line from 1 to 2
  flat.triangles[0] = {1, 1, 2};
  EXPECT_EQ(check_topology(flat, 2).degenerate_triangles, 1);
}

TEST(Topology, BodiesOfOneMaterialThatTouch) {
  SurfaceMesh mesh;  // in the edge 0-1
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}};
  add_tetrahedron(mesh, {0, 1, 2, 3}, 1);
  add_tetrahedron(mesh, {0, 1, 4, 5}, 1);
  TopologyReport r = check_topology(mesh, 2);
  EXPECT_EQ(r.nonmanifold_edges, 1);
  EXPECT_EQ(r.nonmanifold_vertices, 0);  // the edge joins the two vertex fans
  EXPECT_TRUE(pinched_points(mesh).empty());
  EXPECT_EQ(r.inconsistent_edges, 0);
  EXPECT_EQ(r.materials[1].euler, 3);
  EXPECT_EQ(r.materials[1].components, 1);
  EXPECT_TRUE(r.materials[1].closed);

  mesh = {};  // in vertex 0
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  add_tetrahedron(mesh, {0, 1, 2, 3}, 1);
  add_tetrahedron(mesh, {0, 4, 6, 5}, 1);
  r = check_topology(mesh, 2);
  EXPECT_EQ(r.nonmanifold_edges, 0);
  EXPECT_EQ(r.nonmanifold_vertices, 1);
  EXPECT_EQ(pinched_points(mesh), std::vector<std::uint32_t>{0});
  EXPECT_EQ(r.materials[1].euler, 3);
  EXPECT_NEAR(r.materials[1].volume, 2. / 6, 1e-15);
  EXPECT_FALSE(r.sound());

  mesh = {};  // apart
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {9, 0, 0}, {10, 0, 0}, {9, 1, 0}, {9, 0, 1}};
  add_tetrahedron(mesh, {0, 1, 2, 3}, 1);
  add_tetrahedron(mesh, {4, 5, 6, 7}, 1);
  r = check_topology(mesh, 2);
  EXPECT_TRUE(r.sound());
  EXPECT_EQ(r.components, 2);
  EXPECT_EQ(r.materials[1].components, 2);
  EXPECT_EQ(r.materials[1].euler, 4);
}

TEST(Topology, JunctionOfThreeMaterials) {
  SurfaceMesh mesh;  // two tetrahedra on a common triangle 0 1 2: material 1 above, 2 below
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {1, 4, 2}, {0, 2, 4}, {0, 4, 1}, {0, 2, 1}};
  mesh.materials = {{0, 1}, {0, 1}, {0, 1}, {0, 2}, {0, 2}, {0, 2}, {1, 2}};
  std::swap(mesh.triangles[6].b, mesh.triangles[6].c);  // seen from above, where 1 is
  TopologyReport r = check_topology(mesh, 3);
  EXPECT_TRUE(r.sound());
  EXPECT_TRUE(pinched_points(mesh).empty());
  EXPECT_EQ(r.junction_edges, 3);
  EXPECT_EQ(r.pinched_edges, 0);
  for (const MaterialTopology& m : r.materials) EXPECT_EQ(m.euler, 2);
  EXPECT_NEAR(r.materials[1].volume, 1. / 6, 1e-15);
  EXPECT_NEAR(r.materials[2].volume, 1. / 6, 1e-15);
  EXPECT_NEAR(r.materials[0].volume, -2. / 6, 1e-15);

  std::swap(mesh.triangles[6].b, mesh.triangles[6].c);
  r = check_topology(mesh, 3);
  EXPECT_EQ(r.inconsistent_edges, 3);
  EXPECT_TRUE(r.materials[0].closed);
  EXPECT_FALSE(r.materials[1].closed);
}

TEST(Topology, TwoMaterialsThatTouchInAnEdgePinchTheOneBetween) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}};
  add_tetrahedron(mesh, {0, 1, 2, 3}, 1);
  add_tetrahedron(mesh, {0, 1, 4, 5}, 2);
  const TopologyReport r = check_topology(mesh, 3);
  EXPECT_EQ(r.junction_edges, 1);
  EXPECT_EQ(r.pinched_edges, 1);  // the outside meets it in two wedges
  EXPECT_EQ(r.nonmanifold_edges, 0);
  EXPECT_EQ(r.materials[1].euler, 2);
  EXPECT_EQ(r.materials[0].euler, 3);
}

TEST(Topology, EmptyMeshAndBadMeshes) {
  const TopologyReport r = check_topology({}, 2);
  EXPECT_EQ(r.triangles + r.vertices + r.edges + r.components, 0);
  SurfaceMesh mesh = tetrahedron();
  EXPECT_THROW(check_topology(mesh, 1), Error);
  mesh.triangles[0].c = 4;
  EXPECT_THROW(check_topology(mesh, 2), Error);
  mesh = tetrahedron();
  mesh.materials[0] = {1, 0};
  EXPECT_THROW(check_topology(mesh, 2), Error);
  mesh.materials.pop_back();
  EXPECT_THROW(check_topology(mesh, 2), Error);
}

}  // namespace
}  // namespace nacre
