// Nacre: tests of the built-in flow samples.
#include "engine/scene/samples/samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/scene/samples/sample_kit.hpp"
#include "tests/engine/scene/samples/closed_mesh.hpp"
#include "tests/engine/scene/samples/self_contact.hpp"

namespace nacre {
namespace {

struct Expected {
  const char* name;
  int detail;  // coarse enough to be quick
  Vec3d size;  // of the bounding box
  long euler;
  bool open = false;  // a sheet with one edge around it
};

void PrintTo(const Expected& expected, std::ostream* out) { *out << expected.name; }

class Samples : public testing::TestWithParam<Expected> {};

Vec3d velocity_at(const Surface& surface, std::size_t i) {
  const std::vector<float>& values = surface.find("velocity")->values;
  return {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
}

double root_mean_square(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += double(v) * v;
  return std::sqrt(sum / double(values.size()));
}

void expect_sound(const MeshCheck& check, const Expected& expected) {
  EXPECT_EQ(check.repeated_half_edges, 0u);
  EXPECT_EQ(check.degenerate_triangles, 0u);
  EXPECT_EQ(check.euler, expected.euler);
  if (expected.open) {
    EXPECT_GT(check.open_half_edges, 0u);
    EXPECT_EQ(check.pinched_points, check.open_half_edges);  // the edge runs once through each of its points
  } else {
    EXPECT_EQ(check.open_half_edges, 0u);
    EXPECT_EQ(check.pinched_points, 0u);
    EXPECT_GT(check.volume, 0);
  }
  EXPECT_GT(check.least_angle, 10);
  const double longest = std::max({expected.size.x, expected.size.y, expected.size.z});
  EXPECT_NEAR(check.mean_edge * expected.detail / longest, 1, 0.25);
}

void expect_size(const std::vector<Vec3d>& points, const Vec3d& size) {
  Vec3d low(1e9), high(-1e9);
  for (const Vec3d& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(high[axis] - low[axis], size[axis], 0.01 * size[axis]) << axis;
}

void expect_normals_of_triangles(const SampleShape& shape) {
  double sum = 0;
  for (const Triangle& t : shape.triangles) {
    const Vec3d facet = normalized(cross(shape.points[t.b] - shape.points[t.a], shape.points[t.c] - shape.points[t.a]));
    const Vec3d mean = normalized(shape.normals[t.a] + shape.normals[t.b] + shape.normals[t.c]);
    ASSERT_GT(dot(facet, mean), 0.5);
    sum += dot(facet, mean);
  }
  EXPECT_GT(sum / double(shape.triangles.size()), 0.99);
}

TEST_P(Samples, ShapeIsAManifoldAndOfItsProportions) {
  const SampleShape shape = sample_definition(GetParam().name).shape(GetParam().detail);
  expect_sound(check_mesh(shape.points, shape.triangles), GetParam());
  expect_size(shape.points, GetParam().size);
  expect_normals_of_triangles(shape);

  const double finer = 1.25;
  const SampleShape fine = sample_definition(GetParam().name).shape(int(finer * GetParam().detail));
  EXPECT_NEAR(double(fine.triangles.size()) / double(shape.triangles.size()), finer * finer, 0.15 * finer * finer);
}

void expect_tangential(const Surface& surface, const std::vector<Vec3d>& normals) {
  ASSERT_EQ(surface.arrays.size(), 1u);
  ASSERT_EQ(surface.arrays[0].components, 3);
  ASSERT_EQ(surface.arrays[0].size(), surface.points.size());
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Vec3d v = velocity_at(surface, i);
    ASSERT_TRUE(is_finite(surface.points[i]) && is_finite(v));
    ASSERT_NEAR(length(normals[i]), 1, 1e-9);
    ASSERT_LE(std::abs(dot(v, normals[i])), 1e-3 * length(v) + 1e-6);
  }
}

/// Against the triangles, which know nothing of the analytic normals: their mean around a point is close to tangential.
void expect_nearly_along_triangles(const Surface& surface) {
  std::vector<Vec3d> normals(surface.points.size());
  for (const Triangle& t : surface.triangles) {
    const Vec3d& a = surface.points[t.a];
    const Vec3d area = cross(surface.points[t.b] - a, surface.points[t.c] - a);
    for (int k = 0; k < 3; ++k) normals[t[k]] += area;
  }
  double off = 0, all = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Vec3d v = velocity_at(surface, i);
    off += std::abs(dot(v, normalized(normals[i])));
    all += length(v);
  }
  EXPECT_LT(off, 0.02 * all);
}

void expect_worthwhile_speeds(const Surface& surface) {
  std::vector<double> speeds;
  for (std::size_t i = 0; i < surface.points.size(); ++i) speeds.push_back(length(velocity_at(surface, i)));
  std::sort(speeds.begin(), speeds.end());
  const double fast = speeds[speeds.size() * 98 / 100];
  EXPECT_GT(fast, 0.5);
  EXPECT_GT(speeds[speeds.size() / 10], 0.1 * fast);  // few stagnant positions
  EXPECT_LT(speeds.back(), 3 * fast);                 // no spikes
}

/// Neighbouring steps differ, by a part of the flow only; so do the last and the first.
void expect_loop(const SurfaceSeries& series) {
  ASSERT_GE(series.steps(), 16u);
  ASSERT_LE(series.steps(), 24u);
  EXPECT_EQ(series.times.front(), 0);
  const std::size_t n = series.steps();
  for (std::size_t k = 0; k < n; ++k) {
    EXPECT_NEAR(series.times[k], double(k) / double(n), 1e-12);
    const std::vector<float> now = series.load(k).arrays[0].values;
    std::vector<float> change = series.load((k + 1) % n).arrays[0].values;
    for (std::size_t i = 0; i < now.size(); ++i) change[i] -= now[i];
    EXPECT_GT(root_mean_square(change), 0.02 * root_mean_square(now)) << "step " << k;
    EXPECT_LT(root_mean_square(change), 0.5 * root_mean_square(now)) << "step " << k;
  }
}

TEST_P(Samples, FlowIsTangentialUnsteadyAndLoops) {
  const SampleDefinition& definition = sample_definition(GetParam().name);
  const SurfaceSeries series = make_sample(GetParam().name, GetParam().detail);
  const SampleShape shape = definition.shape(GetParam().detail);
  for (std::size_t step = 0; step < series.steps(); step += 7) {
    const Surface surface = series.load(step);
    ASSERT_TRUE(surface.points == shape.points && surface.triangles == shape.triangles);
    expect_tangential(surface, shape.normals);
    expect_nearly_along_triangles(surface);
    expect_worthwhile_speeds(surface);
  }
  const std::size_t last = series.steps() - 1;
  EXPECT_EQ(series.load(last).arrays[0].values, series.load(last).arrays[0].values);
  EXPECT_THROW(series.load(series.steps()), Error);
  if (series.steps() == 1) return;  // the rotation is steady

  expect_loop(series);
  const SampleField first = definition.flow(0), after = definition.flow(1);
  for (std::size_t i = 0; i < shape.points.size(); ++i)
    ASSERT_LT(length(first(shape.points[i], shape.normals[i]) - after(shape.points[i], shape.normals[i])), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, Samples,
                         testing::Values(Expected{"sphere", 40, {2, 2, 2}, 2},
                                         Expected{"sphere-rotation", 40, {2, 2, 2}, 2},
                                         Expected{"torus", 60, {2.8, 2.8, 0.8}, 0},
                                         Expected{"train", 120, {10, 10 * 58 / 512.0, 10 * 69 / 512.0}, 2},
                                         Expected{"aircraft", 200, {3.84, 3.82, 1.165}, -2},
                                         Expected{"cylinder", 140, {1.44, 2.22, 4.72}, 2},
                                         Expected{"delta-wing", 300, {10, 1.006, 1.009}, 1, true}),
                         [](const auto& sample) {
                           std::string name = sample.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(SampleList, EveryNameCanBeMade) {
  std::vector<std::string> names;
  for (const SampleInfo& info : samples()) {
    EXPECT_FALSE(info.help.empty());
    EXPECT_EQ(sample_definition(info.name).info.name, info.name);
    names.push_back(info.name);
  }
  EXPECT_EQ(names, (std::vector<std::string>{"sphere", "sphere-rotation", "torus", "train", "aircraft", "cylinder",
                                             "delta-wing", "pulse"}));
}

TEST(SampleList, DefaultsShowNoFacets) {
  for (const char* name : {"sphere", "torus", "train", "delta-wing"}) {
    const std::size_t triangles = make_sample(name).load(0).triangles.size();
    EXPECT_GT(triangles, 100000u) << name;
    EXPECT_LT(triangles, 200000u) << name;
  }
}

/// docs/performance/flow.md has figures of these.
TEST(SampleList, DefaultsAreThoseOfTheFigures) {
  EXPECT_EQ(make_sample("train").load(0).triangles.size(), 145728u);
  EXPECT_EQ(make_sample("torus").load(0).triangles.size(), 161640u);
  EXPECT_EQ(make_sample("pulse").load(0).triangles.size(), 106032u);
}

TEST(SampleList, UnknownNamesAndDetailsAreTold) {
  const auto message = [](const std::string& name, int detail) -> std::string {
    try {
      make_sample(name, detail);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("spere", 0).find("did you mean 'sphere'?"), std::string::npos);
  EXPECT_NE(message("teapot-of-newell", 0).find("sphere, sphere-rotation, torus, train"), std::string::npos);
  EXPECT_EQ(message("teapot-of-newell", 0).find("did you mean"), std::string::npos);
  EXPECT_NE(message("aircraft", 7).find("from 200 to"), std::string::npos);
  EXPECT_NE(message("sphere", -1), "");
  EXPECT_NE(message("sphere", 1 << 30), "");
}

TEST(SampleSphereRotation, TurnsRigidlyAboutZ) {
  const Surface surface = make_sample("sphere-rotation", 20).load(0);
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Vec3d& p = surface.points[i];
    ASSERT_LT(length(velocity_at(surface, i) - Vec3d{-p.y, p.x, 0}), 1e-6);
  }
}

TEST(SamplePulse, MovesWithPeriodOneAndItsVelocityHasThatOfTheSurface) {
  const SurfaceSeries series = make_sample("pulse", 12);
  EXPECT_TRUE(series.moves);
  const Surface a = series.load(0), b = series.load(1);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_GT(length(a.points[0] - b.points[0]), 1e-3);
  const auto& position = sample_definition("pulse").position;
  const Vec3d p(0.6, 0, 0.8);
  EXPECT_LT(length(position(p, 0.2) - position(p, 1.2)), 1e-12);
  EXPECT_EQ(check_mesh(b.points, b.triangles).open_half_edges, 0u);
}

TEST(SampleDeltaWing, WindsCloselyButNeverMeetsItself) {
  const SampleShape shape = sample_definition("delta-wing").shape(300);
  const double gap = least_gap(shape.points, shape.normals, shape.triangles, 0.05);
  EXPECT_GT(gap, 3 * 10 / 2048.0);  // cells at 2048 along its length
  EXPECT_LT(gap, 6 * 10 / 2048.0);
}

/// Long and narrow: a band of 2.9 cells on either side holds 50 to 100 million cells at 8192 along its length.
TEST(SampleDeltaWing, HasMuchSurfaceForItsLength) {
  const SampleShape shape = sample_definition("delta-wing").shape(300);
  double area = 0;
  for (const Triangle& t : shape.triangles)
    area += 0.5 * length(cross(shape.points[t.b] - shape.points[t.a], shape.points[t.c] - shape.points[t.a]));
  EXPECT_GT(area / 100, 0.15);
  EXPECT_LT(area / 100, 0.25);
}

TEST(LeastGap, OfTwoSheetsIsTheirDistance) {
  const std::vector<Vec3d> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.1, 0.25}, {1, 0, 0.25}, {0, 1, 0.25}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 4, 5}};
  EXPECT_NEAR(least_gap(points, std::vector<Vec3d>(6, Vec3d(0, 0, -1)), triangles, 0.5), 0.25, 1e-12);
  EXPECT_EQ(least_gap(points, std::vector<Vec3d>(6, Vec3d(0, 0, -1)), triangles, 0.2), 0.2);
}

TEST(LatticeBox, IsAClosedBoxOfItsSize) {
  const LatticeBox box = lattice_box(3, 4, 5);
  EXPECT_EQ(box.points.size(), std::size_t(4 * 5 * 6 - 2 * 3 * 4));
  EXPECT_EQ(box.triangles.size(), std::size_t(4 * (3 * 4 + 4 * 5 + 5 * 3)));
  std::vector<Vec3d> points(box.points.begin(), box.points.end());
  const MeshCheck check = check_mesh(points, box.triangles);
  EXPECT_EQ(check.open_half_edges + check.repeated_half_edges + check.pinched_points, 0u);
  EXPECT_NEAR(check.volume, 60, 1e-9);
}

}  // namespace
}  // namespace nacre
