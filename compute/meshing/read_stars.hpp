// Nacre: what settled stars agree on, read off on a device.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/list_where.hpp"
#include "compute/meshing/star_device.hpp"

namespace nacre {

namespace detail {

/// The triangles that all corners agree on, each of its smallest item: counted, or written.
struct ReadAgreed {
  StarItemsView items;
  const MaterialPair* of_surface;
  const Star* star;
  std::uint32_t* first;      // per item: how many it has; if they are written, where they begin
  std::uint32_t* first_rim;  // the same of those between rims
  Triangle* triangle;        // null: they are counted
  MaterialPair* materials;
  RimTriangle* between_rims;
  NACRE_HD void operator()(std::int64_t n) const {
    const auto i = std::uint32_t(n);
    const Star& mine = star[i];
    std::uint32_t at = triangle ? first[i] : 0, rim_at = triangle ? first_rim[i] : 0;
    for (int k = 0; k < mine.count; ++k) {
      if (!(mine.agreed >> k & 1)) continue;
      const std::uint32_t a = mine.ring[k], b = mine.ring[mine.after(k)];
      if (i > a || i > b) continue;
      const bool between = items.between_rims({i, a, b});
      if (triangle) {
        triangle[at] = {items.particle[i], items.particle[a], items.particle[b]};
        materials[at] = of_surface[items.surface[i]];
        if (between) between_rims[rim_at] = {at, {i, a, b}};
      }
      ++at, rim_at += between;
    }
    if (!triangle) first[i] = at, first_rim[i] = rim_at;
  }
};

struct IsIncomplete {
  StarItemsView items;
  const Star* star;
  NACRE_HD bool operator()(std::int64_t i) const { return is_incomplete(items, star[i], std::uint32_t(i)); }
};

struct IsUnsettled {
  StarItemsView items;
  const Star* star;
  const std::uint32_t* item;
  NACRE_HD std::int64_t operator()(std::int64_t k) const { return is_unsettled(items, star[item[k]], item[k]); }
};

template <class Backend>
void read_agreed(Executor<Backend>& exec, const StarItemsView& items, const std::vector<MaterialPair>& materials,
                 const Star* star, std::int64_t n, AgreedTriangles& agreed) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  auto of_surface = arena.template temporary<MaterialPair>(materials.size());
  of_surface.upload(materials);
  const auto first = arena.template temporary<std::uint32_t>(std::size_t(n));
  const auto first_rim = arena.template temporary<std::uint32_t>(std::size_t(n));
  ReadAgreed read{items, of_surface.data(), star, first.data(), first_rim.data(), nullptr, nullptr, nullptr};
  exec.for_each(n, read);
  const std::uint32_t triangles = exec.exclusive_scan(first.data(), first.data(), n);
  const std::uint32_t between = exec.exclusive_scan(first_rim.data(), first_rim.data(), n);
  const auto triangle = arena.template temporary<Triangle>(triangles);
  const auto its_materials = arena.template temporary<MaterialPair>(triangles);
  const auto between_rims = arena.template temporary<RimTriangle>(between);
  read.triangle = triangle.data(), read.materials = its_materials.data(), read.between_rims = between_rims.data();
  if (triangles > 0) exec.for_each(n, read);
  agreed = {triangle.download(), its_materials.download(), between_rims.download()};
}

}  // namespace detail

/// Reads the stars of `n` items on surfaces between these `materials`.
template <class Backend>
void read_stars(Executor<Backend>& exec, const StarItemsView& items, const std::vector<MaterialPair>& materials,
                const Star* star, std::int64_t n, FoundStars& found) {
  Arena::Scope scope(exec.arena());
  detail::read_agreed(exec, items, materials, star, n, found.agreed);
  const Array<std::uint32_t> incomplete = list_where(exec, n, detail::IsIncomplete{items, star});
  found.unsettled = exec.reduce(std::int64_t(incomplete.size()), std::int64_t(0),
                                detail::IsUnsettled{items, star, incomplete.data()}, Add{});
  found.incomplete = incomplete.download();
}

}  // namespace nacre
