// Nacre: the bricks of the octree that one of several processes has, and what it exchanges with the others.
#include "compute/pipeline/octree_share.hpp"

#include <cmath>

#include "compute/embedding/cells_near.hpp"

namespace nacre {
namespace {

/// A brick that a triangle touches, and about how many surface cells (in sixteenths) the triangle adds to it.
struct TouchedBrick {
  std::uint64_t code, work;
};

/// Of the triangles first .. last - 1; ascending, each brick once.
std::vector<TouchedBrick> touched_bricks(const MeshView& mesh, std::uint32_t first, std::uint32_t last, int levels) {
  std::vector<TouchedBrick> all;
  for (std::uint32_t t = first; t < last; ++t) {
    const Corners c = mesh.corners(t);
    const std::size_t begin = all.size();
    for_cells_near(c * (1.0 / BrickOctreeView::width), 0.0, Int3(1 << levels), [&](const Int3& b) {
      all.push_back({morton(b), 0});
    });
    const double area = 0.5 * length(cross(c.b - c.a, c.c - c.a)), bricks = double(all.size() - begin);
    for (std::size_t k = begin; k < all.size(); ++k) all[k].work = std::uint64_t(std::llround(24 * area / bricks)) + 1;
  }
  std::sort(all.begin(), all.end(), [](const TouchedBrick& a, const TouchedBrick& b) { return a.code < b.code; });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (kept > 0 && all[kept - 1].code == all[k].code)
      all[kept - 1].work += all[k].work;
    else
      all[kept++] = all[k];
  }
  all.resize(kept);
  return all;
}

}  // namespace

std::vector<std::uint64_t> cut_octree(Ranks& ranks, const MeshView& mesh, std::uint32_t triangles, int levels) {
  const auto parts = static_cast<std::size_t>(ranks.count()), own = static_cast<std::size_t>(ranks.rank());
  const auto share = [&](std::size_t r) { return std::uint32_t(std::uint64_t(triangles) * r / parts); };
  const std::vector<TouchedBrick> bricks = touched_bricks(mesh, share(own), share(own + 1), levels);
  std::vector<std::uint64_t> before{0};  // the work in the bricks before each
  for (const TouchedBrick& brick : bricks) before.push_back(before.back() + brick.work);
  std::uint64_t whole = before.back();
  ranks.sum({&whole, 1});
  // Bisection of all borders at once: between low and high lies the code at which their share of the work is reached.
  const std::uint64_t codes = std::uint64_t(1) << (3 * levels);
  std::vector<std::uint64_t> low(parts - 1, 0), high(parts - 1, codes), sums(parts - 1);
  for (int round = 0; round <= 3 * levels && parts > 1; ++round) {
    for (std::size_t p = 0; p + 1 < parts; ++p) {
      const std::uint64_t middle = low[p] + (high[p] - low[p]) / 2;
      const auto at = std::lower_bound(bricks.begin(), bricks.end(), middle,
                                       [](const TouchedBrick& brick, std::uint64_t code) { return brick.code < code; });
      sums[p] = before[std::size_t(at - bricks.begin())];
    }
    ranks.sum(sums);
    for (std::size_t p = 0; p + 1 < parts; ++p) {
      const std::uint64_t middle = low[p] + (high[p] - low[p]) / 2;
      const auto wanted = std::uint64_t(double(whole) * double(p + 1) / double(parts));
      (sums[p] < wanted ? low[p] : high[p]) = middle;
    }
  }
  std::vector<std::uint64_t> begin{0};
  for (const std::uint64_t border : high) begin.push_back(std::max(begin.back(), border));
  begin.push_back(codes);
  return begin;
}

}  // namespace nacre
