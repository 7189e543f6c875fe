// Nacre: the triangles between materials, read off from the particles themselves.
#include "compute/meshing/star_mesh.hpp"

#include <algorithm>
#include <array>
#include <ranges>
#include <span>
#include <utility>

#include "compute/math/sort_unique.hpp"
#include "compute/meshing/incidence.hpp"
#include "compute/meshing/star_chords.hpp"
#include "compute/meshing/star_filling.hpp"

namespace nacre {
namespace {

constexpr MaterialPair no_materials = {0, 0};  // of triangles that are to go

bool is_gone(const StarMesh& mesh, std::size_t triangle) { return mesh.materials[triangle] == no_materials; }

Triangle particles_of(const StarItems& items, const Triangle& t) {
  return {items.particle[t.a], items.particle[t.b], items.particle[t.c]};
}

/// Marks triangles that are not agreed on any more; their corners are items, the smallest one first.
void mark_removed(const StarItems& items, std::span<const Triangle> removed, StarMesh& made) {
  const auto numbers = std::views::iota(std::size_t(0), made.triangles.size());
  const auto place_of = [&](std::size_t i) { return std::pair(made.materials[i], made.triangles[i].a); };
  std::vector<std::size_t> gone;
  for (const Triangle& t : removed) {
    const Triangle particles = particles_of(items, t);
    const std::pair place(items.materials[items.surface[t.a]], particles.a);
    for (const std::size_t i : std::ranges::equal_range(numbers, place, {}, place_of))
      if (made.triangles[i] == particles) gone.push_back(i);
  }
  for (const std::size_t i : gone) made.materials[i] = no_materials;
}

/// Adds triangles that have items for corners.
void append(const StarItems& items, std::span<const Triangle> more, StarMesh& made,
            std::vector<RimTriangle>& between_rims) {
  const StarItemsView view = items.view();
  for (const Triangle& t : more) {
    if (view.between_rims(t)) between_rims.push_back({std::uint32_t(made.triangles.size()), t});
    made.triangles.push_back(particles_of(items, t));
    made.materials.push_back(items.materials[items.surface[t.a]]);
  }
}

/// Of two triangles with the same corners, what is left without the material between them: one triangle or, where the
/// same material is on both outer sides, none. Both are used up, the first one for what is left.
void join_doubles(Triangle& first, MaterialPair& first_materials, MaterialPair& second_materials) {
  const auto [low, high] = first_materials;
  const bool low_between = low == second_materials[0] || low == second_materials[1];
  const std::uint16_t between = low_between ? low : high;
  const std::uint16_t beyond = second_materials[0] == between ? second_materials[1] : second_materials[0];
  MaterialPair left = {low_between ? beyond : low, low_between ? high : beyond};
  if (left[0] > left[1]) std::swap(left[0], left[1]), std::swap(first.b, first.c);
  const bool gone = first_materials == second_materials;
  first_materials = gone ? no_materials : left;
  second_materials = no_materials;
}

/// A material that is no thicker than one triangle is taken away there: two surfaces that have it on one of their sides
/// would have the same corners, all of which are on rims.
void join_all_doubles(const StarItems& items, std::span<const RimTriangle> between_rims, StarMesh& made) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> corners;
  for (const auto& [number, t] : between_rims) {
    if (items.next[t.a] == none || items.next[t.b] == none || items.next[t.c] == none) continue;
    std::array<std::uint32_t, 3> c = {items.particle[t.a], items.particle[t.b], items.particle[t.c]};
    std::sort(c.begin(), c.end());
    corners.push_back({c, number});
  }
  std::sort(corners.begin(), corners.end());
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t k = i; k > 0 && corners[k - 1].first == corners[i].first && !is_gone(made, corners[i].second);
         --k) {
      const std::size_t s = corners[k - 1].second, t = corners[i].second;
      if (is_gone(made, s)) continue;
      join_doubles(made.triangles[t], made.materials[t], made.materials[s]);
      made.joined.insert(made.joined.end(), corners[k].first.begin(), corners[k].first.end());
    }
}

void drop_gone(StarMesh& made) {
  std::size_t kept = 0;
  while (kept < made.triangles.size() && !is_gone(made, kept)) ++kept;
  for (std::size_t i = kept; i < made.triangles.size(); ++i)
    if (!is_gone(made, i)) made.triangles[kept] = made.triangles[i], made.materials[kept++] = made.materials[i];
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

StarMesh mesh_from_stars(const StarParticles& particles, StarDevice& device) {
  StarMesh made;
  FoundStars& found = device.find(particles);
  const StarItems& items = found.items;
  made.counts.stars = std::int64_t(items.count());
  made.counts.cut = found.cut;
  made.unsettled = items.broken;
  const auto unsettle = [&](std::span<const std::uint32_t> some) {
    for (const std::uint32_t i : some) made.unsettled.push_back(items.particle[i]);
  };
  made.counts.unsettled = found.unsettled;
  StarOpenings openings(found.stars);
  const StarFilling filling = fill_holes(found, openings);
  made.counts.holes = filling.holes;
  made.counts.filled = std::int64_t(filling.triangles.size());
  unsettle(filling.unsettled);
  for (const std::uint32_t i : filling.around) made.joined.push_back(items.particle[i]);

  made.triangles = std::move(found.agreed.triangles), made.materials = std::move(found.agreed.materials);
  std::vector<RimTriangle>& between_rims = found.agreed.between_rims;
  mark_removed(items, filling.removed, made);
  std::erase_if(between_rims, [&](const RimTriangle& t) { return is_gone(made, t.number); });
  append(items, filling.triangles, made, between_rims);
  for (const std::uint32_t k : exchange_shared_chords(items, found.stars, filling.triangles, between_rims)) {
    const auto& [number, t] = between_rims[k];
    made.triangles[number] = particles_of(items, t);
  }
  join_all_doubles(items, between_rims, made);
  drop_gone(made);
  unsettle(of_lost_materials(items, made));
  const std::vector<std::uint32_t> shared = at_shared_chords(items, between_rims);
  made.unsettled.insert(made.unsettled.end(), shared.begin(), shared.end());
  sort_unique(made.unsettled);
  const std::vector<std::uint8_t> used = mark_corners(made.triangles, particles.count());
  made.counts.left_out = std::count(used.begin(), used.end(), 0);
  return made;
}

}  // namespace nacre
