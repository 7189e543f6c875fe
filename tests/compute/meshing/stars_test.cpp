// Nacre: triangles read off from particles, against convex hulls and on particles that lie badly.
#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "compute/meshing/settle_star.hpp"
#include "compute/meshing/star_mesh.hpp"
#include "tests/compute/meshing/cpu_stars.hpp"
#include "tests/compute/meshing/own_items.hpp"

namespace nacre::test {
namespace {

std::set<std::array<std::uint32_t, 3>> corners(const StarMesh& mesh) {
  std::set<std::array<std::uint32_t, 3>> all;
  for (const Triangle& t : mesh.triangles) {
    std::array<std::uint32_t, 3> c = {t.a, t.b, t.c};
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    all.insert(c);
  }
  return all;
}

TEST(Stars, OnASphereTheyAreItsConvexHull) {
  // The tangent planes at the corners of a facet meet above its circumcentre, so that all stars agree.
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Cloud cloud = sphere(random_directions(300, seed), 5);
    const StarMesh made = mesh_of(cloud);
    ASSERT_TRUE(made.sound()) << seed;
    EXPECT_EQ(made.triangles.size(), 2 * 300 - 4);
    EXPECT_TRUE(cloud.topology(made).sound());
    for (const Triangle& t : made.triangles) {
      const StarParticles p = cloud.view();
      const Vec3d a = p.point(t.a), n = normalized(cross(p.point(t.b) - a, p.point(t.c) - a));
      for (std::size_t i = 0; i < cloud.position.size(); ++i) ASSERT_LT(dot(n, p.point(i) - a), 1e-5) << seed;
    }
  }
}

/// Points of an ellipsoid with axes 8, 5 and 3.
Cloud ellipsoid(int count, unsigned seed) {
  Cloud cloud;
  for (const Vec3d& d : random_directions(count, seed))
    cloud.add(d * Vec3d(8, 5, 3), spacing(5.2, std::size_t(count)), normalized(Vec3d(d.x / 8, d.y / 5, d.z / 3)));
  return cloud;
}

TEST(Stars, WhereTheyDisagreeOneRuleDecides) {
  std::int64_t unsettled = 0, stars = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Cloud cloud = ellipsoid(800, seed);
    const StarMesh made = mesh_of(cloud);
    ASSERT_TRUE(made.sound()) << seed;
    const TopologyReport topology = cloud.topology(made);
    EXPECT_TRUE(topology.sound()) << seed;
    EXPECT_EQ(topology.materials[1].euler, 2) << seed;
    EXPECT_NEAR(topology.materials[1].volume, 4 * M_PI / 3 * 120, 12) << seed;
    unsettled += made.counts.unsettled;
    stars += made.counts.stars;
  }
  EXPECT_LT(double(unsettled), 0.004 * double(stars));
}

TEST(Stars, TheSmallestBodies) {
  const std::vector<Vec3d> four = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  const std::vector<Vec3d> six = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<Vec3d> eight, twelve;
  const double g = 0.5 * (1 + std::sqrt(5.0));
  for (int i = 0; i < 8; ++i) eight.push_back({i & 1 ? 1.0 : -1, i & 2 ? 1.0 : -1, i & 4 ? 1.0 : -1});
  for (const double s : {-1.0, 1.0})
    for (const double t : {-g, g})
      for (const Vec3d& p : {Vec3d(0, s, t), Vec3d(s, t, 0), Vec3d(t, 0, s)}) twelve.push_back(p);
  for (const auto& points : {four, six, eight, twelve}) {
    const Cloud cloud = sphere(points, 1.3);
    const StarMesh made = mesh_of(cloud);
    ASSERT_TRUE(made.sound()) << points.size();
    EXPECT_EQ(made.triangles.size(), 2 * points.size() - 4);
    EXPECT_EQ(cloud.topology(made).materials[1].euler, 2);
    EXPECT_TRUE(cloud.topology(made).sound());
    EXPECT_GT(cloud.topology(made).materials[1].volume, 0);
  }
}

TEST(Stars, WhatIsNoBodyIsLeftToOthers) {
  EXPECT_FALSE(mesh_of(Cloud()).sound());
  for (const int count : {1, 2, 3}) {
    std::vector<Vec3d> points = {{1, 0, 0}, {-0.5, 0.866, 0}, {-0.5, -0.866, 0}};
    points.resize(std::size_t(count));
    EXPECT_FALSE(mesh_of(sphere(points, 1)).sound()) << count;
  }
}

