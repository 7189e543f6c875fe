// Nacre: tests of what the fields are built from.
#include "compute/pipeline/field_recipe.hpp"

#include <gtest/gtest.h>

#include "compute/pipeline/mesh_choices.hpp"

namespace nacre::test {
namespace {

/// Where particles are `small` apart at the tenth percentile, but should be `wanted` apart at least.
double cells_per_voxel(double wanted, float small, const char* quality = "standard") {
  MeshParameters parameters;
  parameters.min_size = parameters.max_size = wanted;
  parameters.quality = quality;
  MaterialBricks bricks;
  bricks.blocks = {4, 4, 4};
  return field_recipe(at_quality(parameters), MeshVolume::Kind::labels, bricks, {}, nullptr, small).cells_per_voxel;
}

TEST(FieldRecipe, CellsAreAsFineAsParticlesAndSheetsAskFor) {
  EXPECT_EQ(cells_per_voxel(1, 1), 1);
  EXPECT_EQ(cells_per_voxel(1, 0.9f), 1);
  EXPECT_EQ(cells_per_voxel(4, 4), 0.375) << "particles are far apart";
  EXPECT_EQ(cells_per_voxel(2, 1), 1.5) << "thin sheets";
  EXPECT_EQ(cells_per_voxel(2, 0.5f), 2) << "thinner ones";
  EXPECT_EQ(cells_per_voxel(2, 0.5f, "draft"), 1);
  EXPECT_EQ(cells_per_voxel(0.5, 0.5f, "best"), 2);
}

}  // namespace
}  // namespace nacre::test
