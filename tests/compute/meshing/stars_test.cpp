// Nacre: triangles read off from particles, against convex hulls and on particles that lie badly.
#include <gtest/gtest.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "compute/meshing/star_mesh.hpp"
#include "compute/meshing/topology.hpp"

namespace nacre::test {
namespace {

/// Particles that own what StarParticles shows.
struct Cloud {
  std::vector<Float4> position, direction;
  std::vector<Junction> junction;
  std::vector<JunctionGradients> gradient;

  /// On the surface between materials 0 and 1; `normal` points out of 1.
  void add(const Vec3d& p, double h, const Vec3d& normal) { add(p, h, normal, Junction(0, 1)); }
  void add(const Vec3d& p, double h, const Vec3d& normal, const Junction& j, const JunctionGradients& g = {}) {
    position.push_back({float(p.x), float(p.y), float(p.z), float(h)});
    direction.push_back({float(normal.x), float(normal.y), float(normal.z), 0});
    junction.push_back(j);
    gradient.push_back(g);
  }
  StarParticles view() const { return {position, direction, junction, gradient}; }

  SurfaceMesh mesh(const StarMesh& made) const {
    SurfaceMesh mesh;
    for (const Float4& p : position) mesh.points.push_back({p.x, p.y, p.z});
    mesh.triangles = made.triangles;
    mesh.materials = made.materials;
    return mesh;
  }
  TopologyReport topology(const StarMesh& made, int materials = 2) const {
    return check_topology(mesh(made), materials);
  }
};

double spacing(double radius, std::size_t count) {
  return radius * std::sqrt(4 * M_PI / (double(count) * std::sqrt(0.75)));
}

/// Points of a sphere around the origin as a cloud of even size.
Cloud sphere(const std::vector<Vec3d>& directions, double radius) {
  Cloud cloud;
  for (const Vec3d& d : directions)
    cloud.add(normalized(d) * radius, spacing(radius, directions.size()), normalized(d));
  return cloud;
}

std::vector<Vec3d> spiral(int count) {
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z), t = i * 2.399963229728653;
    points.push_back({r * std::cos(t), r * std::sin(t), z});
  }
  return points;
}

std::vector<Vec3d> random_directions(int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<Vec3d> points;
  while (int(points.size()) < count) {
    Vec3d p(normal(generator), normal(generator), normal(generator));
    p = normalized(p);
    if (std::all_of(points.begin(), points.end(),
                    [&](const Vec3d& q) { return length(p - q) > 1.2 / std::sqrt(count); }))
      points.push_back(p);
  }
  return points;
}

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
    const StarMesh made = mesh_from_stars(cloud.view());
    ASSERT_TRUE(made.sound) << seed;
    EXPECT_EQ(made.triangles.size(), 2 * 300 - 4);
    EXPECT_TRUE(cloud.topology(made).sound());
    for (const Triangle& t : made.triangles) {
      const StarParticles p = cloud.view();
      const Vec3d a = p.place(t.a), n = normalized(cross(p.place(t.b) - a, p.place(t.c) - a));
      for (std::size_t i = 0; i < cloud.position.size(); ++i) ASSERT_LT(dot(n, p.place(i) - a), 1e-5) << seed;
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

TEST(Stars, WhereTheyDisagreeHolesAreFilled) {
  std::int64_t holes = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Cloud cloud = ellipsoid(800, seed);
    const StarMesh made = mesh_from_stars(cloud.view());
    ASSERT_TRUE(made.sound) << seed;
    const TopologyReport topology = cloud.topology(made);
    EXPECT_TRUE(topology.sound()) << seed;
    EXPECT_EQ(topology.materials[1].euler, 2) << seed;
    EXPECT_NEAR(topology.materials[1].volume, 4 * M_PI / 3 * 120, 12) << seed;
    holes += made.counts.holes;
  }
  EXPECT_GT(holes, 12);
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
    const StarMesh made = mesh_from_stars(cloud.view());
    ASSERT_TRUE(made.sound) << points.size();
    EXPECT_EQ(made.triangles.size(), 2 * points.size() - 4);
    EXPECT_EQ(cloud.topology(made).materials[1].euler, 2);
    EXPECT_TRUE(cloud.topology(made).sound());
    EXPECT_GT(cloud.topology(made).materials[1].volume, 0);
  }
}