TEST(Stars, PointsOfALatticeOnOneSphere) {
  // Many fours, sixes and more of these lie on one circle exactly.
  for (const int square : {14, 26, 41, 62, 74}) {
    std::vector<Vec3d> points;
    for (int x = -9; x <= 9; ++x)
      for (int y = -9; y <= 9; ++y)
        for (int z = -9; z <= 9; ++z)
          if (x * x + y * y + z * z == square) points.push_back(Vec3d(x, y, z));
    const Cloud cloud = sphere(points, std::sqrt(double(square)));
    const StarMesh made = mesh_of(cloud);
    ASSERT_TRUE(made.sound()) << square;
    EXPECT_EQ(made.triangles.size(), 2 * points.size() - 4) << square;
    EXPECT_TRUE(cloud.topology(made).sound()) << square;
    EXPECT_EQ(made.counts.unsettled, 0) << square;  // a tie is decided in the same way at all corners
  }
}

Cloud torus(int around, int across, double skew) {
  Cloud cloud;
  const double big = 8, small = 3;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * M_PI * (i + skew * j) / around, v = 2 * M_PI * j / across;
      const Vec3d out(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
      cloud.add(Vec3d(std::cos(u), std::sin(u), 0) * big + out * small, 2 * M_PI * small / across, out);
    }
  return cloud;
}

TEST(Stars, AGridOnATorus) {
  for (const double skew : {0.0, 0.5}) {  // quadrilaterals all of whose corners lie on a circle; triangles
    const Cloud cloud = torus(56, 22, skew);
    const StarMesh made = mesh_of(cloud);
    ASSERT_TRUE(made.sound());
    const TopologyReport topology = cloud.topology(made);
    EXPECT_TRUE(topology.sound());
    EXPECT_EQ(topology.materials[1].euler, 0);
    EXPECT_EQ(made.triangles.size(), 2 * 56 * 22);
    EXPECT_NEAR(topology.materials[1].volume, 2 * M_PI * M_PI * 8 * 9, 60);
  }
}

TEST(Stars, OneOfTwoInTheSamePlaceIsLeftOut) {
  std::vector<Vec3d> points = spiral(400);
  const StarMesh once = mesh_of(sphere(points, 4));
  Cloud twice = sphere(points, 4);
  for (const std::size_t i : {3, 17, 18, 200, 399}) {
    const Float4 p = twice.position[i], n = twice.direction[i];
    twice.add({p.x, p.y, p.z}, p.w, {n.x, n.y, n.z});
  }
  const StarMesh made = mesh_of(twice);
  ASSERT_TRUE(once.sound() && made.sound());
  EXPECT_EQ(made.counts.left_out, 5);
  EXPECT_EQ(made.triangles.size(), once.triangles.size());
  EXPECT_TRUE(twice.topology(made).sound());
}

TEST(Stars, TheOrderOfTheParticlesMakesNoDifference) {
  const std::vector<Vec3d> points = random_directions(500, 77);
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::shuffle(order.begin(), order.end(), std::mt19937(5));
  std::vector<Vec3d> shuffled;
  for (const std::uint32_t i : order) shuffled.push_back(points[i]);
  const StarMesh one = mesh_of(sphere(points, 5));
  StarMesh other = mesh_of(sphere(shuffled, 5));
  for (Triangle& t : other.triangles) t = {order[t.a], order[t.b], order[t.c]};
  EXPECT_EQ(corners(one), corners(other));
}

/// Squares of a lattice have four corners on one circle: all stars take the same diagonal, whatever rounding says.
TEST(Stars, APerfectLatticeIsDividedInOneWay) {
  Cloud cloud;
  const int n = 24;
  for (int side = 0; side < 6; ++side)  // a box, whose edges and corners are particles of the sides beside, too
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        Vec3d p, normal;
        p[axis] = side % 2 ? n : 0, p[u] = i, p[v] = j;
        int on_faces = 0;
        for (int k = 0; k < 3; ++k)
          if (p[k] == 0 || p[k] == n) normal[k] = p[k] == 0 ? -1 : 1, ++on_faces;
        bool first = true;  // each position once
        for (int k = 0; k < axis; ++k) first = first && p[k] != 0 && p[k] != n;
        if (first) cloud.add(p, 1, normalized(normal));
      }
  const StarMesh made = mesh_of(cloud);
  ASSERT_TRUE(made.sound());
  EXPECT_EQ(made.counts.unsettled, 0);
  EXPECT_EQ(made.triangles.size(), std::size_t(2 * 6 * n * n));
  EXPECT_TRUE(cloud.topology(made).sound());
}

