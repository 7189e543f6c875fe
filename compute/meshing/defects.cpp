// Nacre: which particles spoil triangles, and where some are missing.
#include "compute/meshing/defects.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "compute/meshing/incidence.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr std::size_t small_body = 24, tiny_body = 12;  // points
constexpr double too_close = 0.25;                      // of a new point to old ones, in sizes
constexpr double long_edge = 1.3;                       // in sizes
constexpr double intrudes = 0.25;                       // from the line between two points of a curve, in sizes
constexpr double flat_angle = 115;                      // degrees
constexpr double in_front = 0.8, crowd = 0.45;          // in sizes: a new point before a rim, and from all others

/// A point that a bad triangle wants to be rid of.
struct Wish {
  double ratio;
  std::uint32_t point, triangle;
  std::size_t few;  ///< bodies of no more points keep it
  int flat = -1;    ///< the point's corner of the triangle, where it lies flat between the others
};

std::array<Vec3d, 3> corners(const SurfaceMesh& mesh, std::size_t t) {
  const Triangle& c = mesh.triangles[t];
  return {mesh.points[c.a], mesh.points[c.b], mesh.points[c.c]};
}

bool at_junction(const Triangle& t, std::span<const std::uint8_t> order) {
  return std::min({order[t.a], order[t.b], order[t.c]}) < 2;
}

/// The corner that lies flat between the two others, or -1.
int flat_corner(const std::array<double, 3>& angles) {
  const int widest = int(std::max_element(angles.begin(), angles.end()) - angles.begin());
  return angles[widest] > flat_angle ? widest : -1;
}

/// The point whose removal does away with a bad triangle, or `none`; `few`: bodies of no more points keep it. One that
/// all but coincides with another is of no use to any body.
std::uint32_t culprit(const SurfaceMesh& mesh, std::size_t t, std::span<const std::uint8_t> order,
                      std::span<const float> size, int flat, const DefectRule& rule, std::size_t& few) {
  const Triangle& c = mesh.triangles[t];
  const auto p = corners(mesh, t);
  int shortest = 0;
  double least = 1e300;
  for (int k = 0; k < 3; ++k) {
    const double edge = length(p[(k + 1) % 3] - p[k]);
    if (edge < least) least = edge, shortest = k;
  }
  const std::uint32_t a = c[shortest], b = c[(shortest + 1) % 3];
  const double share = least / std::min(size[a], size[b]);
  few = share < 0.2 ? 0 : share < 0.5 ? tiny_body : small_body;
  if (share < 0.5) return order[a] != order[b] ? (order[a] > order[b] ? a : b) : std::max(a, b);
  if (flat < 0) return none;
  if (order[c[flat]] == 2) return c[flat];
  if (rule.fills) return none;
  const int next = (flat + 1) % 3, last = (flat + 2) % 3;
  const bool next_is_nearer = length(p[next] - p[flat]) < length(p[last] - p[flat]);
  const std::uint32_t nearer = c[next_is_nearer ? next : last], other = c[next_is_nearer ? last : next];
  if (order[nearer] == 2 || order[other] == 2) return order[nearer] == 2 ? nearer : other;
  return order[c[flat]] == 1 ? c[flat] : none;
}

/// Has the closed surface of one of the point's materials no more than `few` points, so that it needs them all?
bool on_small_body(const SurfaceMesh& mesh, const VertexTable& facets_at, std::uint32_t point, std::size_t few) {
  std::vector<std::uint16_t> seen;
  for (const std::uint32_t corner : facets_at.corners(point))
    for (const std::uint16_t material : mesh.materials[corner / 3]) {
      if (std::find(seen.begin(), seen.end(), material) != seen.end()) continue;
      seen.push_back(material);
      std::vector<std::uint32_t> reached{point};
      for (std::size_t next = 0; next < reached.size() && reached.size() <= few; ++next)
        for (const std::uint32_t at : facets_at.corners(reached[next])) {
          const auto& pair = mesh.materials[at / 3];
          if (pair[0] != material && pair[1] != material) continue;
          for (int k = 0; k < 3; ++k) {
            const std::uint32_t other = mesh.triangles[at / 3][k];
            if (std::find(reached.begin(), reached.end(), other) == reached.end()) reached.push_back(other);
          }
        }
      if (reached.size() <= few) return true;
    }
  return false;
}

