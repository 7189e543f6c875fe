// Nacre: which cells of a grid lie near a triangle, found without looking at the empty ones.
#pragma once

#include <cmath>

#include "compute/embedding/triangle.hpp"
#include "compute/grid/vec.hpp"

namespace nacre {

NACRE_HD inline int clamp_cell(double x, int cells) { return x < 0 ? 0 : x >= cells ? cells - 1 : int(x); }

namespace detail {
/// Unit normal of the triangle's plane; of a needle, of some plane through its longest edge.
NACRE_HD inline Vec3d plane_normal(const Corners& t) {
  const Vec3d ab = t.b - t.a, bc = t.c - t.b, ca = t.a - t.c;
  Vec3d e = dot(ab, ab) >= dot(bc, bc) ? ab : bc;
  if (dot(ca, ca) > dot(e, e)) e = ca;
  const Vec3d n = cross(ab, bc);
  const double ee = dot(e, e);
  if (dot(n, n) > 1e-16 * ee * ee) return normalized(n);
  if (!(ee > 0)) return {0, 0, 1};
  const double ex = std::fabs(e.x), ey = std::fabs(e.y), ez = std::fabs(e.z);
  const int thin = ex <= ey && ex <= ez ? 0 : ey <= ez ? 1 : 2;
  Vec3d axis;
  axis[thin] = 1;
  return normalized(cross(e, axis));
}
}  // namespace detail

/// Calls visit(Int3) for every cell (unit cubes, 0..dims-1 per axis) that comes within `margin` of the triangle. With
/// margin 0 exactly those that the triangle touches (closed cells, with a slack of 1e-7); else those whose bounding
/// sphere comes that near, which are all that do and some more. Walks the columns along the normal's largest axis, so
/// that a triangle thousands of cells wide costs its area, not its bounding box.
template <class Visit>
NACRE_HD void for_cells_near(const Corners& t, double margin, Int3 dims, Visit&& visit) {
  const Vec3d low = min(t.a, min(t.b, t.c)), high = max(t.a, max(t.b, t.c));
  const Vec3d n = detail::plane_normal(t);
  const double slack = margin + 1e-7;
  Int3 first, last;
  for (int axis = 0; axis < 3; ++axis) {
    if (low[axis] - slack >= dims[axis] || high[axis] + slack < 0) return;
    first[axis] = clamp_cell(low[axis] - slack, dims[axis]);
    last[axis] = clamp_cell(high[axis] + slack, dims[axis]);
  }
  const double ax = std::fabs(n.x), ay = std::fabs(n.y), az = std::fabs(n.z);
  const int w = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
  const int u = w == 0 ? 1 : 0, v = w == 2 ? 1 : 2;
  const double off_b = std::fabs(dot(n, t.b - t.a)), off_c = std::fabs(dot(n, t.c - t.a));  // of a needle's plane
  const double thickness = slack + (off_b > off_c ? off_b : off_c);
  const double reach = (0.5 * (std::fabs(n[u]) + std::fabs(n[v])) + thickness) / std::fabs(n[w]);
  const double sphere = margin + 0.8660254037844387;  // half the diagonal of a cell

  for (int iv = first[v]; iv <= last[v]; ++iv)
    for (int iu = first[u]; iu <= last[u]; ++iu) {
      int from = first[w], to = last[w];
      const double plane = t.a[w] - (n[u] * (iu + 0.5 - t.a[u]) + n[v] * (iv + 0.5 - t.a[v])) / n[w];
      if (plane - reach >= to + 1 || plane + reach < from) continue;
      from = from > plane - reach ? from : int(std::floor(plane - reach));
      to = to < plane + reach ? to : int(std::floor(plane + reach));
      for (int iw = from; iw <= to; ++iw) {
        Int3 cell;
        cell[u] = iu;
        cell[v] = iv;
        cell[w] = iw;
        const Vec3d centre{cell.x + 0.5, cell.y + 0.5, cell.z + 0.5};
        bool near;
        if (margin > 0) {
          const Vec3d d = closest_point(t, centre) - centre;
          near = dot(d, d) <= sphere * sphere;
        } else {
          near = touches_cube(t, centre, 0.5 + 1e-7);
        }
        if (near) visit(cell);
      }
    }
}

}  // namespace nacre
