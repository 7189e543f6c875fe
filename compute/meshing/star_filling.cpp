// Nacre: holes between agreed triangles are filled, and widened where that fails.
#include "compute/meshing/star_filling.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "compute/meshing/small_hull.hpp"
#include "compute/meshing/star_holes.hpp"

namespace nacre {
namespace {

constexpr int widenings = 5;
constexpr std::size_t most_in_body = 24, most_in_speck = 6;  // particles
constexpr double least_facing = 0.3;  // mean cosine between triangles of a small body and the normals at their corners
constexpr std::size_t most_opened = 50;  // items for each hole: beyond, it is no hole but something else

void sort_unique(std::vector<std::uint32_t>& some) {
  std::sort(some.begin(), some.end());
  some.erase(std::unique(some.begin(), some.end()), some.end());
}

/// Items at edges of filled holes that are not passed once each way, counting the agreed triangles beside them.
std::vector<std::uint32_t> at_odd_edges(const StarItems& items, const std::vector<Star>& stars,
                                        std::span<const Triangle> filled) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : filled)
    for (int k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
  std::sort(edges.begin(), edges.end());
  const auto agreed = [&](std::uint32_t a, std::uint32_t b) {
    const Star& star = stars[a];
    for (int k = 0; k < star.count; ++k)
      if (star.ring[std::size_t(k)] == b) return (star.agreed >> k & 1) != 0;
    return false;
  };
  std::vector<std::uint32_t> odd;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const auto& e = edges[i];
    const bool twice = i + 1 < edges.size() && edges[i + 1] == e;
    const bool ends = items.next[e[0]] == e[1];  // the surface ends here
    const bool back = agreed(e[1], e[0]) || std::binary_search(edges.begin(), edges.end(), std::array{e[1], e[0]});
    if (twice || agreed(e[0], e[1]) || (!ends && !back)) odd.insert(odd.end(), e.begin(), e.end());
  }
  return odd;
}

/// Fills what can be filled; returns the items of the other holes.
std::vector<std::uint32_t> fill(const StarItems& items, const std::vector<Star>& stars,
                                const std::vector<StarHole>& holes, std::vector<Triangle>& triangles) {
  std::vector<std::vector<Triangle>> fillings(holes.size());
  tbb::parallel_for(std::size_t(0), holes.size(),
                    [&](std::size_t i) { fillings[i] = fill_hole(items, stars, holes[i]); });
  std::vector<std::uint32_t> open;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    triangles.insert(triangles.end(), fillings[i].begin(), fillings[i].end());
    if (!fillings[i].empty()) continue;
    open.insert(open.end(), holes[i].loop.begin(), holes[i].loop.end());
    open.insert(open.end(), holes[i].within.begin(), holes[i].within.end());
  }
  return open;
}

/// The convex hull of items as a surface that faces as they do; none where they do not face out of it, or into it.
std::vector<Triangle> hull_of(const StarItems& items, std::span<const std::uint32_t> some) {
  std::vector<Vec3d> position;
  for (const std::uint32_t i : some) position.push_back(items.position[i]);
  std::vector<Triangle> hull = small_hull(position);
  double facing = 0;
  for (Triangle& t : hull) {
    t = {some[t.a], some[t.b], some[t.c]};
    const Vec3d a = items.position[t.a], n = normalized(cross(items.position[t.b] - a, items.position[t.c] - a));
    facing += dot(n, items.normal[t.a] + items.normal[t.b] + items.normal[t.c]) / 3;
  }
  if (!(std::abs(facing) > least_facing * double(hull.size()))) return {};
  if (facing < 0)
    for (Triangle& t : hull) std::swap(t.b, t.c);
  return hull;
}

/// Items that have no triangle and neighbours of which this is true, too, are a body of a few particles: it gets the
/// hull of these. A smaller one without such a hull bounds nothing, and is left out. Returns the items of larger ones.
std::vector<std::uint32_t> close_bodies(const StarItems& items, const std::vector<Star>& stars,
                                        std::span<const std::uint32_t> alone, std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> done, left;  // ascending
  for (const std::uint32_t first : alone) {
    if (std::binary_search(done.begin(), done.end(), first)) continue;
    std::vector<std::uint32_t> body = {first};
    for (std::size_t k = 0; k < body.size() && body.size() <= most_in_body; ++k) {
      const Star& star = stars[body[k]];
      for (int r = 0; r < star.count; ++r) {
        const std::uint32_t q = star.ring[std::size_t(r)];
        const bool is_new = std::find(body.begin(), body.end(), q) == body.end();
        if (is_new && stars[q].agreed == 0 && items.next[q] == none) body.push_back(q);
      }
    }
    std::sort(body.begin(), body.end());
    std::vector<std::uint32_t> both;
    std::set_union(done.begin(), done.end(), body.begin(), body.end(), std::back_inserter(both));
    done.swap(both);
    if (body.size() > most_in_body) {
      left.insert(left.end(), body.begin(), body.end());
      continue;
    }
    const std::vector<Triangle> hull = hull_of(items, body);
    triangles.insert(triangles.end(), hull.begin(), hull.end());
    if (hull.empty() && body.size() > most_in_speck) left.insert(left.end(), body.begin(), body.end());
  }
  return left;
}

}  // namespace

StarFilling fill_holes(StarFinder& finder, std::vector<std::uint32_t> incomplete) {
  const StarItems& items = finder.items();
  const std::vector<Star>& stars = finder.stars();
  StarFilling filling;
  for (int round = 0;; ++round) {
    const StarHoles holes = find_holes(items, stars, incomplete);
    filling.holes = std::int64_t(holes.holes.size());
    filling.triangles.clear();
    std::vector<std::uint32_t> failed = fill(items, stars, holes.holes, filling.triangles);
    const std::vector<std::uint32_t> odd = at_odd_edges(items, stars, filling.triangles);
    failed.insert(failed.end(), odd.begin(), odd.end());
    sort_unique(failed);
    if (failed.empty() || round == widenings || failed.size() > most_opened * holes.holes.size()) {
      for (const StarHole& hole : holes.holes)
        filling.around.insert(filling.around.end(), hole.loop.begin(), hole.loop.end());
      filling.unsettled = std::move(failed);
      const std::vector<std::uint32_t> left = close_bodies(items, stars, holes.alone, filling.triangles);
      for (const auto* more : {&left, &holes.open})
        filling.unsettled.insert(filling.unsettled.end(), more->begin(), more->end());
      sort_unique(filling.opened);
      return filling;
    }
    const std::vector<std::uint32_t> changed = finder.open(failed);
    incomplete.insert(incomplete.end(), changed.begin(), changed.end());
    sort_unique(incomplete);
    filling.opened.insert(filling.opened.end(), failed.begin(), failed.end());
  }
}

}  // namespace nacre
