// Nacre: tests of what is to be changed about particles so that triangles get better.
#include "compute/meshing/defects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/quality.hpp"
#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

/// A ball of radius 1 as a mesh, all of order 2 and one size.
struct Ball {
  std::vector<Vec3d> points;
  SurfaceMesh mesh;
  std::vector<std::uint8_t> order;
  std::vector<float> size;

  explicit Ball(std::vector<Vec3d> p) : points(std::move(p)) {
    const DelaunayCells cells = delaunay(points);
    mesh = extract_interfaces(points, cells, test::labels_of(cells, [](const Vec3d& c) { return length(c) < 0.9; }));
    EXPECT_EQ(mesh.points.size(), points.size());
    order.assign(points.size(), 2);
    size.assign(points.size(), float(std::sqrt(4 * M_PI / 0.866 / double(points.size()))));
  }
  MeshDefects defects(const DefectRule& rule = {},
                      const std::vector<std::array<std::uint32_t, 2>>& touching = {}) const {
    return find_defects(mesh, order, size, touching, rule);
  }
  double worst() const { return surface_quality(mesh).all.radius_ratio_min; }
};

using Points = std::vector<std::uint32_t>;

/// `count` points, and one more at a hundredth of a size from number 7.
std::vector<Vec3d> with_a_twin(int count) {
  std::vector<Vec3d> points = test::points_on_sphere(count, 1);
  points.push_back(normalized(points[7] + Vec3d(0.02, 0.03, 0.01) / std::sqrt(double(count))));
  return points;
}

TEST(Defects, GoodMeshesHaveNone) {
  const MeshDefects d = Ball(test::points_on_sphere(400, 1)).defects();
  EXPECT_EQ(d.bad_triangles, 0);
  EXPECT_TRUE(d.remove.empty() && d.insert.empty());
}

TEST(Defects, OneOfTwoThatAreTooCloseGoes) {
  Ball ball(with_a_twin(400));
  EXPECT_LT(ball.worst(), 0.1);
  EXPECT_EQ(ball.defects().remove, Points{400}) << "the later one";
  EXPECT_GE(ball.defects().bad_triangles, 2);
  ball.order[7] = 1;
  EXPECT_EQ(ball.defects().remove, Points{400}) << "the one on the surface";
  ball.order[7] = 2, ball.order[400] = 1;
  EXPECT_EQ(ball.defects().remove, Points{7});
  ball.order[7] = 1, ball.order[400] = 0;
  EXPECT_EQ(ball.defects().remove, Points{7}) << "the one on the curve";
  ball.points.pop_back();
  EXPECT_GT(Ball(ball.points).worst(), 0.4);
}

TEST(Defects, OneThatLiesFlatBetweenItsNeighboursGoes) {
  Ball ball(test::points_on_sphere(400, 1));
  // Pushed to the middle of the edge opposite of it: an angle of nearly 180 degrees, but no short edge.
  const Triangle t = ball.mesh.triangles[100];
  const Vec3d a = ball.mesh.points[t.a], b = ball.mesh.points[t.b], middle = (a + b) / 2.0;
  ball.mesh.points[t.c] = middle + 0.05 * (ball.mesh.points[t.c] - middle);
  for (float& s : ball.size) s = float(0.6 * length(b - a));
  EXPECT_LT(ball.worst(), 0.1);
  const Points remove = ball.defects({0, 0.2, 0.2}).remove;
  EXPECT_EQ(std::count(remove.begin(), remove.end(), t.c), 1);
  ball.order[t.c] = 1;
  EXPECT_GT(ball.defects({0, 0.2, 0.2}).bad_triangles, 0);
  const Points others = ball.defects({0, 0.2, 0.2}).remove;
  EXPECT_EQ(std::count(others.begin(), others.end(), t.c), 0) << "curves keep theirs";
}

TEST(Defects, TheLastResortAtARimIsToTakeANeighbour) {
  int told_apart = 0;
  for (std::size_t k = 0; k < 20; ++k) {
    Ball ball(test::points_on_sphere(400, 1));
    const Triangle t = ball.mesh.triangles[100 + k];
    const Vec3d a = ball.mesh.points[t.a], b = ball.mesh.points[t.b], middle = (a + b) / 2.0;
    Vec3d& top = ball.mesh.points[t.c];
    top = middle + 0.1 * (top - middle);
    for (float& s : ball.size) s = float(0.6 * length(b - a));
    ball.order[t.c] = 1;
    const std::uint32_t nearer = length(a - top) < length(b - top) ? t.a : t.b;
    const auto goes = [&](std::uint32_t point, bool fills) {
      const Points gone = ball.defects({0, 0.2, 0.2, fills}).remove;
      return std::count(gone.begin(), gone.end(), point) > 0;
    };
    EXPECT_FALSE(goes(t.c, false));
    if (goes(nearer, true)) continue;  // another triangle wants to be rid of it
    ++told_apart;
    EXPECT_TRUE(goes(nearer, false)) << k;
    ball.order[t.a] = ball.order[t.b] = 1;
    EXPECT_FALSE(goes(nearer, false));
    EXPECT_TRUE(goes(t.c, false)) << "where all are on curves, the one that lies flat";
    ball.order[t.c] = 0;
    EXPECT_FALSE(goes(t.c, false)) << "points stay";
  }
  EXPECT_GT(told_apart, 3);
}

