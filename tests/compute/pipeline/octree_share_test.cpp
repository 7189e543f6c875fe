// Nacre: where the octree is cut for several processes.
#include "compute/pipeline/octree_share.hpp"

#include <gtest/gtest.h>

#include "compute/embedding/brick_octree.hpp"
#include "compute/math/morton.hpp"

namespace nacre {
namespace {

/// The first of two processes. The other one has no triangles.
class FirstOfTwo final : public Ranks {
 public:
  int rank() const override { return 0; }
  int count() const override { return 2; }
  void sum(std::span<std::uint64_t>) override {}
  std::vector<Bytes> exchange(const std::vector<Bytes>&) override { return std::vector<Bytes>(2); }
  void begin(std::span<const Part>, std::span<const Part>) override {}
  void finish() override {}
  std::uint64_t sent_bytes() const override { return 0; }
  double waited_seconds() const override { return 0; }
};

/// Bricks along x that a small triangle lies in; the process has the first half of the list.
std::uint64_t border(const std::vector<int>& bricks) {
  constexpr int levels = 3;
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  for (const int brick : bricks) {
    const double x = BrickOctreeView::width * brick;
    const auto first = std::uint32_t(points.size());
    points.insert(points.end(), {{x + 2, 2, 2}, {x + 6, 2, 2}, {x + 2, 6, 2}});
    triangles.push_back({first, first + 1, first + 2});
  }
  triangles.resize(2 * triangles.size(), triangles[0]);
  FirstOfTwo ranks;
  const auto begin = cut_octree(ranks, {points, triangles, {}}, FlowDomain(), levels);
  EXPECT_EQ(begin.size(), 3u);
  EXPECT_EQ(begin.front(), 0u);
  EXPECT_EQ(begin.back(), std::uint64_t(1) << (3 * levels));
  return begin[1];
}

TEST(CutOctree, HalvesTheWork) {
  EXPECT_EQ(border({0, 1, 2, 3, 4}), morton({2, 0, 0}) + 1) << "the third of five passes the half";
  EXPECT_EQ(border({4, 3, 2, 1, 0}), morton({2, 0, 0}) + 1) << "in any order";
  EXPECT_EQ(border({0, 1, 4, 4, 4, 4}), morton({4, 0, 0}) + 1) << "by work, not by bricks";
  EXPECT_EQ(border({0, 0, 0, 0, 1, 4}), morton({0, 0, 0}) + 1);
}

/// Where two processes divide triangles that the first of them has.
std::uint64_t border_of(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles, int levels) {
  std::vector<Triangle> twice = triangles;
  twice.resize(2 * triangles.size(), triangles[0]);
  FirstOfTwo ranks;
  return cut_octree(ranks, {points, twice, {}}, FlowDomain(), levels)[1];
}

TEST(CutOctree, MeasuresWhatLiesInEachBrick) {
  // Half of this triangle lies before x = 19.6.
  const std::vector<Vec3d> points{{2, 2, 2}, {62, 2, 2}, {2, 6, 2}};
  EXPECT_EQ(border_of(points, {{0, 1, 2}}, 3), morton({2, 0, 0}) + 1);
  EXPECT_EQ(border_of(points, {{2, 0, 1}}, 3), morton({2, 0, 0}) + 1) << "whatever its first corner";
  EXPECT_EQ(border_of(points, {{2, 1, 0}}, 3), morton({2, 0, 0}) + 1) << "whatever its winding";
}

TEST(CutOctree, CountsSmallTrianglesByTheirSizeToo) {
  // A strip of 8 bricks: the first in a thousand small triangles, the others in two each.
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  const auto add = [&](double from, double to) {
    const auto first = std::uint32_t(points.size());
    points.insert(points.end(), {{from, 2, 2}, {to, 2, 2}, {to, 6, 2}, {from, 6, 2}});
    triangles.push_back({first, first + 1, first + 2});
    triangles.push_back({first, first + 2, first + 3});
  };
  for (int k = 0; k < 500; ++k) add(8.0 * k / 500, 8.0 * (k + 1) / 500);
  for (int brick = 1; brick < 8; ++brick) add(8.0 * brick, 8.0 * (brick + 1));
  const std::uint64_t border = border_of(points, triangles, 3);
  EXPECT_GE(border, morton({3, 0, 0}) + 1);
  EXPECT_LE(border, morton({4, 0, 0}) + 1);
}

}  // namespace
}  // namespace nacre
