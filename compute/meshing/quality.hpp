// Nacre: how well shaped the triangles and tetrahedra of a mesh are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compute/math/vec.hpp"
#include "compute/meshing/surface_mesh.hpp"

namespace nacre {

/// 2 r_in / r_circ of a triangle: 1 where it is equilateral, 0 where it has no area.
double radius_ratio(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// Cheaper than the ratio: true only where this is above `bound`, as it is where the mean ratio, 1 for an equilateral
/// triangle, too, is above the bound's root. (The ratio is 4 d^2 / (abc (a + b + c)), d twice the area, and the mean
/// ratio 2 sqrt(3) d / s with s = a^2 + b^2 + c^2; a + b + c <= sqrt(3 s) and abc <= (s / 3)^(3/2).)
inline bool ratio_is_above(double bound, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const Vec3d u = b - a, v = c - a, w = c - b, n = cross(u, v);
  const double s = dot(u, u) + dot(v, v) + dot(w, w);
  return 12 * dot(n, n) > (bound + 1e-6) * s * s;
}

/// The three angles of a triangle at a, b and c, degrees; zeros where two corners coincide.
std::array<double, 3> triangle_angles(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// The six dihedral angles of a tetrahedron, degrees, at the edges 01 02 03 12 13 23; its volume's sign plays no part.
std::array<double, 6> dihedral_angles(const std::array<Vec3d, 4>& corners);

/// Marks the points of a mesh where three or more materials meet.
std::vector<std::uint8_t> junction_points(const SurfaceMesh& mesh);

/// Of a set of triangles; zeros where it is empty. Angles in degrees.
struct TriangleQuality {
  std::int64_t triangles = 0;
  double radius_ratio_mean = 0, radius_ratio_min = 0;
  std::array<std::int64_t, 50> radius_ratio_histogram{};  ///< over 0 .. 1
  double angle_min = 0, angle_max = 0;
  double angle_mean_min = 0;  ///< mean of the smallest angle of each triangle
  double share_under_25 = 0;  ///< of the triangles, those with an angle under 25 degrees
};

struct SurfaceQuality {
  TriangleQuality all;
  TriangleQuality away_from_junctions;  ///< triangles without a corner on a junction
};

/// Shape of the triangles of `mesh`, whose corners are points.
SurfaceQuality surface_quality(const SurfaceMesh& mesh);

/// The triangles without a corner on a junction that have an angle under `angle` degrees or a radius ratio under
/// `ratio`, ascending.
std::vector<std::uint32_t> triangles_short_of(const SurfaceMesh& mesh, double angle, double ratio);

/// Of all cells of a tetrahedral mesh; zeros where it is empty. Angles in degrees.
struct CellQuality {
  std::int64_t cells = 0;
  std::int64_t inverted = 0;  ///< volume zero or negative
  double dihedral_min = 0, dihedral_max = 0;
  std::array<std::int64_t, 18> dihedral_histogram{};  ///< all six angles of every cell, in bins of 10 degrees
  double share_within_10_160 = 0;  ///< of the cells, those with all six angles from 10 to 160 degrees
  std::vector<double> volume;      ///< per material, world units^3; [0] is 0
};

/// Shape of the cells of `mesh`, whose materials are less than `materials`.
CellQuality cell_quality(const TetrahedralMesh& mesh, int materials);

}  // namespace nacre