TEST(Defects, BeforeAFlatCornerOnARimIsRoomForOneMore) {
  // A flat patch: a rim from left to right, and behind its middle an edge across, twice as long as all others.
  Ball ball(test::points_on_sphere(400, 1));
  ball.mesh.points = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {-0.9, 0.15, 0}, {1, 0.15, 0}, {0, 1.6, 0}};
  ball.mesh.triangles = {{0, 1, 3}, {1, 4, 3}, {1, 2, 4}, {3, 4, 5}};
  ball.mesh.materials.assign(4, {1, 2});
  ball.order = {1, 1, 1, 2, 2, 2};
  ball.size.assign(6, 1);
  const MeshDefects d = ball.defects({0, 0.3, 0.3});
  ASSERT_EQ(d.insert.size(), 1u);
  EXPECT_LT(length(d.insert[0].position - Vec3d(0, 0.8, 0)), 0.3);
  EXPECT_EQ(d.insert[0].materials, (std::array<std::uint16_t, 2>{1, 2}));
  EXPECT_EQ(std::count(d.remove.begin(), d.remove.end(), 1u), 0);
  ball.mesh.points[5].y = 0.9;
  EXPECT_TRUE(ball.defects({0, 0.3, 0.3}).insert.empty()) << "somebody is there";
}

/// A ball, one half of it against another material: the rim between is a zigzag of edges.
TEST(Defects, ASurfacesPointInACurveGoes) {
  Ball ball(test::points_on_sphere(800, 1));
  std::vector<std::uint8_t> sides(ball.mesh.points.size(), 0);
  for (std::size_t t = 0; t < ball.mesh.triangles.size(); ++t) {
    const Triangle& c = ball.mesh.triangles[t];
    const bool right = ball.mesh.points[c.a].x + ball.mesh.points[c.b].x + ball.mesh.points[c.c].x > 0;
    ball.mesh.materials[t] = right ? std::array<std::uint16_t, 2>{1, 2} : std::array<std::uint16_t, 2>{0, 1};
    for (int k = 0; k < 3; ++k) sides[c[k]] |= right ? 1 : 2;
  }
  for (std::size_t v = 0; v < sides.size(); ++v) ball.order[v] = sides[v] == 3 ? 1 : 2;
  EXPECT_TRUE(ball.defects(worst_defects).remove.empty());
  int intruders = 0;
  for (std::uint32_t v = 0; v < sides.size(); ++v) {
    if (sides[v] != 3) continue;
    ball.order[v] = 2;
    const Points gone = ball.defects(worst_defects).remove;
    EXPECT_TRUE(gone.empty() || gone == Points{v});
    intruders += gone == Points{v};
    ball.order[v] = 1;
  }
  EXPECT_GT(intruders, 3) << "where the rim is straight";
  EXPECT_LT(intruders, std::count(sides.begin(), sides.end(), 3)) << "not where it has a corner";
}

TEST(Defects, SmallBodiesKeepAllOfTheirs) {
  for (const int count : {11, 12}) {
    Ball ball(with_a_twin(count));
    EXPECT_EQ(ball.defects().remove, Points{std::uint32_t(count)}) << "of two that all but coincide one is enough";
    const float apart = float(length(ball.points[7] - ball.points.back()));
    for (float& s : ball.size) s = apart / 0.3f;
    const Points remove = ball.defects({0, 0.2, 0.2}).remove;
    EXPECT_EQ(std::count(remove.begin(), remove.end(), std::uint32_t(count)), count == 12 ? 1 : 0) << "one of 13";
  }
  for (const int count : {24, 25}) {
    Ball ball(test::points_on_sphere(count, 1));
    const Triangle t = ball.mesh.triangles[10];
    const Vec3d middle = (ball.mesh.points[t.a] + ball.mesh.points[t.b]) / 2.0;
    ball.mesh.points[t.c] = middle + 0.05 * (ball.mesh.points[t.c] - middle);  // flat between the others
    for (float& s : ball.size) s *= 0.5f;
    const MeshDefects d = ball.defects({0, 0.1, 0.1});
    EXPECT_EQ(d.remove, count == 24 ? Points{} : Points{t.c});
    ASSERT_EQ(d.insert.size(), count == 24 ? 1u : 0u);
    for (const auto& p : d.insert) EXPECT_LT(length(p.position - middle), 1e-12) << "a new point instead";
  }
}

