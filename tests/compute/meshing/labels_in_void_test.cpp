// Nacre: cells in the void around a patch have one material, where particles are wanted.
#include "compute/meshing/labels_in_void.hpp"

#include <gtest/gtest.h>

namespace nacre::test {
namespace {

using Marks = std::vector<std::uint8_t>;
using Labels = std::vector<std::uint16_t>;

/// The cell (0, 1, 2, 3), and three beside it that have the guard 4 for their fourth corner and meet in facets at point
/// 0; cell 4 is behind point 3, and meets them away from point 0.
DelaunayCells cells_with_guard() {
  DelaunayCells cells;
  cells.vertices = {{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 2, 3, 4}, {0, 1, 3, 4}, {1, 2, 3, 4}};
  cells.neighbours = {{4, 2, 3, 1}, {4, 2, 3, 0}, {4, 3, 1, 0}, {4, 2, 1, 0}, {2, 3, 1, 0}};
  return cells;
}

TEST(LabelsInVoid, MostDecideAroundWantedPoints) {
  Labels label = {9, 5, 4, 5, 4};
  label_void(cells_with_guard(), Marks{1, 0, 0, 0}, label);
  EXPECT_EQ(label, (Labels{9, 5, 5, 5, 4})) << "cell 4 has no wanted corner, cell 0 no guard";
  label = {9, 5, 4, 4, 7};
  label_void(cells_with_guard(), Marks{1, 1, 1, 1}, label);
  EXPECT_EQ(label, (Labels{9, 4, 4, 4, 4}));
  label = {9, 5, 4, 5, 4};
  label_void(cells_with_guard(), Marks{1, 1, 0, 0}, label);
  EXPECT_EQ(label, (Labels{9, 4, 4, 4, 4})) << "the lowest of several";
}

TEST(LabelsInVoid, NothingElseChanges) {
  Labels label = {9, 5, 4, 5, 4};
  label_void(cells_with_guard(), Marks{0, 0, 0, 0}, label);
  EXPECT_EQ(label, (Labels{9, 5, 4, 5, 4})) << "nothing is wanted";
  label_void(cells_with_guard(), Marks{1, 1, 1, 1, 1}, label);
  EXPECT_EQ(label, (Labels{9, 5, 4, 5, 4})) << "there is no guard";
}

}  // namespace
}  // namespace nacre::test
