// Nacre: which cells of a grid are near a triangle, found without visiting the empty ones.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/embedding/triangle.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

/// The cell of 0..cells-1 that contains `x` or is nearest to it; 0 for NaN.
NACRE_HD inline int clamp_cell(double x, int cells) { return x >= cells ? cells - 1 : x >= 0 ? int(x) : 0; }

namespace detail {
/// Unit normal of the triangle's plane; for a needle, of some plane through its longest edge.
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

/// The part of axis `u` that the triangle covers where axis `v` is in low .. high; `from` > `to` if it is empty.
NACRE_HD inline void extent_in_slab(const Corners& t, int u, int v, double low, double high, double& from, double& to) {
  const Vec3d corner[3] = {t.a, t.b, t.c};
  from = 1e300;
  to = -1e300;
  for (int k = 0; k < 3; ++k) {
    const Vec3d &p = corner[k], &q = corner[(k + 1) % 3];
    const double d = q[v] - p[v];
    if ((d >= 0 ? p[v] : q[v]) > high || (d >= 0 ? q[v] : p[v]) < low) continue;
    for (int end = 0; end < 2; ++end) {
      double s = end;  // the ends of an edge that is parallel to the slab
      if (d != 0) s = ((end ? high : low) - p[v]) / d;
      s = s > 0 ? (s < 1 ? s : 1) : 0;
      const double x = p[u] + s * (q[u] - p[u]);
      from = x < from ? x : from;
      to = x > to ? x : to;
    }
  }
}

constexpr double touching = 1e-7;  ///< whatever is nearer to a cell than this touches it

/// The cells that a triangle's bounding box, grown by `slack`, overlaps; empty if its coordinates are NaN.
struct CellBox {
  Int3 first, last;
  bool empty = true;

  NACRE_HD_INLINE CellBox(const Corners& t, double slack, const Int3& dims) {
    if (!is_finite(t.a + t.b + t.c)) return;
    const Vec3d low = min(t.a, min(t.b, t.c)) - Vec3d(slack), high = max(t.a, max(t.b, t.c)) + Vec3d(slack);
    for (int axis = 0; axis < 3; ++axis) {
      if (low[axis] >= dims[axis] || high[axis] < 0) return;
      first[axis] = clamp_cell(low[axis], dims[axis]);
      last[axis] = clamp_cell(high[axis], dims[axis]);
    }
    empty = false;
  }

  /// One cell wide along two axes: in this case the triangle passes through all of its cells.
  NACRE_HD_INLINE bool thin() const {
    return int(first.x == last.x) + int(first.y == last.y) + int(first.z == last.z) >= 2;
  }
  NACRE_HD_INLINE int length() const { return last.x - first.x + last.y - first.y + last.z - first.z + 1; }
};

/// The columns of cells near a triangle, along the largest axis `w` of its normal, in rows along `u`.
struct ColumnWalk {
  Corners t;
  Vec3d n;
  double slack, reach;  // of the plane over the middle of a column: how far away cells along w may be
  int u, v, w;
  Int3 dims, first, last;

  NACRE_HD ColumnWalk(const Corners& corners, double slack_, const CellBox& box, Int3 dims_)
      : t(corners), n(plane_normal(t)), slack(slack_), dims(dims_), first(box.first), last(box.last) {
    const double ax = std::fabs(n.x), ay = std::fabs(n.y), az = std::fabs(n.z);
    w = ax >= ay && ax >= az ? 0 : ay >= az ? 1 : 2;
    u = w == 0 ? 1 : 0;
    v = w == 2 ? 1 : 2;
    const double off_b = std::fabs(dot(n, t.b - t.a)), off_c = std::fabs(dot(n, t.c - t.a));  // of a needle's plane
    const double thickness = slack + (off_b > off_c ? off_b : off_c);
    reach = (0.5 * (std::fabs(n[u]) + std::fabs(n[v])) + thickness) / std::fabs(n[w]);
  }

