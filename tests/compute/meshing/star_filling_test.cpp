// Nacre: what stars leave open is filled: wide holes, specks, bodies of a few particles, shared edges.
#include "compute/meshing/star_filling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <tuple>

#include "compute/meshing/incidence.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/star_chords.hpp"
#include "compute/meshing/star_holes.hpp"
#include "compute/meshing/star_openings.hpp"
#include "tests/compute/meshing/cpu_stars.hpp"
#include "tests/compute/meshing/own_items.hpp"

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

std::vector<std::uint32_t> incomplete_of(const FoundStars& found) {
  std::vector<std::uint32_t> incomplete;
  for (std::uint32_t i = 0; i < found.stars.size(); ++i)
    if (is_incomplete(found.items.view(), found.stars[i], i)) incomplete.push_back(i);
  return incomplete;
}

TEST(StarFilling, AHoleHasAllParticlesInItsMiddle) {
  const Cloud cloud = sphere(spiral(2000), 10);
  CpuStars stars;
  FoundStars& found = stars.find(cloud);
  std::vector<std::uint32_t> near_top;
  for (std::uint32_t i = 0; i < found.items.count(); ++i)
    if (length(found.items.position[i] - Vec3d(0, 0, 10)) < 5 * found.items.size[i]) near_top.push_back(i);
  StarOpenings openings(found.stars);
  openings.open(near_top);
  const StarHoles holes = find_holes(found.items, found.stars, incomplete_of(found));
  ASSERT_EQ(holes.holes.size(), 1U);
  EXPECT_TRUE(holes.alone.empty());
  std::vector<std::uint32_t> within = holes.holes[0].within;
  std::sort(within.begin(), within.end());
  EXPECT_EQ(within, near_top);
  EXPECT_EQ(fill_hole(found.items, found.stars, holes.holes[0]).size(),
            holes.holes[0].loop.size() + 2 * within.size() - 2);
}

/// A square hole, and a particle beside it, which no triangle of the filling can have.
TEST(StarFilling, AHoleIsNotFilledWhereThatWouldCutOffWhatGoesOn) {
  for (const double aside : {0.5, 4.0}) {
    OwnItems items;
    items.materials = {{0, 1}};
    for (const Vec3d& p : {Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(0, 1, 0), Vec3d(1 + aside, 0.5, 0)}) {
      items.position.push_back(p), items.normal.push_back({0, 0, 1}), items.size.push_back(1);
      items.next.push_back(none), items.previous.push_back(none);
    }
    const std::vector<Triangle> filling = fill_hole(items.items(), std::vector<Star>(5), {{0, 1, 2, 3}, {4}});
    EXPECT_EQ(filling.size(), aside > 1 ? 0U : 2U) << aside;
  }
}

/// Fills a hole between flat items. Item k is made with the number apart * k; hole and filling have k.
std::vector<Triangle> flat_filling(const std::vector<Vec3d>& points, std::uint32_t apart, StarHole hole) {
  OwnItems items;
  items.materials = {{0, 1}};
  const std::size_t count = apart * points.size();
  items.position.resize(count), items.normal.assign(count, {0, 0, 1}), items.size.assign(count, 1);
  items.next.assign(count, none), items.previous.assign(count, none);
  for (std::size_t k = 0; k < points.size(); ++k) items.position[apart * k] = points[k];
  for (auto* list : {&hole.loop, &hole.within})
    for (std::uint32_t& i : *list) i *= apart;
  std::vector<Triangle> filling = fill_hole(items.items(), std::vector<Star>(count), hole);
  for (Triangle& t : filling) t = {t.a / apart, t.b / apart, t.c / apart};
  return filling;
}

TEST(StarFilling, AFillingDoesNotDependOnTheNumbersOfItems) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> random(-1, 1);
  std::vector<Vec3d> points;
  StarHole hole;
  for (std::uint32_t k = 0; k < 14; ++k) {
    const double angle = 2 * M_PI * (k + 0.2 * random(generator)) / 14;
    points.emplace_back(2.5 * std::cos(angle), 2.5 * std::sin(angle), 0);
    hole.loop.push_back(k);
  }
  while (points.size() < 30) {
    const Vec3d p(2 * random(generator), 2 * random(generator), 0);
    if (std::ranges::any_of(points, [&](const Vec3d& q) { return length(p - q) < 0.5; }) || length(p) > 2) continue;
    hole.within.push_back(std::uint32_t(points.size()));
    points.push_back(p);
  }
  const std::vector<Triangle> filling = flat_filling(points, 1, hole);
  EXPECT_EQ(filling.size(), 14u + 2 * 16 - 2);
  for (const std::uint32_t apart : {3u, 32u, 64u}) EXPECT_EQ(flat_filling(points, apart, hole), filling) << apart;
}

