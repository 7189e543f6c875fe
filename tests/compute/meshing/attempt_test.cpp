// Nacre: tests of attempts at bad positions, each of which is kept or taken back by itself.
#include "compute/meshing/attempt.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "compute/meshing/interfaces.hpp"
#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

using Marks = std::vector<std::uint8_t>;

/// A unit sphere through some of the points.
struct Sphere {
  SurfaceMesh mesh;
  std::vector<std::uint32_t> point_of;
  Marks order;
  std::vector<std::array<std::uint32_t, 2>> touching;

  explicit Sphere(const std::vector<Vec3d>& points) {
    const DelaunayCells cells = delaunay(points);
    const auto labels = test::labels_of(cells, [](const Vec3d& c) { return length(c) < 0.9; });
    mesh = extract_interfaces(points, cells, labels, &point_of);
    order.assign(mesh.points.size(), 2);
  }
  Attempt::View view() const { return {mesh, point_of, order, touching}; }
  Marks bad() const { return points_at_triangles_under(wanted_ratio, mesh); }
};

Vec3d beside(const Vec3d& p, double by) { return normalized(p + by * normalized(cross(p, Vec3d(0.3, 0.5, 0.8)))); }

/// Points on a sphere, the last two of which are next to the points `north` and `south`.
struct TwoBadPlaces {
  static constexpr std::uint32_t north = 40, south = 360;
  std::vector<Vec3d> points = test::points_on_sphere(400, 1);
  TwoBadPlaces() {
    points.push_back(beside(points[north], 0.005));
    points.push_back(beside(points[south], 0.005));
  }
  Attempt attempt() const {
    const Sphere before(points);
    return Attempt(points.size(), before.view(), before.bad(), worst_defects);
  }
};

TEST(Patches, AreTheMarkedPointsWithTheirNeighboursInPieces) {
  const Sphere s(test::points_on_sphere(400, 1));
  Marks marked(400, 0);
  marked[20] = marked[380] = 1;
  const Patches two = patches_around(s.mesh, marked);
  EXPECT_EQ(two.count, 2u);
  EXPECT_EQ(two.of[20], 0u);
  EXPECT_EQ(two.of[380], 1u);
  EXPECT_EQ(std::count(two.of.begin(), two.of.end(), none), 400 - 2 * 7) << "two points of six neighbours";
  for (const Triangle& t : s.mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      if (t[k] != 20) continue;
      EXPECT_EQ(two.of[t[(k + 1) % 3]], 0u);
      marked[t[(k + 1) % 3]] = 1;
    }
  EXPECT_EQ(patches_around(s.mesh, marked).count, 2u) << "points next to each other hang together";
  EXPECT_EQ(patches_around(s.mesh, Marks(400, 0)).count, 0u);
}

TEST(Attempt, IsKeptWhereItHelpedAndTakenBackElsewhere) {
  const TwoBadPlaces positions;
  Attempt attempt = positions.attempt();
  // In the north the one that is too much goes; in the south the two come still closer.
  Marks gone(402, 0);
  gone[400] = 1;
  std::vector<Vec3d> points = positions.points;
  points.erase(points.begin() + 400);
  points.back() = beside(points[positions.south], 0.001);
  attempt.change(gone, points.size());
  const Sphere now(points);
  attempt.judge(now.view());
  const Marks open = attempt.open(now.view());
  ASSERT_FALSE(open.empty());
  EXPECT_TRUE(open[positions.south] && open[400]);
  EXPECT_FALSE(open[positions.north]);
  const std::vector<Attempt::Source> mixed = attempt.taken_back();
  ASSERT_EQ(mixed.size(), 401u);
  for (std::uint32_t i = 0; i < 400; ++i) {
    EXPECT_EQ(mixed[i].point, i);
    EXPECT_EQ(mixed[i].before, bool(open[i])) << i;
  }
  EXPECT_TRUE(mixed[400].before);
  EXPECT_EQ(mixed[400].point, 401u) << "as it was before the attempt";
}

TEST(Attempt, GoesOnWithWhatIsOpenAndThenHasNothingToTakeBack) {
  const TwoBadPlaces positions;
  Attempt attempt = positions.attempt();
  std::vector<Vec3d> points = positions.points;
  Marks gone(402, 0);
  for (const std::uint32_t last : {401u, 400u}) {
    attempt.judge(Sphere(points).view());
    EXPECT_FALSE(attempt.open(Sphere(points).view()).empty()) << "no better is not enough";
    EXPECT_FALSE(attempt.taken_back().empty());
    gone.assign(last + 1, 0);
    gone[last] = 1;
    points.pop_back();
    attempt.change(gone, last);
  }
  const Sphere now(points);
  attempt.judge(now.view());
  EXPECT_TRUE(attempt.open(now.view()).empty());
  EXPECT_TRUE(attempt.taken_back().empty());
}

TEST(Attempt, NewPointsShareTheFateOfTheirPatch) {
  const TwoBadPlaces positions;
  Attempt attempt = positions.attempt();
  std::vector<Vec3d> points = positions.points;
  points.erase(points.begin() + 400);  // the north is remeshed; in the south comes a third
  points.push_back(beside(points[positions.south], -0.002));
  Marks gone(402, 0);
  gone[400] = 1;
  attempt.change(gone, points.size());
  attempt.judge(Sphere(points).view());
  std::vector<Attempt::Source> mixed = attempt.taken_back();
  ASSERT_EQ(mixed.size(), 401u);
  EXPECT_TRUE(mixed.back().before);

  points.pop_back();
  points.push_back(normalized((points[100] + points[101] + points[113]) / 3.0));  // far from both
  Attempt again = positions.attempt();
  again.change(gone, points.size());
  again.judge(Sphere(points).view());
  mixed = again.taken_back();
  ASSERT_EQ(mixed.size(), 402u);
  EXPECT_FALSE(mixed.back().before) << "it belongs to no patch and stays";
  EXPECT_EQ(mixed.back().point, 401u);
}

TEST(Attempt, PlacesThatTouchAreWorseThanAnyTriangle) {
  const TwoBadPlaces positions;
  Sphere before(positions.points);
  before.touching = {{positions.north, positions.north}};
  Attempt attempt(402, before.view(), before.bad(), worst_defects);
  const Sphere now(positions.points);  // the triangles are as bad as ever, but the surface no longer touches itself
  attempt.judge(now.view());
  const Marks open = attempt.open(now.view());
  EXPECT_FALSE(open[positions.north]);
  EXPECT_TRUE(open[positions.south]);
}

}  // namespace
}  // namespace nacre
