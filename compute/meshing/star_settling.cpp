// Nacre: stars that disagree about a quadrilateral decide it by one rule.
#include "compute/meshing/star_settling.hpp"

#include <algorithm>
#include <cmath>

#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr int settling_rounds = 6;

/// An angle from 0 to 360 degrees as a direction in the plane, of any length.
struct Angle {
  double cosine, sine;
  /// Between two directions.
  Angle(const Vec3d& u, const Vec3d& v) : cosine(dot(u, v)), sine(length(cross(u, v))) {}
  Angle(double c, double s) : cosine(c), sine(s) {}
  friend Angle operator+(const Angle& a, const Angle& b) {
    return {a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
  }
  friend bool operator>=(const Angle& a, const Angle& b) {
    if ((a.sine < 0) != (b.sine < 0)) return a.sine < 0;
    return b.cosine * a.sine - b.sine * a.cosine >= 0;
  }
};

bool are_on_rim(const StarItems& items, std::uint32_t a, std::uint32_t b) {
  return items.next[a] == b || items.previous[a] == b;
}

int position_of(const Star& star, std::uint32_t item) {
  for (int k = 0; k < star.count; ++k)
    if (star.ring[std::size_t(k)] == item) return k;
  return -1;
}

/// The third corner of the triangle that `star` has to the left of the edge from its item to `other`, or to its right;
/// `none` where it has none.
std::uint32_t left_of(const Star& star, std::uint32_t other) {
  const int k = position_of(star, other);
  return k >= 0 && star.has_triangle(k) ? star.ring[std::size_t(star.after(k))] : none;
}
std::uint32_t right_of(const Star& star, std::uint32_t other) {
  const int k = position_of(star, other);
  if (k < 0 || (k == 0 && !star.closed)) return none;
  const int before = k == 0 ? star.count - 1 : k - 1;
  return star.has_triangle(before) ? star.ring[std::size_t(before)] : none;
}

/// What one star changes in a round.
class Settler {
 public:
  Settler(const StarItems& items, const std::vector<Star>& stars, std::uint32_t item)
      : items_(items), stars_(stars), item_(item), star_(stars[item]) {}

  /// False where nothing changes.
  bool run(Star& changed) {
    for (int k = 0; k < star_.count; ++k) {
      if (!star_.has_triangle(k) || (star_.agreed >> k & 1)) continue;
      const std::uint32_t a = star_.ring[std::size_t(k)], b = star_.ring[std::size_t(star_.after(k))];
      consider(k, a, b, right_of(stars_[a], item_), true);
      consider(k, a, b, left_of(stars_[b], item_), false);
    }
    return (leave_ || any_new_) && rebuild(changed);
  }

 private:
  /// Triangle k of this star, (item, a, b), where the star of a (or else b) has `other` in place of the third corner.
  void consider(int k, std::uint32_t a, std::uint32_t b, std::uint32_t other, bool of_a) {
    if (other == none || other == a || other == b || other == item_) return;
    if (lies_between(a, b, other)) {
      if (takes_first_diagonal(items_, {item_, a, other, b})) add(k, other);
    } else if (of_a) {
      if (!takes_first_diagonal(items_, {item_, a, b, other})) leave(star_.after(k));
    } else if (!takes_first_diagonal(items_, {item_, other, a, b})) {
      leave(k);
    }
  }

  bool lies_between(std::uint32_t a, std::uint32_t b, std::uint32_t other) const {
    const Vec3d here = items_.position[item_], r = items_.position[other] - here, n = items_.normal[item_];
    return dot(n, cross(items_.position[a] - here, r)) > 0 && dot(n, cross(r, items_.position[b] - here)) > 0;
  }

  void add(int k, std::uint32_t other) {
    if (position_of(star_, other) >= 0) return;
    std::uint32_t& position = fresh_[std::size_t(k)];
    if (position == none || other < position) position = other;
    any_new_ = true;
  }

  void leave(int k) {
    if (!are_on_rim(items_, item_, star_.ring[std::size_t(k)])) leave_ |= 1u << k;
  }

  bool rebuild(Star& changed) const {
    changed = Star();
    changed.closed = star_.closed;
    const auto put = [&](std::uint32_t q) {
      if (changed.count < Star::most) changed.ring[changed.count] = q;
      ++changed.count;
    };
    for (int k = 0; k < star_.count; ++k) {
      const bool stays = !(leave_ >> k & 1);
      if (stays) put(star_.ring[std::size_t(k)]);
      if (const std::uint32_t q = fresh_[std::size_t(k)]; q != none) put(q);
      if (star_.gaps >> k & 1 && changed.count > 0 && changed.count <= Star::most)
        changed.gaps |= 1u << (changed.count - 1);
    }
    return changed.count <= Star::most && changed.count >= (star_.closed ? 3 : 2);
  }

