// Nacre: where triangles do not meet as they should.
#include "compute/meshing/star_seams.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace nacre::test {
namespace {

/// Tetrahedra of given materials in material 0, all with corner 0 and none with another in common.
StarMesh tetrahedra(const std::vector<std::uint16_t>& materials) {
  StarMesh mesh;
  std::uint32_t next = 1;
  for (const std::uint16_t m : materials) {
    const std::uint32_t a = next++, b = next++, c = next++;
    for (const Triangle& t : {Triangle{0, a, b}, Triangle{0, b, c}, Triangle{0, c, a}, Triangle{a, c, b}})
      mesh.triangles.push_back(t), mesh.materials.push_back({0, m});
  }
  return mesh;
}

std::vector<std::uint32_t> pinched(const StarMesh& mesh) {
  return at_pinched_vertices(mesh, std::vector<std::uint8_t>(3 * mesh.triangles.size(), 1));
}

TEST(StarSeams, BodiesThatMeetInOneVertexPinchWhatIsAroundThem) {
  EXPECT_TRUE(pinched(tetrahedra({1})).empty());
  EXPECT_EQ(pinched(tetrahedra({1, 1})), std::vector<std::uint32_t>{0});
  EXPECT_EQ(pinched(tetrahedra({1, 2})), std::vector<std::uint32_t>{0});
  EXPECT_EQ(pinched(tetrahedra({1, 2, 3})), std::vector<std::uint32_t>{0});
}

/// A vertex of a junction may be passed several times: it has no single surface.
TEST(StarSeams, AVertexOfAJunctionIsNotPinched) {
  StarMesh mesh;
  const std::uint32_t a = 0, b = 1, c = 2, up = 3, down = 4;
  for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
    mesh.triangles.push_back({from, to, up}), mesh.materials.push_back({0, 1});
    mesh.triangles.push_back({to, from, down}), mesh.materials.push_back({0, 2});
  }
  mesh.triangles.push_back({a, b, c}), mesh.materials.push_back({1, 2});
  EXPECT_TRUE(pinched(mesh).empty());
}

TEST(StarSeams, AnEdgeIsOpenWhereATriangleIsMissing) {
  StarMesh mesh = tetrahedra({1});
  const std::vector<std::uint8_t> all(4, 1);
  EXPECT_TRUE(edge_faults(mesh, all).empty());
  mesh.triangles.pop_back(), mesh.materials.pop_back();
  const std::vector<EdgeFault> faults = edge_faults(mesh, all);
  ASSERT_EQ(faults.size(), 6U);  // three edges, for both materials
  for (const EdgeFault& fault : faults) EXPECT_TRUE(fault.open && fault.ends[0] != 0);
}

}  // namespace
}  // namespace nacre::test
