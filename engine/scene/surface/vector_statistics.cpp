// Nacre: how much of a vector field lies in its surface, and how fast it is there.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/scene/surface/prepare.hpp"

namespace nacre {
namespace {

/// Per point, a third of the area around it, and two sums weighted by that area.
struct PointShare {
  double area = 0;
  double normal = 0;      // |v.n|
  double tangential = 0;  // |v - (v.n) n|
};

std::vector<PointShare> share_out(const PreparedSurface& surface, std::span<const Vec3f> vectors) {
  std::vector<PointShare> shares(surface.points.size());
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    const Triangle& t = surface.triangles[i];
    const Vec3d a = surface.points[t.a];
    const double third = length(cross(surface.points[t.b] - a, surface.points[t.c] - a)) / 6;
    for (int k = 0; k < 3; ++k) {
      const Vec3d v = is_finite(vectors[t[k]]) ? Vec3d(vectors[t[k]]) : Vec3d{};
      const Vec3d n(surface.corner_normals[3 * i + k]);
      PointShare& share = shares[t[k]];
      share.area += third;
      share.normal += third * std::abs(dot(v, n));
      share.tangential += third * length(v - dot(v, n) * n);
    }
  }
  return shares;
}

/// The smallest speed such that `fraction` of the weight is no faster. (speed, weight) pairs, reordered: halves are
/// left out until one pair remains.
double weighted_percentile(std::vector<std::pair<double, double>>& speeds, double fraction) {
  if (speeds.empty()) return 0;
  const auto weight = [](auto from, auto to) {
    return std::accumulate(from, to, 0.0, [](double sum, const auto& pair) { return sum + pair.second; });
  };
  auto first = speeds.begin(), last = speeds.end();
  double wanted = fraction * weight(first, last);
  while (last - first > 1) {
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last);
    const double below = weight(first, middle);
    if (below >= wanted)
      last = middle;
    else
      wanted -= below, first = middle;
  }
  return first->first;
}

}  // namespace

VectorStatistics vector_statistics(const PreparedSurface& surface, std::span<const Vec3f> vectors) {
  if (vectors.size() != surface.points.size())
    throw Error("the vectors do not fit the surface",
                fmt::format("{} vectors, {} points", vectors.size(), surface.points.size()));
  const std::vector<PointShare> shares = share_out(surface, vectors);
  VectorStatistics result;
  std::vector<std::pair<double, double>> moving;
  std::size_t used = 0, zero = 0;
  double normal = 0, all = 0;
  for (std::size_t p = 0; p < shares.size(); ++p) {
    const PointShare& share = shares[p];
    if (share.area <= 0) continue;
    ++used;
    const double size = is_finite(vectors[p]) ? length(Vec3d(vectors[p])) : 0.0;
    zero += size == 0;
    normal += share.normal;
    all += share.area * size;
    const double speed = share.tangential / share.area;
    result.max_speed = std::max(result.max_speed, speed);
    if (speed > 0) moving.emplace_back(speed, share.area);
  }
  if (all > 0) result.normal_share = normal / all;
  if (used > 0) result.zero_share = double(zero) / double(used);
  result.percentile_98 = weighted_percentile(moving, 0.98);
  return result;
}

}  // namespace nacre
