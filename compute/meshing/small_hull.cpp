// Nacre: the convex hull of a few points.
#include "compute/meshing/small_hull.hpp"

#include <algorithm>
#include <array>

namespace nacre {
namespace {

constexpr double flat = 1e-4;  // of the cube of the extent: six times a volume that counts as none

double volume(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  return dot(cross(b - a, c - a), d - a);
}

/// Four points that are far from each other's planes, in positive order; false where there are none.
bool first_cell(std::span<const Vec3d> p, double least, std::array<std::uint32_t, 4>& cell) {
  const auto farthest = [&](const auto& measure) {
    std::uint32_t best = 0;
    for (std::uint32_t i = 1; i < p.size(); ++i)
      if (measure(p[i]) > measure(p[best])) best = i;
    return best;
  };
  cell[0] = 0;
  cell[1] = farthest([&](const Vec3d& q) { return dot(q - p[0], q - p[0]); });
  const Vec3d u = p[cell[1]] - p[0];
  cell[2] = farthest([&](const Vec3d& q) { return dot(cross(u, q - p[0]), cross(u, q - p[0])); });
  cell[3] = farthest([&](const Vec3d& q) { return std::abs(volume(p[0], p[cell[1]], p[cell[2]], q)); });
  const double v = volume(p[0], p[cell[1]], p[cell[2]], p[cell[3]]);
  if (v < 0) std::swap(cell[1], cell[2]);
  return std::abs(v) > least;
}

/// Whether each edge is passed once each way, and there is one sphere.
bool is_sphere(const std::vector<Triangle>& hull) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::vector<std::uint32_t> corners;
  for (const Triangle& t : hull)
    for (int k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]}), corners.push_back(t[k]);
  std::sort(edges.begin(), edges.end());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  if (hull.size() + 4 != 2 * corners.size() || std::adjacent_find(edges.begin(), edges.end()) != edges.end())
    return false;
  return std::all_of(edges.begin(), edges.end(), [&](const auto& e) {
    return std::binary_search(edges.begin(), edges.end(), std::array<std::uint32_t, 2>{e[1], e[0]});
  });
}

}  // namespace

std::vector<Triangle> small_hull(std::span<const Vec3d> points) {
  if (points.size() < 4) return {};
  double extent2 = 0;
  for (const Vec3d& p : points) extent2 = std::max(extent2, dot(p - points[0], p - points[0]));
  const double least = flat * extent2 * std::sqrt(extent2);
  std::array<std::uint32_t, 4> c;
  if (!first_cell(points, least, c)) return {};
  std::vector<Triangle> hull = {{c[0], c[2], c[1]}, {c[0], c[1], c[3]}, {c[1], c[2], c[3]}, {c[2], c[0], c[3]}};
  std::vector<Triangle> kept;
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    kept.clear(), edges.clear();
    for (const Triangle& t : hull) {
      if (!(volume(points[t.a], points[t.b], points[t.c], points[i]) > least)) {
        kept.push_back(t);
        continue;
      }
      for (int k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3]});
    }
    if (edges.empty()) continue;
    // What is seen from the point goes; its rim is joined to the point.
    for (const auto& [from, to] : edges)
      if (std::find(edges.begin(), edges.end(), std::array<std::uint32_t, 2>{to, from}) == edges.end())
        kept.push_back({from, to, i});
    hull.swap(kept);
  }
  if (!is_sphere(hull)) hull.clear();
  return hull;
}

}  // namespace nacre
