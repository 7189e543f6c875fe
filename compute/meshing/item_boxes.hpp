// Nacre: items within a distance, found through boxes around runs of them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/math/bits.hpp"
#include "compute/math/eight.hpp"
#include "compute/math/morton.hpp"
#include "compute/meshing/star.hpp"

namespace nacre {

/// Items in Morton order within their surfaces, eight together, with a box around every eight of them, around every
/// eight such boxes, and so on. Eight points or boxes are looked at together.
struct ItemBoxesView {
  struct Points {
    float x[8], y[8], z[8];  ///< as exact as the particles'
    std::uint32_t item[8];
  };
  struct Boxes {
    float low[3][8], high[3][8];
  };
  static constexpr int most_levels = 11;

  const Points* points = nullptr;
  const Boxes* level[most_levels] = {};  ///< level 1 is around points, level `top` has one entry
  int top = 0;

  NACRE_HD std::uint32_t item(std::int64_t k) const { return points[k / 8].item[k % 8]; }

  /// Calls visit(squared distance, item) for items first .. last - 1 of the order whose squared distance from `at` is
  /// at most `radius2`, which `visit` may make smaller.
  template <class Visit>
  NACRE_HD void within(std::uint32_t first, std::uint32_t last, const Vec3f& at, const double& radius2,
                       const Visit& visit) const {
    for_eights(first, last, at, at, radius2,
               [&](std::uint32_t k) { visit_points(points[k], in_range(8 * k, 0, first, last), at, radius2, visit); });
  }

  /// Calls visit(k) for the eights of points, points[k], of which some may be of the items first .. last - 1 of the
  /// order and within a distance of the box from `low` to `high`; `visit` may make its square smaller.
  template <class Visit>
  NACRE_HD void for_eights(std::uint32_t first, std::uint32_t last, const Vec3f& low, const Vec3f& high,
                           const double& radius2, const Visit& visit) const {
    if (first == last) return;
    unsigned left[most_levels];  // which of the eight are still to be entered, per level
    std::uint32_t k = 0;         // the entry that we are in
    int l = top;
    left[l] = near_boxes(l, k, first, last, low, high, radius2);
    for (;;) {
      if (left[l] == 0) {
        if (l == top) return;
        ++l, k >>= 3;
        continue;
      }
      const std::uint32_t part = 8 * k + std::uint32_t(lowest_bit(left[l]));
      left[l] &= left[l] - 1;
      if (l == 1) {
        visit(part);
      } else {
        --l, k = part;
        left[l] = near_boxes(l, k, first, last, low, high, radius2);
      }
    }
  }

  /// Calls visit(squared distance, item) for those of eight points whose bits are in `some`, as `within` does.
  template <class Visit>
  NACRE_HD static void visit_points(const Points& p, unsigned some, const Vec3f& at, const double& radius2,
                                    const Visit& visit) {
    const Eight x = load_eight(p.x) - eight(at.x), y = load_eight(p.y) - eight(at.y), z = load_eight(p.z) - eight(at.z);
    const Eight sum = x * x + y * y + z * z;
    unsigned near = at_most(sum, eight(float(radius2) * slack)) & some;
    for (; near != 0; near &= near - 1) {
      const int j = lowest_bit(near);
      const Vec3d r = Vec3d(p.x[j], p.y[j], p.z[j]) - Vec3d(at);
      if (const double d = dot(r, r); d <= radius2) visit(d, p.item[j]);
    }
  }

  /// The bits of those of eight points that are of the items first .. last - 1 of the order, and may be within a
  /// distance of a box.
  NACRE_HD unsigned near_points(std::uint32_t k, std::uint32_t first, std::uint32_t last, const Vec3f& low,
                                const Vec3f& high, double radius2) const {
    const float* const lows[3] = {points[k].x, points[k].y, points[k].z};
    return near(lows, lows, low, high, radius2) & in_range(8 * k, 0, first, last);
  }

 private:
  /// More than the squared distances of floats can be wrong by.
  static constexpr float slack = 1.000002f;

  /// The bits of those of eight parts from number `part` on that have some of the items first .. last - 1, where each
  /// has 2^shift.
  NACRE_HD static unsigned in_range(std::uint32_t part, int shift, std::uint32_t first, std::uint32_t last) {
    const std::int64_t from = std::int64_t(first >> shift) - part, to = std::int64_t((last - 1) >> shift) - part;
    if (from > 7 || to < 0) return 0;
    return (from > 0 ? 0xffu << from : 0xffu) & (to < 7 ? 0xffu >> (7 - to) : 0xffu);
  }

