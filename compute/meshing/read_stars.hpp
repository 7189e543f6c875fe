// Nacre: what settled stars agree on, read off on a device.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/list_where.hpp"
#include "compute/meshing/star_device.hpp"

namespace nacre {

namespace detail {

/// The triangles that all corners agree on, each of its smallest item: counted, or written.
struct AgreedTriangles {
  const Star* star;
  std::uint32_t* first;  // per item: how many it has; if they are written, where they begin
  Triangle* triangle;    // null: they are counted
  NACRE_HD void operator()(std::int64_t n) const {
    const auto i = std::uint32_t(n);
    const Star& mine = star[i];
    std::uint32_t at = triangle ? first[i] : 0;
    for (int k = 0; k < mine.count; ++k) {
      if (!(mine.agreed >> k & 1)) continue;
      const std::uint32_t a = mine.ring[k], b = mine.ring[mine.after(k)];
      if (i > a || i > b) continue;
      if (triangle) triangle[at] = {i, a, b};
      ++at;
    }
    if (!triangle) first[i] = at;
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

}  // namespace detail

/// Reads the stars of `n` items into `found`.
template <class Backend>
void read_stars(Executor<Backend>& exec, const StarItemsView& items, const Star* star, std::int64_t n,
                FoundStars& found) {
  Arena::Scope scope(exec.arena());
  const auto first = exec.arena().template temporary<std::uint32_t>(std::size_t(n));
  exec.for_each(n, detail::AgreedTriangles{star, first.data(), nullptr});
  const std::uint32_t triangles = exec.exclusive_scan(first.data(), first.data(), n);
  const auto triangle = exec.arena().template temporary<Triangle>(triangles);
  exec.for_each(n, detail::AgreedTriangles{star, first.data(), triangle.data()});
  found.agreed = triangle.download();
  const Array<std::uint32_t> incomplete = list_where(exec, n, detail::IsIncomplete{items, star});
  found.unsettled = exec.reduce(std::int64_t(incomplete.size()), std::int64_t(0),
                                detail::IsUnsettled{items, star, incomplete.data()}, Add{});
  found.incomplete = incomplete.download();
}

}  // namespace nacre
