// Nacre: which particles spoil triangles, and where some are missing.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// Which triangles are bad.
struct DefectRule {
  double angle = 25;   ///< one under this, degrees
  double ratio = 0.4;  ///< or the radius ratio under this
  double near = 0.4;   ///< ... where a corner is on a junction
  /// A rim's corner that lies flat gets a new point in front of it; else a neighbour goes, if one may.
  bool fills = true;
  /// Of three points of curves, the flat one stays where the side opposite it can be split.
  bool splits = false;
};

/// The least that is asked of a mesh, with a margin. Once all particles have been smoothed, only triangles below it
/// make particles come and go.
inline constexpr DefectRule worst_defects{0, 0.31, 0.21, false};
/// Triangles with a smaller ratio are worth further rounds of smoothing.
inline constexpr double wanted_ratio = 0.5;
inline constexpr DefectRule mediocre{0, wanted_ratio, wanted_ratio, false};
/// What is aimed at where time does not matter.
inline constexpr DefectRule not_fine{30, wanted_ratio, wanted_ratio, false};

/// What to change about the particles of a mesh before they are triangulated again.
struct MeshDefects {
  struct NewPoint {
    Vec3d position;
    std::array<std::uint16_t, 2> materials;
    std::uint32_t at;              ///< a point of the mesh that it is next to
    std::uint16_t third = 0xffff;  ///< a material that it is to meet, too: it is for the curve of the three
  };
  std::int64_t bad_triangles = 0;
  std::vector<std::uint32_t> remove;  ///< points of the mesh, ascending; no two of them share a triangle
  std::vector<NewPoint> insert;       ///< near the interface of two materials
};

/// Bad triangles come from particles that are far too close together (under half of the smaller `size`): one of the two
/// is to go, the one on the surface rather than the one on a curve, on a curve rather than at a point; or, where all
/// edges are long, from one that lies flat between its neighbours: it is to go if it is on a surface. One on a rim
/// stays: a new point is put in front of it or, as a last resort (`rule.fills` unset), the nearest corner on the
/// surface is to go, and where all are on curves the flat one (with `rule.splits`, if the side opposite it is long and
/// runs along a curve, a new point splits that instead). A point of a surface that stands between two neighbours on a
/// curve goes, too: it bends the curve aside. Small bodies keep theirs (a closed surface of 24 points; of 12, if
/// they are too close together), but for those nearer than 0.2 sizes; there a new point splits the longest edge, if it
/// is long. `touching` are edges (two points), or vertices (one point twice), where a surface touches itself: off the
/// junctions that shows that it is too coarsely sampled, and new points go into the middle of the facets there; as a
/// last resort at junctions, too. `order` (2 surface, 1 curve, 0 point; of a junction that the mesh has:
/// lift_off_junctions) and `size` (world units) are per point of the mesh.
MeshDefects find_defects(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, std::span<const float> size,
                         std::span<const std::array<std::uint32_t, 2>> touching, const DefectRule& rule = {});

/// Gives the points of `defects` the numbers that they have where only the points `kept`, theirs among them, are left.
void renumber(std::vector<std::array<std::uint32_t, 2>>& defects, std::span<const std::uint32_t> kept);

/// A point of a junction counts as a surface's where the mesh has no junction: too little of a third material comes
/// there for a cell of its own. So triangles are judged by what the mesh shows. `order` is per point of the mesh.
void lift_off_junctions(const SurfaceMesh& mesh, std::vector<std::uint8_t>& order);

/// Triangles with a radius ratio of `ratio` or less, ascending.
std::vector<std::uint32_t> triangles_under(double ratio, const SurfaceMesh& mesh);

/// The highest ratio of a triangle that can be bad by `rule`.
double highest_bad_ratio(const DefectRule& rule);

/// How far a triangle is above what `rule` asks, as a multiple of it; below 1 where it is bad. Its angles count only
/// where no corner is on a junction.
double triangle_fitness(const std::array<Vec3d, 3>& corners, bool at_junction, const DefectRule& rule);
double triangle_fitness(const SurfaceMesh& mesh, std::size_t t, std::span<const std::uint8_t> order,
                        const DefectRule& rule);

/// The largest fitness: better triangles are not distinguished.
inline double best_fitness(const DefectRule& rule) { return rule.ratio < wanted_ratio ? wanted_ratio / rule.ratio : 1; }

/// Marks the points of triangles that are bad by `rule`.
std::vector<std::uint8_t> points_at_bad(const SurfaceMesh& mesh, std::span<const std::uint8_t> order,
                                        const DefectRule& rule);

/// The least fitness of all triangles.
double fitness(const SurfaceMesh& mesh, std::span<const std::uint8_t> order, const DefectRule& rule);

}  // namespace nacre