/// The rule for a quadrilateral: the same diagonal from every corner, both ways around; where an edge is, that one.
TEST(Stars, TheRuleOfAQuadrilateralIsTheSameFromAllItsCorners) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> random(-1, 1);
  std::uniform_int_distribution<int> lattice(0, 2);
  std::int64_t first = 0;
  constexpr int rounds = 200000;
  for (int round = 0; round < rounds; ++round) {
    OwnItems items;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const double angle = 0.5 * M_PI * (k + 0.8 * random(generator));
      Vec3d p(std::cos(angle), std::sin(angle), 0.3 * random(generator));
      if (round % 3 == 0) p = Vec3d(std::cos(angle), std::sin(angle), 0);                    // on one circle
      if (round % 3 == 1) p = Vec3d(k == 1 || k == 2, k > 1, 0) * (1 + lattice(generator));  // on a lattice
      if (round % 7 == 0 && k == 3) p = items.position[2];                                   // two in one place
      items.position.push_back(p);
    }
    items.particle = {3, 9, 4, 7};
    std::shuffle(items.particle.begin(), items.particle.end(), generator);
    items.next.assign(4, none), items.previous.assign(4, none);
    const bool expected = takes_first_diagonal(items.view(), {{0, 1, 2, 3}});
    first += expected;
    for (std::uint32_t k = 0; k < 4; ++k) {
      const FourItems along = {{k, (k + 1) % 4, (k + 2) % 4, (k + 3) % 4}};
      const FourItems against = {{k, (k + 3) % 4, (k + 2) % 4, (k + 1) % 4}};
      ASSERT_EQ(takes_first_diagonal(items.view(), along), expected == (k % 2 == 0)) << round;
      ASSERT_EQ(takes_first_diagonal(items.view(), against), expected == (k % 2 == 0)) << round;
    }
    items.next[1] = 3, items.previous[3] = 1;
    ASSERT_FALSE(takes_first_diagonal(items.view(), {{0, 1, 2, 3}}));
  }
  EXPECT_GT(first, rounds / 4);
  EXPECT_LT(first, 3 * rounds / 4);
}

/// Around crumpled sheets two sides of a star may want the same item: one of them gets it.
TEST(Stars, ASettledStarHasEachNeighbourOnce) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> random(-1, 1);
  constexpr std::uint32_t count = 9;
  int changes = 0;
  for (int round = 0; round < 100000; ++round) {
    OwnItems items;
    std::vector<Star> stars(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      items.position.push_back({random(generator), random(generator), random(generator)});
      items.normal.push_back({0, 0, 1});
      items.particle.push_back(i);
      std::vector<std::uint32_t> others(count);
      std::iota(others.begin(), others.end(), 0u);
      others.erase(others.begin() + i);
      std::shuffle(others.begin(), others.end(), generator);
      stars[i].closed = true;
      stars[i].count = std::uint8_t(4 + generator() % 3);
      std::copy_n(others.begin(), stars[i].count, stars[i].ring);
    }
    items.next.assign(count, none), items.previous.assign(count, none);
    Star changed;
    if (!detail::StarSettler(items.view(), stars.data(), 0).run(changed)) continue;
    ++changes;
    const std::set<std::uint32_t> once(changed.ring, changed.ring + changed.count);
    ASSERT_EQ(once.size(), changed.count) << round;
  }
  EXPECT_GT(changes, 10000);
}

/// What a finder knows from before makes no difference.
TEST(Stars, FoundAnewOnlyWhereSomethingChangedTheyAreTheSame) {
  Cloud cloud = ellipsoid(2500, 8);
  CpuStars stars;
  stars.mesh(cloud);
  std::mt19937 generator(3);
  for (int round = 0; round < 6; ++round) {
    Cloud changed;
    for (std::size_t i = 0; i < cloud.position.size(); ++i) {
      if (generator() % 150 == 0) continue;  // some go, some move, some come
      Float4 p = cloud.position[i];
      const Float4 n = cloud.direction[i];
      if (generator() % 150 == 0) p.x += 0.3f * p.w * n.y, p.y -= 0.3f * p.w * n.x;
      changed.add({p.x, p.y, p.z}, p.w, {n.x, n.y, n.z});
    }
    for (int k = 0; k < 5; ++k) {
      const std::size_t i = generator() % cloud.position.size();
      const Float4 p = cloud.position[i], n = cloud.direction[i];
      changed.add(Vec3d(p.x, p.y, p.z) + 0.5 * p.w * normalized(Vec3d(n.y, -n.x, 0)), p.w, {n.x, n.y, n.z});
    }
    const StarMesh quick = stars.mesh(changed), from_nothing = mesh_of(changed);
    EXPECT_EQ(quick.triangles, from_nothing.triangles) << round;
    EXPECT_EQ(quick.unsettled, from_nothing.unsettled) << round;
    EXPECT_LT(quick.counts.cut, std::int64_t(changed.position.size() / 2));
    EXPECT_GT(quick.counts.cut, 10);
    cloud = changed;
  }
}

