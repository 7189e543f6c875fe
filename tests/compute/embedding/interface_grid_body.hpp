// Nacre: test bodies for the embedding of interfaces and junctions.
#pragma once

#include "tests/compute/embedding/embedding_cases.hpp"

namespace nacre::test {

template <class Backend>
void JunctionsAreFoundAndNamed(Executor<Backend>& exec) {
  const Embedding e = embedding_of(exec, sectors());
  std::vector<Junction> expected;
  for (std::uint32_t a = 0; a < 4; ++a)
    for (std::uint32_t b = a + 1; b < 4; ++b) {
      expected.emplace_back(a, b);
      for (std::uint32_t c = b + 1; c < 4; ++c) expected.emplace_back(a, b, c);
    }
  EXPECT_EQ(e.grid.junctions.size(), expected.size());
  for (const Junction& j : expected) EXPECT_NE(e.number_of(j), none) << j.packed;
  ASSERT_EQ(e.grid.points.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(e.grid.point_junction[k], Junction(0, 1, 2, 3));
    const Float4 p = e.grid.points[k];
    const Vec3f r = Vec3f(p.x, p.y, p.z) - in_fields(sector_centre);
    EXPECT_NEAR(std::hypot(r.x, r.y), 0, 0.02);
    EXPECT_NEAR(std::fabs(r.z), sector_radius, 0.02);
    EXPECT_GT(p.w, 0);
  }
  EXPECT_GT(std::fabs(e.grid.points[0].z - e.grid.points[1].z), 10);
}

/// Points near the plane between sectors 1 and 2, `along` beyond the axis on its side of it.
inline Vec3d near_plane(double along, double up, double off) {
  const Vec3d n = normalized(sector_direction(0) - sector_direction(1)), t = sector_direction(0) + sector_direction(1);
  return sector_centre + normalized(t) * along + Vec3d(0, 0, up) + n * off;
}

template <class Backend>
void PlanesAndTheirRims(Executor<Backend>& exec) {
  const Embedding e = embedding_of(exec, sectors());
  const Vec3f n(normalized(sector_direction(0) - sector_direction(1)));
  std::vector<Vec3f> inside, beyond;
  for (int k = 0; k < 400; ++k) {
    const double up = 8 * uniform_random(1, k, 0) - 4, off = 0.8 * uniform_random(1, k, 1) - 0.4;
    inside.push_back(in_fields(near_plane(1 + 4 * uniform_random(1, k, 2), up, off)));
    beyond.push_back(in_fields(near_plane(-0.2 - 0.5 * uniform_random(1, k, 3), up, 0.3 * off)));
  }
  for (const EmbeddedPoint& at : embed_all(exec, e, Junction(1, 2), inside)) {
    ASSERT_GT(at.h, 0);
    EXPECT_NEAR(dot(at.p - in_fields(sector_centre), n), 0, 0.01);
    EXPECT_LT(degrees_between(at.direction, n), 0.5);
    EXPECT_GT(at.margin, 0);
  }
  std::size_t found = 0;
  for (const EmbeddedPoint& at : embed_all(exec, e, Junction(1, 2), beyond))
    if (at.h > 0) {
      ++found;
      EXPECT_LT(at.margin, 0);
    }
  EXPECT_GT(found, 200u);  // there are cells beyond the rim, so that it can be told where it is
}

template <class Backend>
void CurvesAndTheirTangents(Executor<Backend>& exec) {
  const Embedding e = embedding_of(exec, sectors());
  std::vector<Vec3f> points;
  for (int k = 0; k < 300; ++k)
    points.push_back(in_fields(sector_centre + Vec3d(uniform_random(2, k, 0) - 0.5, uniform_random(2, k, 1) - 0.5,
                                                     11 * uniform_random(2, k, 2) - 5.5)));
  const std::vector<EmbeddedPoint> on = embed_all(exec, e, Junction(1, 2, 3), points);
  for (std::size_t k = 0; k < on.size(); ++k) {
    ASSERT_GT(on[k].h, 0);
    const Vec3f r = on[k].p - in_fields(sector_centre);
    EXPECT_LT(std::hypot(r.x, r.y), 0.01);
    EXPECT_NEAR(on[k].p.z, points[k].z, 0.02);
    EXPECT_LT(degrees_between(on[k].direction, {0, 0, 1}), 0.5);
    EXPECT_GT(on[k].margin, 0);
  }
}

/// Closest points of a sphere, up to a cell away from it.
template <class Backend>
void expect_sphere(Executor<Backend>& exec, double cells_per_voxel, double tolerance) {
  const Vec3d c(13.2, 12.7, 13.1);
  const double radius = 8.3;
  const std::size_t mark = exec.arena().mark();
  const Embedding e = embedding_of(exec, scalar_volume({27, 26, 27}, ball(c, radius)), {}, cells_per_voxel);
  std::vector<Vec3f> points;
  int k = 0;
  for (const Vec3d& d : even_directions(3000))
    points.push_back(in_fields(c + d * (radius + (uniform_random(3, ++k, 0) - 0.5) / cells_per_voxel)));
  const std::vector<EmbeddedPoint> on = embed_all(exec, e, Junction(0, 1), points);
  for (std::size_t i = 0; i < on.size(); ++i) {
    ASSERT_GT(on[i].h, 0);
    const Vec3f n = normalized(points[i] - in_fields(c));
    EXPECT_LT(length(on[i].p - in_fields(c) - n * float(radius)), tolerance);
    EXPECT_LT(degrees_between(on[i].direction, n), 2);
    EXPECT_GT(dot(on[i].direction, n), 0);
    EXPECT_GT(on[i].margin, 0);
    EXPECT_NEAR(on[i].h, 1, 1e-3);
  }
  EXPECT_LT(e.grid.cells(), 30 * 4 * M_PI * radius * radius * cells_per_voxel * cells_per_voxel);
  exec.arena().rewind(mark);
}

template <class Backend>
void SpheresAtSeveralResolutions(Executor<Backend>& exec) {
  expect_sphere(exec, 2, 0.03);
  expect_sphere(exec, 1, 0.04);
  expect_sphere(exec, 4, 0.03);
}

/// A cylinder along z in so many equal wedges: they and the outside are the materials.
inline MeshVolume wedges(int count) {
  return label_volume({30, 30, 30}, count + 1, [count](const Vec3d& p) {
    const Vec3d r = p - Vec3d(14.4, 14.6, 14.5);
    if (std::hypot(r.x, r.y) > 10 || std::fabs(r.z) > 9) return 0;
    return 1 + std::min(count - 1, int((std::atan2(r.y, r.x) / (2 * M_PI) + 0.5) * count));
  });
}

/// More than eight materials lie around a sample near the wedges' edges: that is not passed over in silence. All of the
/// wedges' walls are found all the same.
template <class Backend>
void WhereTooManyMaterialsMeetIsCounted(Executor<Backend>& exec) {
  EXPECT_EQ(embedding_of(exec, sectors()).grid.crowded_cells, 0);
  EXPECT_EQ(embedding_of(exec, wedges(4)).grid.crowded_cells, 0);
  const Embedding e = embedding_of(exec, wedges(12));
  EXPECT_GE(e.grid.crowded_cells, 9) << "one for two voxels of the axis";
  EXPECT_LE(e.grid.crowded_cells, 10 * 5 * 5) << "near the axis only";
  for (std::uint32_t k = 1; k <= 12; ++k) {
    EXPECT_NE(e.number_of(Junction(std::min(k, k % 12 + 1), std::max(k, k % 12 + 1))), none) << k;
    EXPECT_NE(e.number_of(Junction(0, k)), none) << k;
  }
}

/// A box whose function falls from one plateau to another between two voxels, as functions do at the faces of a volume:
/// the shares of the cells beside it add up to its area, where the cells' centres are the voxels', too.
template <class Backend>
void PlateausThatEndBetweenTwoVoxelsHaveTheirArea(Executor<Backend>& exec) {
  const auto inside = [](const Vec3d& p) {
    return std::min({p.x, p.y, p.z}) > 4.5 && std::max({p.x, p.y, p.z}) < 14.5 ? 5.0 : -5.0;
  };
  const MeshVolume box = indicator_volume({20, 20, 20}, {[&](const Vec3d& p) { return -inside(p); }, inside});
  for (const double cells_per_voxel : {1, 2}) {
    const Embedding e = embedding_of(exec, box, {}, cells_per_voxel);
    double area = 0;
    for (const EmbeddedCell& cell : e.grid.cell.download()) {
      const Float4 o = store(load(cell));
      if (o.w >= 0) area += std::max(0.0f, 1 - length(Vec3f(o.x, o.y, o.z)));
    }
    EXPECT_NEAR(area / (cells_per_voxel * cells_per_voxel), 600, 45) << cells_per_voxel;
  }
}

/// With one cell per voxel, a coarse cell has room for both ends of a body's axis.
template <class Backend>
void TwoPointsOfOneCoarseCellAreTold(Executor<Backend>& exec) {
  const Vec3d centre(14.3, 13.8, 13.4);
  const double radius = 1.7;
  for (const double end : {-radius, radius})
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_EQ(int(in_fields(centre + Vec3d(0, 0, end))[axis] / 4), 5) << "the test is not what it says";
  const Embedding e = embedding_of(exec, sectors(centre, radius), {}, 1);
  ASSERT_EQ(e.grid.points.size(), 2u);
  EXPECT_NEAR(std::fabs(e.grid.points[0].z - e.grid.points[1].z), 2 * radius, 0.8);
}

NACRE_DEVICE_TEST(InterfaceGrid, JunctionsAreFoundAndNamed)
NACRE_DEVICE_TEST(InterfaceGrid, TwoPointsOfOneCoarseCellAreTold)
NACRE_DEVICE_TEST(InterfaceGrid, PlateausThatEndBetweenTwoVoxelsHaveTheirArea)
NACRE_DEVICE_TEST(InterfaceGrid, WhereTooManyMaterialsMeetIsCounted)
NACRE_DEVICE_TEST(InterfaceGrid, PlanesAndTheirRims)
NACRE_DEVICE_TEST(InterfaceGrid, CurvesAndTheirTangents)
NACRE_DEVICE_TEST(InterfaceGrid, SpheresAtSeveralResolutions)

}  // namespace nacre::test
