// Nacre: what stars leave open is filled: wide holes, specks, bodies of a few particles, shared edges.
#include "compute/meshing/star_filling.hpp"

#include <gtest/gtest.h>

#include "compute/meshing/quality.hpp"
#include "compute/meshing/star_chords.hpp"
#include "compute/meshing/star_holes.hpp"
#include "tests/compute/meshing/cpu_stars.hpp"

namespace nacre::test {
namespace {

/// A sphere without the particles near its top.
Cloud with_a_gap(double gap) {
  const Cloud whole = sphere(spiral(2000), 10);
  Cloud cloud;
  for (std::size_t i = 0; i < whole.position.size(); ++i) {
    const Float4 p = whole.position[i], n = whole.direction[i];
    if (length(Vec3d(p.x, p.y, p.z) - Vec3d(0, 0, 10)) > gap * p.w) cloud.add({p.x, p.y, p.z}, p.w, {n.x, n.y, n.z});
  }
  return cloud;
}

TEST(StarFilling, WideHolesAreFilledWhereTheyAreFlat) {
  for (const double gap : {2.0, 3.0, 4.0}) {
    const Cloud cloud = with_a_gap(gap);
    const StarMesh made = mesh_of(cloud);
    ASSERT_TRUE(made.sound()) << gap;
    EXPECT_EQ(made.triangles.size(), 2 * cloud.position.size() - 4) << gap;
    EXPECT_TRUE(cloud.topology(made).sound()) << gap;
    EXPECT_EQ(cloud.topology(made).materials[1].euler, 2) << gap;
    if (gap > 2.5) {
      EXPECT_GT(made.counts.filled, 0) << gap;
    }
  }
}

std::vector<std::uint32_t> incomplete_of(const StarFinder& finder) {
  std::vector<std::uint32_t> incomplete;
  for (std::uint32_t i = 0; i < finder.stars().size(); ++i)
    if (is_incomplete(finder.items().view(), finder.stars()[i], i)) incomplete.push_back(i);
  return incomplete;
}

TEST(StarFilling, AHoleHasAllParticlesInItsMiddle) {
  const Cloud cloud = sphere(spiral(2000), 10);
  CpuStars stars;
  StarFinder& finder = stars.finder();
  finder.find(cloud.view());
  std::vector<std::uint32_t> near_top;
  for (std::uint32_t i = 0; i < finder.items().count(); ++i)
    if (length(finder.items().position[i] - Vec3d(0, 0, 10)) < 5 * finder.items().size[i]) near_top.push_back(i);
  finder.open(near_top);
  const StarHoles holes = find_holes(finder.items(), finder.stars(), incomplete_of(finder));
  ASSERT_EQ(holes.holes.size(), 1U);
  EXPECT_TRUE(holes.alone.empty());
  std::vector<std::uint32_t> within = holes.holes[0].within;
  std::sort(within.begin(), within.end());
  EXPECT_EQ(within, near_top);
  EXPECT_EQ(fill_hole(finder.items(), finder.stars(), holes.holes[0]).size(),
            holes.holes[0].loop.size() + 2 * within.size() - 2);
}

/// A square hole, and a particle beside it, which no triangle of the filling can have.
TEST(StarFilling, AHoleIsNotFilledWhereThatWouldCutOffWhatGoesOn) {
  for (const double aside : {0.5, 4.0}) {
    StarItems items;
    items.materials = {{0, 1}};
    for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 1, 0), Vec3d(1 + aside, 0.5, 0)}) {
      items.position.push_back(p), items.normal.push_back({0, 0, 1}), items.size.push_back(1);
      items.next.push_back(none), items.previous.push_back(none);
    }
    const std::vector<Triangle> filling = fill_hole(items, std::vector<Star>(5), {{0, 1, 2, 3}, {4}});
    EXPECT_EQ(filling.size(), aside > 1 ? 0U : 2U) << aside;
  }
}

TEST(StarFilling, ATriangleAloneBoundsNothing) {
  Cloud cloud = sphere(spiral(600), 5);
  for (const Vec3d& p : {Vec3d(20, 0, 0), Vec3d(20.6, 0, 0), Vec3d(20.3, 0.5, 0)}) cloud.add(p, 0.6, {0, 0, 1});
  const StarMesh made = mesh_of(cloud);
  ASSERT_TRUE(made.sound());
  EXPECT_EQ(made.triangles.size(), 2 * 600 - 4);
  EXPECT_EQ(made.counts.left_out, 3);
}

/// Particles of a thin plate's rim and of a body that is little larger than one particle, as in the vessels of a head:
/// their normals say little. Whatever becomes of it, the sphere beside it is closed.
TEST(StarFilling, BodiesOfAFewParticlesAreClosedOrLeftOut) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> random(-1, 1);
  int closed = 0, left_out = 0;
  for (int round = 0; round < 200; ++round) {
    Cloud cloud = sphere(spiral(300), 4);
    const int count = 4 + round % 9;
    for (const Vec3d& d : random_directions(count, unsigned(round))) {
      const Vec3d noise = Vec3d(random(generator), random(generator), random(generator)) * (0.15 * double(round % 7));
      cloud.add(Vec3d(20, 0, 0) + d * 0.4, 0.5, normalized(d + noise));
    }
    const StarMesh made = mesh_of(cloud);
    if (!made.sound()) continue;
    const TopologyReport topology = cloud.topology(made);
    ASSERT_TRUE(topology.sound()) << round;
    ++(topology.materials[1].euler > 2 ? closed : left_out);
    EXPECT_GE(topology.materials[1].euler, 2) << round;
  }
  EXPECT_GT(closed, 150);
  EXPECT_GT(closed + left_out, 190);
}

