// Nacre: the bricks of the octree that one of several processes has, and what it exchanges with the others.
#include "compute/pipeline/octree_share.hpp"

#include <cmath>

#include "compute/math/morton.hpp"

namespace nacre {
namespace {

/// A brick that triangles lie in, and about how many surface cells they add to it, in millionths.
struct TouchedBrick {
  std::uint64_t code, work;
};

/// Divides a triangle until its parts have edges of half a brick at most, and adds the bricks that their middles are
/// in. A part of a plane crosses as many cells as its shadows on the three sides of the domain have squares.
void add_bricks(const Corners& c, int levels, std::vector<TouchedBrick>& bricks) {
  constexpr double longest = 0.5 * BrickOctreeView::width;
  const Vec3d edge[3] = {c.b - c.a, c.c - c.b, c.a - c.c};
  const double squared[3] = {dot(edge[0], edge[0]), dot(edge[1], edge[1]), dot(edge[2], edge[2])};
  const auto k = std::max_element(squared, squared + 3) - squared;
  if (squared[k] > longest * longest) {
    const Vec3d from = k == 0 ? c.a : k == 1 ? c.b : c.c, to = k == 0 ? c.b : k == 1 ? c.c : c.a;
    const Vec3d other = k == 0 ? c.c : k == 1 ? c.a : c.b, middle = (from + to) * 0.5;
    add_bricks({from, middle, other}, levels, bricks);
    add_bricks({middle, to, other}, levels, bricks);
    return;
  }
  const Vec3d middle = (c.a + c.b + c.c) * (1.0 / 3), normal = cross(edge[0], edge[1]);
  const double shadows = 0.5 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z));
  Int3 brick;
  for (int axis = 0; axis < 3; ++axis)
    brick[axis] = std::clamp(int(std::floor(middle[axis] / BrickOctreeView::width)), 0, (1 << levels) - 1);
  bricks.push_back({morton(brick), std::uint64_t(std::llround(1e6 * shadows)) + 1});
}

/// Of the triangles first .. last - 1; ascending, each brick once.
std::vector<TouchedBrick> touched_bricks(const FlowMesh& mesh, const FlowDomain& domain, std::size_t first,
                                         std::size_t last, int levels) {
  std::vector<TouchedBrick> all;
  for (std::size_t t = first; t < last; ++t) {
    const auto corner = [&](int k) { return domain.to_grid(mesh.points[mesh.triangles[t][k]]); };
    add_bricks({corner(0), corner(1), corner(2)}, levels, all);
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

std::vector<std::uint64_t> cut_octree(Ranks& ranks, const FlowMesh& mesh, const FlowDomain& domain, int levels) {
  const auto parts = static_cast<std::size_t>(ranks.count()), own = static_cast<std::size_t>(ranks.rank());
  const std::size_t triangles = mesh.triangles.size();
  const auto share = [&](std::size_t r) { return mesh.shared ? triangles * (r - own) : triangles * r / parts; };
  const std::vector<TouchedBrick> bricks = touched_bricks(mesh, domain, share(own), share(own + 1), levels);
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
