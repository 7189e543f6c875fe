// Nacre: how far triangles are from their interfaces, and meshes whose deviation is bounded.
#include <gtest/gtest.h>

#include "compute/device/cpu_device.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/deviation_refinement.hpp"
#include "tests/compute/icosphere.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

constexpr double radius = 3;

std::vector<Vec3d> onto_sphere(std::span<const Vec3d> points, std::span<const Junction>) {
  std::vector<Vec3d> on;
  for (const Vec3d& p : points) on.push_back(p * (radius / length(p)));
  return on;
}

TEST(MeshDeviation, IsThatOfTheMiddleOfAFlatTriangle) {
  const SurfaceMesh mesh = icosphere(0, radius);
  const MeshDeviation deviation = measure_deviation(mesh, onto_sphere, 2);
  const double inner = radius * std::sqrt((5 + 2 * std::sqrt(5.0)) / 15);  // of an icosahedron's inscribed sphere
  ASSERT_EQ(deviation.triangle.size(), 20u);
  for (const float d : deviation.triangle) EXPECT_NEAR(d, (radius - inner) / 2, 1e-6);
  EXPECT_NEAR(deviation.max, (radius - inner) / 2, 1e-6);
  EXPECT_NEAR(deviation.mean, deviation.max, 1e-6);
  for (const MeshDeviation::Rim& rim : deviation.on_rim[0]) EXPECT_EQ(rim.away, -1);
}

TEST(MeshDeviation, EdgesOfCurvesAreMeasuredFromTheCurve) {
  SurfaceMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 1}, {0, 4, 1}};
  mesh.materials = {{1, 2}, {2, 7}, {1, 7}};
  const auto onto = [](std::span<const Vec3d> points, std::span<const Junction> junctions) {
    std::vector<Vec3d> on(points.begin(), points.end());
    for (std::size_t i = 0; i < on.size(); ++i)
      if (junctions[i] == Junction(1, 2, 7)) on[i].y += 0.25;
    return on;
  };
  const MeshDeviation deviation = measure_deviation(mesh, onto, 1);
  EXPECT_EQ(deviation.triangle, (std::vector<float>{0.25f, 0.25f, 0.25f}));
  EXPECT_EQ(deviation.on_rim[0][0].away, -1);
  EXPECT_EQ(deviation.on_rim[0][1].away, -1);
  EXPECT_EQ(deviation.on_rim[0][2].away, 0.25f);
  EXPECT_EQ(deviation.on_rim[0][2].third, 7);
  const DeviationRefinement further = refine_deviation(mesh, deviation, {0.1, 0.25});
  ASSERT_EQ(further.insert.size(), 1u) << "the three wish for one point";
  EXPECT_EQ(further.insert[0].position, Vec3d(0, 0, 0.5));
  std::array<std::uint16_t, 3> met{further.insert[0].materials[0], further.insert[0].materials[1],
                                   further.insert[0].third};
  std::sort(met.begin(), met.end());
  EXPECT_EQ(met, (std::array<std::uint16_t, 3>{1, 2, 7}));
  EXPECT_EQ(further.above, 3);
  EXPECT_EQ(further.above_junctions, 3);
}

TEST(MeshDeviation, TheFreeSideOfASmallLoopGetsThePoint) {
  // Materials 1 and 2 meet in a disc around the origin that a circle of radius 1 bounds. The chord from 0 to 2 has the
  // upper half of the circle, with a point on it, nearer to its middle than the lower half, which has none.
  SurfaceMesh mesh;
  const double low = -0.1;
  mesh.points = {
      {-std::sqrt(1 - low * low), low, 0}, {0, 1, 0}, {std::sqrt(1 - low * low), low, 0}, {0, 0, 3}, {0, 0, -3}};
  mesh.triangles = {{0, 1, 2}};
  mesh.materials = {{1, 2}};
  for (std::uint32_t k = 0; k < 3; ++k) {
    mesh.triangles.push_back({k, (k + 1) % 3, 3});
    mesh.materials.push_back({1, 7});
    mesh.triangles.push_back({k, (k + 1) % 3, 4});
    mesh.materials.push_back({2, 7});
  }
  bool loop = true;
  const auto onto = [&](std::span<const Vec3d> points, std::span<const Junction> junctions) {
    std::vector<Vec3d> on(points.begin(), points.end());
    for (std::size_t i = 0; i < on.size(); ++i)
      if (junctions[i] == Junction(1, 2, 7) && points[i].x == 0) on[i] = Vec3d(0, loop ? 1 : -0.8, 0);
    return on;
  };
  const DeviationRule rule{0.1, 0.25};
  const DeviationRefinement across = refine_deviation(mesh, measure_deviation(mesh, onto, 1), rule);
  ASSERT_EQ(across.insert.size(), 1u);
  EXPECT_NEAR(across.insert[0].position.y, 2 * low - 1, 1e-12) << "opposite the point that is there";
  loop = false;
  const DeviationRefinement beside = refine_deviation(mesh, measure_deviation(mesh, onto, 1), rule);
  ASSERT_EQ(beside.insert.size(), 1u);
  EXPECT_NEAR(beside.insert[0].position.y, low, 1e-12) << "in the middle, from where the curve is near";
}