  /// Where the plane of the triangle crosses the middle of a column.
  NACRE_HD_INLINE double plane(double middle_u, int iv) const {
    return t.a[w] - (n[u] * (middle_u - t.a[u]) + n[v] * (iv + 0.5 - t.a[v])) / n[w];
  }

  /// The columns of a row, without those whose cells near the plane are outside. False if there are none.
  NACRE_HD bool row(int iv, int& from, int& to) const {
    double low, high;
    extent_in_slab(t, u, v, iv - slack, iv + 1 + slack, low, high);
    low -= slack + 1e-7;
    high += slack + 1e-7;
    const double slope = -n[u] / n[w];
    if (std::fabs(slope) * dims[u] > 1) {
      const double base = plane(0, iv), a = (-reach - base) / slope, b = (dims[w] + reach - base) / slope;
      low = std::fmax(low, (a < b ? a : b) - 1.5);
      high = std::fmin(high, (a < b ? b : a) + 1.5);
    }
    if (!(low <= high && low < dims[u] && high >= 0)) return false;
    from = clamp_cell(low, dims[u]);
    to = clamp_cell(high, dims[u]);
    return true;
  }
};
}  // namespace detail

/// About how many columns of cells are under a triangle: `for_cells_near` visits at least as many cells.
NACRE_HD inline std::uint64_t columns_under(const Corners& t, Int3 dims) {
  const detail::CellBox box(t, detail::touching, dims);
  if (box.empty) return 0;
  if (box.thin()) return std::uint64_t(box.length());
  const detail::ColumnWalk walk(t, detail::touching, box, dims);
  std::uint64_t columns = 0;
  const int stride = 1 + (walk.last[walk.v] - walk.first[walk.v]) / 1024;  // a sample of the rows, if many
  int from = 0, to = 0;
  for (int iv = walk.first[walk.v]; iv <= walk.last[walk.v]; iv += stride)
    if (walk.row(iv, from, to)) columns += std::uint64_t(stride) * std::uint64_t(to - from + 1);
  return columns;
}

/// Calls visit(Int3) for every cell (unit cubes, 0..dims-1 per axis) that comes within `margin` of the triangle. With
/// margin 0, exactly those that the triangle touches (closed cells, with a tolerance of 1e-7); otherwise those whose
/// bounding sphere comes that near, which are all that do and some more. It visits the columns along the normal's
/// largest axis that are under the triangle, so that a triangle thousands of cells wide costs its area, not its
/// bounding box. A triangle whose coordinates are NaN is near nothing.
template <class Visit>
NACRE_HD void for_cells_near(const Corners& t, double margin, Int3 dims, Visit&& visit) {
  const detail::CellBox box(t, margin + detail::touching, dims);
  if (box.empty) return;
  if (margin == 0 && box.thin()) {
    for (int z = box.first.z; z <= box.last.z; ++z)
      for (int y = box.first.y; y <= box.last.y; ++y)
        for (int x = box.first.x; x <= box.last.x; ++x) visit(Int3(x, y, z));
    return;
  }
  const detail::ColumnWalk walk(t, margin + detail::touching, box, dims);
  const int u = walk.u, v = walk.v, w = walk.w;
  const double sphere = margin + 0.8660254037844387;  // half the diagonal of a cell

  for (int iv = walk.first[v]; iv <= walk.last[v]; ++iv) {
    int iu_first = 0, iu_last = -1;
    if (!walk.row(iv, iu_first, iu_last)) continue;
    for (int iu = iu_first; iu <= iu_last; ++iu) {
      int from = walk.first[w], to = walk.last[w];
      const double plane = walk.plane(iu + 0.5, iv), reach = walk.reach;
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
          near = touches_cube(t, centre, 0.5 + detail::touching);
        }
        if (near) visit(cell);
      }
    }
  }
}

}  // namespace nacre
