// Nacre: stars that disagree about a quadrilateral decide it by one rule.
#pragma once

#include <cstdint>

#include "compute/meshing/star.hpp"

namespace nacre {

namespace detail {

/// An angle from 0 to 360 degrees as a direction in the plane, of any length.
struct TurnedAngle {
  double cosine, sine;
  NACRE_HD TurnedAngle(double c, double s) : cosine(c), sine(s) {}
  /// Between two directions.
  NACRE_HD TurnedAngle(const Vec3d& u, const Vec3d& v) : cosine(dot(u, v)), sine(length(cross(u, v))) {}
  friend NACRE_HD TurnedAngle operator+(const TurnedAngle& a, const TurnedAngle& b) {
    return {a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
  }
  friend NACRE_HD bool operator>=(const TurnedAngle& a, const TurnedAngle& b) {
    if ((a.sine < 0) != (b.sine < 0)) return a.sine < 0;
    return b.cosine * a.sine - b.sine * a.cosine >= 0;
  }
};

}  // namespace detail

/// Four items in their order around a quadrilateral.
struct FourItems {
  std::uint32_t item[4];
};

/// Which diagonal divides a quadrilateral: true for the one from item 0 to item 2. An edge of a rim is always kept;
/// else the diagonal is the one whose ends have the larger sum of angles, which in a plane is Delaunay's. Ties go to
/// the diagonal with the lowest particle. The answer does not depend on the corner that is named first, nor on the
/// direction around.
NACRE_HD inline bool takes_first_diagonal(const StarItemsView& items, const FourItems& corners) {
  const std::uint32_t* c = corners.item;
  if (items.are_on_rim(c[0], c[2])) return true;
  if (items.are_on_rim(c[1], c[3])) return false;
  // Sums begin at the same corner, and go the same way around, whoever asks: rounding is then the same, too.
  int low = 0;
  for (int k = 1; k < 4; ++k)
    if (items.particle[c[k]] < items.particle[c[low]]) low = k;
  const int step = items.particle[c[(low + 1) % 4]] < items.particle[c[(low + 3) % 4]] ? 1 : 3;
  const auto angle = [&](int k) {
    const int at = low + k * step;
    const Vec3d here = items.position[c[at % 4]];
    return detail::TurnedAngle(items.position[c[(at + step) % 4]] - here,
                               items.position[c[(at + 4 - step) % 4]] - here);
  };
  const bool from_low = angle(0) + angle(2) >= angle(1) + angle(3);
  return from_low == (low % 2 == 0);
}

namespace detail {

/// What one star changes in a round: where it and another lay different triangles on an edge, the four corners are a
/// quadrilateral, and each of the four stars takes the diagonal of the rule.
class StarSettler {
 public:
  NACRE_HD StarSettler(const StarItemsView& items, const Star* stars, std::uint32_t item)
      : items_(items), stars_(stars), item_(item), star_(stars[item]) {
    for (std::uint32_t& q : fresh_) q = none;
  }

  /// False where nothing changes.
  NACRE_HD bool run(Star& changed) {
    for (int k = 0; k < star_.count; ++k) {
      if (!star_.has_triangle(k) || (star_.agreed >> k & 1)) continue;
      const std::uint32_t a = star_.ring[k], b = star_.ring[star_.after(k)];
      consider(k, a, b, stars_[a].right_of(item_), true);
      consider(k, a, b, stars_[b].left_of(item_), false);
    }
    return (leave_ || any_new_) && rebuild(changed);
  }

 private:
  /// Triangle k of this star, (item, a, b), where the star of a (or else b) has `other` in place of the third corner.
  NACRE_HD void consider(int k, std::uint32_t a, std::uint32_t b, std::uint32_t other, bool of_a) {
    if (other == none || other == a || other == b || other == item_) return;
    if (lies_between(a, b, other)) {
      if (takes_first_diagonal(items_, {{item_, a, other, b}})) add(k, other);
    } else if (of_a) {
      if (!takes_first_diagonal(items_, {{item_, a, b, other}})) leave(star_.after(k));
    } else if (!takes_first_diagonal(items_, {{item_, other, a, b}})) {
      leave(k);
    }
  }

  NACRE_HD bool lies_between(std::uint32_t a, std::uint32_t b, std::uint32_t other) const {
    const Vec3d here = items_.position[item_], r = items_.position[other] - here, n = items_.normal[item_];
    return dot(n, cross(items_.position[a] - here, r)) > 0 && dot(n, cross(r, items_.position[b] - here)) > 0;
  }

  NACRE_HD void add(int k, std::uint32_t other) {
    if (star_.position_of(other) >= 0) return;
    for (const std::uint32_t q : fresh_)
      if (q == other) return;  // another side takes it: it is in the ring once
    if (fresh_[k] == none || other < fresh_[k]) fresh_[k] = other;
    any_new_ = true;
  }

  NACRE_HD void leave(int k) {
    if (!items_.are_on_rim(item_, star_.ring[k])) leave_ |= 1u << k;
  }

  NACRE_HD bool rebuild(Star& changed) const {
    changed = Star();
    changed.closed = star_.closed;
    int count = 0;
    const auto put = [&](std::uint32_t q) {
      if (count < Star::most) changed.ring[count] = q;
      ++count;
    };
    for (int k = 0; k < star_.count; ++k) {
      if (!(leave_ >> k & 1)) put(star_.ring[k]);
      if (fresh_[k] != none) put(fresh_[k]);
      if (star_.gaps >> k & 1 && count > 0 && count <= Star::most) changed.gaps |= 1u << (count - 1);
    }
    changed.count = std::uint8_t(count);
    return count <= Star::most && count >= (star_.closed ? 3 : 2);
  }

  const StarItemsView& items_;
  const Star* stars_;
  std::uint32_t item_;
  const Star& star_;
  std::uint32_t leave_ = 0;          // bit k: ring[k] goes
  std::uint32_t fresh_[Star::most];  // comes behind ring[k]
  bool any_new_ = false;
};

}  // namespace detail
}  // namespace nacre
