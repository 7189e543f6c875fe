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
  const MeshView mesh{points.data(), triangles.data(), nullptr};
  const auto begin = cut_octree(ranks, mesh, std::uint32_t(triangles.size()), levels);
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

}  // namespace
}  // namespace nacre
