// Nacre: the triangles at points that are included, and at their neighbours, are all found.
#include "compute/meshing/triangles_around.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace nacre::test {
namespace {

constexpr std::uint32_t side = 40;

/// A square of side * side points.
std::vector<Triangle> square() {
  std::vector<Triangle> triangles;
  for (std::uint32_t y = 0; y + 1 < side; ++y)
    for (std::uint32_t x = 0; x + 1 < side; ++x) {
      const std::uint32_t a = y * side + x;
      triangles.push_back({a, a + 1, a + side});
      triangles.push_back({a + side, a + 1, a + side + 1});
    }
  return triangles;
}

std::vector<std::uint32_t> found(const TrianglesAround& around, std::uint32_t point) {
  std::vector<std::uint32_t> numbers;
  around.visit(point, [&](std::uint32_t place) { numbers.push_back(around.numbers()[place]); });
  return numbers;
}

std::vector<std::uint32_t> expected(const std::vector<Triangle>& all, std::uint32_t point) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (has_corner(all[i], point)) numbers.push_back(i);
  return numbers;
}

/// Those at a point and at its neighbours are all there.
void expect_all_at(const TrianglesAround& around, const std::vector<Triangle>& all, std::uint32_t point) {
  std::set<std::uint32_t> near = {point};
  for (const std::uint32_t i : expected(all, point)) near.insert({all[i].a, all[i].b, all[i].c});
  for (const std::uint32_t v : near) EXPECT_EQ(found(around, v), expected(all, v)) << v;
}

TEST(TrianglesAround, AllAtPointsAndTheirNeighbours) {
  const std::vector<Triangle> all = square();
  TrianglesAround around(all, side * side);
  std::vector<std::uint8_t> marks(side * side, 0);
  std::vector<std::uint32_t> points;
  // Points that come nearby one by one, and then far away.
  for (const std::uint32_t v : {10 * side + 10, 10 * side + 11, 10 * side + 13, 12 * side + 15, 30 * side + 38, 0u}) {
    marks[v] = 1;
    points.push_back(v);
    around.include(marks, points);
    for (const std::uint32_t p : points) expect_all_at(around, all, p);
  }
  EXPECT_LT(around.numbers().size(), all.size() / 4);
  EXPECT_TRUE(std::ranges::is_sorted(around.numbers()));
  for (std::size_t k = 0; k < around.numbers().size(); ++k) {
    const Triangle &listed = around[k], &t = all[around.numbers()[k]];
    EXPECT_TRUE(listed.a == t.a && listed.b == t.b && listed.c == t.c);
  }
}

TEST(TrianglesAround, NothingBeforeAPointIsThere) {
  const std::vector<Triangle> all = square();
  const TrianglesAround around(all, side * side);
  EXPECT_TRUE(found(around, 5).empty());
  EXPECT_TRUE(around.numbers().empty());
}

}  // namespace
}  // namespace nacre::test
