// Nacre: triangulates quads by the better diagonal, convex polygons as fans, round ones by halves, others by ear
// clipping.
#include "engine/io/triangulate.hpp"

#include <algorithm>

namespace nacre {
namespace {

using Corners = std::vector<std::uint32_t>;

// Ear clipping takes quadratic time, and no legitimate polygon is larger than this.
constexpr std::size_t max_clipped_corners = 2000;

/// Twice the area of triangle abc, seen along `normal`; negative if it has the opposite orientation.
double turn(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& normal) {
  return dot(cross(b - a, c - a), normal);
}

/// Newell's normal: the area vector of the polygon, doubled.
Vec3d area_normal(const Corners& corners, const std::vector<Vec3d>& points) {
  const Vec3d origin = points[corners[0]];
  Vec3d sum;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i)
    sum += cross(points[corners[i]] - origin, points[corners[i + 1]] - origin);
  return sum;
}

void cut_quad(const Corners& q, const std::vector<Vec3d>& points, const Vec3d& normal, std::vector<Triangle>& out) {
  const Vec3d &a = points[q[0]], &b = points[q[1]], &c = points[q[2]], &d = points[q[3]];
  const double inside_ac = std::min(turn(a, b, c, normal), turn(a, c, d, normal));
  const double inside_bd = std::min(turn(a, b, d, normal), turn(b, c, d, normal));
  const bool both = inside_ac > 0 && inside_bd > 0;
  const bool use_ac = both ? dot(c - a, c - a) <= dot(d - b, d - b) : inside_ac >= inside_bd;
  if (use_ac) {
    out.push_back({q[0], q[1], q[2]});
    out.push_back({q[0], q[2], q[3]});
  } else {
    out.push_back({q[0], q[1], q[3]});
    out.push_back({q[1], q[2], q[3]});
  }
}

bool is_ear(const Corners& corners, std::size_t i, const std::vector<Vec3d>& points, const Vec3d& normal) {
  const std::size_t n = corners.size();
  const std::uint32_t ia = corners[(i + n - 1) % n], ib = corners[i], ic = corners[(i + 1) % n];
  const Vec3d &a = points[ia], &b = points[ib], &c = points[ic];
  if (turn(a, b, c, normal) <= 0) return false;
  for (const std::uint32_t other : corners) {
    if (other == ia || other == ib || other == ic) continue;
    const Vec3d& p = points[other];
    if (turn(a, b, p, normal) >= 0 && turn(b, c, p, normal) >= 0 && turn(c, a, p, normal) >= 0) return false;
  }
  return true;
}

void clip_ears(Corners corners, const std::vector<Vec3d>& points, const Vec3d& normal, std::vector<Triangle>& out) {
  std::size_t at = 0;
  while (corners.size() > 3) {
    const std::size_t n = corners.size();
    std::size_t tried = 0;
    while (tried < n && !is_ear(corners, (at + tried) % n, points, normal)) ++tried;
    // A self-intersecting polygon may have no ear left: take the next corner, so that this always ends.
    const std::size_t ear = (at + (tried < n ? tried : 0)) % n;
    out.push_back({corners[(ear + n - 1) % n], corners[ear], corners[(ear + 1) % n]});
    corners.erase(corners.begin() + ear);
    at = ear % corners.size();
  }
  out.push_back({corners[0], corners[1], corners[2]});
}

bool is_convex(const Corners& corners, const std::vector<Vec3d>& points, const Vec3d& normal) {
  const std::size_t n = corners.size();
  for (std::size_t i = 0; i < n; ++i)
    if (turn(points[corners[i]], points[corners[(i + 1) % n]], points[corners[(i + 2) % n]], normal) < 0) return false;
  return true;
}

// A fan of very many triangles is slivers from rim to rim, which every cell and every ray on their way has to look at.
constexpr std::size_t many_corners = 64, few_corners = 16;

/// Whether the rim from corner `first` to `last` bulges outwards at every scale, down to a few corners: then it can be
/// halved. Rims with straight parts would lose the corners on these.
bool is_round(const Corners& corners, std::size_t first, std::size_t last, const std::vector<Vec3d>& points,
              const Vec3d& unit_normal) {
  if (last - first <= few_corners) return true;
  const std::size_t middle = (first + last) / 2;
  const Vec3d &a = points[corners[first]], &b = points[corners[middle]], &c = points[corners[last]];
  constexpr double least_height = 1e-6;  // of the base
  return turn(a, b, c, unit_normal) > least_height * dot(c - a, c - a) &&
         is_round(corners, first, middle, points, unit_normal) && is_round(corners, middle, last, points, unit_normal);
}

/// The triangle between the ends and the middle of a part of the rim, and so on with both halves: all but few triangles
/// are small.
void cut_by_halves(const Corners& corners, std::size_t first, std::size_t last, std::vector<Triangle>& out) {
  if (last - first <= few_corners) {
    for (std::size_t i = first + 1; i < last; ++i) out.push_back({corners[first], corners[i], corners[i + 1]});
    return;
  }
  const std::size_t middle = (first + last) / 2;
  out.push_back({corners[first], corners[middle], corners[last]});
  cut_by_halves(corners, first, middle, out);
  cut_by_halves(corners, middle, last, out);
}

}  // namespace

void triangulate(std::span<const std::uint32_t> polygon, const std::vector<Vec3d>& points, std::vector<Triangle>& out) {
  if (polygon.size() == 3) {
    out.push_back({polygon[0], polygon[1], polygon[2]});
    return;
  }
  Corners corners;
  for (const std::uint32_t corner : polygon)
    if (corners.empty() || corner != corners.back()) corners.push_back(corner);
  while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  if (corners.size() < 3) return;

  const Vec3d normal = area_normal(corners, points);
  if (corners.size() == 3)
    out.push_back({corners[0], corners[1], corners[2]});
  else if (corners.size() == 4)
    cut_quad(corners, points, normal, out);
  else if (corners.size() > many_corners && is_round(corners, 0, corners.size() - 1, points, normalized(normal)))
    cut_by_halves(corners, 0, corners.size() - 1, out);
  else if (corners.size() > max_clipped_corners || is_convex(corners, points, normal))
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) out.push_back({corners[0], corners[i], corners[i + 1]});
  else
    clip_ears(std::move(corners), points, normal, out);
}

}  // namespace nacre
