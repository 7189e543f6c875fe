// Nacre: the triangles between materials, read off from the particles themselves.
#include "compute/meshing/star_mesh.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <tuple>

#include "compute/meshing/select_where.hpp"
#include "compute/meshing/star_chords.hpp"
#include "compute/meshing/star_filling.hpp"
#include "compute/meshing/star_holes.hpp"

namespace nacre {
namespace {

/// Whether a star does without a hole: all its triangles are agreed, or it has none, as a particle beyond a rim has.
bool agrees(const StarItems& items, const Star& star, std::uint32_t i) {
  if (star.count < 2 || (!star.closed && items.next[i] == none)) return false;
  if (star.gaps != 0 && star.agreed == 0) return true;
  for (int k = 0; k < star.count; ++k)
    if ((star.closed || k + 1 < star.count) && !(star.agreed >> k & 1)) return false;
  return true;
}

/// What one pass over all stars finds.
struct Agreed {
  std::vector<Triangle> triangles;        ///< that all corners agree on, each listed by its smallest item, as items
  std::vector<std::uint32_t> incomplete;  ///< see is_incomplete; ascending
  std::int64_t unsettled = 0;             ///< stars that do not do without a hole
};

void add_agreed(const StarItems& items, const std::vector<Star>& stars, std::uint32_t i, Agreed& found) {
  const Star& star = stars[i];
  for (int k = 0; k < star.count; ++k) {
    if (!(star.agreed >> k & 1)) continue;
    const std::uint32_t a = star.ring[k], b = star.ring[star.after(k)];
    if (i < a && i < b) found.triangles.push_back({i, a, b});
  }
  if (!is_incomplete(items, star, i)) return;
  found.incomplete.push_back(i);
  found.unsettled += !agrees(items, star, i);
}

Agreed find_agreed(const StarItems& items, const std::vector<Star>& stars) {
  constexpr std::size_t part = 1 << 13;
  std::vector<Agreed> parts((stars.size() + part - 1) / part);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t k) {
    const std::size_t end = std::min(stars.size(), (k + 1) * part);
    parts[k].triangles.reserve(2 * (end - k * part));
    for (std::size_t i = k * part; i < end; ++i) add_agreed(items, stars, std::uint32_t(i), parts[k]);
  });
  Agreed all;
  std::size_t triangles = 0;
  for (const Agreed& some : parts) triangles += some.triangles.size();
  all.triangles.reserve(triangles + triangles / 16);
  for (const Agreed& some : parts) {
    all.triangles.insert(all.triangles.end(), some.triangles.begin(), some.triangles.end());
    all.incomplete.insert(all.incomplete.end(), some.incomplete.begin(), some.incomplete.end());
    all.unsettled += some.unsettled;
  }
  return all;
}

/// Of two triangles with the same corners, what is left without the material between them: one triangle or, where the
/// same material is on both outer sides, none. Both are used up, the first one for what is left.
void join_doubles(Triangle& first, std::array<std::uint16_t, 2>& first_materials,
                  std::array<std::uint16_t, 2>& second_materials) {
  const auto [low, high] = first_materials;
  const bool low_between = low == second_materials[0] || low == second_materials[1];
  const std::uint16_t between = low_between ? low : high;
  const std::uint16_t beyond = second_materials[0] == between ? second_materials[1] : second_materials[0];
  std::array<std::uint16_t, 2> left = {low_between ? beyond : low, low_between ? high : beyond};
  if (left[0] > left[1]) std::swap(left[0], left[1]), std::swap(first.b, first.c);
  const bool gone = first_materials == second_materials;
  first_materials = gone ? std::array<std::uint16_t, 2>{0, 0} : left;
  second_materials = {0, 0};
}