  NACRE_HD unsigned near_boxes(int l, std::uint32_t k, std::uint32_t first, std::uint32_t last, const Vec3f& low,
                               const Vec3f& high, double radius2) const {
    const Boxes& boxes = level[l][k];
    const float* const lows[3] = {boxes.low[0], boxes.low[1], boxes.low[2]};
    const float* const highs[3] = {boxes.high[0], boxes.high[1], boxes.high[2]};
    return near(lows, highs, low, high, radius2) & in_range(8 * k, 3 * l, first, last);
  }

  /// The bits of those of eight boxes that are within a distance of another.
  NACRE_HD static unsigned near(const float* const* lows, const float* const* highs, const Vec3f& low,
                                const Vec3f& high, double radius2) {
    Eight sum = eight(0);
    for (int a = 0; a < 3; ++a) {
      const Eight gap = max(max(load_eight(lows[a]) - eight(high[a]), eight(low[a]) - load_eight(highs[a])), eight(0));
      sum = sum + gap * gap;
    }
    return at_most(sum, eight(float(radius2) * slack));
  }
};

/// Items around some others, gathered once for all of these.
class ItemsAround {
 public:
  /// Those of the items first .. last - 1 of the order that are within a distance of a box. False where there are too
  /// many.
  NACRE_HD bool gather(const ItemBoxesView& boxes, std::uint32_t first, std::uint32_t last, const Vec3f& low,
                       const Vec3f& high, double reach) {
    count_ = 0, reach_ = reach;
    double radius2 = 1.00001 * reach * reach;
    boxes.for_eights(first, last, low, high, radius2, [&](std::uint32_t k) {
      for (unsigned near = boxes.near_points(k, first, last, low, high, radius2); near != 0; near &= near - 1) {
        if (count_ == 8 * most_eights) {
          radius2 = -1, reach_ = -1;
          return;
        }
        add(boxes.points[k], lowest_bit(near));
      }
    });
    return reach_ >= 0;
  }

  NACRE_HD double reach() const { return reach_; }

  /// As ItemBoxesView::within, for a position in the box and at most the distance that was gathered for.
  template <class Visit>
  NACRE_HD void within(const Vec3f& at, const double& radius2, const Visit& visit) const {
    for (int k = 0; 8 * k < count_; ++k) {
      const int left = count_ - 8 * k;
      ItemBoxesView::visit_points(eight_[k], left < 8 ? 0xffu >> (8 - left) : 0xffu, at, radius2, visit);
    }
  }

 private:
  static constexpr int most_eights = 12;

  NACRE_HD void add(const ItemBoxesView::Points& from, int j) {
    ItemBoxesView::Points& to = eight_[count_ / 8];
    const int k = count_++ % 8;
    to.x[k] = from.x[j], to.y[k] = from.y[j], to.z[k] = from.z[j], to.item[k] = from.item[j];
  }

