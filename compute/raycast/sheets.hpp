// Nacre: two sheets in one place: a ray meets both, and sees the one that faces it.
#pragma once

#include "compute/raycast/triangle_boxes.hpp"

namespace nacre {

/// Second sheets lie where others do and face the other way. They are embedded aside, so that either has cells of its
/// own; this leads from where they are seen to where they are embedded.
struct SheetsView {
  const std::uint8_t* second = nullptr;  ///< per triangle: 1 in a second sheet; null: there are none
  Vec3d shift{};                         ///< cells

  NACRE_HD_INLINE Vec3d point(const Ray& ray, const Hit& hit) const {
    return second && second[hit.triangle] ? ray.at(hit.t) + shift : ray.at(hit.t);
  }
};

NACRE_HD inline bool faces_away(const MeshView& mesh, std::uint32_t triangle, const Ray& ray) {
  const Corners c = mesh.corners(triangle);
  return dot(cross(c.b - c.a, c.c - c.a), ray.direction) > 0;
}

/// First hits by the tree over all triangles, as they are seen.
struct NearestTriangles {
  TriangleBoxesView boxes{};
  SheetsView sheets{};

  static constexpr double together = 1e-6;  ///< cells: sheets that are no farther apart are in one place

  NACRE_HD bool find(const MeshView& mesh, const Ray& ray, Hit& hit) const {
    if (!sheets.second)
      return cast(boxes, ray, hit, [&](std::uint32_t t, const Ray& r, Hit& h) { intersect(mesh, t, r, h); });
    return cast(boxes, ray, hit, [&](std::uint32_t t, const Ray& r, Hit& h) {
      Hit own;
      intersect(mesh, t, r, own);
      if (own.triangle == none) return;
      const double nearer = h.t - own.t;
      const bool in_one_place = h.triangle != none && nearer < together && nearer > -together;
      const bool away = in_one_place && faces_away(mesh, t, r), other = in_one_place && faces_away(mesh, h.triangle, r);
      if (away != other ? other : nearer > 0 || (nearer == 0 && t < h.triangle)) h = own;
    });
  }
};

}  // namespace nacre
