// Nacre: meshes of second order: a node on each edge, and on the interface where the edge belongs to one.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/field/interface.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// The edges of a tetrahedron in the order of its midside nodes; the first three are those of a triangle.
inline constexpr std::array<std::array<std::size_t, 2>, 6> cell_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
/// The same for both directions of an edge.
inline std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
}

/// The midside nodes of a mesh of n points. Node k is point n + k of the mesh of second order.
struct SecondOrder {
  std::vector<Vec3d> nodes;                             ///< world; first those of the edges of triangles
  std::vector<std::array<std::uint32_t, 2>> edges;      ///< per node: the ends of its edge, the lower first
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< per triangle: its nodes, on the edges 01 12 20
  std::vector<std::array<std::uint32_t, 6>> cells;      ///< per cell: its nodes, on the edges 01 12 20 03 13 23

  std::int64_t on_surfaces = 0, on_curves = 0;  ///< nodes of interface edges, by what they were put on
  std::int64_t left_straight = 0;               ///< of interface edges that have no interface near their middle
  std::int64_t pulled_back = 0;      ///< of those put on an interface, the ones that had to go back towards the edge
  std::int64_t straightened = 0;     ///< of those pulled back, the ones back in the middle of the edge
  double least_jacobian = 1;         ///< of all elements: see `scaled_jacobian`
  std::int64_t curved_elements = 0;  ///< with a node that is not in the middle of its edge
};

/// Where each point comes to lie on its junction; not finite where there is none nearby.
using OntoJunctions = std::function<std::vector<Vec3d>(std::span<const Vec3d>, std::span<const Junction>)>;

/// No element is left with a smaller scaled Jacobian by its nodes, unless its straight twin is inverted.
inline constexpr double least_scaled_jacobian = 0.1;

/// A lower bound of the determinant of the Jacobian of a tetrahedron of second order over all of it, divided by that of
/// the tetrahedron with the same corners and straight edges, for which it is 1: the least of its 20 Bezier coefficients
/// (Johnen, Remacle & Geuzaine 2013, "Geometrical validity of curvilinear finite elements"). `node`: the corners, then
/// the nodes on the edges 01 12 20 03 13 23.
double scaled_jacobian(const std::array<Vec3d, 10>& node);

/// The same for a triangle in space: the least of the 6 coefficients of the normal's component along that of the flat
/// triangle. `node`: the corners, then the nodes on the edges 01 12 20.
double scaled_jacobian(const std::array<Vec3d, 6>& node);

/// Where a triangle of second order is at barycentric coordinates. `node`: the corners, then the nodes on 01 12 20.
Vec3d point_of_triangle(const std::array<Vec3d, 6>& node, const std::array<double, 3>& at);

/// Corners and nodes of triangle `t`.
std::array<Vec3d, 6> nodes_of_triangle(const SurfaceMesh& surface, const SecondOrder& second, std::size_t t);

/// The volume that the curved triangles enclose of each material below `materials`, world units^3; [0] is 0.
std::vector<double> enclosed_volumes(const SurfaceMesh& surface, const SecondOrder& second, int materials);

/// The nodes of `surface` alone, or (where `filled` is not null) of the tetrahedra that fill it, whose points begin
/// with those of `surface`. A node of a triangle's edge lies where `onto` puts the edge's middle: on the surface
/// between two materials, on the curve where three meet. It stays in the middle where `onto` finds nothing within 0.3
/// of the edge's length, and goes back towards it where an element would have a scaled Jacobian under
/// `least_scaled_jacobian`. All other nodes are in the middle of their edges. Throws Interrupted soon after `*stop` is
/// set.
SecondOrder second_order(const SurfaceMesh& surface, const TetrahedralMesh* filled, const OntoJunctions& onto,
                         const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
