// Nacre: what a mesh of volumes with formulas is measured by: distances, normals, topology and shapes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test {

/// The exact interface between two materials: how far a point is from it (any sign), and points spread over it.
struct ExactInterface {
  std::uint16_t lower, higher;
  PlaceFunction distance;
  std::vector<Vec3d> points;
};

inline double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / double(std::max<std::size_t>(values.size(), 1));
}
inline double largest_of(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}
inline double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Triangles between two materials.
inline std::vector<Triangle> facets_between(const SurfaceMesh& mesh, std::uint16_t lower, std::uint16_t higher) {
  std::vector<Triangle> facets;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.materials[t][0] == lower && mesh.materials[t][1] == higher) facets.push_back(mesh.triangles[t]);
  return facets;
}

struct InterfaceError {
  std::size_t facets = 0;
  double to_exact_mean = 0, to_exact_max = 0;  ///< of ten points of each facet
  double from_exact_max = 0;                   ///< of the exact points from the nearest facet
  double normal_median = 0;                    ///< degrees
  double hausdorff() const { return std::max(to_exact_max, from_exact_max); }
};

/// Distances both ways between the facets of an interface and the exact one, in voxels.
inline InterfaceError interface_error(const SurfaceMesh& mesh, const ExactInterface& exact) {
  InterfaceError error;
  const std::vector<Triangle> facets = facets_between(mesh, exact.lower, exact.higher);
  error.facets = facets.size();
  std::vector<double> away, turned;
  for (const Triangle& t : facets) {
    const Vec3d a = mesh.points[t.a], b = mesh.points[t.b], c = mesh.points[t.c];
    for (int i = 0; i <= 3; ++i)
      for (int j = 0; j <= 3 - i; ++j)
        away.push_back(std::fabs(exact.distance((a * double(i) + b * double(j) + c * double(3 - i - j)) / 3.0)));
    const Vec3d centre = (a + b + c) / 3.0, n = normalized(cross(b - a, c - a));
    Vec3d gradient;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d step;
      step[axis] = 1e-4;
      gradient[axis] = exact.distance(centre + step) - exact.distance(centre - step);
    }
    turned.push_back(std::acos(std::min(1.0, std::fabs(dot(n, normalized(gradient))))) * 180 / M_PI);
  }
  error.to_exact_mean = mean_of(away);
  error.to_exact_max = largest_of(away);
  error.normal_median = median_of(turned);
  const BruteForce nearest(mesh.points, facets);
  for (const Vec3d& p : exact.points) error.from_exact_max = std::max(error.from_exact_max, nearest(p).distance);
  return error;
}

/// Sound, every material closed and of the Euler characteristic given (by number, the outside first).
inline void expect_topology(const SurfaceMesh& mesh, const std::vector<std::int64_t>& euler) {
  const TopologyReport report = check_topology(mesh, int(euler.size()));
  EXPECT_TRUE(report.sound()) << report.boundary_edges << " boundary, " << report.nonmanifold_edges << " non-manifold, "
                              << report.inconsistent_edges << " inconsistent edges, " << report.nonmanifold_vertices
                              << " non-manifold vertices";
  for (std::size_t m = 0; m < euler.size(); ++m) {
    EXPECT_TRUE(report.materials[m].closed) << "material " << m;
    EXPECT_EQ(report.materials[m].euler, euler[m]) << "material " << m;
  }
}

/// Triangles away from junctions have no small angle (99.9%) and no small ratio; near them none is a sliver.
inline void expect_good_shapes(const MeshRun& run, double mean = 0.95) {
  const SurfaceQuality q = surface_quality(run.mesh);
  EXPECT_GE(q.all.radius_ratio_mean, mean);
  EXPECT_GE(q.all.radius_ratio_min, 0.15);
  EXPECT_GE(q.away_from_junctions.radius_ratio_min, 0.3);
  EXPECT_LE(q.away_from_junctions.share_under_25, 0.001);
}

inline void print_quality(const char* what, const MeshRun& run) {
  const SurfaceQuality q = surface_quality(run.mesh);
  std::printf(
      "%s: %zu triangles, ratio mean %.4f min %.3f (away from junctions %.4f, %.3f), smallest angle %.1f, "
      "under 25 away %.3f%%, %d iterations\n",
      what, run.mesh.triangles.size(), q.all.radius_ratio_mean, q.all.radius_ratio_min,
      q.away_from_junctions.radius_ratio_mean, q.away_from_junctions.radius_ratio_min, q.all.angle_min,
      100 * q.away_from_junctions.share_under_25, run.info.iterations);
}

}  // namespace nacre::test
