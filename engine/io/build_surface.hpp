// Nacre: from the contents of a file to a surface that the numerics can rely on.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/io/raw_mesh.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Triangulates the polygons of `mesh`, drops what cannot be used (corners without a point, points that are NaN or
/// infinite, triangles without area), moves arrays on cells to the points (mean of the adjacent triangles, weighted by
/// area), sets NaN and infinite values to 0, and drops points that no triangle uses. Each loss adds one sentence with
/// counts to `warnings`. Throws Error with `name` (the file) if no triangle is left.
/// `moved`: positions of the same points at another time; null: none. They become the points of the result, everything
/// else follows from the mesh's own. `part`: of a larger mesh; it may have no triangle.
Surface build_surface(RawMesh mesh, const std::string& name, std::vector<std::string>& warnings,
                      const std::vector<Vec3d>* moved = nullptr, bool part = false);

/// 1234567 as "1,234,567".
std::string with_commas(std::size_t number);

}  // namespace nacre