/// A material that is no thicker than one triangle is taken away there: two surfaces that have it on one of their sides
/// would have the same corners, all of which are on rims.
void remove_doubles(const StarItems& items, const std::vector<Triangle>& with_items, StarMesh& made) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::size_t>> corners;
  const auto on_rims = [&](std::size_t i) {
    const Triangle& t = with_items[i];
    return items.next[t.a] != none && items.next[t.b] != none && items.next[t.c] != none;
  };
  for (const std::uint32_t i : select_where(with_items.size(), on_rims)) {
    const Triangle& t = with_items[i];
    std::array<std::uint32_t, 3> c = {items.particle[t.a], items.particle[t.b], items.particle[t.c]};
    std::sort(c.begin(), c.end());
    corners.push_back({c, i});
  }
  std::sort(corners.begin(), corners.end());
  bool any = false;
  const auto there = [&](std::size_t i) { return made.materials[i][1] != 0; };
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t k = i; k > 0 && corners[k - 1].first == corners[i].first && there(corners[i].second); --k) {
      const std::size_t s = corners[k - 1].second, t = corners[i].second;
      if (!there(s)) continue;
      join_doubles(made.triangles[t], made.materials[t], made.materials[s]);
      made.joined.insert(made.joined.end(), corners[k].first.begin(), corners[k].first.end());
      any = true;
    }
  if (!any) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < made.triangles.size(); ++i)
    if (there(i)) made.triangles[kept] = made.triangles[i], made.materials[kept++] = made.materials[i];
  made.triangles.resize(kept), made.materials.resize(kept);
}

/// Items on the surfaces of materials that have no triangle.
std::vector<std::uint32_t> of_lost_materials(const StarItems& items, const StarMesh& made) {
  std::vector<std::uint8_t> there(0x10000, 0);
  for (const auto& [low, high] : made.materials) there[low] = there[high] = 1;
  std::vector<std::uint32_t> lost;
  for (std::uint32_t s = 0; s < items.materials.size(); ++s)
    if (!there[items.materials[s][0]] || !there[items.materials[s][1]])
      for (std::uint32_t i = items.first[s]; i < items.first[s + 1]; ++i) lost.push_back(i);
  return lost;
}

}  // namespace

StarMesh mesh_from_stars(const StarParticles& particles, StarFinder& finder) {
  StarMesh made;
  finder.find(star_items(particles));
  const StarItems& items = finder.items();
  const std::vector<Star>& stars = finder.stars();
  made.counts.stars = std::int64_t(items.count());
  made.unsettled = items.broken;
  const auto unsettle = [&](std::span<const std::uint32_t> some) {
    for (const std::uint32_t i : some) made.unsettled.push_back(items.particle[i]);
  };
  Agreed found = find_agreed(items, stars);
  made.counts.unsettled = found.unsettled;
  StarFilling filling = fill_holes(finder, std::move(found.incomplete));
  made.counts.holes = filling.holes;
  made.counts.filled = std::int64_t(filling.triangles.size());
  unsettle(filling.unsettled);
  for (const std::uint32_t i : filling.around) made.joined.push_back(items.particle[i]);

  std::vector<Triangle>& triangles = found.triangles;
  if (!filling.opened.empty()) {
    std::vector<std::uint8_t> opened(items.count(), 0);
    for (const std::uint32_t i : filling.opened) opened[i] = 1;
    std::erase_if(triangles, [&](const Triangle& t) { return opened[t.a] || opened[t.b] || opened[t.c]; });
  }
  triangles.insert(triangles.end(), filling.triangles.begin(), filling.triangles.end());
  exchange_shared_chords(items, triangles);

  made.triangles.resize(triangles.size());
  made.materials.resize(triangles.size());
  tbb::parallel_for(std::size_t(0), triangles.size(), [&](std::size_t i) {
    const Triangle& t = triangles[i];
    made.triangles[i] = {items.particle[t.a], items.particle[t.b], items.particle[t.c]};
    made.materials[i] = items.materials[items.surface[t.a]];
  });
  remove_doubles(items, triangles, made);
  unsettle(of_lost_materials(items, made));
  const std::vector<std::uint32_t> shared = at_shared_chords(items, triangles);
  made.unsettled.insert(made.unsettled.end(), shared.begin(), shared.end());
  std::sort(made.unsettled.begin(), made.unsettled.end());
  made.unsettled.erase(std::unique(made.unsettled.begin(), made.unsettled.end()), made.unsettled.end());
  std::vector<std::uint8_t> used(particles.count(), 0);
  for (const Triangle& t : made.triangles)
    for (int k = 0; k < 3; ++k) used[t[k]] = 1;
  made.counts.left_out = std::count(used.begin(), used.end(), 0);
  return made;
}

}  // namespace nacre
