// Nacre: meshes of second order on bodies with known answers: nodes, volumes, and elements that are not inverted.
#include "compute/meshing/second_order.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "tests/compute/icosphere.hpp"

namespace nacre::test {
namespace {

constexpr double radius = 3;

/// The nearest point of the sphere.
std::vector<Vec3d> onto_sphere(std::span<const Vec3d> points, std::span<const Junction> junctions) {
  std::vector<Vec3d> on;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(junctions[i] == Junction(0, 1));
    on.push_back(points[i] * (radius / length(points[i])));
  }
  return on;
}

/// The ball as tetrahedra from its centre to the triangles.
TetrahedralMesh cone_of(const SurfaceMesh& surface) {
  TetrahedralMesh filled;
  filled.points = surface.points;
  filled.points.push_back({});
  const auto centre = std::uint32_t(surface.points.size());
  for (const Triangle& t : surface.triangles) filled.cells.push_back({centre, t.a, t.b, t.c});
  filled.material.assign(filled.cells.size(), 1);
  return filled;
}

std::array<Vec3d, 10> nodes_of(const TetrahedralMesh& mesh, const SecondOrder& second, std::size_t i) {
  std::array<Vec3d, 10> node;
  for (std::size_t k = 0; k < 4; ++k) node[k] = mesh.points[mesh.cells[i][k]];
  for (std::size_t k = 0; k < 6; ++k) node[4 + k] = second.nodes[second.cells[i][k]];
  return node;
}

/// The determinant of the Jacobian at barycentric coordinates, by shape functions, over that of the straight one.
double jacobian_at(const std::array<Vec3d, 10>& node, const std::array<double, 4>& at) {
  constexpr int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  std::array<Vec3d, 4> along;
  for (std::size_t k = 0; k < 4; ++k) along[k] = (4 * at[k] - 1) * node[k];
  for (std::size_t e = 0; e < 6; ++e) {
    const auto i = std::size_t(edge[e][0]), j = std::size_t(edge[e][1]);
    along[i] += 4 * at[j] * node[4 + e];
    along[j] += 4 * at[i] * node[4 + e];
  }
  const auto volume = [](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    return dot(b - a, cross(c - a, d - a));
  };
  return volume(along[0], along[1], along[2], along[3]) / volume(node[0], node[1], node[2], node[3]);
}

/// At the corners, the middles of edges, and the points of Gauss rules of degree 2 and 3.
double least_sampled(const std::array<Vec3d, 10>& node) {
  std::vector<std::array<double, 4>> places{{0.25, 0.25, 0.25, 0.25}};
  for (std::size_t k = 0; k < 4; ++k)
    for (const double inner : {0.0, 0.1381966011250105, 1.0 / 6}) {
      places.push_back({inner, inner, inner, inner});
      places.back()[k] = 1 - 3 * inner;
    }
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      places.push_back({0, 0, 0, 0});
      places.back()[i] = places.back()[j] = 0.5;
    }
  double least = std::numeric_limits<double>::max();
  for (const auto& at : places) least = std::min(least, jacobian_at(node, at));
  return least;
}

const std::array<Vec3d, 10> straight{
    {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};

TEST(SecondOrder, AStraightElementHasTheJacobianOne) {
  EXPECT_NEAR(scaled_jacobian(straight), 1, 1e-12);
  EXPECT_NEAR(scaled_jacobian(
                  std::array<Vec3d, 6>{straight[0], straight[1], straight[2], straight[4], straight[5], straight[6]}),
              1, 1e-12);
}

TEST(SecondOrder, TheBoundIsBelowEveryValue) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> step(-0.4, 0.4), share(0, 1);
  int positive = 0;
  for (int k = 0; k < 300; ++k) {
    std::array<Vec3d, 10> node = straight;
    for (std::size_t n = 4; n < 10; ++n) node[n] += Vec3d(step(random), step(random), step(random));
    const double bound = scaled_jacobian(node);
    EXPECT_LE(bound, least_sampled(node) + 1e-12);
    for (int s = 0; s < 50; ++s) {
      std::array<double, 4> at{share(random), share(random), share(random), share(random)};
      const double sum = at[0] + at[1] + at[2] + at[3];
      for (double& x : at) x /= sum;
      EXPECT_LE(bound, jacobian_at(node, at) + 1e-12);
    }
    positive += bound > 0;
  }
  EXPECT_GT(positive, 20) << "it is no better than nothing";
}

