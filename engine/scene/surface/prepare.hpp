// Nacre: a surface made ready for the numerics, and the choice of the vectors to show on it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "compute/math/vec.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

struct Share;  // engine/scene/surface/surface_share.hpp

/// What the numerics take: clean triangles with consistent winding, and normals that respect creases.
struct PreparedSurface {
  std::vector<Vec3d> points;          ///< as in the file, one to one with its arrays (unused where not finite: moved)
  std::vector<Triangle> triangles;    ///< indices in range, area above zero, none twice, winding consistent
  std::vector<Vec3f> corner_normals;  ///< three per triangle, unit length: `corner_normals[3 * triangle + corner]`
  /// Per triangle 1 for those of a second sheet (engine/scene/surface/sheets.hpp); empty: there is none.
  std::vector<std::uint8_t> second_sheet;
};

/// Cleans and orients `surface`. Triangles with indices out of range, coordinates that are not finite, no area, or the
/// same three points as an earlier one are dropped. Winding is made consistent across every edge that joins exactly two
/// triangles; closed parts face outwards (positive volume), open ones keep the winding of their majority. Points at the
/// same position count as one for this, so a seam does not show. A corner's normal is the angle-weighted mean over the
/// triangles around its point whose normals lie within `crease_degrees` of its own triangle's. Points that are not
/// finite are moved onto a used point, so that a bounding box of all points stays finite.
/// Where two sheets lie in one place and face opposite ways, as thin walls do in files of flow simulations, both stay,
/// if they have points of their own and the file has arrays on these. The second ones come last. Either sheet is what
/// one sees from the side that it faces; open parts face inwards where most closed ones of the file did.
/// Each kind of repair adds one sentence with its count to `warnings`. Throws Error where no triangle is left.
PreparedSurface prepare(const Surface& surface, double crease_degrees = 40.0,
                        std::vector<std::string>* warnings = nullptr);

/// The corner normals of other positions of the same points, by the same rule. `same[point]`: the first point at its
/// position in the shape that was prepared (first_at_position), so that parts which only touch stay apart.
void update_normals(PreparedSurface& surface, std::span<const std::uint32_t> same, double crease_degrees);

/// Whether a triangle has no area, and is dropped for that.
bool has_no_area(const std::vector<Vec3d>& points, const Triangle& triangle);

struct WindingReport;
/// The sentences on what was done to a surface; `flat`: triangles dropped that have no area.
void tell_repairs(const WindingReport& winding, std::size_t flat, std::vector<std::string>* warnings);

/// What a name says about the motion of a surface.
enum class VectorKind { other, wall_shear, velocity };
VectorKind vector_kind(const std::string& name);

/// The array to show, and a phrase that says why it is this one.
struct VectorChoice {
  std::string name;
  std::string reason;
};

/// Which vectors to show. `request` names an array (exactly, else up to case) or an analytic field ("@swirl"). Empty:
/// the only 3-component array, else the most likely by name (wall shear, velocity, momentum, others, displacement last)
/// and content (not all zero, not mostly normal to the surface); never normals, colours or coordinates.
/// Throws Error that lists the arrays there are. `share`: `surface` is what a process has before it is prepared, and
/// this says which of its points count; collective.
VectorChoice choose_vectors(const Surface& surface, const std::string& request, const Share* share = nullptr);

/// How much of a vector field lies in the surface. Means and percentile are weighted by area.
struct VectorStatistics {
  double normal_share = 0;   ///< mean |v.n| / mean |v|: 0 tangential, 1 normal; 0 where all vectors are zero
  double zero_share = 0;     ///< share of the triangles' points whose vector is zero or not finite
  double max_speed = 0;      ///< largest tangential speed, in the array's unit
  double percentile_98 = 0;  ///< 98 % of the area that moves at all is no faster than this (tangential speed)
};

/// Statistics of `vectors` (one per point of `surface`, else Error); `share`: with those of the other processes,
/// collective. All sums are exact, and do not depend on who adds what.
VectorStatistics vector_statistics(const PreparedSurface& surface, std::span<const Vec3f> vectors,
                                   const Share* share = nullptr);

/// A tangential field for surfaces without vectors, one vector per point (zero on points without triangle).
/// "@swirl": a smooth unsteady field with nodes, saddles and vortices, period 1 in `t` (seconds), root mean square
/// speed about 1. "@rotation": steady rigid rotation about the z axis through the bounding box's centre, speed 1 at the
/// largest radius. Both depend on positions relative to the bounding box only, so scale does not matter. Error for
/// other names. `share`: of the whole surface, on the points of a share; collective.
std::vector<Vec3f> analytic_vectors(const std::string& name, const PreparedSurface& surface, double t,
                                    const Share* share = nullptr);

/// The names that `analytic_vectors` takes, each beginning with '@'.
std::vector<std::string> analytic_vector_names();

}  // namespace nacre
