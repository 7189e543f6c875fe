// Nacre: which particles spoil triangles, and where some are missing.
#include "compute/meshing/defects.hpp"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "compute/meshing/quality.hpp"

namespace nacre {
namespace {

/// A point that a bad triangle wants to be rid of.
struct Wish {
  double ratio;
  std::uint32_t point;
};

std::array<Vec3d, 3> corners(const SurfaceMesh& mesh, std::size_t t) {
  const Triangle& c = mesh.triangles[t];
  return {mesh.points[c.a], mesh.points[c.b], mesh.points[c.c]};
}

/// The point whose removal mends a bad triangle, or `none`.
std::uint32_t culprit(const SurfaceMesh& mesh, std::size_t t, std::span<const std::uint8_t> order,
                      std::span<const float> size, const std::array<double, 3>& angles) {
  const Triangle& c = mesh.triangles[t];
  const auto p = corners(mesh, t);
  int shortest = 0;
  double least = 1e300;
  for (int k = 0; k < 3; ++k) {
    const double edge = length(p[(k + 1) % 3] - p[k]);
    if (edge < least) least = edge, shortest = k;
  }
  const std::uint32_t a = c[shortest], b = c[(shortest + 1) % 3];
  if (least < 0.5 * std::min(size[a], size[b]))
    return order[a] != order[b] ? (order[a] > order[b] ? a : b) : std::max(a, b);
  const int widest = int(std::max_element(angles.begin(), angles.end()) - angles.begin());
  return angles[widest] > 115 && order[c[widest]] == 2 ? c[widest] : none;
}

/// Points wished away, the worst triangles first, no two of one triangle.
std::vector<std::uint32_t> choose(const SurfaceMesh& mesh, std::vector<Wish>& wishes) {
  std::sort(wishes.begin(), wishes.end(),
            [](const Wish& a, const Wish& b) { return a.ratio != b.ratio ? a.ratio < b.ratio : a.point < b.point; });
  std::vector<std::uint8_t> wished(mesh.points.size(), 0), blocked(mesh.points.size(), 0);
  for (const Wish& w : wishes) wished[w.point] = 1;
  // Facets of the points that are wished away, by point.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> facets;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (wished[mesh.triangles[t][k]]) facets.emplace_back(mesh.triangles[t][k], std::uint32_t(t));
  std::sort(facets.begin(), facets.end());
  std::vector<std::uint32_t> chosen;
  for (const Wish& w : wishes) {
    if (blocked[w.point]) continue;
    chosen.push_back(w.point);
    for (auto f = std::lower_bound(facets.begin(), facets.end(), std::pair(w.point, std::uint32_t(0)));
         f != facets.end() && f->first == w.point; ++f)
      for (int k = 0; k < 3; ++k) blocked[mesh.triangles[f->second][k]] = 1;
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Facets at edges that two materials alone share more than twice.
void find_touching(const SurfaceMesh& mesh, MeshDefects& defects) {
  struct Side {
    std::uint64_t edge;
    std::uint32_t facet;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint64_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b) << 32 | std::max(a, b), std::uint32_t(t)});
    }
  tbb::parallel_sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return a.edge != b.edge ? a.edge < b.edge : a.facet < b.facet;
  });
  std::vector<std::uint32_t> facets;
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].edge == sides[i].edge) ++j;
    if (j - i < 3) continue;
    const auto same = [&](const Side& s) { return mesh.materials[s.facet] == mesh.materials[sides[i].facet]; };
    if (!std::all_of(sides.begin() + std::ptrdiff_t(i), sides.begin() + std::ptrdiff_t(j), same)) continue;
    ++defects.nonmanifold_edges;
    for (std::size_t k = i; k < j; ++k) facets.push_back(sides[k].facet);
  }
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  for (const std::uint32_t t : facets) {
    const auto p = corners(mesh, t);
    defects.insert.push_back({(p[0] + p[1] + p[2]) / 3.0, mesh.materials[t]});
  }
}

}  // namespace

MeshDefects find_defects(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, std::span<const float> size) {
  MeshDefects defects;
  std::vector<Wish> wishes;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto p = corners(mesh, t);
    const double ratio = radius_ratio(p[0], p[1], p[2]);
    if (ratio > 0.75) continue;  // then no angle is under 25 degrees
    const std::array<double, 3> angles = triangle_angles(p[0], p[1], p[2]);
    if (ratio >= 0.4 && *std::min_element(angles.begin(), angles.end()) >= 25) continue;
    ++defects.bad_triangles;
    const std::uint32_t point = culprit(mesh, t, order, size, angles);
    if (point != none) wishes.push_back({ratio, point});
  }
  defects.remove = choose(mesh, wishes);
  find_touching(mesh, defects);
  return defects;
}

}  // namespace nacre