TEST(Stars, OneThatWasLeftOutComesBackWhenTheOtherGoes) {
  Cloud twice = sphere(spiral(400), 4);
  const std::size_t first = twice.position.size();
  for (const std::size_t i : {3, 17, 200}) {
    const Float4 p = twice.position[i], n = twice.direction[i];
    twice.add({p.x, p.y, p.z}, p.w, {n.x, n.y, n.z});
  }
  for (const bool copies_go : {false, true}) {
    CpuStars stars;
    EXPECT_EQ(stars.mesh(twice).counts.left_out, 3);
    Cloud once;
    for (std::size_t i = 0; i < twice.position.size(); ++i) {
      const Float4 p = twice.position[i], n = twice.direction[i];
      if (copies_go ? i < first : i != 3 && i != 17 && i != 200) once.add({p.x, p.y, p.z}, p.w, {n.x, n.y, n.z});
    }
    const StarMesh made = stars.mesh(once);
    EXPECT_EQ(made.counts.left_out, 0);
    EXPECT_EQ(made.triangles, mesh_of(once).triangles);
    EXPECT_LT(made.counts.cut, 100);
  }
}

TEST(Stars, NorDoesTheNumberOfThreads) {
  const Cloud cloud = ellipsoid(1500, 3);
  const auto on = [&](int threads) {
    return tbb::task_arena(threads).execute([&] { return mesh_of(cloud, threads); });
  };
  const StarMesh one = on(1), four = on(4);
  EXPECT_EQ(one.triangles, four.triangles);
  EXPECT_EQ(one.materials, four.materials);
}

TEST(Stars, SurfacesShareTheirRims) {
  const Cloud cloud = halves(6, 0.8);
  const StarMesh made = mesh_of(cloud);
  ASSERT_TRUE(made.sound());
  const TopologyReport topology = cloud.topology(made, 3);
  EXPECT_TRUE(topology.sound());
  EXPECT_EQ(topology.junction_edges, int(2 * M_PI * 6 / 0.8));
  for (const int m : {1, 2}) {
    EXPECT_TRUE(topology.materials[std::size_t(m)].closed);
    EXPECT_EQ(topology.materials[std::size_t(m)].euler, 2);
    EXPECT_NEAR(topology.materials[std::size_t(m)].volume, 2 * M_PI * 216 / 3, 10);
  }
}

TEST(Stars, ABrokenRimIsNotPassedOver) {
  Cloud cloud = halves(6, 0.8);
  const int missing = 16;
  cloud.position.erase(cloud.position.begin(), cloud.position.begin() + missing);
  cloud.direction.erase(cloud.direction.begin(), cloud.direction.begin() + missing);
  cloud.junction.erase(cloud.junction.begin(), cloud.junction.begin() + missing);
  cloud.gradient.erase(cloud.gradient.begin(), cloud.gradient.begin() + missing);
  CpuStars stars;
  const std::vector<std::uint32_t> broken = stars.find(cloud).items.broken;
  EXPECT_EQ(broken.size(), 2u) << "where it begins and where it ends";
  const StarMesh made = mesh_of(cloud);
  EXPECT_FALSE(made.sound());
  EXPECT_TRUE(std::includes(made.unsettled.begin(), made.unsettled.end(), broken.begin(), broken.end()));
}

TEST(Stars, ARimOfOneOrTwoBoundsNothing) {
  for (const int count : {1, 2}) {
    Cloud cloud = sphere(spiral(600), 5);
    for (int i = 0; i < count; ++i) {  // a third material touches the sphere in a speck
      JunctionGradients g;
      g.from_first[0] = {0, 0, 1}, g.from_first[1] = {float(1 - 2 * i), 0, 1};
      cloud.add({0.1 * i, 0, 5.001}, 0.5, Vec3d(), Junction(0, 1, 2), g);
    }
    const StarMesh made = mesh_of(cloud);
    ASSERT_FALSE(made.triangles.empty() && made.sound());
    if (made.sound()) {
      EXPECT_TRUE(cloud.topology(made, 3).sound());
    }
  }
}

}  // namespace
}  // namespace nacre::test
