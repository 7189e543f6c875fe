// Nacre: agreed triangles that are taken back.
#include "compute/meshing/star_openings.hpp"

#include <algorithm>

namespace nacre {
namespace {

Triangle smallest_first(Triangle t) {
  const std::uint32_t smallest = std::min({t.a, t.b, t.c});
  while (t.a != smallest) t = {t.b, t.c, t.a};
  return t;
}

}  // namespace

std::vector<std::uint32_t> StarOpenings::open(std::span<const std::uint32_t> some) {
  std::vector<std::uint32_t> changed;
  const auto forget = [&](std::uint32_t item, std::uint32_t from, std::uint32_t to) {
    Star& star = stars_[item];
    for (int k = 0; k < star.count; ++k) {
      if (star.ring[k] != from || star.ring[star.after(k)] != to || !star.is_agreed(k)) continue;
      opened_.push_back({item, star.agreed});
      changed.push_back(item);
      star.agreed &= ~(1u << k);
    }
  };
  for (const std::uint32_t i : some) {
    const Star star = stars_[i];
    for (int k = 0; k < star.count; ++k) {
      if (!star.is_agreed(k)) continue;
      const std::uint32_t a = star.ring[k], b = star.ring[star.after(k)];
      forget(i, a, b), forget(a, b, i), forget(b, i, a);
      removed_.push_back(smallest_first({i, a, b}));
    }
  }
  return changed;
}

void StarOpenings::close() {
  for (; !opened_.empty(); opened_.pop_back()) stars_[opened_.back().first].agreed = opened_.back().second;
  removed_.clear();
}

}  // namespace nacre