/// Where a hole's loop passes an item twice, an edge across the hole may be one of its sides already.
TEST(StarFilling, NoEdgeOfAFillingIsASideOfItsHole) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<double> random(-2, 2);
  int filled = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Vec3d> points(8);
    for (Vec3d& p : points) p = {random(generator), random(generator), 0};
    StarHole hole{{0, 1, 2, 3, 4, 5, 6, 7}, {}};
    hole.loop.insert(hole.loop.begin() + 5 + round % 3, 1 + std::uint32_t(round % 2));  // again
    const std::vector<Triangle> filling = flat_filling(points, 1, hole);
    if (filling.empty()) continue;
    ++filled;
    for (std::size_t k = 0; k < hole.loop.size(); ++k) {
      const std::uint32_t a = hole.loop[k], b = hole.loop[(k + 1) % hole.loop.size()];
      const auto has_side = [&](const Triangle& t) { return has_corner(t, a) && has_corner(t, b); };
      EXPECT_EQ(std::ranges::count_if(filling, has_side), 1) << round;
    }
  }
  EXPECT_GT(filled, 100);
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
  FoundStars& found = stars.find(cloud);
  const std::vector<Star> before(found.stars.begin(), found.stars.end());
  StarOpenings openings(found.stars);
  for (const std::uint32_t i : {5U, 6U, 5U, 90U}) openings.open(std::vector<std::uint32_t>{i});
  openings.close();
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_EQ(found.stars[i].agreed, before[i].agreed) << i;
  EXPECT_TRUE(openings.removed().empty());
}

TEST(StarFilling, WhatIsOpenedAreTheTrianglesAtTheseItems) {
  const Cloud cloud = sphere(random_directions(800, 3), 6);
  CpuStars stars;
  FoundStars& found = stars.find(cloud);
  const std::vector<std::uint32_t> some = {5, 6, 90};
  std::vector<Triangle> expected = found.agreed.triangles;  // one surface: items are particles
  std::erase_if(expected, [&](const Triangle& t) {
    return std::ranges::none_of(some, [&](std::uint32_t i) { return t.a == i || t.b == i || t.c == i; });
  });
  StarOpenings openings(found.stars);
  openings.open(some);
  std::vector<Triangle> removed = openings.removed();
  const auto by_corners = [](const Triangle& s, const Triangle& t) {
    return std::tie(s.a, s.b, s.c) < std::tie(t.a, t.b, t.c);
  };
  std::sort(removed.begin(), removed.end(), by_corners), std::sort(expected.begin(), expected.end(), by_corners);
  EXPECT_EQ(removed, expected);
}

TEST(StarFilling, WhatWasOpenedIsThereAgainTheNextTime) {
  const Cloud cloud = sphere(random_directions(800, 3), 6);
  CpuStars stars;
  const StarMesh first = stars.mesh(cloud);
  const std::vector<std::uint32_t> some = {5, 6, 90};
  FoundStars& found = stars.find(cloud);
  {
    StarOpenings openings(found.stars);
    EXPECT_GT(openings.open(some).size(), 3 * some.size());
    for (const std::uint32_t i : some) EXPECT_EQ(found.stars[i].agreed, 0u);
  }
  const StarMesh again = stars.mesh(cloud);
  EXPECT_EQ(again.triangles, first.triangles);
  EXPECT_EQ(again.counts.cut, 0);
}

/// Two surfaces, 0 and 1, over the same four particles, which are their rims.
OwnItems two_quadrilaterals(double lift) {
  OwnItems items;
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

std::vector<RimTriangle> numbered(std::span<const Triangle> triangles) {
  std::vector<RimTriangle> all;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) all.push_back({i, triangles[i]});
  return all;
}

TEST(StarChords, AnEdgeThatTwoSurfacesHaveIsExchangedInOne) {
  const OwnItems own = two_quadrilaterals(0.3);
  const StarItems items = own.items();
  const std::vector<Star> no_stars(items.count());
  const std::vector<Triangle> both = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  std::vector<RimTriangle> triangles = numbered(both);
  EXPECT_EQ(at_shared_chords(items, triangles), (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(exchange_shared_chords(items, no_stars, {}, triangles), (std::vector<std::uint32_t>{2, 3}))
      << "in the flat one: the other triangles are worse";
  EXPECT_TRUE(at_shared_chords(items, triangles).empty());
  EXPECT_EQ(triangles[0].items, both[0]);
  EXPECT_EQ(triangles[1].items, both[1]);
  std::vector<RimTriangle> one = numbered(std::span(both).first(2));
  EXPECT_TRUE(exchange_shared_chords(items, no_stars, {}, one).empty());
}

/// Of another triangle of a filled hole, or of one that stars agree on.
TEST(StarChords, WhereTheOtherEdgeIsThereAlreadyNothingChanges) {
  const OwnItems own = two_quadrilaterals(0);
  const StarItems items = own.items();
  const std::vector<Triangle> both = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}, others = {{1, 3, 2}, {5, 7, 6}};
  std::vector<RimTriangle> triangles = numbered(both);
  EXPECT_TRUE(exchange_shared_chords(items, std::vector<Star>(8), others, triangles).empty());
  std::vector<Star> stars(8);
  for (const Triangle& t : others) {
    Star& star = stars[t.a];
    star.ring[0] = t.b, star.ring[1] = t.c, star.count = 2, star.agreed = 1;
  }
  EXPECT_TRUE(exchange_shared_chords(items, stars, {}, triangles).empty());
  EXPECT_EQ(exchange_shared_chords(items, std::vector<Star>(8), {}, triangles).size(), 2u);
}

}  // namespace
}  // namespace nacre::test