/// Three points of curves: the flat one is near the middle of a long side, along which another curve runs.
TEST(Defects, ALongSideAlongACurveIsSplit) {
  Ball ball(test::points_on_sphere(400, 1));
  ball.mesh.points = {{-1, 0, 0}, {0, 0.1, 0}, {1, 0, 0}, {0, -1, 0}};
  ball.mesh.triangles = {{0, 2, 1}, {2, 0, 3}};
  ball.mesh.materials = {{1, 2}, {0, 1}};
  ball.order = {1, 1, 1, 2};
  ball.size.assign(4, 1);
  DefectRule rule = worst_defects;
  EXPECT_TRUE(ball.defects(rule).insert.empty());
  rule.splits = true;
  const MeshDefects d = ball.defects(rule);
  ASSERT_EQ(d.insert.size(), 1u);
  EXPECT_LT(length(d.insert[0].position), 1e-12);
  EXPECT_EQ(d.insert[0].materials, (std::array<std::uint16_t, 2>{1, 2}));
  EXPECT_EQ(d.insert[0].third, 0);
  EXPECT_TRUE(d.remove.empty());
  ball.mesh.points[3] = {0, -0.1, 0};
  ball.order[3] = 1;
  EXPECT_EQ(ball.defects(rule).insert.size(), 1u) << "flat triangles on both sides share the new point";
  ball.mesh.points[3] = {0, -1, 0};
  ball.order[3] = 2;
  ball.order[2] = 0;
  EXPECT_TRUE(ball.defects(rule).insert.empty()) << "the curve ends there";
  ball.order[2] = 1;
  ball.size.assign(4, 2);
  EXPECT_TRUE(ball.defects(rule).insert.empty()) << "it is not long";
  ball.size.assign(4, 1);
  ball.mesh.materials[1] = {1, 2};
  EXPECT_TRUE(ball.defects(rule).insert.empty()) << "no curve runs there";
}

/// That a small body needs its points says nothing about one that all but coincides with another.
TEST(Defects, AnIntruderOnASmallBodyGoesWhereItIsOneTooMany) {
  Ball ball(test::points_on_sphere(400, 1));
  const double near = 0.01;
  ball.mesh.points = {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0.5 * near, near, 0}};
  ball.mesh.triangles = {{0, 1, 5}, {1, 2, 5}, {0, 5, 3}, {5, 2, 3}, {1, 0, 4}, {2, 1, 4}};
  ball.mesh.materials = {{0, 1}, {0, 1}, {0, 1}, {0, 1}, {1, 2}, {1, 2}};
  ball.order = {1, 2, 1, 2, 2, 1};
  ball.size.assign(6, 1);
  EXPECT_EQ(ball.defects(worst_defects).remove, Points{1});
  ball.mesh.points[5] = {0, 0.5, 0};
  EXPECT_TRUE(ball.defects(worst_defects).remove.empty()) << "an intruder, but the body has no other";
}

TEST(Defects, FurtherRoundsCareForTheWorstOnly) {
  // A thin triangle, but not the worst: two points at 0.35 of a size.
  std::vector<Vec3d> points = test::points_on_sphere(400, 1);
  points.push_back(normalized(points[7] + Vec3d(0.03, 0.045, 0.0)));
  Ball ball(points);
  ASSERT_GT(ball.worst(), 0.2);
  ASSERT_LT(ball.worst(), 0.6);
  EXPECT_EQ(ball.defects({25, ball.worst() + 0.01, 0}).remove, Points{400});
  EXPECT_TRUE(ball.defects({0, ball.worst() - 0.01, 1}).remove.empty());
  for (std::uint8_t& o : ball.order) o = 1;  // all at a junction: the other bound
  ball.order[400] = 2;
  EXPECT_EQ(ball.defects({0, 0, ball.worst() + 0.01}).remove, Points{400});
  EXPECT_TRUE(ball.defects({0, 1, ball.worst() - 0.01}).remove.empty());
  EXPECT_LT(worst_defects.near, worst_defects.ratio);
}

