// Nacre: a mesh made ready to be drawn and looked into, on any thread. No OpenGL here.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"
#include "engine/render/geometry.hpp"

namespace nacre {

/// What the passes take.
struct MeshDrawing {
  SurfaceGeometry geometry;
  std::vector<std::array<std::uint16_t, 2>> materials;  ///< of its triangles
  std::vector<std::array<std::uint32_t, 3>> edge_of;    ///< per triangle, of the geometry's edges
  std::vector<std::uint32_t> junctions;                 ///< edges of three or more triangles
};

MeshDrawing make_mesh_drawing(const SurfaceMesh& mesh);

/// A triangle and how badly it is shaped.
struct WorstTriangle {
  double radius_ratio = 1;
  std::uint32_t triangle = 0;
};

/// The figures of a mesh.
struct MeshMeasures {
  TopologyReport topology;
  SurfaceQuality quality;
  SurfaceDistance distance;
  std::vector<WorstTriangle> worst;  ///< the worst first; at most 1000
  std::vector<float> size;           ///< sizing field at the mesh's points, voxels
  std::vector<double> area;          ///< per material, of all its facets, world units^2
};

/// Of the facets of each of `materials` materials, world units^2.
std::vector<double> material_areas(const SurfaceMesh& mesh, std::size_t materials);

std::vector<WorstTriangle> worst_triangles(const SurfaceMesh& mesh, std::size_t most);

}  // namespace nacre
