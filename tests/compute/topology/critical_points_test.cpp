// Nacre: critical points against fields on spheres, tori and squares whose topology is known.
#include "compute/topology/critical_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

constexpr double persistence = 0.06;  ///< of the largest speed: six standard deviations of the noise

struct Known {
  CriticalKind kind;
  Vec3d position;
};

FlowTopology topology_of(const Shape& shape, const std::vector<Vec3f>& vectors, double share = persistence) {
  const TangentField field(shape.points, shape.triangles, vectors);
  double largest = 0;
  for (std::size_t v = 0; v < field.vertices(); ++v) largest = std::max(largest, field.speed(v));
  return find_critical_points(field, share * largest);
}

/// All of `known` are found, each within `tolerance`, and none besides.
void expect_points(const FlowTopology& found, const std::vector<Known>& known, double tolerance) {
  EXPECT_EQ(found.points.size(), known.size());
  for (const Known& each : known) {
    const auto nearest = std::min_element(found.points.begin(), found.points.end(), [&](const auto& a, const auto& b) {
      return length(a.position - each.position) < length(b.position - each.position);
    });
    ASSERT_NE(nearest, found.points.end());
    EXPECT_LT(length(nearest->position - each.position), tolerance);
    EXPECT_EQ(name_of(nearest->kind), std::string(name_of(each.kind)));
  }
}

/// The gradient of x^2 + 2 y^2 + 3 z^2.
Vec3d six_points(const Vec3d& p) { return on_sphere({2 * p.x, 4 * p.y, 6 * p.z}, p); }
const std::vector<Known> the_six = {{CriticalKind::source, {1, 0, 0}}, {CriticalKind::source, {-1, 0, 0}},
                                    {CriticalKind::saddle, {0, 1, 0}}, {CriticalKind::saddle, {0, -1, 0}},
                                    {CriticalKind::sink, {0, 0, 1}},   {CriticalKind::sink, {0, 0, -1}}};

Vec3d rotation(const Vec3d& p) { return {-p.y, p.x, 0}; }
Vec3d spiral(const Vec3d& p) { return rotation(p) + on_sphere({0, 0, 1}, p) * 0.5; }

/// Downwards along x on the torus: source at x = 1.4, saddles at 0.6 and -0.6, sink at -1.4.
Vec3d along_x(const Vec3d& p) {
  const double r = std::hypot(p.x, p.y);
  const Vec3d circle(p.x / r, p.y / r, 0), n = normalized(p - circle);
  return -(Vec3d(1, 0, 0) - n * n.x);
}
const std::vector<Known> the_four = {{CriticalKind::source, {1.4, 0, 0}},
                                     {CriticalKind::saddle, {0.6, 0, 0}},
                                     {CriticalKind::saddle, {-0.6, 0, 0}},
                                     {CriticalKind::sink, {-1.4, 0, 0}}};

TEST(CriticalPoints, OfAGradientOnTheSphere) {
  const Shape sphere = divided_sphere(5);
  const FlowTopology found = topology_of(sphere, vectors_on(sphere, six_points));
  expect_points(found, the_six, 0.003);
  EXPECT_EQ(found.point_index, 2);
  EXPECT_EQ(found.euler_characteristic, 2);
  for (const CriticalPoint& point : found.points) {  // eigenvalues: differences of 2, 4 and 6
    const double at = std::fabs(point.position.x) > 0.9 ? 2 : std::fabs(point.position.y) > 0.9 ? 4 : 6;
    std::vector<double> expected;
    for (const double other : {6, 4, 2})
      if (other != at) expected.push_back(other - at);
    EXPECT_NEAR(point.first.real(), expected[0], 0.05);
    EXPECT_NEAR(point.second.real(), expected[1], 0.05);
    EXPECT_EQ(point.first.imag(), 0);
    const Vec3d axis = at == 6 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);  // of the larger one
    EXPECT_GT(std::fabs(dot(point.first_axis, axis)), 0.999);
    EXPECT_LT(std::fabs(dot(point.first_axis, point.second_axis)), 0.01);
  }
}