/// Where points are too few to take one away, another one splits the longest edge of a bad triangle, if it is long.
bool split(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, std::span<const float> size, std::uint32_t t,
           MeshDefects& defects) {
  const Triangle& c = mesh.triangles[t];
  const auto p = corners(mesh, t);
  int longest = 0;
  for (int k = 1; k < 3; ++k)
    if (length(p[(k + 1) % 3] - p[k]) > length(p[(longest + 1) % 3] - p[longest])) longest = k;
  const std::uint32_t a = c[longest], b = c[(longest + 1) % 3];
  if (order[a] != 2 || order[b] != 2) return false;
  if (length(mesh.points[b] - mesh.points[a]) <= long_edge * std::min(size[a], size[b])) return false;
  defects.insert.push_back({(mesh.points[a] + mesh.points[b]) / 2.0, mesh.materials[t], a});
  return true;
}

/// A new point splits the side of a triangle that is opposite its flat corner, if that is long and runs along a curve;
/// not where a curve ends, whose last points crowd.
bool split_curve(const SurfaceMesh& mesh, const VertexTable& facets_at, std::span<const std::uint8_t> order,
                 std::span<const float> size, std::uint32_t t, int flat, MeshDefects& defects) {
  const Triangle& c = mesh.triangles[t];
  const std::uint32_t a = c[(flat + 1) % 3], b = c[(flat + 2) % 3];
  if (order[a] != 1 || order[b] != 1) return false;
  if (length(mesh.points[b] - mesh.points[a]) <= long_edge * std::min(size[a], size[b])) return false;
  const Vec3d middle = (mesh.points[a] + mesh.points[b]) / 2.0;
  const auto is_there = [&](const MeshDefects::NewPoint& p) { return p.position == middle; };
  if (std::any_of(defects.insert.begin(), defects.insert.end(), is_there)) return true;  // for a triangle beyond it
  for (const std::uint32_t corner : facets_at.corners(a)) {
    if (!has_corner(mesh.triangles[corner / 3], b)) continue;
    for (const std::uint16_t third : mesh.materials[corner / 3]) {
      if (third == mesh.materials[t][0] || third == mesh.materials[t][1]) continue;
      defects.insert.push_back({middle, mesh.materials[t], a, third});
      return true;
    }
  }
  return false;
}

/// Points of a surface that have come into a junction.
std::vector<std::uint32_t> in_junctions(const SurfaceMesh& mesh, std::span<const std::uint8_t> order) {
  const std::vector<std::uint8_t> at_junction = junction_points(mesh);
  std::vector<std::uint32_t> found;
  for (std::uint32_t v = 0; v < at_junction.size(); ++v)
    if (at_junction[v] && order[v] == 2) found.push_back(v);
  return found;
}

/// Points of a surface that stand in a curve, between two of its own points, so that the curve is bent aside to them.
void find_intruders(const SurfaceMesh& mesh, const VertexTable& facets_at, std::span<const std::uint8_t> order,
                    std::span<const float> size, std::span<const std::uint32_t> candidates, std::vector<Wish>& wishes) {
  std::vector<std::uint32_t> rim;
  for (const std::uint32_t v : candidates) {
    rim.clear();
    for (const std::uint32_t corner : facets_at.corners(v))
      for (int k = 0; k < 3; ++k)
        if (const std::uint32_t other = mesh.triangles[corner / 3][k]; order[other] < 2) rim.push_back(other);
    const auto between = [&](std::uint32_t a, std::uint32_t b) {
      const Vec3d along = mesh.points[b] - mesh.points[a], r = mesh.points[v] - mesh.points[a];
      const double share = dot(r, along) / dot(along, along);
      return share > 0.2 && share < 0.8 && length(r - along * share) < intrudes * size[v];
    };
    const auto ends_here = [&](std::uint32_t a) {
      return std::any_of(rim.begin(), rim.end(), [&](std::uint32_t b) { return a < b && between(a, b); });
    };
    if (std::any_of(rim.begin(), rim.end(), ends_here))
      wishes.push_back({0, v, facets_at.corners(v)[0] / 3, small_body});
  }
}

