// Nacre: the first triangle that a ray meets.
#include "app/viewer/ray_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace nacre {
namespace {

constexpr std::uint32_t group_size = 64;

/// Bits of three coordinates of 10 bits, one after the other.
std::uint32_t interleaved(const Vec3d& share) {
  std::uint32_t code = 0;
  for (int a = 0; a < 3; ++a) {
    const std::uint32_t x = std::uint32_t(std::clamp(share[a], 0.0, 1.0) * 1023);
    for (std::uint32_t bit = 0; bit < 10; ++bit) code |= (x >> bit & 1u) << (3 * bit + std::uint32_t(a));
  }
  return code;
}

bool meets_box(const Vec3d& low, const Vec3d& high, const Vec3d& from, const Vec3d& along, double farthest) {
  double enter = 0, leave = farthest;
  for (int a = 0; a < 3; ++a) {
    const double x = (low[a] - from[a]) / along[a], y = (high[a] - from[a]) / along[a];
    if (std::isnan(x) || std::isnan(y)) {  // along the plane of a side
      if (from[a] < low[a] || from[a] > high[a]) return false;
      continue;
    }
    enter = std::max(enter, std::min(x, y));
    leave = std::min(leave, std::max(x, y));
  }
  return enter <= leave;
}

}  // namespace

RayTriangles::RayTriangles(std::span<const Vec3d> points, std::span<const Triangle> triangles)
    : points_(points), triangles_(triangles), order_(triangles.size()) {
  if (triangles.empty()) return;
  Vec3d low = points[triangles[0].a], high = low;
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) low = min(low, points[t[k]]), high = max(high, points[t[k]]);
  const Vec3d extent = max(high - low, Vec3d(std::numeric_limits<double>::min()));
  std::vector<std::uint32_t> code;
  code.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const Vec3d p = (points[t.a] + points[t.b] + points[t.c]) / 3.0 - low;
    code.push_back(interleaved({p.x / extent.x, p.y / extent.y, p.z / extent.z}));
  }
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(code[a], a) < std::pair(code[b], b); });
  for (std::uint32_t first = 0; first < order_.size(); first += group_size) {
    Group group{high, low, first, std::min(first + group_size, std::uint32_t(order_.size()))};
    for (std::uint32_t i = first; i < group.last; ++i)
      for (int k = 0; k < 3; ++k) {
        const Vec3d& p = points[triangles[order_[i]][k]];
        group.low = min(group.low, p);
        group.high = max(group.high, p);
      }
    groups_.push_back(group);
  }
}

std::optional<TriangleHit> RayTriangles::first_hit(const Vec3d& from, const Vec3d& along,
                                                   const std::function<bool(const TriangleHit&)>& counts) const {
  std::optional<TriangleHit> nearest;
  for (const Group& group : groups_) {
    const double farthest = nearest ? nearest->distance : std::numeric_limits<double>::infinity();
    if (meets_box(group.low, group.high, from, along, farthest)) meet(group, from, along, counts, nearest);
  }
  return nearest;
}

void RayTriangles::meet(const Group& group, const Vec3d& from, const Vec3d& along,
                        const std::function<bool(const TriangleHit&)>& counts,
                        std::optional<TriangleHit>& nearest) const {
  for (std::uint32_t i = group.first; i < group.last; ++i) {
    const Triangle& t = triangles_[order_[i]];
    const Vec3d ab = points_[t.b] - points_[t.a], ac = points_[t.c] - points_[t.a];
    const Vec3d p = cross(along, ac);
    const double volume = dot(ab, p);
    if (volume == 0) continue;
    const Vec3d s = from - points_[t.a], q = cross(s, ab);
    const double u = dot(s, p) / volume, v = dot(along, q) / volume, distance = dot(ac, q) / volume;
    if (u < 0 || v < 0 || u + v > 1 || distance <= 0 || (nearest && distance >= nearest->distance)) continue;
    const TriangleHit hit{order_[i], distance, from + along * distance, u, v};
    if (counts(hit)) nearest = hit;
  }
}

}  // namespace nacre
