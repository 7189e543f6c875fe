// Nacre: the sizing field: how far apart particles shall be (Meyer et al. 2007).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "compute/field/distance.hpp"
#include "compute/field/size_limits.hpp"
#include "compute/field/size_slope.hpp"

namespace nacre {

/// What shapes the field; lengths in voxels.
struct SizingRule {
  float epsilon = 0.5f, delta = 0.4f, min_size = 0.5f, max_size = 1;
  bool curvature = false;
  float deviation = 0;   ///< largest distance of triangles from the interface; 0: any
  float detail = 0.25f;  ///< no h is smaller than this for its sake

  /// A triangle of spacing h is k h^2 / 6 from a surface of curvature k at its middle, k h^2 / 8 at those of its edges;
  /// that of a triangle of the usual unevenness is asked to keep the bound.
  static constexpr float flatness = 4.5f;

  /// Whatever the smallest size says: where the medial ball is small, h stays below this share of its radius, or thin
  /// things and small islands would have no particles to stand on; but not below `smallest` voxels.
  static constexpr float resolve = 1.2f, smallest = 0.35f;

  /// h where the medial ball has this radius and the sharpest bend that one; `most`: the largest size there.
  NACRE_HD float size(float feature, float bend, float most) const {
    const float bound = curvature ? min(feature, bend) : feature;
    const float wanted = min(max(epsilon * bound, min_size), most);
    const float usual = min(wanted, max(resolve * feature, smallest));
    return deviation > 0 ? min(usual, max(std::sqrt(flatness * deviation * bend), detail)) : usual;
  }
  /// Radius from which on a medial ball makes no difference.
  float reach() const { return max_size / (min_size < max_size ? min(epsilon, resolve) : resolve); }
  bool operator==(const SizingRule&) const = default;
};

/// The rule with the largest of all sizes as `max_size`: what reaches far enough for each of them.
inline SizingRule widest_rule(SizingRule rule, const std::vector<SizeBound>& bounds,
                              const SizeWishes* wishes = nullptr) {
  if (wishes) rule.max_size = std::max(rule.max_size, wishes->most);
  for (const SizeBound& bound : bounds) rule.max_size = std::max(rule.max_size, bound.size);
  return rule;
}

/// h at a point, trilinear between the centres of a lattice; `far` in cells that are not stored.
struct SizingFieldView {
  TilesView tiles;
  const float* h = nullptr;  ///< per slot
  float far = 0;

  NACRE_HD float at(const Int3& cell) const {
    const std::int64_t slot = tiles.slot(cell);
    return slot < 0 ? far : h[slot];
  }

  NACRE_HD_INLINE float operator()(const Vec3f& p) const {
    const Lattice& lattice = tiles.lattice;
    Int3 first;
    float f[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float u = p[axis] / lattice.spacing[axis] - 0.5f, most = float(lattice.cells[axis]) - 1.001f;
      const float limited = u < 0 ? 0 : u > most ? most : u;
      first[axis] = int(limited);
      f[axis] = limited - float(first[axis]);
    }
    float corner[8];
    corners(first, corner);
    const auto line = [&](const float* a) { return a[0] + (a[1] - a[0]) * f[0]; };
    const float low = line(corner) + (line(corner + 2) - line(corner)) * f[1];
    const float high = line(corner + 4) + (line(corner + 6) - line(corner + 4)) * f[1];
    return low + (high - low) * f[2];
  }

 private:
  /// Of the 2^3 cells from `first` on, x fastest.
  NACRE_HD_INLINE void corners(const Int3& first, float* corner) const {
    constexpr int n = Lattice::tile;
    if (first.x % n + 1 == n || first.y % n + 1 == n || first.z % n + 1 == n) {
      for (int k = 0; k < 8; ++k) corner[k] = at(first + Int3(k & 1, k >> 1 & 1, k >> 2));
      return;
    }
    const std::int64_t slot = tiles.slot(first);
    for (int k = 0; k < 8; ++k) corner[k] = slot < 0 ? far : h[slot + Lattice::place(k & 1, k >> 1 & 1, k >> 2)];
  }
};

namespace detail {

/// The medial axis by shrinking balls (Ma, Bae & Choi 2012): the largest ball that touches the interface at a point and
/// holds no other interface point. Its radius is the distance to the medial axis along the normal; a ball that is
/// stopped by points seen under less than 75 degrees from its centre goes on growing: noise and wide wedges make no
/// medial axis.
struct MedialRadius {
  DistanceFieldView distance;
  float most;       ///< no ball is larger: the field knows what is near the centre of one that large
  float free;       ///< what stands for the radius of one that nothing makes smaller
  float tolerance;  ///< voxels