  ItemBoxesView::Points eight_[most_eights];
  int count_ = 0;
  double reach_ = -1;
};

namespace detail {

struct ItemExtent {
  Vec3f low, high;
};

struct ExtentOfItem {
  const Vec3d* position;
  NACRE_HD ItemExtent operator()(std::int64_t i) const {
    const Vec3f p(position[i]);
    return {p, p};
  }
};

struct JoinExtents {
  NACRE_HD ItemExtent operator()(const ItemExtent& a, const ItemExtent& b) const {
    return {min(a.low, b.low), max(a.high, b.high)};
  }
};

/// Surface, then Morton code within the extent of all.
struct ItemKey {
  static constexpr int digits = 14;  // of the code, per axis: 22 bits are left for the surface
  StarItemsView items;
  Vec3f low;
  float scale;
  std::uint64_t* key;
  std::uint32_t* number;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f p = (Vec3f(items.position[i]) - low) * scale;
    const auto digit = [](float x) { return x > 0 ? (x < float(1 << digits) ? int(x) : (1 << digits) - 1) : 0; };
    key[i] = std::uint64_t(items.surface[i]) << 3 * digits | morton({digit(p.x), digit(p.y), digit(p.z)});
    number[i] = std::uint32_t(i);
  }
};

struct PutPoints {
  StarItemsView items;
  const std::uint32_t* number;
  ItemBoxesView::Points* points;
  NACRE_HD void operator()(std::int64_t k) const {
    ItemBoxesView::Points& eight = points[k / 8];
    const Vec3f p(items.position[number[k]]);
    eight.x[k % 8] = p.x, eight.y[k % 8] = p.y, eight.z[k % 8] = p.z, eight.item[k % 8] = number[k];
  }
};

/// What is around eight points or boxes, of which `n` are there.
NACRE_HD inline ItemExtent extent_of(const ItemBoxesView::Points& points, int n) {
  ItemExtent all{Vec3f(3e38f), Vec3f(-3e38f)};
  for (int j = 0; j < n; ++j) {
    const Vec3f p(points.x[j], points.y[j], points.z[j]);
    all = JoinExtents()(all, {p, p});
  }
  return all;
}
NACRE_HD inline ItemExtent extent_of(const ItemBoxesView::Boxes& boxes, int n) {
  ItemExtent all{Vec3f(3e38f), Vec3f(-3e38f)};
  for (int j = 0; j < n; ++j)
    all = JoinExtents()(all, {{boxes.low[0][j], boxes.low[1][j], boxes.low[2][j]},
                              {boxes.high[0][j], boxes.high[1][j], boxes.high[2][j]}});
  return all;
}

template <class Part>
struct PutBoxes {
  const Part* part;
  std::int64_t parts;  // points or boxes, eight of them in each entry of `part`
  ItemBoxesView::Boxes* boxes;
  NACRE_HD void operator()(std::int64_t k) const {
    const std::int64_t left = parts - 8 * k;
    const ItemExtent around = extent_of(part[k], left < 8 ? int(left) : 8);
    for (int a = 0; a < 3; ++a) {
      boxes[k / 8].low[a][k % 8] = around.low[a];
      boxes[k / 8].high[a][k % 8] = around.high[a];
    }
  }
};

inline std::int64_t eighth(std::int64_t n) { return (n + 7) / 8; }

}  // namespace detail

/// The boxes of `n` items, at least one, in temporary memory of the caller's scope.
template <class Backend>
ItemBoxesView item_boxes(Executor<Backend>& exec, const StarItemsView& items, std::int64_t n) {
  using detail::eighth;
  Arena& arena = exec.arena();
  const auto points = arena.template temporary<ItemBoxesView::Points>(std::size_t(eighth(n)));
  std::int64_t all_boxes = 1;
  for (std::int64_t count = eighth(eighth(n)); count > 1; count = eighth(count)) all_boxes += count;
  const auto boxes = arena.template temporary<ItemBoxesView::Boxes>(std::size_t(all_boxes));
  {
    Arena::Scope scope(arena);
    const detail::ItemExtent extent = exec.reduce(n, detail::ItemExtent{Vec3f(3e38f), Vec3f(-3e38f)},
                                                  detail::ExtentOfItem{items.position}, detail::JoinExtents{});
    const Vec3f size = extent.high - extent.low;
    const float widest = std::max({size.x, size.y, size.z});
    const float scale = widest > 0 ? float(1 << detail::ItemKey::digits) / widest : 0;
    const auto key = arena.template temporary<std::uint64_t>(std::size_t(n));
    const auto number = arena.template temporary<std::uint32_t>(std::size_t(n));
    exec.for_each(n, detail::ItemKey{items, extent.low, scale, key.data(), number.data()});
    exec.sort_pairs(key.data(), number.data(), n);
    exec.for_each(n, detail::PutPoints{items, number.data(), points.data()});
  }
  ItemBoxesView view{points.data()};
  ItemBoxesView::Boxes* level = boxes.data();
  std::int64_t parts = n, entries = eighth(n);  // of the level below
  exec.for_each(entries, detail::PutBoxes<ItemBoxesView::Points>{points.data(), parts, level});
  view.level[view.top = 1] = level;
  for (;;) {
    parts = entries, entries = eighth(entries);
    if (entries == 1) return view;
    ItemBoxesView::Boxes* above = level + entries;
    exec.for_each(entries, detail::PutBoxes<ItemBoxesView::Boxes>{level, parts, above});
    view.level[++view.top] = level = above;
  }
}

}  // namespace nacre
