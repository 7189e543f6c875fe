// Nacre: streamlines that lie evenly: along the flow, not too near to each other, and everywhere.
#include "compute/topology/even_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compute/topology/surfaces.hpp"

namespace nacre::test {
namespace {

/// Distances from line to line, and from each point of the surface to its nearest line.
struct Evenness {
  double nearest_lines = 1e300, farthest_point = 0;
  Evenness(const Shape& shape, const std::vector<EvenLine>& lines) {
    for (std::size_t i = 0; i < lines.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        for (const Vec3d& p : lines[i].points)
          for (const Vec3d& q : lines[j].points) nearest_lines = std::min(nearest_lines, length(p - q));
    for (const Vec3d& p : shape.points) {
      double nearest = 1e300;
      for (const EvenLine& line : lines)
        for (const Vec3d& q : line.points) nearest = std::min(nearest, length(p - q));
      farthest_point = std::max(farthest_point, nearest);
    }
  }
};

TEST(EvenLines, AreCirclesOfLatitudeAroundASphere) {
  const Shape sphere = divided_sphere(5);
  const auto rotation = [](const Vec3d& p) { return Vec3d(-p.y, p.x, 0); };
  const TangentField field(sphere.points, sphere.triangles, vectors_on(sphere, rotation));
  const double spacing = 0.2;
  const std::vector<EvenLine> lines = even_lines(field, spacing);
  EXPECT_GT(lines.size(), 10u);  // pi / 0.2 is 16
  EXPECT_LT(lines.size(), 24u);
  for (const EvenLine& line : lines) {
    ASSERT_EQ(line.points.size(), line.speed.size());
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      EXPECT_NEAR(line.points[i].z, line.points[0].z, 0.01);
      EXPECT_NEAR(line.speed[i], std::hypot(line.points[i].x, line.points[i].y), 0.01);
    }
    // Once around, and with the flow.
    const Vec3d along = line.points[1] - line.points[0];
    EXPECT_GT(dot(along, rotation(line.points[0])), 0);
  }
  const Evenness even(sphere, lines);
  EXPECT_GT(even.nearest_lines, 0.49 * spacing);
  EXPECT_LT(even.farthest_point, 1.5 * spacing);
}

TEST(EvenLines, CoverAFieldWithSaddles) {
  const Shape sphere = divided_sphere(5);
  const TangentField field(sphere.points, sphere.triangles, vectors_on(sphere, [](const Vec3d& p) {
                             return on_sphere({2 * p.x + 0.5 * p.y, 4 * p.y - 0.5 * p.x, 6 * p.z}, p);
                           }));
  for (const double spacing : {0.1, 0.2}) {
    const std::vector<EvenLine> lines = even_lines(field, spacing);
    const Evenness even(sphere, lines);
    EXPECT_GT(even.nearest_lines, 0.45 * spacing);
    EXPECT_LT(even.farthest_point, 1.6 * spacing);
  }
}

TEST(EvenLines, OfAPlateEndAtItsRim) {
  const Shape plate = square(12);
  const TangentField field(plate.points, plate.triangles,
                           vectors_on(plate, [](const Vec3d&) { return Vec3d(1, 0, 0); }));
  const std::vector<EvenLine> lines = even_lines(field, 0.1);
  EXPECT_GE(lines.size(), 9u);
  EXPECT_LE(lines.size(), 12u);
  for (const EvenLine& line : lines) EXPECT_NEAR(line.points.back().x - line.points.front().x, 1, 1e-6);
}

TEST(EvenLines, AreOfEachPieceAndOfNoStillOne) {
  Shape two = square(6);
  const Shape other = square(6);
  const auto n = std::uint32_t(two.points.size());
  for (const Vec3d& p : other.points) two.points.push_back(p + Vec3d(5, 0, 0));
  for (const Triangle& t : other.triangles) two.triangles.push_back({t.a + n, t.b + n, t.c + n});
  const auto lines_of = [&](double left, double right) {
    const TangentField field(two.points, two.triangles,
                             vectors_on(two, [&](const Vec3d& p) { return Vec3d(0, p.x < 2 ? left : right, 0); }));
    std::vector<int> count(2);
    for (const EvenLine& line : even_lines(field, 0.2)) ++count[line.points[0].x < 2 ? 0 : 1];
    return count;
  };
  EXPECT_EQ(lines_of(1, 1)[0], lines_of(1, 1)[1]);
  EXPECT_GT(lines_of(1, 1)[0], 3);
  EXPECT_EQ(lines_of(0, 1)[0], 0);
  EXPECT_EQ(lines_of(0, 0)[1], 0);
}

}  // namespace
}  // namespace nacre::test