/// Points wished away, the worst triangles first, no two of one triangle.
void choose(const SurfaceMesh& mesh, const VertexTable& facets_at, std::span<const std::uint8_t> order,
            std::span<const float> size, std::vector<Wish>& wishes, MeshDefects& defects) {
  std::sort(wishes.begin(), wishes.end(),
            [](const Wish& a, const Wish& b) { return a.ratio != b.ratio ? a.ratio < b.ratio : a.point < b.point; });
  std::vector<std::uint8_t> blocked(mesh.points.size(), 0);
  for (const Wish& w : wishes) {
    if (blocked[w.point]) continue;
    if (!on_small_body(mesh, facets_at, w.point, w.few))
      defects.remove.push_back(w.point);
    else if (!split(mesh, order, size, w.triangle, defects))
      continue;  // another wish for the point may be stronger
    for (const std::uint32_t corner : facets_at.corners(w.point))
      for (int k = 0; k < 3; ++k) blocked[mesh.triangles[corner / 3][k]] = 1;
  }
  std::sort(defects.remove.begin(), defects.remove.end());
}

/// New points in the facets where a surface of two materials touches itself, or another one off the junctions; at
/// junctions `anyhow`. Not next to old ones.
void fill_in(const SurfaceMesh& mesh, const VertexTable& facets_at, std::span<const std::uint8_t> order,
             std::span<const float> size, std::span<const std::array<std::uint32_t, 2>> touching, bool anyhow,
             MeshDefects& defects) {
  std::vector<std::uint32_t> facets, here;
  for (const auto& [a, b] : touching) {
    here.clear();
    for (const std::uint32_t corner : facets_at.corners(a))
      if (has_corner(mesh.triangles[corner / 3], b)) here.push_back(corner / 3);
    const auto alike = [&](std::uint32_t t) { return mesh.materials[t] == mesh.materials[here[0]]; };
    if (anyhow || (order[a] == 2 && order[b] == 2) || std::all_of(here.begin(), here.end(), alike))
      facets.insert(facets.end(), here.begin(), here.end());
  }
  std::sort(facets.begin(), facets.end());
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  for (const std::uint32_t t : facets) {
    const auto p = corners(mesh, t);
    const Vec3d middle = (p[0] + p[1] + p[2]) / 3.0;
    const auto crowded = [&](int k) { return length(p[k] - middle) < too_close * size[mesh.triangles[t][k]]; };
    if (!crowded(0) && !crowded(1) && !crowded(2))
      defects.insert.push_back({middle, mesh.materials[t], mesh.triangles[t].a});
  }
}

/// A rim's point lies flat between two on the surface: they have a gap of two sizes before it, room for a new one.
void fill_before_rim(const SurfaceMesh& mesh, const VertexTable& facets_at, std::span<const float> size,
                     std::uint32_t t, int flat, MeshDefects& defects) {
  const Triangle& c = mesh.triangles[t];
  const auto p = corners(mesh, t);
  const Vec3d across = (p[(flat + 1) % 3] + p[(flat + 2) % 3]) / 2.0 - p[flat];
  const Vec3d position = p[flat] + normalized(across) * (in_front * double(size[c[flat]]));
  if (!is_finite(position)) return;
  for (int k = 0; k < 3; ++k)
    for (const std::uint32_t corner : facets_at.corners(c[k]))
      for (int j = 0; j < 3; ++j) {
        const std::uint32_t q = mesh.triangles[corner / 3][j];
        if (length(mesh.points[q] - position) < crowd * size[q]) return;
      }
  defects.insert.push_back({position, mesh.materials[t], c[flat]});
}

}  // namespace

std::vector<std::uint32_t> triangles_under(double ratio, const SurfaceMesh& mesh) {
  return select_where(mesh.triangles.size(), [&](std::size_t t) {
    const auto p = corners(mesh, t);
    return !ratio_is_above(ratio, p[0], p[1], p[2]) && radius_ratio(p[0], p[1], p[2]) <= ratio;
  });
}

