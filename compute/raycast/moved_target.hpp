// Nacre: what rays traverse where the surface has moved away from the shape that is embedded.
#pragma once

#include "compute/raycast/footprint.hpp"
#include "compute/raycast/triangle_boxes.hpp"

namespace nacre {

/// Rays meet the triangles where they are now; the texture is looked up at the same material point of the embedded
/// shape, which `rest` knows. See render.hpp for what a target has.
template <class Target>
struct MovedTarget {
  Target rest;
  MeshView rest_mesh{}, moved_mesh{};
  TriangleBoxesView tree;  ///< of the triangles as they are now

  NACRE_HD bool find(const MeshView& mesh, const Ray& ray, Hit& hit) const {
    return cast(tree, ray, hit, [&](std::uint32_t t, const Ray& r, Hit& h) { intersect(mesh, t, r, h); });
  }

  NACRE_HD float texture(const float* shown, const Ray&, const Hit& hit, const Footprint& footprint) const {
    const Corners c = rest_mesh.corners(hit.triangle), now = moved_mesh.corners(hit.triangle);
    const Vec3d p = c.a * double(hit.weights.x) + c.b * double(hit.weights.y) + c.c * double(hit.weights.z);
    const auto at_rest = [&](const Vec3f& side) { return Vec3f(carried(Vec3d(side), now, c)); };
    return rest.at(shown, p, {at_rest(footprint.across), at_rest(footprint.up)});
  }

 private:
  /// A vector in the plane of triangle `from`, as the motion to triangle `to` carries it; zero if `from` has no area.
  NACRE_HD static Vec3d carried(const Vec3d& v, const Corners& from, const Corners& to) {
    const Vec3d e = from.b - from.a, f = from.c - from.a;
    const double ee = dot(e, e), ef = dot(e, f), ff = dot(f, f), det = ee * ff - ef * ef;
    if (!(det > 0)) return {};
    const double ve = dot(v, e), vf = dot(v, f);
    return (to.b - to.a) * ((ve * ff - vf * ef) / det) + (to.c - to.a) * ((vf * ee - ve * ef) / det);
  }
};

}  // namespace nacre
