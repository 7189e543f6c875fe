// Nacre: the materials of a patch's cells where it has no particles.
#include "compute/meshing/patch_voids.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace nacre {
namespace {

/// Two tetrahedra on one triangle, and a point far from them: the cells that have this meet in long facets.
class PatchVoids : public testing::Test {
 protected:
  PatchVoids() {
    for (std::size_t i = 0; i < cells_.vertices.size(); ++i) {
      const auto& v = cells_.vertices[i];
      const bool in_void = std::find(v.begin(), v.end(), 5u) != v.end();
      void_.push_back(in_void);
      label_.push_back(in_void ? std::uint16_t(1 + int(voids_++ == 0)) : std::uint16_t(7));
    }
    known_.assign(label_.size(), 0);
  }

  void unify(double reach) {
    unify_voids(points_, cells_, std::vector<double>{reach, reach, reach, reach, reach, 0}, known_, label_);
  }

  void expect_in_void(std::uint16_t label) const {
    for (std::size_t i = 0; i < label_.size(); ++i) EXPECT_EQ(label_[i], void_[i] ? label : 7) << i;
  }

  const std::vector<Vec3d> points_ = {{0, 0, 0},       {1, 0, 0},        {0, 1, 0},
                                      {0.3, 0.3, 0.5}, {0.3, 0.3, -0.5}, {0.3, 0.31, 30}};
  const DelaunayCells cells_ = delaunay(points_);
  std::vector<std::uint8_t> void_, known_;
  std::vector<std::uint16_t> label_;  // in the void: 2 of one cell, 1 of the others
  int voids_ = 0;
};

TEST_F(PatchVoids, TakeTheCommonestLabel) {
  ASSERT_GE(voids_, 3);
  unify(3);
  expect_in_void(1);
}

TEST_F(PatchVoids, WhatIsKnownCountsMore) {
  known_[std::size_t(std::find(label_.begin(), label_.end(), 2) - label_.begin())] = 1;
  unify(3);
  expect_in_void(2);
}

TEST_F(PatchVoids, ShortFacetsMayLieBetweenMaterials) {
  const std::vector<std::uint16_t> before = label_;
  unify(100);
  EXPECT_EQ(label_, before);
  unify(0);  // no particle is asked
  EXPECT_EQ(label_, before);
}

}  // namespace
}  // namespace nacre
