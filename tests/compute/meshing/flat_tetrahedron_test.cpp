// Nacre: tests of a tetrahedron that goes from one material to another.
#include "compute/meshing/flat_tetrahedron.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace nacre::flat_tetrahedron_test {
namespace {

using Facets = std::vector<MaterialFacet>;

/// The face of tetrahedron (0, 1, 2, 3) opposite of `corner`, with material `inside` in it and `beyond` on the other
/// side. With corners at the origin and on the three axes, in this order, faces run counter-clockwise from outside.
MaterialFacet face(int corner, std::uint16_t inside, std::uint16_t beyond) {
  constexpr Triangle opposite[4] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  Triangle t = opposite[corner];
  if (inside < beyond) std::swap(t.b, t.c);  // it is seen from the side of the lower material
  return {t, {std::min(inside, beyond), std::max(inside, beyond)}};
}

/// Turned so that the smallest corner comes first; in order.
Facets canonical(Facets facets) {
  for (MaterialFacet& f : facets)
    while (f.corners.a > f.corners.b || f.corners.a > f.corners.c) f.corners = {f.corners.b, f.corners.c, f.corners.a};
  std::sort(facets.begin(), facets.end(), [](const auto& s, const auto& t) {
    return std::array{s.corners.a, s.corners.b, s.corners.c} < std::array{t.corners.a, t.corners.b, t.corners.c};
  });
  return facets;
}

/// The faces opposite of 3 and 2 are at edge (0, 1), with corners 2 and 3.
TEST(FlatTetrahedron, ASliverBetweenTwoMaterialsGoesToOneOfThem) {
  for (const std::uint16_t inside : {0, 5, 9}) {
    const Facets faces = {face(3, inside, 6), face(2, inside, 6), face(1, inside, 4), face(0, inside, 4)};
    const auto left = give_away(0, 1, 2, 3, faces);
    ASSERT_TRUE(left.has_value());
    EXPECT_EQ(canonical(*left), canonical({face(1, 6, 4), face(0, 6, 4)}));
    // The sense of u and v, of c and d, and the order of the faces do not matter.
    for (const auto& other : {give_away(1, 0, 2, 3, faces), give_away(0, 1, 3, 2, faces),
                              give_away(0, 1, 2, 3, Facets(faces.rbegin(), faces.rend()))}) {
      ASSERT_TRUE(other.has_value());
      EXPECT_EQ(canonical(*other), canonical(*left));
    }
  }
}

TEST(FlatTetrahedron, AFaceBesideTheSameMaterialVanishes) {
  const auto left = give_away(0, 1, 2, 3, Facets{face(3, 5, 4), face(2, 5, 4), face(1, 5, 4), face(0, 5, 6)});
  ASSERT_TRUE(left.has_value());
  EXPECT_EQ(canonical(*left), canonical({face(0, 4, 6)}));
}

TEST(FlatTetrahedron, WhereItWasOpenAFaceAppears) {
  const auto left = give_away(0, 1, 2, 3, Facets{face(3, 5, 6), face(2, 5, 6), face(1, 5, 4)});
  ASSERT_TRUE(left.has_value());
  EXPECT_EQ(canonical(*left), canonical({face(1, 6, 4), face(0, 6, 5)}));
}

TEST(FlatTetrahedron, NothingIsDoneWhereItIsNotClear) {
  // A body of one tetrahedron would be gone.
  EXPECT_FALSE(give_away(0, 1, 2, 3, Facets{face(3, 5, 4), face(2, 5, 4), face(1, 5, 4), face(0, 5, 4)}));
  // A corner with three triangles of one surface: either side may be inside.
  EXPECT_FALSE(give_away(0, 1, 2, 3, Facets{face(3, 5, 4), face(2, 5, 4), face(1, 5, 4)}));
  // No material is inside of all.
  EXPECT_FALSE(give_away(0, 1, 2, 3, Facets{face(3, 5, 6), face(2, 5, 6), face(1, 7, 4)}));
  // A face that the mesh has twice.
  EXPECT_FALSE(give_away(0, 1, 2, 3, Facets{face(3, 5, 6), face(2, 5, 6), face(1, 5, 4), face(1, 4, 5)}));
  // A flip is enough.
  EXPECT_FALSE(give_away(0, 1, 2, 3, Facets{face(3, 5, 6), face(2, 5, 6)}));
}

}  // namespace
}  // namespace nacre::flat_tetrahedron_test
