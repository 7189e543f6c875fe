// Nacre: holes between agreed triangles are filled, and widened where that fails.
#include "compute/meshing/star_filling.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "compute/math/disjoint_sets.hpp"
#include "compute/math/sort_unique.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/select_where.hpp"
#include "compute/meshing/small_hull.hpp"
#include "compute/meshing/star_holes.hpp"

namespace nacre {
namespace {

constexpr int widenings = 5;
constexpr std::size_t most_in_body = 24, most_in_speck = 6;  // particles
constexpr double least_facing = 0.3;  // mean cosine between triangles of a small body and the normals at their corners
constexpr double least_ratio = 0.2;   // of these triangles
constexpr std::size_t most_opened = 50;  // items for each hole: beyond, it is no hole but something else

/// Items at edges of filled holes that are not passed once each way, counting the agreed triangles beside them.
std::vector<std::uint32_t> at_odd_edges(const StarItems& items, std::span<const Star> stars,
                                        std::span<const Triangle> filled) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : filled)
    for (int k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
  tbb::parallel_sort(edges.begin(), edges.end());
  const auto agreed = [&](std::uint32_t a, std::uint32_t b) {
    const Star& star = stars[a];
    for (int k = 0; k < star.count; ++k)
      if (star.ring[k] == b) return star.is_agreed(k);
    return false;
  };
  const auto is_odd = [&](std::size_t i) {
    const auto& e = edges[i];
    const bool twice = i + 1 < edges.size() && edges[i + 1] == e;
    const bool ends = items.next[e[0]] == e[1];  // the surface ends here
    return twice || agreed(e[0], e[1]) ||
           (!ends && !agreed(e[1], e[0]) && !std::binary_search(edges.begin(), edges.end(), std::array{e[1], e[0]}));
  };
  std::vector<std::uint32_t> odd;
  for (const std::uint32_t i : select_where(edges.size(), is_odd))
    odd.insert(odd.end(), edges[i].begin(), edges[i].end());
  return odd;
}

struct FilledHole {
  StarHole hole;
  std::vector<Triangle> triangles;  ///< none where it cannot be filled
};

/// Fills holes. Those that were there `before` are filled as then where none of their items has `changed` (ascending)
/// since.
std::vector<FilledHole> fill_each(const StarItems& items, std::span<const Star> stars, std::vector<StarHole> holes,
                                  std::span<const FilledHole> before, std::span<const std::uint32_t> changed) {
  const auto has_changed = [&](std::uint32_t i) { return std::binary_search(changed.begin(), changed.end(), i); };
  const auto filled_before = [&](const StarHole& hole) -> const FilledHole* {
    if (std::ranges::any_of(hole.loop, has_changed) || std::ranges::any_of(hole.within, has_changed)) return nullptr;
    const auto begin =
        std::ranges::lower_bound(before, hole.loop[0], {}, [](const FilledHole& f) { return f.hole.loop[0]; });
    for (auto f = begin; f != before.end() && f->hole.loop[0] == hole.loop[0]; ++f)
      if (f->hole == hole) return &*f;
    return nullptr;
  };
  std::vector<FilledHole> filled(holes.size());
  tbb::parallel_for(std::size_t(0), holes.size(), [&](std::size_t i) {
    const FilledHole* as_before = filled_before(holes[i]);
    filled[i].triangles = as_before ? as_before->triangles : fill_hole(items, stars, holes[i]);
    filled[i].hole = std::move(holes[i]);
  });
  return filled;
}

/// Items of holes that could not be filled.
struct Failed {
  std::vector<std::uint32_t> wider;     ///< of those that are worth widening
  std::vector<std::uint32_t> hopeless;  ///< of the others
};

/// Collects the triangles. Holes that have one of the items `hopeless`, which ascend, are not worth widening.
Failed collect(const StarItems& items, std::span<const Star> stars, std::span<const FilledHole> holes,
               std::span<const std::uint32_t> hopeless, std::vector<Triangle>& triangles) {
  const auto is_hopeless = [&](std::uint32_t i) { return std::binary_search(hopeless.begin(), hopeless.end(), i); };
  Failed failed;
  for (const auto& [hole, filling] : holes) {
    const auto &loop = hole.loop, &within = hole.within;
    triangles.insert(triangles.end(), filling.begin(), filling.end());
    if (!filling.empty()) continue;
    const bool no_hope =
        std::any_of(loop.begin(), loop.end(), is_hopeless) || std::any_of(within.begin(), within.end(), is_hopeless);
    for (const auto* some : {&loop, &within}) {
      auto& list = no_hope ? failed.hopeless : failed.wider;
      list.insert(list.end(), some->begin(), some->end());
    }
  }
  for (const std::uint32_t i : at_odd_edges(items, stars, triangles))
    (is_hopeless(i) ? failed.hopeless : failed.wider).push_back(i);
  sort_unique(failed.wider), sort_unique(failed.hopeless);
  return failed;
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
  const auto is_poor = [&](const Triangle& t) {
    return radius_ratio(items.position[t.a], items.position[t.b], items.position[t.c]) < least_ratio;
  };
  if (std::any_of(hull.begin(), hull.end(), is_poor)) return {};
  if (facing < 0)
    for (Triangle& t : hull) std::swap(t.b, t.c);
  return hull;
}

/// Items that are neighbours of each other, one of the other at least, in groups; all of `alone`, which ascends.
std::vector<std::vector<std::uint32_t>> group_neighbours(std::span<const Star> stars,
                                                         std::span<const std::uint32_t> alone) {
  DisjointSets sets(alone.size());
  std::vector<std::uint8_t> is_among(alone.size(), 0);  // several such
  for (std::uint32_t k = 0; k < alone.size(); ++k) {
    const Star& star = stars[alone[k]];
    int neighbours = 0;
    for (int r = 0; r < star.count; ++r) {
      const auto at = std::lower_bound(alone.begin(), alone.end(), star.ring[r]);
      if (at == alone.end() || *at != star.ring[r]) continue;
      sets.join(k, std::uint32_t(at - alone.begin()));
      ++neighbours;
    }
    is_among[k] = neighbours >= 3;
  }
  std::vector<std::vector<std::uint32_t>> groups(alone.size());
  std::vector<std::uint8_t> any(alone.size(), 0);
  for (std::uint32_t k = 0; k < alone.size(); ++k) {
    groups[sets.find(k)].push_back(alone[k]);
    any[sets.find(k)] |= is_among[k];
  }
  for (std::size_t k = 0; k < groups.size(); ++k)
    if (!any[k]) groups[k].clear();
  std::erase_if(groups, [](const auto& group) { return group.empty(); });
  return groups;
}

/// Items that have no triangle and neighbours of which this is true, too, are a body of a few particles: it gets the
/// hull of these. A smaller one without such a hull bounds nothing, and is left out, as are items beside a surface that
/// does without them. Returns the items of larger ones.
std::vector<std::uint32_t> close_bodies(const StarItems& items, std::span<const Star> stars,
                                        std::span<const std::uint32_t> alone, std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> left;
  for (const std::vector<std::uint32_t>& body : group_neighbours(stars, alone)) {
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

/// Fills holes, and widens those that cannot be filled, `hopeless` ones excepted. `failed` receives the items of those
/// that were widened in vain.
StarFilling widen_and_fill(const FoundStars& found, StarOpenings& openings, std::span<const std::uint32_t> hopeless,
                           std::vector<std::uint32_t>& failed) {
  const StarItems& items = found.items;
  const std::span<const Star> stars = found.stars;
  std::vector<std::uint32_t> incomplete = found.incomplete;
  StarFilling filling;
  std::vector<FilledHole> filled;
  std::vector<std::uint32_t> changed;
  for (int round = 0;; ++round) {
    StarHoles holes = find_holes(items, stars, incomplete);
    filled = fill_each(items, stars, std::move(holes.holes), filled, changed);
    filling.holes = std::int64_t(filled.size());
    filling.triangles.clear();
    Failed now = collect(items, stars, filled, hopeless, filling.triangles);
    if (now.wider.empty() || round == widenings || now.wider.size() > most_opened * filled.size()) {
      failed = std::move(now.wider);
      for (const auto& [hole, triangles] : filled)
        filling.around.insert(filling.around.end(), hole.loop.begin(), hole.loop.end());
      filling.unsettled = failed;
      const std::vector<std::uint32_t> left = close_bodies(items, stars, holes.alone, filling.triangles);
      for (const std::span<const std::uint32_t> more :
           {std::span<const std::uint32_t>(now.hopeless), std::span<const std::uint32_t>(left),
            std::span<const std::uint32_t>(holes.open)})
        filling.unsettled.insert(filling.unsettled.end(), more.begin(), more.end());
      filling.removed = openings.removed();
      return filling;
    }
    changed = openings.open(now.wider);
    sort_unique(changed);
    incomplete.insert(incomplete.end(), changed.begin(), changed.end());
    sort_unique(incomplete);
  }
}

}  // namespace

StarFilling fill_holes(const FoundStars& found, StarOpenings& openings) {
  std::vector<std::uint32_t> failed;
  StarFilling filling = widen_and_fill(found, openings, {}, failed);
  if (failed.empty()) return filling;
  // What was widened in vain stays as small as it was.
  openings.close();
  std::vector<std::uint32_t> again;
  return widen_and_fill(found, openings, failed, again);
}

}  // namespace nacre
