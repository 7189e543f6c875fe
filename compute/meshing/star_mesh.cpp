// Nacre: the triangles between materials, read off from the particles themselves.
#include "compute/meshing/star_mesh.hpp"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <tuple>

#include "compute/meshing/incidence.hpp"
#include "compute/meshing/star_chords.hpp"
#include "compute/meshing/star_filling.hpp"

namespace nacre {
namespace {

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
void remove_doubles(const StarItems& items, const std::vector<Triangle>& with_items,
                    std::span<const std::uint32_t> between_rims, StarMesh& made) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::size_t>> corners;
  for (const std::uint32_t i : between_rims) {
    const Triangle& t = with_items[i];
    if (items.next[t.a] == none || items.next[t.b] == none || items.next[t.c] == none) continue;
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
  finder.find(particles);
  const StarItems& items = finder.items();
  made.counts.stars = std::int64_t(items.count());
  made.unsettled = items.broken;
  const auto unsettle = [&](std::span<const std::uint32_t> some) {
    for (const std::uint32_t i : some) made.unsettled.push_back(items.particle[i]);
  };
  made.counts.unsettled = finder.found().unsettled;
  StarFilling filling = fill_holes(finder, finder.found().incomplete);
  made.counts.holes = filling.holes;
  made.counts.filled = std::int64_t(filling.triangles.size());
  unsettle(filling.unsettled);
  for (const std::uint32_t i : filling.around) made.joined.push_back(items.particle[i]);

  std::vector<Triangle> triangles = finder.take_agreed();
  if (!filling.opened.empty()) {
    std::vector<std::uint8_t> opened(items.count(), 0);
    for (const std::uint32_t i : filling.opened) opened[i] = 1;
    std::erase_if(triangles, [&](const Triangle& t) { return opened[t.a] || opened[t.b] || opened[t.c]; });
  }
  triangles.insert(triangles.end(), filling.triangles.begin(), filling.triangles.end());
  const std::vector<std::uint32_t> between_rims = triangles_between_rims(items, triangles);
  exchange_shared_chords(items, between_rims, triangles);

  made.triangles.resize(triangles.size());
  made.materials.resize(triangles.size());
  tbb::parallel_for(std::size_t(0), triangles.size(), [&](std::size_t i) {
    const Triangle& t = triangles[i];
    made.triangles[i] = {items.particle[t.a], items.particle[t.b], items.particle[t.c]};
    made.materials[i] = items.materials[items.surface[t.a]];
  });
  remove_doubles(items, triangles, between_rims, made);
  unsettle(of_lost_materials(items, made));
  const std::vector<std::uint32_t> shared = at_shared_chords(items, triangles, between_rims);
  made.unsettled.insert(made.unsettled.end(), shared.begin(), shared.end());
  std::sort(made.unsettled.begin(), made.unsettled.end());
  made.unsettled.erase(std::unique(made.unsettled.begin(), made.unsettled.end()), made.unsettled.end());
  const std::vector<std::uint8_t> used = mark_corners(made.triangles, particles.count());
  made.counts.left_out = std::count(used.begin(), used.end(), 0);
  return made;
}

}  // namespace nacre