/// The neighbours of a particle need not have it for one of theirs: each particle is in one body all the same.
TEST(StarFilling, NoParticleIsInTwoBodies) {
  std::mt19937 generator(9);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 100; ++round) {
    Cloud cloud = sphere(spiral(300), 4);
    for (int k = 0; k < 10 + round % 30; ++k) {
      const Vec3d p(normal(generator), normal(generator), 0.2 * normal(generator));
      const Vec3d n(normal(generator), normal(generator), normal(generator));
      cloud.add(Vec3d(20, 0, 0) + p, 0.7, normalized(n));
    }
    const StarMesh made = mesh_of(cloud);
    if (!made.sound()) continue;
    ASSERT_TRUE(cloud.topology(made).sound()) << round;
    const SurfaceMesh mesh = cloud.mesh(made);
    for (const Triangle& t : made.triangles) {
      const double ratio = radius_ratio(mesh.points[t.a], mesh.points[t.b], mesh.points[t.c]);
      EXPECT_TRUE(mesh.points[t.a].x < 10 || ratio >= 0.2) << round;
    }
  }
}

TEST(StarFilling, ClosingUndoesAllThatWasOpened) {
  const Cloud cloud = sphere(random_directions(800, 3), 6);
  CpuStars stars;
  StarFinder& finder = stars.finder();
  finder.find(cloud.view());
  const std::vector<Star> before = finder.stars();
  for (const std::uint32_t i : {5U, 6U, 5U, 90U}) finder.open(std::vector<std::uint32_t>{i});
  finder.close();
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(finder.stars()[i].agreed, before[i].agreed) << i;
}

TEST(StarFilling, WhatWasOpenedIsThereAgainTheNextTime) {
  const Cloud cloud = sphere(random_directions(800, 3), 6);
  CpuStars stars;
  StarFinder& finder = stars.finder();
  const StarMesh first = stars.mesh(cloud);
  const std::vector<std::uint32_t> some = {5, 6, 90};
  const std::vector<std::uint32_t> changed = finder.open(some);
  EXPECT_GT(changed.size(), 3 * some.size());
  for (const std::uint32_t i : some) EXPECT_EQ(finder.stars()[i].agreed, 0u);
  EXPECT_EQ(stars.mesh(cloud).triangles, first.triangles);
  EXPECT_EQ(finder.found().cut, 0);
}

/// Two surfaces, 0 and 1, over the same four particles, which are their rims.
StarItems two_quadrilaterals(double lift) {
  StarItems items;
  items.materials = {{0, 1}, {0, 2}};
  items.first = {0, 4, 8};
  for (std::uint32_t s = 0; s < 2; ++s)
    for (std::uint32_t p = 0; p < 4; ++p) {
      items.position.push_back({double(p == 1 || p == 2), double(p > 1), p == 3 && s == 0 ? lift : 0});
      items.normal.push_back({0, 0, 1});
      items.size.push_back(1);
      items.particle.push_back(p), items.surface.push_back(s);
      items.next.push_back(4 * s + (p + 1) % 4), items.previous.push_back(4 * s + (p + 3) % 4);
    }
  return items;
}

TEST(StarChords, AnEdgeThatTwoSurfacesHaveIsExchangedInOne) {
  const StarItems items = two_quadrilaterals(0.3);
  const std::vector<Triangle> both = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  EXPECT_EQ(at_shared_chords(items, both, triangles_between_rims(items, both)), (std::vector<std::uint32_t>{0, 2}));
  std::vector<Triangle> triangles = both;
  exchange_shared_chords(items, triangles_between_rims(items, triangles), triangles);
  EXPECT_TRUE(at_shared_chords(items, triangles, triangles_between_rims(items, triangles)).empty());
  EXPECT_EQ(triangles[0], both[0]) << "in the flat one: the other triangles are worse";
  EXPECT_EQ(triangles[1], both[1]);
  std::vector<Triangle> one = {both[0], both[1]};
  exchange_shared_chords(items, triangles_between_rims(items, one), one);
  EXPECT_EQ(one, std::vector<Triangle>(both.begin(), both.begin() + 2));
}

TEST(StarChords, WhereTheOtherEdgeIsThereAlreadyNothingChanges) {
  const StarItems items = two_quadrilaterals(0);
  const std::vector<Triangle> both = {{0, 1, 2}, {0, 2, 3}, {1, 3, 2}, {4, 5, 6}, {4, 6, 7}, {5, 7, 6}};
  std::vector<Triangle> triangles = both;
  exchange_shared_chords(items, triangles_between_rims(items, triangles), triangles);
  EXPECT_EQ(triangles, both);
}

}  // namespace
}  // namespace nacre::test