TEST(Stars, WhatIsNoBodyIsLeftToOthers) {
  EXPECT_FALSE(mesh_from_stars(Cloud().view()).sound);
  for (const int count : {1, 2, 3}) {
    std::vector<Vec3d> points = {{1, 0, 0}, {-0.5, 0.866, 0}, {-0.5, -0.866, 0}};
    points.resize(std::size_t(count));
    EXPECT_FALSE(mesh_from_stars(sphere(points, 1).view()).sound) << count;
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
    const StarMesh made = mesh_from_stars(cloud.view());
    ASSERT_TRUE(made.sound) << square;
    EXPECT_EQ(made.triangles.size(), 2 * points.size() - 4) << square;
    EXPECT_TRUE(cloud.topology(made).sound()) << square;
    EXPECT_EQ(made.counts.disagreeing, 0) << square;  // a tie is decided in the same way at all corners
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
    const StarMesh made = mesh_from_stars(cloud.view());
    ASSERT_TRUE(made.sound);
    const TopologyReport topology = cloud.topology(made);
    EXPECT_TRUE(topology.sound());
    EXPECT_EQ(topology.materials[1].euler, 0);
    EXPECT_EQ(made.triangles.size(), 2 * 56 * 22);
    EXPECT_NEAR(topology.materials[1].volume, 2 * M_PI * M_PI * 8 * 9, 60);
  }
}

TEST(Stars, OneOfTwoInTheSamePlaceIsLeftOut) {
  std::vector<Vec3d> points = spiral(400);
  const StarMesh once = mesh_from_stars(sphere(points, 4).view());
  Cloud twice = sphere(points, 4);
  for (const std::size_t i : {3, 17, 18, 200, 399}) {
    const Float4 p = twice.position[i], n = twice.direction[i];
    twice.add({p.x, p.y, p.z}, p.w, {n.x, n.y, n.z});
  }
  const StarMesh made = mesh_from_stars(twice.view());
  ASSERT_TRUE(once.sound && made.sound);
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
  const StarMesh one = mesh_from_stars(sphere(points, 5).view());
  StarMesh other = mesh_from_stars(sphere(shuffled, 5).view());
  for (Triangle& t : other.triangles) t = {order[t.a], order[t.b], order[t.c]};
  EXPECT_EQ(corners(one), corners(other));
}

TEST(Stars, NorDoesTheNumberOfThreads) {
  const Cloud cloud = ellipsoid(1500, 3);
  const auto on = [&](int threads) {
    return tbb::task_arena(threads).execute([&] { return mesh_from_stars(cloud.view()); });
  };
  const StarMesh one = on(1), four = on(4);
  EXPECT_EQ(one.triangles, four.triangles);
  EXPECT_EQ(one.materials, four.materials);
  EXPECT_GT(one.counts.holes, 0);
}

/// A ball that the plane z = 0 cuts into materials 1 (above) and 2.
Cloud halves(double radius, double h) {
  Cloud cloud;
  const int rim = int(2 * M_PI * radius / h);
  for (int i = 0; i < rim; ++i) {
    const Vec3d out(std::cos(2 * M_PI * i / rim), std::sin(2 * M_PI * i / rim), 0);
    JunctionGradients g;
    g.from_first[0] = Vec3f(out - Vec3d(0, 0, 0.5)), g.from_first[1] = Vec3f(out + Vec3d(0, 0, 0.5));
    cloud.add(out * radius, h, Vec3d(), Junction(0, 1, 2), g);
  }
  for (const Vec3d& d : spiral(int(4 * M_PI * radius * radius / (h * h * std::sqrt(0.75)))))
    if (std::abs(d.z) * radius > 0.6 * h) cloud.add(d * radius, h, d, Junction(0, d.z > 0 ? 1 : 2));
  const int n = int(radius / h) + 2;
  for (int j = -n; j <= n; ++j)
    for (int i = -2 * n; i <= 2 * n; ++i) {
      const Vec3d p(h * (i + 0.5 * (j & 1)), h * std::sqrt(0.75) * j, 0);
      if (length(p) < radius - 0.6 * h) cloud.add(p, h, {0, 0, 1}, Junction(1, 2));
    }
  return cloud;
}

TEST(Stars, SurfacesShareTheirRims) {
  const Cloud cloud = halves(6, 0.8);
  const StarMesh made = mesh_from_stars(cloud.view());
  ASSERT_TRUE(made.sound);
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
  EXPECT_FALSE(mesh_from_stars(cloud.view()).sound);
}

TEST(Stars, ARimOfOneOrTwoBoundsNothing) {
  for (const int count : {1, 2}) {
    Cloud cloud = sphere(spiral(600), 5);
    for (int i = 0; i < count; ++i) {  // a third material touches the sphere in a speck
      JunctionGradients g;
      g.from_first[0] = {0, 0, 1}, g.from_first[1] = {float(1 - 2 * i), 0, 1};
      cloud.add({0.1 * i, 0, 5.001}, 0.5, Vec3d(), Junction(0, 1, 2), g);
    }
    const StarMesh made = mesh_from_stars(cloud.view());
    ASSERT_FALSE(made.triangles.empty() && made.sound);
    if (made.sound) {
      EXPECT_TRUE(cloud.topology(made, 3).sound());
    }
  }
}

}  // namespace
}  // namespace nacre::test