  const StarItems& items_;
  const std::vector<Star>& stars_;
  std::uint32_t item_;
  const Star& star_;
  std::uint32_t leave_ = 0;  // bit k: ring[k] goes
  bool any_new_ = false;
  std::array<std::uint32_t, Star::most> fresh_ = [] {  // comes behind ring[k]
    std::array<std::uint32_t, Star::most> all;
    all.fill(none);
    return all;
  }();
};

}  // namespace

bool takes_first_diagonal(const StarItems& items, const std::array<std::uint32_t, 4>& corners) {
  if (are_on_rim(items, corners[0], corners[2])) return true;
  if (are_on_rim(items, corners[1], corners[3])) return false;
  // Sums begin at the same corner, and go the same way around, whoever asks: rounding is then the same, too.
  std::size_t low = 0;
  for (std::size_t k = 1; k < 4; ++k)
    if (items.particle[corners[k]] < items.particle[corners[low]]) low = k;
  const bool along = items.particle[corners[(low + 1) % 4]] < items.particle[corners[(low + 3) % 4]];
  const std::size_t step = along ? 1 : 3;
  const auto angle = [&](std::size_t k) {
    const std::size_t at = low + k * step;
    const Vec3d here = items.position[corners[at % 4]];
    return Angle(items.position[corners[(at + step) % 4]] - here, items.position[corners[(at + 4 - step) % 4]] - here);
  };
  const bool from_low = angle(0) + angle(2) >= angle(1) + angle(3);
  return from_low == (low % 2 == 0);
}

std::uint32_t agreed_on(const std::vector<Star>& stars, std::uint32_t i, const Star& star) {
  std::uint32_t agreed = 0;
  for (int k = 0; k < star.count; ++k) {
    if (!star.has_triangle(k)) continue;
    const std::uint32_t a = star.ring[std::size_t(k)], b = star.ring[std::size_t(star.after(k))];
    if (stars[a].has(b, i) && stars[b].has(i, a)) agreed |= 1u << k;
  }
  return agreed;
}

bool has_open(const Star& star) {
  for (int k = 0; k < star.count; ++k)
    if (star.has_triangle(k) && !(star.agreed >> k & 1)) return true;
  return false;
}

std::vector<std::pair<std::uint32_t, Star>> settle_stars(const StarItems& items, std::vector<Star>& stars,
                                                         std::vector<std::uint32_t> open) {
  std::vector<std::pair<std::uint32_t, Star>> before;
  std::vector<std::uint8_t> kept(stars.size(), 0), concerned(stars.size(), 0), news(stars.size(), 1);
  const auto keep = [&](std::uint32_t i) {
    if (!kept[i]) before.push_back({i, stars[i]});
    kept[i] = 1;
  };
  std::vector<Star> changed;
  for (int round = 0; round < settling_rounds && !open.empty(); ++round) {
    changed.resize(open.size());
    const std::vector<std::uint32_t> changes = select_where(
        open.size(),
        [&](std::size_t k) {
          // A star that knows nothing new decides as it did.
          const Star& star = stars[open[k]];
          const bool asks = news[open[k]] || std::any_of(star.ring.begin(), star.ring.begin() + star.count,
                                                         [&](std::uint32_t r) { return news[r] != 0; });
          return asks && Settler(items, stars, open[k]).run(changed[k]);
        },
        64);
    if (changes.empty()) break;
    std::fill(concerned.begin(), concerned.end(), 0);
    std::fill(news.begin(), news.end(), 0);
    for (const std::uint32_t i : open) concerned[i] = 1;
    for (const std::uint32_t k : changes) {
      news[open[k]] = 1;
      for (const Star* star : {&stars[open[k]], &changed[k]})
        for (int r = 0; r < star->count; ++r) concerned[star->ring[std::size_t(r)]] = 1;
    }
    const std::vector<std::uint32_t> touched =
        select_where(stars.size(), [&](std::size_t i) { return concerned[i] != 0; });
    for (const std::uint32_t k : changes) keep(open[k]), stars[open[k]] = changed[k];
    std::vector<std::uint32_t> agreed(touched.size());
    const std::vector<std::uint32_t> differ = select_where(
        touched.size(),
        [&](std::size_t k) {
          const Star& star = stars[touched[k]];
          return (agreed[k] = agreed_on(stars, touched[k], star)) != star.agreed;
        },
        512);
    for (const std::uint32_t k : differ) keep(touched[k]), stars[touched[k]].agreed = agreed[k];
    open = select_where(touched.size(), [&](std::size_t k) { return has_open(stars[touched[k]]); });
    for (std::uint32_t& k : open) k = touched[k];
  }
  return before;
}

}  // namespace nacre
