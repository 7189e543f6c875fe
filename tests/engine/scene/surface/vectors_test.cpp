// Nacre: tests of vector choice, statistics and the analytic fields.
#include <gtest/gtest.h>

#include "compute/device/error.hpp"
#include "engine/scene/surface/prepare.hpp"
#include "tests/engine/scene/surface/shapes.hpp"

namespace nacre {
namespace {

using test::cube;
using test::icosphere;

/// Adds an array of equal tuples.
void add(Surface& s, const std::string& name, const std::vector<float>& tuple) {
  PointArray array{name, int(tuple.size()), {}};
  for (std::size_t p = 0; p < s.points.size(); ++p) array.values.insert(array.values.end(), tuple.begin(), tuple.end());
  s.arrays.push_back(array);
}

std::string message(const Surface& s, const std::string& request) {
  try {
    choose_vectors(s, request);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

TEST(ChooseVectors, TheOnlyOne) {
  Surface s = cube();
  add(s, "pressure", {1});
  add(s, "Normals", {0, 0, 1});
  add(s, "thing", {1, 2, 3});
  const VectorChoice choice = choose_vectors(s, "");
  EXPECT_EQ(choice.name, "thing");
  EXPECT_EQ(choice.reason, "the only vector array");
}

TEST(ChooseVectors, NamesInOrder) {
  const std::vector<std::string> order = {"wallShearStress_0", "Velocity", "Momentum", "GradT", "DISPL"};
  for (std::size_t best = 0; best < order.size(); ++best) {
    Surface s = cube();
    for (std::size_t i = order.size(); i-- > best;) add(s, order[i], {1, 1, 1});
    add(s, "TextureCoordinates", {1, 1, 1});
    EXPECT_EQ(choose_vectors(s, "").name, order[best]);
  }
}

TEST(ChooseVectors, ShortNamesAreWholeWords) {
  for (const std::string name : {"U", "V", "UMean", "u_0", "WSS", "vel", "inflow_vel_12"}) {
    Surface s = cube();
    add(s, "uncertain", {1, 1, 1});
    add(s, name, {1, 1, 1});
    add(s, "vorticity", {1, 1, 1});
    EXPECT_EQ(choose_vectors(s, "").name, name);
  }
}

TEST(ChooseVectors, ContentCounts) {
  Surface s = icosphere(1);
  add(s, "velocity", {0, 0, 0});  // nothing to see
  PointArray normal{"flow_velocity", 3, {}};
  for (const Vec3d& p : s.points)
    for (int axis = 0; axis < 3; ++axis) normal.values.push_back(float(2 * p[axis]));  // leaves the surface
  s.arrays.push_back(normal);
  add(s, "momentum", {1, 0, 0});
  EXPECT_EQ(choose_vectors(s, "").name, "momentum");
  for (float& v : normal.values) v /= 2;
  s.arrays = {normal};
  s.arrays[0].name = "nml";  // unit length and normal: normals under another name
  EXPECT_NE(message(s, "").find("no vectors to show"), std::string::npos);
}

TEST(ChooseVectors, Requests) {
  Surface s = cube();
  add(s, "Velocity", {1, 0, 0});
  add(s, "pressure", {1});
  EXPECT_EQ(choose_vectors(s, "Velocity").name, "Velocity");
  EXPECT_EQ(choose_vectors(s, "velocity").name, "Velocity");
  EXPECT_EQ(choose_vectors(s, "@swirl").name, "@swirl");
  EXPECT_NE(message(s, "wind").find("its point arrays are Velocity [3], pressure"), std::string::npos);
  EXPECT_NE(message(s, "pressure").find("1 component"), std::string::npos);
  EXPECT_NE(message(s, "@wind").find("@swirl and @rotation"), std::string::npos);
  EXPECT_NE(message(cube(), "").find("no point arrays"), std::string::npos);
}

TEST(VectorStatistics, CubeInUniformFlow) {
  const PreparedSurface s = prepare(cube());
  const std::vector<Vec3f> flow(s.points.size(), Vec3f(0, 0, 2));
  const VectorStatistics stats = vector_statistics(s, flow);
  EXPECT_NEAR(stats.normal_share, 1.0 / 3, 1e-6);  // two of six equal faces
  EXPECT_EQ(stats.zero_share, 0);
  EXPECT_NEAR(stats.max_speed, 2, 1.0);  // corners average their faces, by the area each triangle gives them
  EXPECT_LE(stats.percentile_98, stats.max_speed);
}

TEST(VectorStatistics, PercentileIsWeightedByArea) {
  Surface in;  // a unit square, slow, and far away one of area 0.01, fast
  in.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {5, 0, 0}, {5.1, 0, 0}, {5.1, 0.1, 0}, {5, 0.1, 0}};
  in.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  std::vector<Vec3f> v(8, Vec3f(1, 0, 0));
  for (int p = 4; p < 8; ++p) v[p] = {100, 0, 0};
  VectorStatistics stats = vector_statistics(prepare(in), v);
  EXPECT_NEAR(stats.percentile_98, 1, 1e-6);
  EXPECT_NEAR(stats.max_speed, 100, 1e-4);
  for (int p = 0; p < 4; ++p) v[p] = {};  // what does not move at all does not count
  stats = vector_statistics(prepare(in), v);
  EXPECT_NEAR(stats.percentile_98, 100, 1e-4);
  EXPECT_EQ(stats.zero_share, 0.5);
  EXPECT_THROW(vector_statistics(prepare(in), std::vector<Vec3f>(3)), Error);
}

TEST(AnalyticVectors, RotationIsTheRotation) {
  const PreparedSurface s = prepare(icosphere(3));
  const std::vector<Vec3f> v = analytic_vectors("@rotation", s, 0.25);
  for (std::size_t p = 0; p < v.size(); ++p)
    EXPECT_LT(length(Vec3d(v[p]) - Vec3d(-s.points[p].y, s.points[p].x, 0)), 0.02);
}

TEST(AnalyticVectors, SwirlIsTangentPeriodicUnsteadyAndScaleFree) {
  Surface in = icosphere(3);
  const PreparedSurface s = prepare(in);
  const std::vector<Vec3f> v0 = analytic_vectors("@swirl", s, 0), v1 = analytic_vectors("@swirl", s, 1);
  const std::vector<Vec3f> half = analytic_vectors("@swirl", s, 0.5);
  for (Vec3d& p : in.points) p = p * 1000.0 + Vec3d(7000, 0, 0);
  const std::vector<Vec3f> big = analytic_vectors("@swirl", prepare(in), 0);
  double squares = 0, change = 0;
  for (std::size_t p = 0; p < v0.size(); ++p) {
    EXPECT_LT(std::abs(dot(Vec3d(v0[p]), s.points[p])), 0.02);
    EXPECT_LT(length(v0[p] - v1[p]), 1e-5);
    EXPECT_LT(length(v0[p] - big[p]), 1e-3);
    squares += dot(v0[p], v0[p]);
    change += length(v0[p] - half[p]);
  }
  EXPECT_NEAR(std::sqrt(squares / double(v0.size())), 1, 0.3);
  EXPECT_GT(change / double(v0.size()), 0.2);
  EXPECT_LT(vector_statistics(s, v0).normal_share, 0.01);
}

TEST(AnalyticVectors, UnknownName) {
  EXPECT_THROW(analytic_vectors("@nothing", prepare(cube()), 0), Error);
  for (const std::string& name : analytic_vector_names()) EXPECT_NO_THROW(analytic_vectors(name, prepare(cube()), 0));
}

}  // namespace
}  // namespace nacre
