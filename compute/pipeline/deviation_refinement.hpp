// Nacre: where new points bring the triangles of a mesh nearer to their interfaces.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/meshing/defects.hpp"
#include "compute/pipeline/mesh_deviation.hpp"

namespace nacre {

/// Bounds of a refinement.
struct DeviationRule {
  double most;      ///< that a triangle may deviate, in the unit of the deviation
  double detail;    ///< no new point is wished for nearer to others than 0.7 of this, in the unit of the mesh
  double unit = 1;  ///< of the deviation, in that of the mesh
  /// Where a new point has been in vain, with the third material there; may be empty.
  std::function<bool(std::uint16_t, const Vec3d&)> tried = {};
};

/// What brings the triangles above the bound nearer.
struct DeviationRefinement {
  std::vector<MeshDefects::NewPoint> insert;
  std::int64_t above = 0;            ///< triangles above the bound
  std::int64_t above_detail = 0;     ///< of these, those too small to be divided
  std::int64_t above_junctions = 0;  ///< of the others, those with a corner where more than two materials meet
  std::vector<std::uint32_t> worst;  ///< of these triangles at most 100, the worst first
};

/// New points in the triangles above the bound: at the middle of an edge on a junction curve, where that is too far
/// away or where the triangle's circumcentre is nearer to the edge's middle than its ends; else at the circumcentre,
/// which is as far from all points as from the corners where triangles are facets of Delaunay cells (Boissonnat & Oudot
/// 2005, "Provably good sampling and meshing of surfaces"). Where that was tried before: at the triangle's middle, then
/// at that of its longest edge. Points of one call keep 1.3 times their distance from old points from each other. Where
/// the curve is nearest to an edge's middle on the side on which it has other points, that is the far side of a small
/// loop: the new point is put on the other side, as far from the middle as the ends are.
DeviationRefinement refine_deviation(const SurfaceMesh& mesh, const MeshDeviation& deviation,
                                     const DeviationRule& rule);

/// The materials in which points of the world lie.
using MaterialsAt = std::function<std::vector<std::uint16_t>(std::span<const Vec3d>)>;

/// New points in the place of those of `points`, on surfaces of `mesh`, that have not become particles (`taken`: the
/// indices of those that have, ascending): where a third material covers the interface, points are to be on the curve
/// on which the three meet, on all sides of the one that was wished for: that curve may be a small loop that has no
/// point yet. They keep `spacing` from each other and from the points of the mesh on that curve.
std::vector<MeshDefects::NewPoint> points_on_rims(const SurfaceMesh& mesh,
                                                  std::span<const MeshDefects::NewPoint> points,
                                                  std::span<const std::uint32_t> taken, double spacing,
                                                  const NearestOnJunctions& onto, const MaterialsAt& material_at);

}  // namespace nacre