MeshDefects find_defects(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, std::span<const float> size,
                         std::span<const std::array<std::uint32_t, 2>> touching, const DefectRule& rule) {
  MeshDefects defects;
  struct Cap {
    std::uint32_t triangle;
    int flat;
  };
  std::vector<Wish> wishes;
  std::vector<Cap> caps;
  for (const std::uint32_t t : triangles_under(0.75, mesh)) {  // in others no angle is under 25 degrees
    const auto p = corners(mesh, t);
    const double ratio = radius_ratio(p[0], p[1], p[2]);
    const Triangle& c = mesh.triangles[t];
    const bool near = at_junction(c, order);
    const std::array<double, 3> angles = triangle_angles(p[0], p[1], p[2]);
    const double least = *std::min_element(angles.begin(), angles.end());
    if (ratio >= (near ? rule.near : rule.ratio) && least >= rule.angle) continue;
    ++defects.bad_triangles;
    std::size_t few = small_body;
    const int flat = flat_corner(angles);
    const std::uint32_t point = culprit(mesh, t, order, size, flat, rule, few);
    if (point != none)
      wishes.push_back({ratio, point, std::uint32_t(t), few, flat >= 0 && point == c[flat] ? flat : -1});
    else if (flat >= 0)
      caps.push_back({std::uint32_t(t), flat});
  }
  const std::vector<std::uint32_t> candidates = in_junctions(mesh, order);
  if (wishes.empty() && touching.empty() && caps.empty() && candidates.empty()) return defects;
  const VertexTable facets_at(mesh.triangles, mesh.points.size());
  if (rule.splits)
    std::erase_if(wishes, [&](const Wish& w) {
      return w.flat >= 0 && order[w.point] == 1 &&
             split_curve(mesh, facets_at, order, size, w.triangle, w.flat, defects);
    });
  find_intruders(mesh, facets_at, order, size, candidates, wishes);
  choose(mesh, facets_at, order, size, wishes, defects);
  fill_in(mesh, facets_at, order, size, touching, !rule.fills, defects);
  for (const Cap& cap : caps) fill_before_rim(mesh, facets_at, size, cap.triangle, cap.flat, defects);
  return defects;
}

void renumber(std::vector<std::array<std::uint32_t, 2>>& defects, std::span<const std::uint32_t> kept) {
  for (auto& defect : defects)
    for (std::uint32_t& v : defect) {
      const auto at = std::lower_bound(kept.begin(), kept.end(), v);
      assert(at != kept.end() && *at == v);
      v = std::uint32_t(at - kept.begin());
    }
}

void lift_off_junctions(const SurfaceMesh& mesh, std::vector<std::uint8_t>& order) {
  const auto near =
      select_where(mesh.triangles.size(), [&](std::size_t t) { return at_junction(mesh.triangles[t], order); });
  constexpr std::array<std::uint16_t, 2> nothing{0xffff, 0xffff};
  std::vector<std::array<std::uint16_t, 2>> seen(order.size(), nothing);
  std::vector<std::uint8_t> stays(order.size(), 0);
  for (const std::uint32_t t : near)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = mesh.triangles[t][k];
      if (seen[v] == nothing) seen[v] = mesh.materials[t];
      stays[v] |= mesh.materials[t] != seen[v];
    }
  for (std::size_t v = 0; v < order.size(); ++v)
    if (!stays[v]) order[v] = 2;
}

double highest_bad_ratio(const DefectRule& rule) {
  const double least = rule.angle * std::numbers::pi / 180, others = (std::numbers::pi - least) / 2;
  const double isosceles = 8 * std::sin(least / 2) * std::sin(others / 2) * std::sin(others / 2);
  return std::max({rule.ratio, rule.near, isosceles});
}

double triangle_fitness(const std::array<Vec3d, 3>& corners, bool at_junction, const DefectRule& rule) {
  const auto& [a, b, c] = corners;
  const double by_ratio = radius_ratio(a, b, c) / (at_junction ? rule.near : rule.ratio);
  const double fitness = std::min(by_ratio, best_fitness(rule));
  if (at_junction || rule.angle <= 0) return fitness;
  const std::array<double, 3> angles = triangle_angles(a, b, c);
  return std::min(fitness, *std::min_element(angles.begin(), angles.end()) / rule.angle);
}

double triangle_fitness(const SurfaceMesh& mesh, std::size_t t, std::span<const std::uint8_t> order,
                        const DefectRule& rule) {
  return triangle_fitness(corners(mesh, t), at_junction(mesh.triangles[t], order), rule);
}

std::vector<std::uint8_t> points_at_bad(const SurfaceMesh& mesh, std::span<const std::uint8_t> order,
                                        const DefectRule& rule) {
  std::vector<std::uint8_t> bad(mesh.points.size(), 0);
  for (const std::uint32_t t : triangles_under(highest_bad_ratio(rule) + 1e-6, mesh)) {
    const Triangle& c = mesh.triangles[t];
    if (triangle_fitness(mesh, t, order, rule) < 1) bad[c.a] = bad[c.b] = bad[c.c] = 1;
  }
  return bad;
}

double fitness(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, const DefectRule& rule) {
  const double best = best_fitness(rule);
  double least = best;
  for (const std::uint32_t t : triangles_under(best * highest_bad_ratio(rule) + 1e-6, mesh))
    least = std::min(least, triangle_fitness(mesh, t, order, rule));
  return least;
}

}  // namespace nacre
