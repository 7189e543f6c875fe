// Nacre: how much of a vector field lies in its surface, and how fast it is there.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "compute/device/among_all.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/surface/surface_share.hpp"

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

/// A speed and a whole number that says how much it weighs.
struct Weighted {
  double speed;
  std::uint64_t weight;
};

/// The smallest speed such that `wanted` of the weight is no faster: halves are left out until one is left. Reorders.
double weighted_percentile(std::vector<Weighted>& speeds, std::uint64_t wanted) {
  if (speeds.empty()) return 0;
  auto first = speeds.begin(), last = speeds.end();
  const auto slower = [](const Weighted& a, const Weighted& b) { return a.speed < b.speed; };
  while (last - first > 1) {
    const auto middle = first + (last - first) / 2;
    std::nth_element(first, middle, last, slower);
    std::uint64_t below = 0;
    for (auto each = first; each != middle; ++each) below += each->weight;
    if (below >= wanted)
      last = middle;
    else
      wanted -= below, first = middle;
  }
  return first->speed;
}

/// The same of the speeds of all processes: bisection over all numbers above 0, whose bits are in their order.
double weighted_percentile(Ranks& ranks, std::vector<Weighted>& speeds, std::uint64_t wanted) {
  std::sort(speeds.begin(), speeds.end(), [](const Weighted& a, const Weighted& b) { return a.speed < b.speed; });
  std::vector<std::uint64_t> before{0};  // the weight of those before each
  for (const Weighted& each : speeds) before.push_back(before.back() + each.weight);
  std::uint64_t low = 0, high = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    const auto faster = std::upper_bound(speeds.begin(), speeds.end(), std::bit_cast<double>(middle),
                                         [](double speed, const Weighted& each) { return speed < each.speed; });
    const std::uint64_t weight = sum_of_all(&ranks, before[std::size_t(faster - speeds.begin())]);
    (weight >= wanted ? high : low) = middle;
  }
  return std::bit_cast<double>(high);
}

/// `fraction` of the area moves no faster. Areas weigh as parts of their sum, in 2^52nds.
double percentile(Ranks* ranks, const std::vector<std::pair<double, double>>& moving, double fraction) {
  ExactSum area;
  for (const auto& each : moving) area.add(each.second);
  sum_of_all(ranks, area);
  const double all = area.value();
  std::vector<Weighted> speeds;
  speeds.reserve(moving.size());
  std::uint64_t weight = 0;
  for (const auto& [speed, own] : moving) {
    speeds.push_back({speed, std::uint64_t(std::llround(own / all * 0x1p52))});
    weight += speeds.back().weight;
  }
  weight = sum_of_all(ranks, weight);
  if (weight == 0) return 0;
  const auto wanted = std::uint64_t(std::ceil(fraction * double(weight)));
  return ranks ? weighted_percentile(*ranks, speeds, wanted) : weighted_percentile(speeds, wanted);
}

}  // namespace

VectorStatistics vector_statistics(const PreparedSurface& surface, std::span<const Vec3f> vectors, const Share* share) {
  if (vectors.size() != surface.points.size())
    throw Error("the vectors do not fit the surface",
                fmt::format("{} vectors, {} points", vectors.size(), surface.points.size()));
  Ranks* ranks = share ? share->ranks : nullptr;
  const std::vector<PointShare> shares = share_out(surface, vectors);
  VectorStatistics result;
  std::vector<std::pair<double, double>> moving;
  std::uint64_t used = 0, zero = 0;
  ExactSum normal, all;
  for (std::size_t p = 0; p < shares.size(); ++p) {
    const PointShare& at = shares[p];
    if (at.area <= 0 || !is_counted(share, p)) continue;
    ++used;
    const double size = is_finite(vectors[p]) ? length(Vec3d(vectors[p])) : 0.0;
    zero += size == 0;
    normal.add(at.normal);
    all.add(at.area * size);
    const double speed = at.tangential / at.area;
    result.max_speed = std::max(result.max_speed, speed);
    if (speed > 0) moving.emplace_back(speed, at.area);
  }
  sum_of_all(ranks, normal);
  sum_of_all(ranks, all);
  used = sum_of_all(ranks, used);
  zero = sum_of_all(ranks, zero);
  extremes_of_all(ranks, {}, {&result.max_speed, 1});
  if (all.value() > 0) result.normal_share = normal.value() / all.value();
  if (used > 0) result.zero_share = double(zero) / double(used);
  result.percentile_98 = percentile(ranks, moving, 0.98);
  return result;
}

}  // namespace nacre
