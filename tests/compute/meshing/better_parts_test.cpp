// Nacre: tests of what is taken from the second of two meshes.
#include "compute/meshing/better_parts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "compute/meshing/incidence.hpp"
#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/topology.hpp"
#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

using Marks = std::vector<std::uint8_t>;

/// The Delaunay mesh of a unit sphere through points.
struct Sphere {
  SurfaceMesh mesh;
  Marks order;
  std::vector<std::array<std::uint32_t, 2>> touching;

  explicit Sphere(const std::vector<Vec3d>& points) {
    const DelaunayCells cells = delaunay(points);
    mesh = extract_interfaces(points, cells, test::labels_of(cells, [](const Vec3d& c) { return length(c) < 0.9; }));
    order.assign(mesh.points.size(), 2);
  }
  JudgedMesh judged() const { return {mesh, order, touching}; }
};

Vec3d beside(const Vec3d& p, double by) { return normalized(p + by * normalized(cross(p, Vec3d(0.3, 0.5, 0.8)))); }

/// A point stands beside point `north`, and one beside `south`. In the second mesh the one in the north is gone, and
/// the one in the south has come closer still.
struct TwoMeshes {
  static constexpr std::uint32_t north = 40, south = 360, even = 400;
  std::vector<Vec3d> points = test::points_on_sphere(even, 1);
  Sphere first, second;
  std::vector<std::uint32_t> same;
  Marks stays;

  TwoMeshes() : first(with(0.005)), second(without_north()), same(even + 1, none), stays(even + 2, 0) {
    for (std::uint32_t v = 0; v < even; ++v) same[v] = v;
  }
  BetterParts compare(std::vector<std::int64_t> facets = {1000, 1000}) const {
    return better_parts(first.judged(), second.judged(), same, stays, std::move(facets), worst_defects);
  }
  /// The first mesh with the parts that are taken.
  SurfaceMesh mixed(const BetterParts& parts) const {
    SurfaceMesh mesh;
    mesh.points = first.mesh.points;
    mesh.points.push_back(second.mesh.points.back());
    for (std::uint32_t t = 0; t < first.mesh.triangles.size(); ++t)
      if (!std::binary_search(parts.gone.begin(), parts.gone.end(), t))
        mesh.triangles.push_back(first.mesh.triangles[t]), mesh.materials.push_back(first.mesh.materials[t]);
    for (const std::uint32_t t : parts.taken) {
      Triangle c = second.mesh.triangles[t];
      for (int k = 0; k < 3; ++k)
        if (c[k] == even) (k == 0 ? c.a : k == 1 ? c.b : c.c) = even + 2;
      mesh.triangles.push_back(c), mesh.materials.push_back(second.mesh.materials[t]);
    }
    return mesh;
  }

 private:
  std::vector<Vec3d> with(double by) const {
    std::vector<Vec3d> more = points;
    more.push_back(beside(points[north], by)), more.push_back(beside(points[south], by));
    return more;
  }
  std::vector<Vec3d> without_north() const {
    std::vector<Vec3d> more = with(0.001);
    more.erase(more.begin() + even);
    return more;
  }
};

TEST(BetterParts, AreTakenWhereTheyAreBetterAndNowhereElse) {
  const TwoMeshes meshes;
  const BetterParts parts = meshes.compare();
  ASSERT_FALSE(parts.gone.empty());
  ASSERT_FALSE(parts.taken.empty());
  EXPECT_LT(parts.gone.size(), 20u);
  const Vec3d there = meshes.points[TwoMeshes::north];
  for (const std::uint32_t t : parts.gone)
    EXPECT_LT(length(meshes.first.mesh.points[meshes.first.mesh.triangles[t].a] - there), 0.5);
  const TopologyReport topology = check_topology(meshes.mixed(parts), 2);
  EXPECT_TRUE(topology.sound());
  EXPECT_EQ(topology.unused_points, 2) << "the point that is gone, and that of the part that is not taken";
}

TEST(BetterParts, TheSameMeshHasNone) {
  TwoMeshes meshes;
  meshes.second = meshes.first;
  meshes.same.assign(402, 0);
  for (std::uint32_t v = 0; v < 402; ++v) meshes.same[v] = v;
  EXPECT_TRUE(meshes.compare().gone.empty());
  for (Triangle& t : meshes.second.mesh.triangles) t = {t.b, t.c, t.a};  // the same, from other corners on
  EXPECT_TRUE(meshes.compare().gone.empty());
  meshes.same.assign(402, none);
  EXPECT_TRUE(meshes.compare().gone.empty()) << "no better as a whole";
}