TEST(Defects, PlacesThatTouchGetNewPointsUnlessTheyAreCrowded) {
  Ball ball(test::points_on_sphere(400, 1));
  const Triangle t = ball.mesh.triangles[50];
  const MeshDefects edge = ball.defects({}, {{std::min(t.a, t.b), std::max(t.a, t.b)}});
  ASSERT_EQ(edge.insert.size(), 2u) << "one in each facet";
  for (const auto& p : edge.insert) {
    EXPECT_EQ(p.materials, (std::array<std::uint16_t, 2>{0, 1}));
    EXPECT_NEAR(length(p.position), 1, 0.01);
    EXPECT_LT(length(p.position - ball.points[t.a]), 2 * ball.size[0]);
  }
  const std::size_t facets =
      std::size_t(std::count_if(ball.mesh.triangles.begin(), ball.mesh.triangles.end(),
                                [&](const Triangle& u) { return u.a == t.a || u.b == t.a || u.c == t.a; }));
  EXPECT_EQ(ball.defects({}, {{t.a, t.a}}).insert.size(), facets) << "a vertex";
  for (float& s : ball.size) s *= 4;
  EXPECT_TRUE(ball.defects({0, 0, 0}, {{t.a, t.a}}).insert.empty());
  ball.mesh.materials[50] = {0, 2};
  for (float& s : ball.size) s /= 4;
  EXPECT_EQ(ball.defects({}, {{t.a, t.a}}).insert.size(), facets) << "the surface of others, off the junctions";
  ball.order[t.a] = 1;
  EXPECT_TRUE(ball.defects({}, {{t.a, t.a}}).insert.empty()) << "junctions may be touched";
  EXPECT_EQ(ball.defects(worst_defects, {{t.a, t.a}}).insert.size(), facets) << "at last, there too";
}

TEST(Defects, PointsOfAJunctionCountAsASurfacesWhereTheMeshHasNone) {
  Ball ball(with_a_twin(400));
  for (std::uint8_t& o : ball.order) o = 1;
  lift_off_junctions(ball.mesh, ball.order);
  EXPECT_EQ(ball.order, std::vector<std::uint8_t>(ball.order.size(), 2)) << "two materials only";
  EXPECT_NEAR(fitness(ball.mesh, ball.order, worst_defects), ball.worst() / worst_defects.ratio, 1e-9);
  for (std::uint8_t& o : ball.order) o = 0;
  ball.mesh.materials[50] = {0, 2};
  lift_off_junctions(ball.mesh, ball.order);
  EXPECT_EQ(std::count(ball.order.begin(), ball.order.end(), 0), 3);
  const Triangle t = ball.mesh.triangles[50];
  EXPECT_TRUE(ball.order[t.a] == 0 && ball.order[t.b] == 0 && ball.order[t.c] == 0) << "three materials meet there";
}

TEST(Defects, FitnessIsTheLeastRatioByWhatIsAsked) {
  Ball ball(with_a_twin(400));
  const double worst = ball.worst();
  EXPECT_NEAR(fitness(ball.mesh, ball.order, worst_defects), worst / worst_defects.ratio, 1e-9);
  for (std::uint8_t& o : ball.order) o = 1;
  EXPECT_NEAR(fitness(ball.mesh, ball.order, worst_defects), worst / worst_defects.near, 1e-9);
  const Ball good(test::points_on_sphere(400, 1));
  EXPECT_EQ(fitness(good.mesh, good.order, worst_defects), wanted_ratio / worst_defects.ratio) << "good ones are alike";
  const DefectRule just_above{0, worst + 1e-9, worst + 1e-9, false};
  const std::vector<std::uint8_t> marked = points_at_bad(ball.mesh, ball.order, just_above);
  EXPECT_EQ(std::count(marked.begin(), marked.end(), 1), 3);
  EXPECT_TRUE(marked[400] && marked[7]);
}

TEST(Defects, AnglesCountAwayFromJunctions) {
  const auto isosceles = [](double degrees) {  // the least angle between two sides of length 1
    const double a = degrees * M_PI / 180;
    return std::array<Vec3d, 3>{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(std::cos(a), std::sin(a), 0)};
  };
  for (const double degrees : {24.0, 29.0}) {
    EXPECT_NEAR(triangle_fitness(isosceles(degrees), false, not_fine), degrees / 30, 1e-9);
    EXPECT_EQ(triangle_fitness(isosceles(degrees), true, not_fine), 1);
    EXPECT_EQ(triangle_fitness(isosceles(degrees), false, mediocre), 1);
  }
  EXPECT_EQ(triangle_fitness(isosceles(31), false, not_fine), 1);
  const auto at_bound = isosceles(30);
  EXPECT_NEAR(highest_bad_ratio(not_fine), radius_ratio(at_bound[0], at_bound[1], at_bound[2]), 1e-9);
  EXPECT_EQ(highest_bad_ratio(mediocre), wanted_ratio);
}

}  // namespace
}  // namespace nacre
