// Nacre: test bodies for interface points, closest points of lattice cells, and signed distances.
#pragma once

#include "compute/field/distance.hpp"
#include "tests/compute/field/all_cells.hpp"
#include "tests/compute/field/field_cases.hpp"

namespace nacre::test {

const Vec3d sphere_centre(13.2, 12.7, 13.1);
constexpr double sphere_radius = 8.3;

template <class Backend>
void PointsLieOnTheSphere(Executor<Backend>& exec) {
  const MaterialBricks b = bricks_of(exec, scalar_volume({27, 26, 27}, ball(sphere_centre, sphere_radius)));
  const DistanceField d = distance_field(exec, b, 0.5f, 6);
  const Vec3f c = in_fields(sphere_centre);
  std::size_t points = 0;
  std::vector<double> bends;
  for (const InterfacePoint& q : d.point.download()) {
    if (q.position.w < 0) continue;
    ++points;
    const Vec3f r = Vec3f(q.position.x, q.position.y, q.position.z) - c, n(q.normal.x, q.normal.y, q.normal.z);
    EXPECT_NEAR(length(r), sphere_radius, 0.05);
    EXPECT_LT(length(n - normalized(r)), 0.05f);  // towards the lower material: out
    EXPECT_EQ(q.surface, Junction(0, 1));
    bends.push_back(q.normal.w);
  }
  EXPECT_GT(double(points), 4 * M_PI * sphere_radius * sphere_radius);  // at least one to a voxel that it passes
  EXPECT_EQ(points, d.point.size());
  EXPECT_NEAR(median_of(bends), 1 / sphere_radius, 0.15 / sphere_radius);
}

/// Each cell within reach knows the nearest of all points; those beyond know none.
template <class Backend>
void expect_nearest(Executor<Backend>& exec, const MeshVolume& volume, float spacing, float reach) {
  const MaterialBricks b = bricks_of(exec, volume);
  const DistanceField d = distance_field(exec, b, spacing, reach);
  const std::vector<InterfacePoint> points = d.point.download();
  const std::vector<std::uint32_t> nearest = nearest_of_cells(exec, d);
  std::size_t within = 0;
  for (std::size_t i = 0; i < nearest.size(); i += 3) {
    const Vec3f p = d.lattice().centre(d.lattice().cell(std::int64_t(i)));
    float least = 1e30f;
    for (const InterfacePoint& q : points)
      if (q.position.w >= 0) {
        const Vec3f r = Vec3f(q.position.x, q.position.y, q.position.z) - p;
        least = std::min(least, dot(r, r));
      }
    least = std::sqrt(least);
    if (least >= reach) {
      ASSERT_EQ(nearest[i], none);
      continue;
    }
    ++within;
    ASSERT_NE(nearest[i], none) << least;
    const Float4 at = points[nearest[i]].position;
    ASSERT_GE(at.w, 0);
    ASSERT_LE(length(Vec3f(at.x, at.y, at.z) - p), least + 1e-4f);
  }
  ASSERT_GT(within, 100u);
}

/// Per slot, how many points come before that of its cell.
template <class Backend>
std::vector<std::uint32_t> starts_of(Executor<Backend>& exec, const MaterialBricks& b, const DistanceField& d) {
  Arena::Scope scope(exec.arena());
  const auto start = exec.arena().template temporary<std::uint32_t>(std::size_t(d.tiles.slots()));
  find_interface_points(exec, b, d.tiles, start);
  return start.download();
}

template <class Backend>
void CellsKnowTheirNearestPoint(Executor<Backend>& exec) {
  expect_nearest(exec, scalar_volume({22, 21, 22}, ball({10.7, 10.2, 10.9}, 6.3)), 1, 5);
  MeshVolume flat = label_volume({18, 20, 9}, 3, [](const Vec3d& p) {
    return p.x + 2 * p.z < 11 ? 1 : length(p - Vec3d(11, 10, 5)) < 4 ? 2 : 0;
  });
  flat.spacing = {1, 0.8, 2};
  expect_nearest(exec, flat, 1, 6);
  expect_nearest(exec, flat, 2.5f, 6);  // cells larger than voxels
  flat.spacing = {1, 1, 3};
  expect_nearest(exec, flat, 1, 20);  // the nearest points are some tiles away
}

/// More points than a team lists at a time are about as near to the cells in the middle of a ball.
template <class Backend>
void CellsKnowTheNearestOfManyPoints(Executor<Backend>& exec) {
  expect_nearest(exec, scalar_volume({31, 30, 31}, ball({15.1, 14.6, 15.3}, 12.4)), 1, 14);
}

/// Of points in one place, the first counts.
template <class Backend>
void CellsKnowTheFirstOfEqualPoints(Executor<Backend>& exec) {
  const MaterialBricks b = bricks_of(exec, scalar_volume({22, 21, 22}, ball({10.7, 10.2, 10.9}, 6.3)));
  DistanceField d = distance_field(exec, b, 1, 5);
  std::vector<InterfacePoint> points = d.point.download();
  const std::vector<std::uint32_t> start = starts_of(exec, b, d);
  ASSERT_GT(points.size(), 20u);
  for (InterfacePoint& q : points) q.position = points[0].position;
  d.point.upload(points);
  d.nearest.upload(start);
  find_nearest_points(exec, d.tiles, d.point, 5, d.nearest);
  std::size_t know = 0;
  for (const std::uint32_t q : nearest_of_cells(exec, d)) {
    ASSERT_TRUE(q == 0 || q == none) << q;
    know += q == 0;
  }
  EXPECT_GT(know, 100u);
}

/// Signed distance from `p` to the nearest interface, positive in `material`; `reach` where none is near.
NACRE_HD inline float signed_distance(const DistanceFieldView& d, const MaterialBricksView& field, const Vec3f& p,
                                      std::uint32_t material) {
  float distance = d.reach;
  if (d.closest(p, distance) == none || distance > d.reach) distance = d.reach;
  return material_at(field, p) == material ? distance : -distance;
}

struct DistanceAt {
  DistanceFieldView distance;
  MaterialBricksView field;
  const Vec3f* point;
  float* value;
  NACRE_HD void operator()(std::int64_t i) const { value[i] = signed_distance(distance, field, point[i], 1); }
};

template <class Backend>
void DistancesHaveASignAndAnEnd(Executor<Backend>& exec) {
  const MaterialBricks b = bricks_of(exec, scalar_volume({27, 26, 27}, ball(sphere_centre, sphere_radius)));
  const DistanceField d = distance_field(exec, b, 0.5f, 4);
  std::vector<Vec3f> points;
  std::vector<double> exact;
  for (const Vec3d& n : even_directions(60))
    for (const double r : {3.0, 5.6, 7.9, 9.1, 11.4, 13.2}) {
      points.push_back(in_fields(sphere_centre + n * r));
      exact.push_back(sphere_radius - r);
    }
  Array<Vec3f> in = exec.arena().template permanent_copy<Vec3f>(points);
  Array<float> out = exec.arena().template permanent<float>(points.size());
  exec.for_each(std::int64_t(points.size()), DistanceAt{d.view(), b.view(), in.data(), out.data()});
  const std::vector<float> found = out.download();
  for (std::size_t k = 0; k < found.size(); ++k)
    if (std::fabs(exact[k]) > 4.5) {
      EXPECT_EQ(std::fabs(found[k]), 4) << exact[k];
      EXPECT_EQ(found[k] > 0, exact[k] > 0);
    } else if (std::fabs(exact[k]) < 3.5) {  // points are about a voxel apart: the nearest lies aside by half of that
      const double aside = std::hypot(exact[k], 0.75);
      EXPECT_GE(std::fabs(found[k]), std::fabs(exact[k]) - 0.05);
      EXPECT_LE(std::fabs(found[k]), aside + 0.05);
      EXPECT_EQ(found[k] > 0, exact[k] > 0);
    }
}

NACRE_DEVICE_TEST(Distance, PointsLieOnTheSphere)
NACRE_DEVICE_TEST(Distance, CellsKnowTheirNearestPoint)
NACRE_DEVICE_TEST(Distance, CellsKnowTheNearestOfManyPoints)
NACRE_DEVICE_TEST(Distance, CellsKnowTheFirstOfEqualPoints)
NACRE_DEVICE_TEST(Distance, DistancesHaveASignAndAnEnd)

}  // namespace nacre::test