TEST(CriticalPoints, OfRotationsOnTheSphere) {
  const Shape sphere = divided_sphere(5);
  const FlowTopology turning = topology_of(sphere, vectors_on(sphere, rotation));
  expect_points(turning, {{CriticalKind::centre, {0, 0, 1}}, {CriticalKind::centre, {0, 0, -1}}}, 0.003);
  for (const CriticalPoint& point : turning.points) EXPECT_NEAR(point.first.imag(), 1, 0.01);
  const FlowTopology found = topology_of(sphere, vectors_on(sphere, spiral));
  expect_points(found, {{CriticalKind::focus_sink, {0, 0, 1}}, {CriticalKind::focus_source, {0, 0, -1}}}, 0.003);
  for (const CriticalPoint& point : found.points) {
    EXPECT_NEAR(std::fabs(point.first.real()), 0.5, 0.01);
    EXPECT_NEAR(point.first.imag(), 1, 0.01);
  }
}

TEST(CriticalPoints, OnTheTorus) {
  const Shape shape = torus(48);
  const FlowTopology found = topology_of(shape, vectors_on(shape, along_x));
  expect_points(found, the_four, 0.01);
  EXPECT_EQ(found.euler_characteristic, 0);
  EXPECT_EQ(found.point_index, 0);
  const FlowTopology none_at_all = topology_of(shape, vectors_on(shape, rotation));
  EXPECT_TRUE(none_at_all.points.empty());
  EXPECT_EQ(none_at_all.cancelled, 0u);
}

TEST(CriticalPoints, UnderNoiseAllAreFoundAndNoneBesides) {
  const Shape sphere = divided_sphere(6), ring = torus(64);
  std::size_t cancelled = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const FlowTopology six = topology_of(sphere, vectors_on(sphere, six_points, 0.01, seed));
    expect_points(six, the_six, 0.03);
    EXPECT_EQ(six.point_index, 2);
    const FlowTopology two = topology_of(sphere, vectors_on(sphere, spiral, 0.01, seed));
    expect_points(two, {{CriticalKind::focus_sink, {0, 0, 1}}, {CriticalKind::focus_source, {0, 0, -1}}}, 0.03);
    const FlowTopology turning = topology_of(sphere, vectors_on(sphere, rotation, 0.01, seed));
    EXPECT_EQ(turning.points.size(), 2u);
    for (const CriticalPoint& point : turning.points) EXPECT_LT(std::fabs(point.first.real()), 0.05);
    const FlowTopology four = topology_of(ring, vectors_on(ring, along_x, 0.01, seed));
    expect_points(four, the_four, 0.05);
    EXPECT_EQ(four.point_index, 0);
    EXPECT_TRUE(topology_of(ring, vectors_on(ring, rotation, 0.01, seed)).points.empty());
    cancelled += six.cancelled + two.cancelled + turning.cancelled + four.cancelled;
  }
  EXPECT_GT(cancelled, 0u);  // else the noise would have shown nothing
}

TEST(CriticalPoints, PersistenceIsWhatTakesThePairsOfNoiseAway) {
  const Shape sphere = divided_sphere(6);
  const std::vector<Vec3f> vectors = vectors_on(sphere, six_points, 0.03);
  const FlowTopology all = topology_of(sphere, vectors, 0);
  EXPECT_GT(all.points.size(), 10u);
  EXPECT_EQ(all.point_index, 2);
  const FlowTopology few = topology_of(sphere, vectors, 0.15);
  expect_points(few, the_six, 0.06);
  EXPECT_EQ(few.cancelled + 6, all.points.size());
}

TEST(CriticalPoints, ThoseThatCancelAreThoseThatALargerPersistenceLeavesOut) {
  const Shape sphere = divided_sphere(5);
  const std::vector<Vec3f> vectors = vectors_on(sphere, six_points);
  const FlowTopology all = topology_of(sphere, vectors, 0);
  ASSERT_EQ(all.points.size(), 6u);
  const TangentField field(sphere.points, sphere.triangles, vectors);
  for (const CriticalPoint& point : all.points) {
    if (point.kind != CriticalKind::saddle) continue;
    const FlowTopology fewer = find_critical_points(field, point.persistence);
    EXPECT_LT(fewer.points.size(), 6u);
    EXPECT_EQ(fewer.point_index, 2);
  }
}

