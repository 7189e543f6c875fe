// Nacre: long edges of bad triangles, split by new points.
#include "compute/meshing/edge_splits.hpp"

#include <algorithm>
#include <utility>

#include "compute/math/sort_unique.hpp"
#include "compute/meshing/incidence.hpp"

namespace nacre {
namespace {

constexpr double least_share = 0.5;  // of the worst fitness that is left: edits and smoothing follow
constexpr double long_edge = 1.3;    // in sizes
constexpr double least_turn = 0.35;  // cosine between the normals of a surface before and after

std::vector<std::uint32_t> triangles_at(const SurfaceMesh& mesh, const VertexTable& table,
                                        const std::array<std::uint32_t, 2>& ends) {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t corner : table.corners(ends[0]))
    if (has_corner(mesh.triangles[corner / 3], ends[1])) found.push_back(corner / 3);
  return found;
}

Triangle with(Triangle t, std::uint32_t old, std::uint32_t fresh) {
  (t.a == old ? t.a : t.b == old ? t.b : t.c) = fresh;
  return t;
}

Vec3d normal(const SurfaceMesh& mesh, const Triangle& t) {
  return cross(mesh.points[t.b] - mesh.points[t.a], mesh.points[t.c] - mesh.points[t.a]);
}

/// Whether a triangle's normal is far from the mean of those at the edge that are of the same interface: a bad
/// triangle's own normal says little.
bool turns_away(const SurfaceMesh& mesh, std::span<const std::uint32_t> there, const Triangle& made,
                const std::array<std::uint16_t, 2>& materials) {
  Vec3d around{};
  for (const std::uint32_t t : there)
    if (mesh.materials[t] == materials) around += normal(mesh, mesh.triangles[t]);
  const Vec3d after = normal(mesh, made);
  return !(dot(around, after) > least_turn * length(around) * length(after));
}

}  // namespace

std::vector<EdgeSplit> edges_to_split(const SurfaceMesh& mesh, std::span<const std::uint8_t> order,
                                      std::span<const float> size, const DefectRule& rule) {
  std::vector<std::pair<double, std::uint32_t>> bad;
  for (const std::uint32_t t : triangles_under(highest_bad_ratio(rule) + 1e-6, mesh))
    if (const double fitness = triangle_fitness(mesh, t, order, rule); fitness < 1) bad.push_back({fitness, t});
  if (bad.empty()) return {};
  std::sort(bad.begin(), bad.end());
  const VertexTable table(mesh.triangles, mesh.points.size());
  std::vector<std::uint8_t> taken(mesh.triangles.size(), 0);
  std::vector<EdgeSplit> splits;
  for (const auto& [fitness, t] : bad) {
    const Triangle& corner = mesh.triangles[t];
    const auto side = [&](int k) { return mesh.points[corner[(k + 1) % 3]] - mesh.points[corner[k]]; };
    int longest = 0;
    for (int k = 1; k < 3; ++k)
      if (length(side(k)) > length(side(longest))) longest = k;
    const std::array<std::uint32_t, 2> ends{corner[longest], corner[(longest + 1) % 3]};
    if (length(side(longest)) <= long_edge * std::max(size[ends[0]], size[ends[1]])) continue;
    const std::vector<std::uint32_t> there = triangles_at(mesh, table, ends);
    std::vector<std::uint16_t> met;
    for (const std::uint32_t other : there)
      met.insert(met.end(), mesh.materials[other].begin(), mesh.materials[other].end());
    sort_unique(met);
    // A surface's edge has two triangles, a curve's three: elsewhere the mesh touches itself, or four materials meet.
    if (met.size() != there.size() || met.size() > 3) continue;
    if (std::any_of(there.begin(), there.end(), [&](std::uint32_t other) { return taken[other] != 0; })) continue;
    for (const std::uint32_t other : there) taken[other] = 1;
    const Vec3d middle = (mesh.points[ends[0]] + mesh.points[ends[1]]) / 2.0;
    splits.push_back({ends, {middle, {met[0], met[1]}, ends[0], met.size() == 3 ? met[2] : std::uint16_t(0xffff)}});
  }
  return splits;
}

std::vector<std::uint32_t> split_edges(SurfaceMesh& mesh, std::span<const std::uint8_t> order,
                                       std::span<const EdgeSplit> splits, std::span<const Vec3d> at,
                                       const DefectRule& rule) {
  const VertexTable table(mesh.triangles, mesh.points.size());
  std::vector<std::uint8_t> order_with(order.begin(), order.end());
  std::vector<std::uint32_t> made;
  for (std::uint32_t k = 0; k < splits.size(); ++k) {
    const auto& [ends, point] = splits[k];
    const std::vector<std::uint32_t> there = triangles_at(mesh, table, ends);
    const auto fresh = std::uint32_t(mesh.points.size());
    mesh.points.push_back(at[k]);
    order_with.push_back(point.third == 0xffff ? 2 : 1);
    const std::size_t before = mesh.triangles.size();
    double worst_before = best_fitness(rule), worst_after = worst_before;
    bool turns = false;
    for (const std::uint32_t t : there) {
      const Triangle old = mesh.triangles[t];
      worst_before = std::min(worst_before, triangle_fitness(mesh, t, order_with, rule));
      for (const std::uint32_t end : ends) {
        mesh.triangles.push_back(with(old, end, fresh));
        mesh.materials.push_back(mesh.materials[t]);
        worst_after = std::min(worst_after, triangle_fitness(mesh, mesh.triangles.size() - 1, order_with, rule));
        turns = turns || turns_away(mesh, there, mesh.triangles.back(), mesh.materials[t]);
      }
    }
    if (turns || !(worst_after > least_share * worst_before)) {
      mesh.triangles.resize(before), mesh.materials.resize(before);
      mesh.points.pop_back(), order_with.pop_back();
      continue;
    }
    for (std::size_t i = 0; i < there.size(); ++i) {
      mesh.triangles[there[i]] = mesh.triangles[before + 2 * i];
      mesh.triangles[before + i] = mesh.triangles[before + 2 * i + 1];
    }
    mesh.triangles.resize(before + there.size()), mesh.materials.resize(before);
    for (const std::uint32_t t : there) mesh.materials.push_back(mesh.materials[t]);
    made.push_back(k);
  }
  return made;
}

}  // namespace nacre
