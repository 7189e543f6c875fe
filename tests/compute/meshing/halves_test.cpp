// Nacre: points of a mesh divided in two by the parts that they are in.
#include "compute/meshing/halves.hpp"

#include <gtest/gtest.h>

namespace nacre::test {
namespace {

using Lists = std::vector<std::vector<std::uint32_t>>;

/// So many strips of two triangles each, points 4k to 4k + 3.
SurfaceMesh strips(std::uint32_t count) {
  SurfaceMesh mesh;
  mesh.points.resize(4 * count);
  for (std::uint32_t k = 0; k < count; ++k)
    mesh.triangles.insert(mesh.triangles.end(), {{4 * k, 4 * k + 1, 4 * k + 2}, {4 * k + 2, 4 * k + 1, 4 * k + 3}});
  mesh.materials.assign(mesh.triangles.size(), {0, 1});
  return mesh;
}

TEST(Halves, PartsStayWhole) {
  const std::vector<std::uint8_t> marked = {1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 1, 0, 1, 0, 0, 0};
  EXPECT_EQ(halves(strips(4), marked), (Lists{{0, 3, 9, 10}, {12}}));
  EXPECT_EQ(halves(strips(4), std::vector<std::uint8_t>(16, 1)),
            (Lists{{0, 1, 2, 3, 4, 5, 6, 7}, {8, 9, 10, 11, 12, 13, 14, 15}}));
}

TEST(Halves, OnePartHasNone) {
  EXPECT_TRUE(halves(strips(2), std::vector<std::uint8_t>{1, 0, 0, 1, 0, 0, 0, 0}).empty());
  EXPECT_TRUE(halves(strips(2), std::vector<std::uint8_t>(8, 0)).empty());
}

/// As attempts go about pieces whose cells do not settle: the lists become shorter until each is of one part.
TEST(Halves, EndWithSingleParts) {
  const SurfaceMesh mesh = strips(7);
  std::vector<std::vector<std::uint32_t>> left = {{0, 5, 9, 13, 17, 21, 25}}, single;
  while (!left.empty()) {
    std::vector<std::uint8_t> marked(mesh.points.size(), 0);
    for (const std::uint32_t v : left.back()) marked[v] = 1;
    const Lists two = halves(mesh, marked);
    if (two.empty()) single.push_back(left.back());
    left.pop_back();
    left.insert(left.end(), two.begin(), two.end());
  }
  EXPECT_EQ(single.size(), 7u);
  for (const auto& points : single) EXPECT_EQ(points.size(), 1u);
}

}  // namespace
}  // namespace nacre::test
