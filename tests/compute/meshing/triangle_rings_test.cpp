// Nacre: tests of the triangles around particles.
#include "compute/meshing/triangle_rings.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

TEST(TriangleRings, SidesOppositeByParticles) {
  SurfaceMesh mesh;
  mesh.points.resize(4);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<std::uint32_t> point_of = {1, 3, 4, 6};  // particles 0, 2 and 5 are at no triangle
  const TriangleRings all = triangle_rings(mesh, point_of, std::vector<std::uint8_t>{1, 1, 1, 1}, 8);
  EXPECT_EQ(all.first, (std::vector<std::uint32_t>{0, 0, 2, 2, 3, 5, 5, 6, 6}));
  const std::uint32_t sides[6][2] = {{3, 4}, {4, 6}, {4, 1}, {1, 3}, {6, 1}, {1, 4}};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(all.edge[k].a, sides[k][0]) << k;
    EXPECT_EQ(all.edge[k].b, sides[k][1]) << k;
  }
  const TriangleRings one = triangle_rings(mesh, point_of, std::vector<std::uint8_t>{0, 0, 0, 1}, 8);
  EXPECT_EQ(one.first, (std::vector<std::uint32_t>{0, 0, 0, 0, 0, 0, 0, 1, 1}));
  EXPECT_EQ(one.edge[0].a, 1u);
}

}  // namespace
}  // namespace nacre