  NACRE_HD float operator()(const Vec3f& p, const Vec3f& towards) const {
    const float r = shrink(p, towards);
    return r < most ? r : free;
  }

 private:
  NACRE_HD float shrink(const Vec3f& p, const Vec3f& towards) const {
    float r = most;
    for (int k = 0; k < 16; ++k) {
      const Vec3f centre = p + towards * r;
      float d = 0;
      const std::uint32_t q = distance.closest(centre, d);
      if (q == none || d >= r - tolerance) return r;
      const Float4 at = distance.point[q].position;
      const Vec3f to_q = Vec3f(at.x, at.y, at.z) - p;
      const float along = dot(to_q, towards), square = dot(to_q, to_q);
      if (along <= 0.02f || square < 0.05f) return r;
      const float smaller = square / (2 * along);
      const Vec3f c = p + towards * smaller, from_c = Vec3f(at.x, at.y, at.z) - c;
      if (dot(from_c, p - c) > 0.26f * smaller * smaller) return r;  // cos 75 degrees
      if (smaller >= r - 1e-3f) return r;
      r = smaller;
    }
    return r;
  }
};

/// The largest size at an interface point.
struct LargestSize {
  float usual;
  const SizeBound* bound;
  int bounds;
  SizeWishesView wish;

  /// Of several bounds and a wish the smallest holds, whether or not it is below the usual largest size.
  NACRE_HD float operator()(const InterfacePoint& q) const {
    float least = 3e38f;
    if (const float wanted = wish({q.position.x, q.position.y, q.position.z}); wanted > 0) least = wanted;
    for (int b = 0; b < bounds; ++b)
      if (bound[b].holds({q.position.x, q.position.y, q.position.z}, q.surface)) least = min(least, bound[b].size);
    return least < 3e38f ? least : usual;
  }
};

struct SizeAtInterface {
  MedialRadius radius;
  SizingRule rule;
  LargestSize largest;
  float* at_point;
  NACRE_HD void operator()(std::int64_t i) const {
    const InterfacePoint& q = radius.distance.point[i];
    if (q.position.w < 0) {
      at_point[i] = largest.usual;
      return;
    }
    const Vec3f p{q.position.x, q.position.y, q.position.z}, n{q.normal.x, q.normal.y, q.normal.z};
    at_point[i] = rule.size(min(radius(p, n), radius(p, -n)), 1 / max(q.normal.w, 1e-3f), largest(q));
  }
};

/// h at a voxel: that of its closest interface point plus delta times the distance. Beside the interface no more than
/// is the largest there: the distance of a voxel's centre must not make small triangles larger.
struct SpreadSize {
  TilesView tiles;  ///< of h
  DistanceFieldView distance;
  SizingRule rule;  ///< the widest
  LargestSize largest;
  float beside;  ///< voxels
  const float* at_point;
  float* h;
  NACRE_HD void operator()(std::int64_t i) const {
    const Int3 c = tiles.cell(i);
    const std::uint32_t q = tiles.lattice.holds(c) ? distance.at(c) : none;
    if (q == none) {
      h[i] = rule.max_size;
      return;
    }
    const Float4 at = distance.point[q].position;
    const float away = length(Vec3f(at.x, at.y, at.z) - tiles.lattice.centre(c));
    h[i] = min(away < beside ? largest(distance.point[q]) : rule.max_size, at_point[q] + rule.delta * away);
  }
};

struct CountSmaller {
  const float* value;
  float limit;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return value[i] < limit ? 1 : 0; }
};

struct SizeRange {
  float low = 3e38f, high = 0;
};

struct SizeRangeAt {
  const float* value;
  NACRE_HD SizeRange operator()(std::int64_t i) const { return {value[i], value[i]}; }
};

struct JoinSizeRanges {
  NACRE_HD SizeRange operator()(const SizeRange& a, const SizeRange& b) const {
    return {a.low < b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
  }
};

}  // namespace detail

struct SizingField {
  LatticeTiles tiles;
  Array<float> h;                   ///< per slot of the tiles
  float far = 0;                    ///< in all other cells
  float smallest = 0, largest = 0;  ///< on the interfaces
  float small = 1;                  ///< all but a tenth of the interface points have this size or more
  const Lattice& lattice() const { return tiles.lattice; }
  SizingFieldView view() const { return {tiles.view(), h.data(), far}; }
  std::int64_t bytes() const { return std::int64_t(h.bytes()); }
};

namespace detail {

/// What is small among the sizes of the points: see SizingField.
template <class Backend>
void describe_sizes(Executor<Backend>& exec, SizingField& field, const Array<float>& at_point) {
  const auto points = std::int64_t(at_point.size());
  const SizeRange range = exec.reduce(points, SizeRange{}, SizeRangeAt{at_point.data()}, JoinSizeRanges{});
  field.smallest = range.low;
  field.largest = range.high;
  float low = SizingRule::smallest, high = field.far;
  for (int k = 0; k < 10; ++k) {
    const float middle = 0.5f * (low + high);
    const std::uint64_t smaller = exec.reduce(points, std::uint64_t(0), CountSmaller{at_point.data(), middle}, Add{});
    (smaller * 10 > std::uint64_t(points) ? high : low) = middle;
  }
  field.small = low;
}

}  // namespace detail

/// h = epsilon * local feature size on the interfaces, where the local feature size is the radius of the medial ball
/// (with `curvature`: or the smallest radius of curvature), clamped; elsewhere the largest field with slope `delta`. On
/// the lattice of `distance`; a body that its reach does not see across counts as wide. `bounds` hold where they are,
/// in place of the rule's largest size, and so do `wishes` (may be null).
template <class Backend>
SizingField sizing_field(Executor<Backend>& exec, const DistanceField& distance, const SizingRule& rule,
                         const std::vector<SizeBound>& bounds = {}, const SizeWishes* wishes = nullptr) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  const std::int64_t points = std::int64_t(distance.point.size());
  const DistanceFieldView view = distance.view();
  Array<float> at_point = arena.temporary<float>(points);
  const SizingRule widest = widest_rule(rule, bounds, wishes);
  Array<SizeBound> bound = arena.temporary<SizeBound>(std::max<std::size_t>(bounds.size(), 1));
  if (!bounds.empty()) bound.upload(bounds);
  Array<float> wish = arena.temporary<float>(wishes ? wishes->size.size() : 1);
  SizeWishesView wished;
  if (wishes) {
    wish.upload(wishes->size);
    wished = {wishes->dims, wishes->origin, {wishes->row[0], wishes->row[1], wishes->row[2]}, wish.data()};
  }
  const detail::LargestSize largest{rule.max_size, bound.data(), int(bounds.size()), wished};
  const detail::LargestSize widest_of_all{widest.max_size, bound.data(), int(bounds.size()), wished};
  const Vec3f& s = distance.lattice().spacing;
  const float voxel = std::max({s.x, s.y, s.z});
  const float free = widest.reach() + 0.5f, most = std::min(free, distance.reach - 1.5f);
  exec.for_each(points,
                detail::SizeAtInterface{{view, most, free, 0.1f * voxel}, rule, widest_of_all, at_point.data()});
  SizingField field;
  field.far = widest.max_size;
  detail::describe_sizes(exec, field, at_point);
  field.tiles = distance.tiles;
  const std::size_t mark = arena.mark();
  for (int rings = 1;; rings *= 2) {
    field.h = arena.permanent<float>(field.tiles.slots());
    const detail::SpreadSize spread{field.tiles.view(), view,          widest, largest, 1.5f * voxel,
                                    at_point.data(),    field.h.data()};
    exec.for_each(field.tiles.slots(), spread);
    if (limit_slope(exec, field.tiles, rule.delta, field.far, field.h)) return field;
    arena.rewind(mark);
    field.tiles = tiles_around(exec, distance.tiles, rings);
  }
}

}  // namespace nacre
