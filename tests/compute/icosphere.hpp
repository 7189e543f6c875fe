// Nacre: a mesh of a ball, for tests.
#pragma once

#include <utility>

#include "compute/meshing/surface_mesh.hpp"
#include "tests/icosphere.hpp"

namespace nacre::test {

/// About zero; material 1 is inside.
inline SurfaceMesh icosphere(int level, double radius) {
  Icosphere unit = unit_icosphere(level);
  SurfaceMesh mesh;
  mesh.points = std::move(unit.points);
  mesh.triangles = std::move(unit.triangles);
  for (Vec3d& p : mesh.points) p *= radius;
  mesh.materials.assign(mesh.triangles.size(), {0, 1});
  return mesh;
}

}  // namespace nacre::test
