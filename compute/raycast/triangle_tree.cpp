// Nacre: a tree of triangles for single rays and closest points on the host.
#include "compute/raycast/triangle_tree.hpp"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "compute/embedding/triangle.hpp"
#include "compute/math/morton.hpp"

namespace nacre {
namespace {

constexpr std::size_t leaf_size = 4;  // triangles

/// The parameters between which the ray is inside the box; none if low > high.
std::pair<double, double> inside(const Vec3d& low, const Vec3d& high, const Vec3d& from, const Vec3d& along) {
  std::pair<double, double> part{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) {
      if (from[axis] < low[axis] || from[axis] > high[axis]) return {1, 0};
      continue;
    }
    const double a = (low[axis] - from[axis]) / along[axis], b = (high[axis] - from[axis]) / along[axis];
    part = {std::max(part.first, std::min(a, b)), std::min(part.second, std::max(a, b))};
  }
  return part;
}

}  // namespace

TriangleTree::TriangleTree(std::span<const Vec3d> points, std::span<const Triangle> triangles)
    : points_(points.begin(), points.end()), triangles_(triangles.begin(), triangles.end()) {
  if (triangles_.empty()) return;
  sort();
  make_boxes();
}

void TriangleTree::sort() {
  Box all;
  for (const Triangle& t : triangles_)
    for (int k = 0; k < 3; ++k) all.low = min(all.low, points_[t[k]]), all.high = max(all.high, points_[t[k]]);
  const Vec3d extent = all.high - all.low;
  const double scale = ((1 << 20) - 1) / std::max({extent.x, extent.y, extent.z, 1e-300});
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(triangles_.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const Triangle& t = triangles_[i];
    const Vec3d middle = ((points_[t.a] + points_[t.b] + points_[t.c]) / 3.0 - all.low) * scale;
    keys[i] = {morton(Int3(int(middle.x), int(middle.y), int(middle.z))), std::uint32_t(i)};
  }
  tbb::parallel_sort(keys);
  for (const auto& key : keys) order_.push_back(key.second);
}

void TriangleTree::make_boxes() {
  leaves_ = std::bit_ceil((triangles_.size() + leaf_size - 1) / leaf_size);
  boxes_.resize(2 * leaves_);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    Box& box = boxes_[leaves_ + i / leaf_size];
    for (int k = 0; k < 3; ++k) {
      const Vec3d& p = points_[triangles_[order_[i]][k]];
      box.low = min(box.low, p), box.high = max(box.high, p);
    }
  }
  for (std::size_t node = leaves_ - 1; node >= 1; --node) {
    const Box &a = boxes_[2 * node], &b = boxes_[2 * node + 1];
    boxes_[node] = {min(a.low, b.low), max(a.high, b.high)};
  }
}

/// Rays along an edge must not slip between its two triangles for rounding: they end a little beyond it.
void TriangleTree::hit_leaf(std::size_t leaf, const Vec3d& from, const Vec3d& along, double near, double& far,
                            std::optional<TriangleHit>& hit) const {
  constexpr double slack = 1e-12;  // of the weights
  const std::size_t end = std::min(order_.size(), (leaf + 1) * leaf_size);
  for (std::size_t i = leaf * leaf_size; i < end; ++i) {
    const Triangle& t = triangles_[order_[i]];
    const Vec3d a = points_[t.a], u = points_[t.b] - a, v = points_[t.c] - a, p = cross(along, v);
    const double determinant = dot(u, p);
    if (determinant == 0) continue;
    const Vec3d s = from - a, q = cross(s, u);
    const double b = dot(s, p) / determinant, c = dot(along, q) / determinant, t_hit = dot(v, q) / determinant;
    if (!(b >= -slack && c >= -slack && b + c <= 1 + slack && t_hit >= near && t_hit < far)) continue;
    far = t_hit;
    const Vec3d w = max(Vec3d(1 - b - c, b, c), Vec3d(0.0));
    hit = TriangleHit{order_[i], t_hit, from + along * t_hit, w / (w.x + w.y + w.z)};
  }
}