TEST(MeshDeviation, NewPointsKeepAwayFromAllOthers) {
  const SurfaceMesh mesh = icosphere(1, radius);
  const MeshDeviation deviation = measure_deviation(mesh, onto_sphere, 1);
  const DeviationRefinement further = refine_deviation(mesh, deviation, {0.5 * deviation.max, 0.25});
  EXPECT_GT(further.insert.size(), 10u);
  EXPECT_EQ(further.above_detail, 0);
  const double edge = length(mesh.points[mesh.triangles[0].a] - mesh.points[mesh.triangles[0].b]);
  for (std::size_t i = 0; i < further.insert.size(); ++i) {
    for (const Vec3d& p : mesh.points) EXPECT_GT(length(p - further.insert[i].position), 0.5 * edge);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(length(further.insert[j].position - further.insert[i].position), 0.5 * edge);
  }
  const DeviationRefinement none = refine_deviation(mesh, deviation, {0.5 * deviation.max, 10});
  EXPECT_TRUE(none.insert.empty()) << "the triangles are too small for such a detail";
  EXPECT_EQ(none.above_detail, none.above);
  const DeviationRefinement deep = refine_deviation(mesh, deviation, {0.5 * deviation.max, 10, 10 / deviation.max});
  EXPECT_GT(deep.insert.size(), 10u) << "points that move so far do not come near to others";
  EXPECT_EQ(refine_deviation(mesh, deviation, {1.01 * deviation.max, 0.25}).above, 0);
}

TEST(MeshDeviation, LostPointsAreLookedForOnTheRims) {
  // Materials 1 and 2 meet at y = 0; 3 covers what is beyond x = 1.
  const auto onto = [](std::span<const Vec3d> points, std::span<const Junction> junctions) {
    std::vector<Vec3d> on;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool curve = junctions[i] == Junction(1, 2, 3);
      EXPECT_TRUE(curve || junctions[i] == Junction(1, 2));
      on.push_back(points[i].z < 5 ? Vec3d(curve ? 1 : points[i].x, 0, points[i].z) : Vec3d(NAN));
    }
    return on;
  };
  const auto material_at = [](std::span<const Vec3d> points) {
    std::vector<std::uint16_t> material;
    for (const Vec3d& p : points) material.push_back(p.x > 1 ? 3 : p.y > 0 ? 2 : 1);
    return material;
  };
  using NewPoint = MeshDefects::NewPoint;
  const std::vector<NewPoint> wished{
      {{0, 0.1, 0}, {1, 2}, 0},     // became a particle
      {{2, 0.1, 0}, {1, 2}, 1},     // beyond the rim
      {{0, 0.1, 1}, {1, 2}, 2},     // lost for another reason
      {{2, 0.1, 1}, {1, 2}, 3, 7},  // on a curve already
      {{2, 0.1, 6}, {1, 2}, 4},     // beyond the rim, without an interface nearby
  };
  SurfaceMesh mesh;
  mesh.points = {{-1, 0, 0}, {1, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 0, 5}};
  const std::vector<NewPoint> found =
      points_on_rims(mesh, wished, std::vector<std::uint32_t>{0}, 0.5, onto, material_at);
  ASSERT_EQ(found.size(), 4u) << "three from the second wish, one from the last, which finds the curve on one side";
  EXPECT_EQ(found[0].position, Vec3d(1, 0, 0)) << "on the curve, where the interface was";
  for (const NewPoint& p : found) {
    EXPECT_EQ(p.position.x, 1);
    EXPECT_EQ(p.position.y, 0);
    EXPECT_EQ(p.third, 3);
    EXPECT_EQ(p.materials, wished[1].materials);
  }
  EXPECT_TRUE(points_on_rims(mesh, {}, {}, 0.5, onto, material_at).empty());
}

