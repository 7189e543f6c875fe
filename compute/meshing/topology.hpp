// Nacre: whether a mesh of materials is closed, manifold off the junctions, and turned the same way everywhere.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// The surface of one material: all facets with it on one of their sides.
struct MaterialTopology {
  std::int64_t vertices = 0, edges = 0, facets = 0;
  std::int64_t components = 0;  ///< of the surface; parts that share a vertex are one
  std::int64_t euler = 0;       ///< vertices - edges + facets
  bool closed = false;          ///< has facets, and passes every edge as often one way as the other
  double volume = 0;            ///< within, world units^3; of the outside (0): less that of everything else
};

/// A junction edge is one whose facets touch three or more materials; a vertex is on a junction if one of its edges is.
/// Every edge and vertex is counted under one heading at most, but for `inconsistent_edges`.
struct TopologyReport {
  std::int64_t vertices = 0;  ///< that a facet uses
  std::int64_t unused_points = 0;
  std::int64_t triangles = 0, edges = 0;
  std::int64_t components = 0;         ///< of the whole mesh; parts that share a vertex are one
  std::int64_t boundary_edges = 0;     ///< with one facet
  std::int64_t nonmanifold_edges = 0;  ///< off junctions, with more than two facets; or on one, a material meets it in
                                       ///< an odd number of facets
  std::int64_t junction_edges = 0;     ///< touch three or more materials
  std::int64_t pinched_edges = 0;      ///< of the junction edges, those that a material meets in more than one wedge
  std::int64_t nonmanifold_vertices = 0;    ///< off junctions, a material's surface passes more than once through it
  std::int64_t pinched_vertices = 0;        ///< the same on junctions
  std::int64_t inconsistent_edges = 0;      ///< a material's surface passes it more often one way than the other
  std::int64_t duplicate_triangles = 0;     ///< same three corners as an earlier one
  std::int64_t degenerate_triangles = 0;    ///< no area
  std::vector<MaterialTopology> materials;  ///< by number; [0] is the outside

  /// Closed around every material, manifold off junctions, consistent, nothing duplicated or degenerate.
  bool sound() const {
    return boundary_edges == 0 && nonmanifold_edges == 0 && nonmanifold_vertices == 0 && inconsistent_edges == 0 &&
           duplicate_triangles == 0 && degenerate_triangles == 0;
  }
};

/// Examines `mesh`, whose material numbers are less than `materials` (throws Error where one is not, or a corner is no
/// point). Materials that no facet touches come out with zeros.
TopologyReport check_topology(const SurfaceMesh& mesh, int materials);

/// The points that check_topology counts as nonmanifold vertices, ascending.
std::vector<std::uint32_t> pinched_points(const SurfaceMesh& mesh);

}  // namespace nacre
