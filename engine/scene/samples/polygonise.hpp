// Nacre: the zero set of a function in space as a closed triangle mesh.
#pragma once

#include <functional>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Negative inside, positive outside, about a distance near the surface: |f(p) - f(q)| <= 1.5 |p - q|.
using ImplicitFunction = std::function<double(const Vec3d&)>;

struct PolygonMesh {
  std::vector<Vec3d> points;
  std::vector<Vec3d> normals;  ///< unit, along the gradient of the function
  std::vector<Triangle> triangles;
};

/// Unit gradient of `f` at `p` by central differences over 2e-5 `scale`.
Vec3d implicit_normal(const ImplicitFunction& f, const Vec3d& p, double scale);

/// The zero set of `f` as a closed manifold wound outward, with edges of about `edge`: marching tetrahedra, which
/// cannot make holes or edges with more than two facets, then `remesh`. Points lie on the zero set to about 1e-9
/// `edge`; parts thinner than about `edge` are lost. The result does not depend on the number of threads. Throws Error
/// if the zero set is empty or not within the box from `lower` to `upper`, or if the box has too many cells of that
/// size.
PolygonMesh polygonise(const ImplicitFunction& f, const Vec3d& lower, const Vec3d& upper, double edge);

}  // namespace nacre