TEST(MeshDeviation, ALoopWithoutPointsGetsThemOnAllSides) {
  // Materials 1 and 2 meet at z = 0; 3 covers a disc around the origin.
  const double disc = 0.4;
  const auto onto = [&](std::span<const Vec3d> points, std::span<const Junction> junctions) {
    std::vector<Vec3d> on;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3d flat(points[i].x, points[i].y, 0);
      const double r = length(flat);
      on.push_back(junctions[i] == Junction(1, 2) ? flat : r > 0 ? flat * (disc / r) : Vec3d(disc, 0, 0));
    }
    return on;
  };
  const auto material_at = [&](std::span<const Vec3d> points) {
    std::vector<std::uint16_t> material;
    for (const Vec3d& p : points) material.push_back(length(p) < disc ? 3 : p.z > 0 ? 2 : 1);
    return material;
  };
  SurfaceMesh mesh;
  mesh.points = {{1, 0, 0}, {-0.5, 0.9, 0}, {-0.5, -0.9, 0}};
  const std::vector<MeshDefects::NewPoint> wished{{{0.1, 0.05, 0.1}, {1, 2}, 0}};
  const auto found = points_on_rims(mesh, wished, {}, 0.25, onto, material_at);
  ASSERT_GE(found.size(), 3u) << "fewer bound no facet";
  EXPECT_LE(found.size(), 8u);
  Vec3d sum;
  for (const auto& p : found) {
    EXPECT_NEAR(length(p.position), disc, 1e-12);
    sum = sum + p.position;
    for (const auto& other : found) EXPECT_TRUE(&other == &p || length(other.position - p.position) >= 0.25);
  }
  EXPECT_LT(length(sum) / double(found.size()), 0.5 * disc) << "all lie on one side";
  // With points of the mesh on the curve, new ones keep away from them.
  mesh.points.insert(mesh.points.end(), {{disc, 0, 0}, {0, disc, 0}, {0, 0, 1}, {0, 0, -1}});
  mesh.triangles = {{3, 4, 0}, {3, 4, 5}, {3, 4, 6}};
  mesh.materials = {{1, 2}, {2, 3}, {1, 3}};
  const auto others = points_on_rims(mesh, wished, {}, 0.25, onto, material_at);
  EXPECT_LT(others.size(), found.size());
  for (const auto& p : others)
    for (const std::size_t v : {3, 4}) EXPECT_GE(length(mesh.points[v] - p.position), 0.25);
}

/// The largest distance of middles of triangles and edges, by a formula.
double largest_off(const SurfaceMesh& mesh, const PlaceFunction& distance) {
  double most = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3d &a = mesh.points[t.a], &b = mesh.points[t.b], &c = mesh.points[t.c];
    for (const Vec3d& p : {(a + b + c) / 3.0, (a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5})
      most = std::max(most, std::fabs(distance(p)));
  }
  return most;
}

struct Body {
  const char* name;
  Int3 dims;
  PlaceFunction distance;
};

/// Distances of voxels are exact near these surfaces, so that what the fields make of them is nearly so.
std::vector<Body> bodies() {
  const Vec3d c(15.3, 15.1, 14.8);
  return {{"ball", {31, 31, 31}, ball(c, 11)}, {"torus", {40, 40, 20}, [](const Vec3d& p) {
                                                  const Vec3d r = p - Vec3d(19.6, 19.3, 9.7);
                                                  const double out = std::hypot(r.x, r.y) - 12;
                                                  return 5 - std::hypot(out, r.z);
                                                }}};
}

TEST(MeshDeviation, TheBoundHoldsWhereParticlesMayBeFarApart) {
  const auto device = make_cpu_device();
  for (const Body& body : bodies())
    for (const double bound : {0.05, 0.02}) {
      MeshParameters parameters;
      parameters.max_size = 6;
      parameters.min_size = 0.5;
      parameters.epsilon = 2;
      parameters.max_deviation = bound;
      const MeshRun run = run_mesh(*device, scalar_volume(body.dims, body.distance), parameters);
      const DeviationInfo& d = run.info.deviation;
      EXPECT_LE(d.max, bound) << body.name;
      EXPECT_EQ(d.above(), 0) << body.name;
      EXPECT_GT(d.max, 0.5 * bound) << body.name << ": more triangles than needed";
      EXPECT_LE(largest_off(run.mesh, body.distance), bound + 0.004) << body.name;
      EXPECT_TRUE(check_topology(run.mesh, 2).sound()) << body.name;
    }
}

TEST(MeshDeviation, TheBoundHoldsAtJunctions) {
  const auto device = make_cpu_device();
  MeshParameters parameters;
  parameters.max_size = 3;
  parameters.epsilon = 1;
  parameters.max_deviation = 0.05;
  const MeshRun run = run_mesh(*device, three_balls(), parameters);
  EXPECT_LE(run.info.deviation.max, 0.05);
  EXPECT_EQ(run.info.deviation.above(), 0);
  EXPECT_TRUE(check_topology(run.mesh, 4).sound());
}

TEST(MeshDeviation, WhatCannotBeReachedIsSaid) {
  const auto device = make_cpu_device();
  MeshParameters parameters;
  parameters.max_deviation = 0.001;
  const MeshRun run = run_mesh(
      *device,
      label_volume({14, 14, 14}, 2, [](const Vec3d& p) { return length(p - Vec3d(6.6, 6.4, 6.5)) < 2.6 ? 1 : 0; }),
      parameters);
  const DeviationInfo& d = run.info.deviation;
  EXPECT_GT(d.max, 0.001);
  EXPECT_GT(d.above_detail, 0);
  EXPECT_FALSE(d.places.empty());
  EXPECT_TRUE(check_topology(run.mesh, 2).sound());
}

TEST(MeshDeviation, NoBoundNoWork) {
  const auto device = make_cpu_device();
  const MeshRun run = run_mesh(*device, scalar_volume({20, 20, 20}, ball({9.5, 9.5, 9.5}, 6)));
  EXPECT_EQ(run.info.deviation.rounds, 0);
  EXPECT_EQ(run.info.deviation.max, 0);
}

}  // namespace
}  // namespace nacre::test