TEST(SecondOrder, ANodePastItsCornerInvertsTheElement) {
  std::array<Vec3d, 10> node = straight;
  node[4] = {0.4, 0, 0};  // beyond a quarter of the edge the map folds at the corner
  EXPECT_LT(scaled_jacobian(node), 0);
  node[4] = {0.6, 0, 0};
  EXPECT_GT(scaled_jacobian(node), 0);
}

TEST(SecondOrder, EveryEdgeHasOneNodeInTheOrderOfVtk) {
  const SurfaceMesh surface = icosphere(1, radius);
  const TetrahedralMesh filled = cone_of(surface);
  const SecondOrder second = second_order(surface, &filled, onto_sphere);
  const std::size_t outer = 3 * surface.triangles.size() / 2;
  EXPECT_EQ(second.nodes.size(), outer + surface.points.size()) << "each corner has an edge from the centre";
  constexpr int edge[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  for (std::size_t i = 0; i < filled.cells.size(); ++i)
    for (std::size_t e = 0; e < 6; ++e) {
      const std::uint32_t a = filled.cells[i][std::size_t(edge[e][0])], b = filled.cells[i][std::size_t(edge[e][1])];
      EXPECT_EQ(second.edges[second.cells[i][e]], (std::array{std::min(a, b), std::max(a, b)}));
    }
  for (std::size_t n = 0; n < second.nodes.size(); ++n) {
    const Vec3d middle = (filled.points[second.edges[n][0]] + filled.points[second.edges[n][1]]) * 0.5;
    if (n < outer)
      EXPECT_NEAR(length(second.nodes[n]), radius, 1e-12);
    else
      EXPECT_EQ(second.nodes[n], middle) << "an inner edge is straight";
  }
  EXPECT_EQ(second.on_surfaces, std::int64_t(outer));
  EXPECT_EQ(second.pulled_back, 0);
  EXPECT_EQ(second.curved_elements, std::int64_t(filled.cells.size()));
}

/// A flat triangle is off by the square of its size, one of second order by the fourth power.
TEST(SecondOrder, TheVolumeOfABallConvergesFaster) {
  const double exact = 4 * M_PI / 3 * radius * radius * radius;
  double flat[2], curved[2];
  for (int level = 2; level < 4; ++level) {
    const SurfaceMesh surface = icosphere(level, radius);
    const SecondOrder second = second_order(surface, nullptr, onto_sphere);
    SecondOrder middles = second;
    for (std::size_t n = 0; n < middles.nodes.size(); ++n)
      middles.nodes[n] = (surface.points[second.edges[n][0]] + surface.points[second.edges[n][1]]) * 0.5;
    flat[level - 2] = 1 - enclosed_volumes(surface, middles, 2)[1] / exact;
    curved[level - 2] = std::fabs(1 - enclosed_volumes(surface, second, 2)[1] / exact);
  }
  EXPECT_GT(flat[1], 1e-3);
  EXPECT_LT(curved[1], 0.01 * flat[1]);
  EXPECT_NEAR(flat[0] / flat[1], 4, 0.4);
  EXPECT_GT(curved[0] / curved[1], 12);
}

TEST(SecondOrder, CellsHoldTheVolumeThatTheirTrianglesEnclose) {
  const SurfaceMesh surface = icosphere(1, radius);
  const TetrahedralMesh filled = cone_of(surface);
  const SecondOrder second = second_order(surface, &filled, onto_sphere);
  double sum = 0;
  for (std::size_t i = 0; i < filled.cells.size(); ++i) {
    // The mean of the determinant over the cell, by a rule of degree 3.
    const std::array<Vec3d, 10> node = nodes_of(filled, second, i);
    const double straight_volume = dot(node[1] - node[0], cross(node[2] - node[0], node[3] - node[0])) / 6;
    double mean = -0.8 * jacobian_at(node, {0.25, 0.25, 0.25, 0.25});
    for (std::size_t k = 0; k < 4; ++k) {
      std::array<double, 4> at{1.0 / 6, 1.0 / 6, 1.0 / 6, 1.0 / 6};
      at[k] = 0.5;
      mean += 0.45 * jacobian_at(node, at);
    }
    sum += mean * straight_volume;
  }
  EXPECT_NEAR(enclosed_volumes(surface, second, 2)[1], sum, 1e-9 * sum);
}

/// Under each triangle a cell so flat that the sphere's bulge would turn it inside out.
TEST(SecondOrder, NodesGoBackWhereAnElementWouldBeInverted) {
  const SurfaceMesh surface = icosphere(0, radius);
  TetrahedralMesh filled;
  filled.points = surface.points;
  for (const Triangle& t : surface.triangles) {
    // Outside of the sphere: it is the outer side that has no room.
    const Vec3d middle = (surface.points[t.a] + surface.points[t.b] + surface.points[t.c]) / 3.0;
    filled.cells.push_back({t.a, t.b, t.c, std::uint32_t(filled.points.size())});
    filled.points.push_back(middle * 1.08);
    filled.material.push_back(1);
  }
  const SecondOrder second = second_order(surface, &filled, onto_sphere);
  EXPECT_GT(second.pulled_back, 0);
  EXPECT_LT(second.straightened, second.on_surfaces) << "as little as is enough";
  EXPECT_GE(second.least_jacobian, least_scaled_jacobian);
  for (std::size_t i = 0; i < filled.cells.size(); ++i) {
    const std::array<Vec3d, 10> node = nodes_of(filled, second, i);
    EXPECT_GE(scaled_jacobian(node), least_scaled_jacobian - 1e-12);
    EXPECT_GT(least_sampled(node), 0);
  }
  for (std::size_t n = 0; n < std::size_t(second.on_surfaces); ++n) {
    const double r = length(second.nodes[n]);
    const Vec3d middle = (surface.points[second.edges[n][0]] + surface.points[second.edges[n][1]]) * 0.5;
    EXPECT_LE(r, radius + 1e-12);
    EXPECT_GE(r, length(middle) - 1e-12) << "between the edge and the sphere";
  }
}

TEST(SecondOrder, NodesWithoutAnInterfaceNearbyStayInTheMiddle) {
  const SurfaceMesh surface = icosphere(1, radius);
  const auto nowhere = [](std::span<const Vec3d> points, std::span<const Junction>) {
    std::vector<Vec3d> on(points.begin(), points.end());
    for (std::size_t i = 0; i < on.size(); ++i) on[i] = i % 2 ? on[i] * 1.5 : Vec3d(NAN);
    return on;
  };
  const SecondOrder second = second_order(surface, nullptr, nowhere);
  EXPECT_EQ(second.left_straight, std::int64_t(second.nodes.size()));
  EXPECT_EQ(second.curved_elements, 0);
  EXPECT_EQ(second.least_jacobian, 1);
  for (std::size_t n = 0; n < second.nodes.size(); ++n)
    EXPECT_EQ(second.nodes[n], (surface.points[second.edges[n][0]] + surface.points[second.edges[n][1]]) * 0.5);
}

/// Three pages of a book: their common edge is on the curve where three materials meet.
TEST(SecondOrder, NodesOfJunctionCurvesAreAskedForOnTheCurve) {
  SurfaceMesh surface;
  surface.points = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
  surface.triangles = {{0, 2, 1}, {0, 3, 1}, {0, 4, 1}};
  surface.materials = {{1, 2}, {2, 7}, {1, 7}};
  std::map<std::array<double, 3>, Junction> asked;
  const auto onto = [&](std::span<const Vec3d> points, std::span<const Junction> junctions) {
    for (std::size_t i = 0; i < points.size(); ++i) asked[{points[i].x, points[i].y, points[i].z}] = junctions[i];
    return std::vector<Vec3d>(points.begin(), points.end());
  };
  const SecondOrder second = second_order(surface, nullptr, onto);
  EXPECT_TRUE((asked[{0, 0, 0.5}] == Junction(1, 2, 7)));
  EXPECT_TRUE((asked[{0.5, 0, 0}] == Junction(1, 2)));
  EXPECT_TRUE((asked[{-0.5, 0.5, 0.5}] == Junction(2, 7)));
  EXPECT_EQ(second.on_curves, 1);
  EXPECT_EQ(second.on_surfaces, 6);
}

}  // namespace
}  // namespace nacre::test
