// Nacre: a tree of triangles for single rays and closest points on the host.
#include "compute/raycast/triangle_tree.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "compute/embedding/triangle.hpp"
#include "compute/math/eight.hpp"

namespace nacre {
namespace {

constexpr double finite = std::numeric_limits<double>::max(), infinite = std::numeric_limits<double>::infinity();

/// At least as much as rounding to float changes a number, so that a box with it on every side is large enough.
float rounding(double x) {
  return float(std::abs(x)) * std::numeric_limits<float>::epsilon() + std::numeric_limits<float>::min();
}

using Doubles = EightDoubles;  // of a node's children

Doubles to_doubles(const std::array<float, 8>& a) { return __builtin_convertvector(load_eight(a.data()), Doubles); }
Doubles larger(const Doubles& a, const Doubles& b) { return a > b ? a : b; }
Doubles smaller(const Doubles& a, const Doubles& b) { return a < b ? a : b; }

/// Where a triangle is, more or less.
struct Middle {
  Vec3f at;
  std::uint32_t triangle;
};

/// Sorts the triangles of a node so that those of each of its children, and of theirs, come one after the other. It
/// cuts across the axis along which they extend farthest.
void divide(std::span<Middle> middles, std::size_t width) {
  if (middles.size() <= width) return;
  std::size_t child = width;  // triangles of one that is full
  while (child * width < middles.size()) child *= width;
  Vec3f low = middles[0].at, high = low;
  for (const Middle& m : middles) low = min(low, m.at), high = max(high, m.at);
  const Vec3f extent = high - low;
  const int axis = extent.x >= std::max(extent.y, extent.z) ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t children = (middles.size() + child - 1) / child, half = children / 2 * child;
  std::nth_element(middles.begin(), middles.begin() + half, middles.end(), [axis](const Middle& a, const Middle& b) {
    return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.triangle < b.triangle;
  });
  const auto lower = [&] { divide(middles.first(half), width); };
  const auto upper = [&] { divide(middles.subspan(half), width); };
  constexpr std::size_t many = 10000;
  if (middles.size() > many)
    tbb::parallel_invoke(lower, upper);
  else
    lower(), upper();
}

}  // namespace

TriangleTree::TriangleTree(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  auto soup = std::make_shared<TriangleSoup>();
  soup->points.assign(points.begin(), points.end());
  soup->triangles.assign(triangles.begin(), triangles.end());
  std::vector<std::uint32_t> all(triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  build(std::move(soup), std::move(all));
}

TriangleTree TriangleTree::of_some(std::shared_ptr<const TriangleSoup> soup, std::vector<std::uint32_t> some) {
  TriangleTree tree;
  tree.build(std::move(soup), std::move(some));
  return tree;
}

void TriangleTree::build(std::shared_ptr<const TriangleSoup> soup, std::vector<std::uint32_t> some) {
  soup_ = std::move(soup);
  order_ = std::move(some);
  if (order_.empty()) return;
  sort();
  make_boxes();
}

void TriangleTree::sort() {
  std::vector<Middle> middles(order_.size());
  tbb::parallel_for(std::size_t(0), middles.size(), [&](std::size_t i) {
    const std::uint32_t t = order_[i];
    const Vec3f at((corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0);
    middles[i] = {is_finite(at) ? at : Vec3f(0.0f), t};  // numbers that can be sorted
  });
  divide(middles, width);
  std::transform(middles.begin(), middles.end(), order_.begin(), [](const Middle& m) { return m.triangle; });
}

TriangleTree::Boxes TriangleTree::no_boxes() {
  Boxes boxes;
  for (std::array<float, width>& low : boxes.low) low.fill(std::numeric_limits<float>::infinity());
  for (std::array<float, width>& high : boxes.high) high.fill(-std::numeric_limits<float>::infinity());
  return boxes;
}

/// Of those from `first` on in their order.
TriangleTree::Boxes TriangleTree::boxes_of_triangles(std::size_t first) const {
  Boxes boxes = no_boxes();
  for (std::size_t k = 0; k < std::min(width, order_.size() - first); ++k) {
    const Vec3d &a = corner(order_[first + k], 0), &b = corner(order_[first + k], 1), &c = corner(order_[first + k], 2);
    const Vec3d low = min(a, min(b, c)), high = max(a, max(b, c));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes.low[axis][k] = float(low[int(axis)]) - rounding(low[int(axis)]);
      boxes.high[axis][k] = float(high[int(axis)]) + rounding(high[int(axis)]);
    }
  }
  return boxes;
}

TriangleTree::Boxes TriangleTree::boxes_of_nodes(std::size_t first, std::size_t count) const {
  Boxes boxes = no_boxes();
  for (std::size_t k = 0; k < std::min(width, count); ++k)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      boxes.low[axis][k] = *std::ranges::min_element(boxes_[first + k].low[axis]);
      boxes.high[axis][k] = *std::ranges::max_element(boxes_[first + k].high[axis]);
    }
  return boxes;
}

void TriangleTree::make_boxes() {
  std::size_t nodes = (order_.size() + width - 1) / width;
  level_ = {0};
  boxes_.resize(nodes);
  tbb::parallel_for(std::size_t(0), nodes, [&](std::size_t k) { boxes_[k] = boxes_of_triangles(k * width); });
  while (nodes > 1) {
    const std::size_t below = level_.back(), end = boxes_.size();
    nodes = (nodes + width - 1) / width;
    level_.push_back(end);
    for (std::size_t k = 0; k < nodes; ++k)
      boxes_.push_back(boxes_of_nodes(below + k * width, end - below - k * width));
  }
}

/// Calls visit(triangle) for those whose boxes are not more than `most` away, which visit may lower; near ones first,
/// more or less. away(boxes): how far those of a node's children are, infinite where there is none.
template <class Away, class Visit>
void TriangleTree::search(const double& most, const Away& away, const Visit& visit) const {
  struct Entry {
    std::size_t level, node;
    double away;
  };
  std::array<Entry, 96> open;  // seven for each level, and one more
  std::size_t count = 0;
  open[count++] = {level_.size() - 1, 0, 0};
  while (count > 0) {
    const Entry entry = open[--count];
    if (entry.away > most) continue;
    const Doubles far = away(boxes_[level_[entry.level] + entry.node]);
    std::array<std::uint8_t, width> within;  // children, near ones first
    std::size_t found = 0;
    for (std::uint8_t k = 0; k < width; ++k) {  // without a branch, as nobody could predict it
      within[found] = k;
      found += far[k] <= most;
    }
    for (std::size_t n = 1; n < found; ++n)
      for (std::size_t at = n; at > 0 && far[within[at - 1]] > far[within[at]]; --at)
        std::swap(within[at - 1], within[at]);
    const std::size_t first = entry.node * width;
    if (entry.level == 0)
      for (std::size_t n = 0; n < found && far[within[n]] <= most; ++n) visit(order_[first + within[n]]);
    else
      while (found-- > 0) open[count++] = {entry.level - 1, first + within[found], far[within[found]]};
  }
}

/// Rays along an edge must not slip between its two triangles for rounding: they end a little beyond it.
void TriangleTree::try_hit(std::uint32_t triangle, const Vec3d& from, const Vec3d& along, double near, double& far,
                           std::optional<TriangleHit>& hit) const {
  constexpr double slack = 1e-12;  // of the weights
  const Vec3d a = corner(triangle, 0), u = corner(triangle, 1) - a, v = corner(triangle, 2) - a, p = cross(along, v);
  const double determinant = dot(u, p);
  if (determinant == 0) return;
  const Vec3d s = from - a, q = cross(s, u);
  const double b = dot(s, p) / determinant, c = dot(along, q) / determinant, t_hit = dot(v, q) / determinant;
  if (!(b >= -slack && c >= -slack && b + c <= 1 + slack && t_hit >= near && t_hit <= far)) return;
  if (t_hit == far && !(hit && triangle < hit->triangle)) return;
  far = t_hit;
  const Vec3d w = max(Vec3d(1 - b - c, b, c), Vec3d(0.0));
  hit = TriangleHit{triangle, t_hit, from + along * t_hit, w / (w.x + w.y + w.z)};
}

std::optional<TriangleHit> TriangleTree::first(const Vec3d& from, const Vec3d& along, double near, double far) const {
  std::optional<TriangleHit> hit;
  if (empty()) return hit;
  far = std::min(far, finite);
  const auto enters = [&](const Boxes& boxes) {
    Doubles enter = near - Doubles{}, leave = far - Doubles{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int axis = int(k);
      const Doubles low = to_doubles(boxes.low[k]) - from[axis], high = to_doubles(boxes.high[k]) - from[axis];
      leave = low <= high ? leave : -infinite - Doubles{};  // there is no child
      if (along[axis] == 0) {
        leave = low > 0 || high < 0 ? -infinite - Doubles{} : leave;
        continue;
      }
      const Doubles a = low / along[axis], b = high / along[axis];
      enter = larger(enter, smaller(a, b)), leave = smaller(leave, larger(a, b));
    }
    return enter <= leave ? enter : infinite - Doubles{};
  };
  search(far, enters, [&](std::uint32_t t) { try_hit(t, from, along, near, far, hit); });
  return hit;
}

void TriangleTree::try_closest(std::uint32_t triangle, const Vec3d& from, double& nearest,
                               std::optional<TriangleHit>& hit) const {
  const Vec3d p = closest_point({corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)}, from), off = p - from;
  const double squared = dot(off, off);
  if (squared > nearest || (squared == nearest && hit && triangle >= hit->triangle)) return;
  nearest = squared;
  hit = TriangleHit{triangle, 0, p, {}};
}

