// Nacre: cells beside known triangles take the materials on their sides.
#include "compute/meshing/labels_beside.hpp"

#include <gtest/gtest.h>

namespace nacre::test {
namespace {

/// Two cells, (0, 1, 2, 3) and (1, 2, 3, 4), on both sides of the facet (1, 2, 3).
DelaunayCells two_cells() {
  DelaunayCells cells;
  cells.vertices = {{0, 1, 2, 3}, {4, 1, 3, 2}};
  cells.neighbours = {{1, -1, -1, -1}, {0, -1, -1, -1}};
  return cells;
}

TEST(LabelsBeside, ATriangleGivesBothOfItsCellsTheirMaterials) {
  const DelaunayCells cells = two_cells();
  for (const Triangle& t : {Triangle{1, 2, 3}, Triangle{3, 1, 2}}) {  // from outside of cell 0
    std::vector<std::uint16_t> label = {7, 7};
    label_beside(cells, std::vector<Triangle>{t}, std::vector<std::array<std::uint16_t, 2>>{{4, 6}}, label);
    EXPECT_EQ(label, (std::vector<std::uint16_t>{6, 4}));
  }
  std::vector<std::uint16_t> label = {7, 7};
  label_beside(cells, std::vector<Triangle>{{1, 3, 2}}, std::vector<std::array<std::uint16_t, 2>>{{4, 6}}, label);
  EXPECT_EQ(label, (std::vector<std::uint16_t>{4, 6}));
}

TEST(LabelsBeside, WhatIsNoFacetOrDisagreesChangesNothing) {
  const DelaunayCells cells = two_cells();
  std::vector<std::uint16_t> label = {7, 8};
  label_beside(cells, {}, {}, label);
  label_beside(cells, std::vector<Triangle>{{0, 1, 4}}, std::vector<std::array<std::uint16_t, 2>>{{4, 6}}, label);
  EXPECT_EQ(label, (std::vector<std::uint16_t>{7, 8}));
  // Cell 0 would be of material 6 by the first triangle, of 5 by the second.
  label_beside(cells, std::vector<Triangle>{{1, 2, 3}, {0, 1, 3}},
               std::vector<std::array<std::uint16_t, 2>>{{4, 6}, {4, 5}}, label);
  EXPECT_EQ(label, (std::vector<std::uint16_t>{7, 4}));
}

}  // namespace
}  // namespace nacre::test