std::optional<TriangleHit> TriangleTree::first(const Vec3d& from, const Vec3d& along, double near, double far) const {
  std::optional<TriangleHit> hit;
  if (triangles_.empty()) return hit;
  struct Entry {
    std::size_t node;
    double at;
  };
  std::vector<Entry> open{{1, near}};
  while (!open.empty()) {
    const Entry entry = open.back();
    open.pop_back();
    if (entry.at >= far) continue;
    if (entry.node >= leaves_) {
      hit_leaf(entry.node - leaves_, from, along, near, far, hit);
      continue;
    }
    std::array<Entry, 2> children;
    for (std::size_t k = 0; k < 2; ++k) {
      const Box& box = boxes_[2 * entry.node + k];
      const auto [enters, leaves] = inside(box.low, box.high, from, along);
      const bool empty = box.low.x > box.high.x;  // beyond the last triangle
      const bool met = !empty && enters <= leaves && leaves >= near;
      children[k] = {2 * entry.node + k, met ? std::max(enters, near) : std::numeric_limits<double>::infinity()};
    }
    if (children[0].at < children[1].at) std::swap(children[0], children[1]);  // the nearer one is examined first
    for (const Entry& child : children)
      if (child.at < far) open.push_back(child);
  }
  return hit;
}

/// Squared, and a little less than it is: rounding must not hide a triangle that is exactly as near as another.
double TriangleTree::distance_to_box(std::size_t node, const Vec3d& from) const {
  const Box& box = boxes_[node];
  if (box.low.x > box.high.x) return std::numeric_limits<double>::infinity();  // beyond the last triangle
  const Vec3d off = from - min(max(from, box.low), box.high);
  return dot(off, off) * (1 - 1e-12);
}

void TriangleTree::try_closest(std::uint32_t triangle, const Vec3d& from, double& nearest,
                               std::optional<TriangleHit>& hit) const {
  const Triangle& t = triangles_[triangle];
  const Vec3d p = closest_point(Corners{points_[t.a], points_[t.b], points_[t.c]}, from), off = p - from;
  const double squared = dot(off, off);
  if (squared > nearest || (squared == nearest && hit && triangle >= hit->triangle)) return;
  nearest = squared;
  hit = TriangleHit{triangle, 0, p, {}};
}

std::optional<TriangleHit> TriangleTree::closest(const Vec3d& from, std::optional<std::uint32_t> guess) const {
  std::optional<TriangleHit> hit;
  if (triangles_.empty()) return hit;
  struct Entry {
    std::size_t node;
    double squared;
  };
  double nearest = std::numeric_limits<double>::infinity();
  if (guess) try_closest(*guess, from, nearest, hit);
  std::array<Entry, 66> open;  // one for each level, and one more
  std::size_t count = 0;
  open[count++] = {1, distance_to_box(1, from)};
  while (count > 0) {
    const Entry entry = open[--count];
    if (entry.squared > nearest) continue;
    if (entry.node >= leaves_) {
      const std::size_t begin = (entry.node - leaves_) * leaf_size, end = std::min(order_.size(), begin + leaf_size);
      for (std::size_t i = begin; i < end; ++i) try_closest(order_[i], from, nearest, hit);
      continue;
    }
    Entry near{2 * entry.node, distance_to_box(2 * entry.node, from)};
    Entry far{2 * entry.node + 1, distance_to_box(2 * entry.node + 1, from)};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared <= nearest && std::isfinite(far.squared)) open[count++] = far;
    if (near.squared <= nearest && std::isfinite(near.squared)) open[count++] = near;
  }
  if (hit) hit->distance = length(hit->position - from);
  return hit;
}

Vec3d TriangleTree::weights_at(std::uint32_t triangle, const Vec3d& position) const {
  const Triangle& t = triangles_[triangle];
  const Vec3d &a = points_[t.a], b = points_[t.b] - a, c = points_[t.c] - a, d = position - a;
  const Vec3d normal = cross(b, c);
  const double whole = dot(normal, normal);
  if (!(whole > 0)) return {1, 0, 0};
  const double v = std::clamp(dot(cross(d, c), normal) / whole, 0.0, 1.0);
  const double w = std::clamp(dot(cross(b, d), normal) / whole, 0.0, 1.0 - v);
  return {1 - v - w, v, w};
}

}  // namespace nacre