TEST(BetterParts, PointsThatStayKeepTheirParts) {
  TwoMeshes meshes;
  meshes.stays[TwoMeshes::south] = 1;
  EXPECT_FALSE(meshes.compare().taken.empty());
  meshes.stays[TwoMeshes::north] = 1;
  EXPECT_TRUE(meshes.compare().taken.empty());
}

TEST(BetterParts, WhatTouchesItselfIsWorseThanAllElse) {
  TwoMeshes meshes;
  meshes.second.touching = {{TwoMeshes::north, TwoMeshes::north}};
  EXPECT_TRUE(meshes.compare().taken.empty());
  meshes.second.touching = {};
  meshes.first.touching = {{TwoMeshes::south, TwoMeshes::south}};
  const BetterParts both = meshes.compare();
  const auto at_last = [&](std::uint32_t t) { return has_corner(meshes.second.mesh.triangles[t], TwoMeshes::even); };
  EXPECT_TRUE(std::any_of(both.taken.begin(), both.taken.end(), at_last)) << "bad triangles rather than that";
}

/// Two fans of facets, whose tips are so far from the circle where they meet.
struct Body {
  SurfaceMesh mesh;
  Marks order;
  Body(int fans, double height) {
    mesh.points = {{0, 0, height}, {0, 0, -height}};
    for (int k = 0; k < fans; ++k) {
      const double angle = 2 * M_PI * k / fans;
      mesh.points.push_back({std::cos(angle), std::sin(angle), 0});
      const auto a = std::uint32_t(2 + k), b = std::uint32_t(2 + (k + 1) % fans);
      mesh.triangles.insert(mesh.triangles.end(), {{0, a, b}, {1, b, a}});
      mesh.materials.insert(mesh.materials.end(), {{0, 1}, {0, 1}});
    }
    order.assign(mesh.points.size(), 2);
  }
};

TEST(BetterParts, OnlySpecksOfMaterialsThatAreElsewhereMayVanish) {
  const SurfaceMesh nothing{Body(3, 1).mesh.points, {}, {}};
  const Marks order(nothing.points.size(), 2);
  const auto compared = [&](const Body& body, std::int64_t elsewhere) {
    const auto facets = std::int64_t(body.mesh.triangles.size());
    const std::vector<std::uint32_t> same(nothing.points.size(), none);
    return better_parts({body.mesh, body.order, {}}, {nothing, order, {}}, same, Marks(body.order.size(), 0),
                        {facets + 100, facets + elsewhere}, worst_defects);
  };
  const auto gone = [&](const Body& body, std::int64_t elsewhere) { return compared(body, elsewhere).gone.size(); };
  EXPECT_EQ(gone(Body(4, 20), 4), 8u) << "a speck of needles";
  EXPECT_EQ(gone(Body(4, 20), 0), 0u) << "all that there is of the material";
  EXPECT_EQ(gone(Body(10, 20), 4), 20u);
  EXPECT_EQ(gone(Body(11, 20), 4), 0u) << "too large";
  EXPECT_EQ(gone(Body(4, 1), 4), 0u) << "good triangles";
  EXPECT_EQ(compared(Body(4, 20), 4).specks, 1);
  EXPECT_EQ(compared(Body(11, 20), 4).specks, 0);
}

TEST(BetterParts, MaterialsDoNotAppear) {
  const Body needles(4, 20);
  Body good(4, 1);
  const auto taken = [&] {
    const std::vector<std::uint32_t> same(good.order.size(), none);
    std::vector<std::uint32_t> own = same;
    own[2] = 2;  // one part
    return better_parts({needles.mesh, needles.order, {}}, {good.mesh, good.order, {}}, own,
                        Marks(needles.order.size(), 0), {100, 100, 100}, worst_defects)
        .taken.size();
  };
  EXPECT_EQ(taken(), 8u);
  good.mesh.materials[0] = {0, 2};
  EXPECT_EQ(taken(), 0u);
}

}  // namespace
}  // namespace nacre
