// Nacre: makes the triangles of a closed implicit surface nearly equilateral.
#pragma once

#include "engine/scene/samples/polygonise.hpp"

namespace nacre {

/// Collapses short edges, flips edges and spreads the points evenly, so that edges become about `edge` long (the
/// input's must not be longer: none is split). A closed manifold stays one, and its points stay on the zero set of `f`;
/// no change turns a triangle by more than 60 degrees against the surface, unless it was turned as far before.
void remesh(const ImplicitFunction& f, double edge, PolygonMesh& mesh);

}  // namespace nacre
