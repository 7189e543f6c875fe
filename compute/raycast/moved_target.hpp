// Nacre: what rays traverse where the surface has moved away from the shape that is embedded.
#pragma once

#include "compute/raycast/box_tree.hpp"

namespace nacre {

/// Rays meet the triangles where they are now; the texture is looked up at the same material point of the embedded
/// shape, which `rest` knows. See render.hpp for what a target has.
template <class Target>
struct MovedTarget {
  Target rest;
  MeshView rest_mesh{};
  BoxTreeView tree;  ///< of the triangles as they are now

  NACRE_HD bool find(const MeshView& mesh, const Ray& ray, Hit& hit) const { return cast(tree, mesh, ray, hit); }

  NACRE_HD float texture(const float* shown, const Ray& ray, const Hit& hit) const {
    const Corners c = rest_mesh.corners(hit.triangle);
    const Vec3d p = c.a * double(hit.weights.x) + c.b * double(hit.weights.y) + c.c * double(hit.weights.z);
    Hit there = hit;
    there.t = 0;
    return rest.texture(shown, {p, ray.direction}, there);
  }
};

}  // namespace nacre