TEST(CriticalPoints, RimsAndZeroRegionsMakeUpTheRest) {
  const Shape plate = square(20);
  const FlowTopology out = topology_of(plate, vectors_on(plate, [](const Vec3d& p) { return p; }));
  expect_points(out, {{CriticalKind::source, {0, 0, 0}}}, 1e-5);
  EXPECT_EQ(out.rims, 1u);
  EXPECT_EQ(out.rim_index, 0);  // all of it leaves
  EXPECT_EQ(out.euler_characteristic, 1);
  const FlowTopology through = topology_of(plate, vectors_on(plate, [](const Vec3d&) { return Vec3d(1, 0.3, 0); }));
  EXPECT_TRUE(through.points.empty());
  EXPECT_EQ(through.rim_index, 1);
  const FlowTopology saddle = topology_of(plate, vectors_on(plate, [](const Vec3d& p) { return Vec3d(p.x, -p.y, 0); }));
  expect_points(saddle, {{CriticalKind::saddle, {0, 0, 0}}}, 1e-5);
  EXPECT_EQ(saddle.rim_index, 2);

  const Shape sphere = divided_sphere(5);
  const auto still_cap = [](const Vec3d& p) { return p.z > 0.8 ? Vec3d(0, 0, 0) : rotation(p); };
  const FlowTopology cap = topology_of(sphere, vectors_on(sphere, still_cap));
  expect_points(cap, {{CriticalKind::centre, {0, 0, -1}}}, 0.003);
  ASSERT_EQ(cap.zero_regions.size(), 1u);
  EXPECT_EQ(cap.zero_regions[0].index, 1);
  EXPECT_NEAR(cap.zero_regions[0].area, 2 * 3.14159 * 0.2, 0.15);
  EXPECT_EQ(cap.point_index + cap.region_index + cap.rim_index, cap.euler_characteristic);
}

TEST(CriticalPoints, AZeroAtAPointIsAnOrdinaryOne) {
  Shape sphere = divided_sphere(4);
  const Vec3d pole = sphere.points[5];
  const FlowTopology found = topology_of(
      sphere, vectors_on(sphere, [&](const Vec3d& p) { return p == pole ? Vec3d(0, 0, 0) : on_sphere(pole, p); }));
  EXPECT_TRUE(found.zero_regions.empty());
  expect_points(found, {{CriticalKind::sink, pole}, {CriticalKind::source, -pole}}, 0.01);
}

TEST(CriticalPoints, OfNothing) {
  const Shape sphere = divided_sphere(3);
  const FlowTopology still = topology_of(sphere, std::vector<Vec3f>(sphere.points.size()));
  EXPECT_TRUE(still.points.empty());
  EXPECT_EQ(still.region_index, 2);
  std::vector<Vec3f> bad = vectors_on(sphere, rotation);
  bad[7] = Vec3f(std::numeric_limits<float>::quiet_NaN());
  const FlowTopology found = topology_of(sphere, bad);
  EXPECT_EQ(found.point_index + found.region_index, 2);
  const FlowTopology empty = find_critical_points(TangentField({}, {}, {}), 0);
  EXPECT_TRUE(empty.points.empty());
}

TEST(CriticalPoints, EdgesOfThreeTrianglesAreRims) {
  Shape fins = square(4);
  const auto top = std::uint32_t(fins.points.size());
  fins.points.push_back({0, 0, 1});
  fins.triangles.push_back({6, 7, top});
  const FlowTopology found = topology_of(fins, vectors_on(fins, [](const Vec3d&) { return Vec3d(1, 0.3, 0.2); }));
  EXPECT_EQ(found.point_index + found.region_index + found.rim_index, found.euler_characteristic);
}

}  // namespace
}  // namespace nacre::test
