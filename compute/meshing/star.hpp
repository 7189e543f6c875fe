// Nacre: the neighbours of a particle on one of its surfaces, and what is read to find them.
#pragma once

#include <cstdint>

#include "compute/math/vec.hpp"

namespace nacre {

/// StarItems as kernels read them; all pointers have an entry for each item but `first`.
struct StarItemsView {
  const Vec3d* position = nullptr;
  const Vec3d* normal = nullptr;
  const double* size = nullptr;
  const std::uint32_t* particle = nullptr;
  const std::uint32_t* surface = nullptr;
  const std::uint32_t* next = nullptr;
  const std::uint32_t* previous = nullptr;
  const std::uint32_t* first = nullptr;  ///< per surface and one more

  /// Whether two items follow each other on a rim.
  NACRE_HD bool on_rim(std::uint32_t i) const { return next[i] != none; }
  /// Whether two corners of a triangle or more are on rims.
  NACRE_HD bool between_rims(const Triangle& t) const {
    return int(on_rim(t.a)) + int(on_rim(t.b)) + int(on_rim(t.c)) > 1;
  }
  NACRE_HD bool are_on_rim(std::uint32_t a, std::uint32_t b) const { return next[a] == b || previous[a] == b; }
};

/// The neighbours of one item, counter-clockwise: those whose bisecting planes bound its Voronoi cell in the tangent
/// plane. On a rim from the next item of the rim to the previous one, else closed.
struct Star {
  static constexpr int most = 20;
  std::uint32_t ring[most];
  std::uint8_t count = 0;
  bool closed = false;
  bool hidden = false;       ///< another item has the same position; it has no neighbours
  float reach = 0;           ///< nothing farther away was looked at, the items beside it on a rim excepted
  std::uint32_t gaps = 0;    ///< bit k: ring[k] and the one after it are no neighbours of each other
  std::uint32_t agreed = 0;  ///< bit k: triangle (item, ring[k], the one after it) is in the stars of all its corners

  NACRE_HD int after(int k) const { return k + 1 == count ? 0 : k + 1; }
  /// Whether the triangle to the left of the edge to ring[k] is agreed, or the one to its right.
  NACRE_HD bool is_agreed(int k) const { return agreed >> k & 1; }
  NACRE_HD bool is_agreed_right(int k) const {
    if (k > 0) return is_agreed(k - 1);
    return closed && is_agreed(count - 1);
  }
  NACRE_HD bool has_agreed_edge(std::uint32_t to) const {
    const int k = position_of(to);
    return k >= 0 && (is_agreed(k) || is_agreed_right(k));
  }
  /// Whether a triangle may begin with ring[k].
  NACRE_HD bool has_triangle(int k) const { return !(gaps >> k & 1) && (closed || k + 1 < count) && count > 1; }
  NACRE_HD bool has(std::uint32_t a, std::uint32_t b) const {
    const int k = position_of(a);
    return k >= 0 && has_triangle(k) && ring[after(k)] == b;
  }
  /// Where an item is in the ring; -1 where it is not.
  NACRE_HD int position_of(std::uint32_t item) const {
    for (int k = 0; k < count; ++k)
      if (ring[k] == item) return k;
    return -1;
  }
  /// The third corner of the triangle to the left of the edge to `other`, or to its right; `none` where there is none.
  NACRE_HD std::uint32_t left_of(std::uint32_t other) const {
    const int k = position_of(other);
    return k >= 0 && has_triangle(k) ? ring[after(k)] : none;
  }
  NACRE_HD std::uint32_t right_of(std::uint32_t other) const {
    const int k = position_of(other);
    if (k < 0 || (k == 0 && !closed)) return none;
    const int before = k == 0 ? count - 1 : k - 1;
    return has_triangle(before) ? ring[before] : none;
  }
  /// Whether there is a triangle that not all of its corners have.
  NACRE_HD bool has_open() const {
    for (int k = 0; k < count; ++k)
      if (has_triangle(k) && !(agreed >> k & 1)) return true;
    return false;
  }
};

/// Whether an item may be at a hole or within one: it is on a rim, or it has a triangle that is not agreed, or none.
NACRE_HD inline bool is_incomplete(const StarItemsView& items, const Star& star, std::uint32_t i) {
  return items.next[i] != none || star.agreed == 0 || star.agreed != (1u << star.count) - 1;
}

/// Whether a star does not do without a hole: not all its triangles are agreed. One without any does, as that of a
/// particle beyond a rim.
NACRE_HD inline bool is_unsettled(const StarItemsView& items, const Star& star, std::uint32_t i) {
  if (star.count < 2 || (!star.closed && items.next[i] == none)) return true;
  if (star.gaps != 0 && star.agreed == 0) return false;
  for (int k = 0; k < star.count; ++k)
    if ((star.closed || k + 1 < star.count) && !(star.agreed >> k & 1)) return true;
  return false;
}

/// What is to be marked as agreed in `star`, of item i: the triangles that are in the stars of all their corners.
NACRE_HD inline std::uint32_t agreed_on(const Star* stars, std::uint32_t i, const Star& star) {
  std::uint32_t mine = 0, by_first = 0, by_second = 0;  // who has triangle k: this star, those of its other corners
  for (int k = 0; k < star.count; ++k) {
    if (star.has_triangle(k)) mine |= 1u << k;
    const Star& other = stars[star.ring[k]];
    const int at = other.position_of(i);
    if (at < 0) continue;
    // On a rim of two this item is the other's next and its previous one: triangles end at the latter.
    const bool twice = !other.closed && other.ring[other.count - 1] == i;
    const int end = twice ? other.count - 1 : at;
    const int before = end == 0 ? other.count - 1 : end - 1, k_before = k == 0 ? star.count - 1 : k - 1;
    if (other.has_triangle(before) && other.ring[before] == star.ring[star.after(k)]) by_first |= 1u << k;
    if (other.has_triangle(at) && other.ring[other.after(at)] == star.ring[k_before]) by_second |= 1u << k_before;
  }
  return mine & by_first & by_second;
}

}  // namespace nacre