/// `squared`: beyond this squared distance there is no hit.
template <class Counts>
std::optional<TriangleHit> TriangleTree::closest_within(const Vec3d& from, double squared, const Counts& counts,
                                                        std::optional<std::uint32_t> guess) const {
  std::optional<TriangleHit> hit;
  if (empty()) return hit;
  double nearest = squared;
  if (guess) try_closest(*guess, from, nearest, hit);
  // A little less than it is: rounding must not hide a triangle that is exactly as near as another.
  const auto away = [&](const Boxes& boxes) {
    Doubles off_squared{};
    for (int axis = 0; axis < 3; ++axis) {
      const Doubles low = to_doubles(boxes.low[std::size_t(axis)]) - from[axis],
                    high = from[axis] - to_doubles(boxes.high[std::size_t(axis)]);
      const Doubles off = larger(larger(low, high), Doubles{});
      off_squared += off * off;
    }
    return off_squared * (1 - 1e-12);
  };
  search(nearest, away, [&](std::uint32_t t) {
    if (counts(t)) try_closest(t, from, nearest, hit);
  });
  if (hit) hit->distance = length(hit->position - from);
  return hit;
}

std::optional<TriangleHit> TriangleTree::closest(const Vec3d& from, std::optional<std::uint32_t> guess) const {
  return closest_within(
      from, finite, [](std::uint32_t) { return true; }, guess);
}

std::optional<TriangleHit> TriangleTree::closest_of(const Vec3d& from, double most,
                                                    const std::function<bool(std::uint32_t)>& counts,
                                                    std::optional<std::uint32_t> guess) const {
  return closest_within(from, std::min(most * most, finite), counts, guess);
}

Vec3d TriangleTree::weights_at(std::uint32_t triangle, const Vec3d& position) const {
  const Vec3d a = corner(triangle, 0), b = corner(triangle, 1) - a, c = corner(triangle, 2) - a, d = position - a;
  const Vec3d normal = cross(b, c);
  const double whole = dot(normal, normal);
  if (!(whole > 0)) return {1, 0, 0};
  const double v = std::clamp(dot(cross(d, c), normal) / whole, 0.0, 1.0);
  const double w = std::clamp(dot(cross(b, d), normal) / whole, 0.0, 1.0 - v);
  return {1 - v - w, v, w};
}

}  // namespace nacre
