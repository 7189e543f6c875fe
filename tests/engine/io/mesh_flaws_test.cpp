// Nacre: what is said of a mesh that is not as it was asked for.
#include <gtest/gtest.h>

#include "engine/io/mesh_input.hpp"

namespace nacre {
namespace {

using Labels = std::vector<std::int64_t>;

/// Materials of these labels, each with a closed surface; [0] is the outside.
TopologyReport closed_around(const Labels& labels) {
  TopologyReport t;
  t.materials.assign(labels.size(), {});
  for (MaterialTopology& m : t.materials) m.facets = 4, m.closed = true;
  return t;
}

void expect_one(const std::vector<std::string>& flaws, const std::vector<std::string>& parts) {
  ASSERT_EQ(flaws.size(), 1u);
  for (const std::string& part : parts) EXPECT_NE(flaws[0].find(part), flaws[0].npos) << part << "\n" << flaws[0];
}

const Labels three{0, 5, -7, 9};

TEST(MeshFlaws, ASoundMeshHasNone) {
  EXPECT_TRUE(mesh_flaws(three, closed_around(three)).empty());
  EXPECT_TRUE(lost_labels(three, closed_around(three)).empty());
  TopologyReport pinched = closed_around(three);
  pinched.pinched_vertices = pinched.pinched_edges = 3;  // junctions may
  EXPECT_TRUE(mesh_flaws(three, pinched).empty());
}

TEST(MeshFlaws, LostLabelsAreNamed) {
  TopologyReport t = closed_around(three);
  t.materials[0] = {};  // the outside cannot be lost
  t.materials[2] = {};
  EXPECT_EQ(lost_labels(three, t), Labels{-7});
  expect_one(mesh_flaws(three, t), {"label -7 was lost", "no surface", "--min-size"});
  t.materials[3] = {};
  EXPECT_EQ(lost_labels(three, t), (Labels{-7, 9}));
  expect_one(mesh_flaws(three, t), {"2 labels were lost", "have no surface", "(-7, 9)"});
}

TEST(MeshFlaws, ManyLostLabelsAreALineNotAPage) {
  Labels many(40);
  for (std::size_t k = 0; k < many.size(); ++k) many[k] = std::int64_t(k);
  TopologyReport t;
  t.materials.assign(many.size(), {});
  EXPECT_EQ(lost_labels(many, t).size(), 39u);
  expect_one(mesh_flaws(many, t), {"39 labels", "(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, ...)"});
}

TEST(MeshFlaws, WhatIsNotSoundIsCountedByItsName) {
  using Count = std::int64_t TopologyReport::*;
  const std::vector<std::pair<Count, std::string>> defects{
      {&TopologyReport::boundary_edges, "boundary edge"},
      {&TopologyReport::nonmanifold_edges, "non-manifold edge"},
      {&TopologyReport::nonmanifold_vertices, "non-manifold vert"},
      {&TopologyReport::inconsistent_edges, "turned against each other"},
      {&TopologyReport::duplicate_triangles, "duplicate triangle"},
      {&TopologyReport::degenerate_triangles, "without area"}};
  for (const auto& [count, name] : defects) {
    TopologyReport t = closed_around(three);
    t.*count = 2;
    expect_one(mesh_flaws(three, t), {"not sound: 2 ", name, "smaller --min-size and --max-size"});
  }
  TopologyReport t = closed_around(three);
  t.nonmanifold_vertices = 1;
  t.degenerate_triangles = 3;
  expect_one(mesh_flaws(three, t), {"1 non-manifold vertex, 3 triangles without area;"});
}

TEST(MeshFlaws, SurfacesThatAreNotClosedAreNamed) {
  TopologyReport t = closed_around(three);
  t.materials[1].closed = t.materials[3].closed = false;
  expect_one(mesh_flaws(three, t), {"not closed", "5, 9"});
}

}  // namespace
}  // namespace nacre
