// Nacre: processes that have a surface in shares get the triangles near their bricks. Threads act as processes.
#include "compute/pipeline/mesh_of_bricks.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <random>
#include <set>

#include "compute/embedding/brick_ranges.hpp"
#include "compute/embedding/cells_near.hpp"
#include "compute/pipeline/octree_share.hpp"
#include "tests/thread_ranks.hpp"

namespace nacre {
namespace {

constexpr int levels = 4, width = BrickOctreeView::width;

struct Soup {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  std::vector<Vec3f> normals;

  /// Points of triangles first .. last - 1, which have no points in common.
  Soup part(std::size_t first, std::size_t last) const {
    Soup own;
    for (std::size_t t = first; t < last; ++t) {
      const auto p = std::uint32_t(own.points.size());
      for (int k = 0; k < 3; ++k) own.points.push_back(points[triangles[t][k]]);
      own.triangles.push_back({p, p + 1, p + 2});
      own.normals.insert(own.normals.end(), normals.begin() + std::ptrdiff_t(3 * t),
                         normals.begin() + std::ptrdiff_t(3 * t + 3));
    }
    return own;
  }
};

/// Small triangles and some that are 50 cells wide, in a domain of 128 cells, which are the world's unit.
Soup make_soup(int count) {
  Soup soup;
  std::mt19937 random(3);
  const auto number = [&](double size) { return size * double(random()) / 4294967296.0; };
  for (int t = 0; t < count; ++t) {
    const double size = t % 10 == 0 ? 50 : 4;
    const Vec3d at(8 + number(50), 8 + number(50), 20 + number(30));
    for (int k = 0; k < 3; ++k) soup.points.push_back(at + Vec3d(number(size), number(size), number(0.3 * size)));
    const auto p = std::uint32_t(3 * t);
    soup.triangles.push_back({p, p + 1, p + 2});
    for (int k = 0; k < 3; ++k) soup.normals.push_back({float(t), float(k), 1});
  }
  return soup;
}

class NearBricks : public testing::TestWithParam<int> {};

TEST_P(NearBricks, HaveAllTrianglesOfTheirCellsInOrder) {
  const int count = GetParam(), depth = 1;
  const Soup whole = make_soup(400);
  FlowDomain domain;
  domain.radius = 2.24;
  domain.cells = Int3(128);
  std::mutex mutex;
  on_ranks(count, [&](Ranks& ranks) {
    const auto border = [&](int r) { return whole.triangles.size() * std::size_t(r) / std::size_t(count); };
    const Soup own = whole.part(border(ranks.rank()), border(ranks.rank() + 1));
    FlowMesh share{own.points, own.triangles, own.normals};
    share.shared = true;
    const std::vector<std::uint64_t> begin = cut_octree(ranks, share, domain, levels);
    const MeshOfBricks near(ranks, share, domain, levels, begin, depth);
    std::vector<float> number_of_share, here(near.mesh().points.size());
    for (std::size_t p = 0; p < own.points.size(); ++p) number_of_share.push_back(float(own.points[p].x));
    near.take(std::span<const float>(number_of_share), std::span<float>(here));

    const std::lock_guard lock(mutex);
    std::set<std::uint64_t> own_bricks;
    const auto bricks_of = [&](const Triangle& t, double cells, const auto& visit) {
      const auto at = [&](std::uint32_t p) { return whole.points[p] / double(width); };
      for_cells_near({at(t.a), at(t.b), at(t.c)}, cells / width, Int3(1 << levels),
                     [&](const Int3& brick) { visit(morton(brick)); });
    };
    for (const Triangle& t : whole.triangles)
      bricks_of(t, domain.radius, [&](std::uint64_t code) {
        if (code >= begin[std::size_t(ranks.rank())] && code < begin[std::size_t(ranks.rank()) + 1])
          own_bricks.insert(code);
      });
    const std::vector<std::uint64_t> wanted =
        codes_around(std::vector<std::uint64_t>(own_bricks.begin(), own_bricks.end()), depth, levels);
    const std::set<std::uint64_t> in_reach(wanted.begin(), wanted.end());
    const std::set<std::uint32_t> numbers(near.numbers().begin(), near.numbers().end());
    EXPECT_TRUE(std::is_sorted(near.numbers().begin(), near.numbers().end()));
    EXPECT_EQ(numbers.size(), near.numbers().size()) << "each once";
    for (std::uint32_t t = 0; t < whole.triangles.size(); ++t) {
      bool needed = false;
      bricks_of(whole.triangles[t], domain.radius, [&](std::uint64_t code) { needed |= in_reach.count(code) > 0; });
      if (needed) {
        EXPECT_TRUE(numbers.count(t)) << "triangle " << t << " in process " << ranks.rank();
      }
    }
    for (std::size_t k = 0; k < near.numbers().size(); ++k)
      for (int c = 0; c < 3; ++c) {
        const std::size_t corner = 3 * std::size_t(near.numbers()[k]) + std::size_t(c);
        const std::uint32_t p = near.mesh().triangles[k][c];
        EXPECT_EQ(near.mesh().points[p], whole.points[corner]);
        EXPECT_EQ(near.mesh().corner_normals[3 * k + std::size_t(c)], whole.normals[corner]);
        EXPECT_EQ(here[p], float(whole.points[corner].x)) << "values go with the points";
      }
  });
}

INSTANTIATE_TEST_SUITE_P(Processes, NearBricks, testing::Values(1, 2, 3, 7));

}  // namespace
}  // namespace nacre
