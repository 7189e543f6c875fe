// Nacre: the critical points of a tangential vector field on triangles.
#pragma once

#include <complex>
#include <cstdint>
#include <string>
#include <vector>

#include "compute/topology/tangent_field.hpp"

namespace nacre {

/// How the flow leaves a zero. A centre is a focus whose real part is within twice its standard error.
enum class CriticalKind { saddle, source, sink, focus_source, focus_sink, centre };

const char* name_of(CriticalKind kind);

struct CriticalPoint {
  CriticalKind kind = CriticalKind::saddle;
  int index = 0;                       ///< 1, or -1 for a saddle
  std::uint32_t triangle = 0;          ///< where it lies
  Vec3d weights, position;             ///< at the triangle's corners; world units
  std::complex<double> first, second;  ///< eigenvalues, 1 / unit of time; of real ones the larger is the first
  Vec3d first_axis, second_axis;       ///< of real eigenvalues: unit vectors in the surface; else zero
  double persistence =
      0;  ///< the speed that must be ignored for it to vanish together with another; at most the largest
};

/// Two or more points beside each other whose vectors are zero, and the triangles around them.
struct ZeroRegion {
  std::size_t points = 0;
  double area = 0;         ///< of triangles that are zero at all corners
  int index = 0;           ///< what is left of it after cancelling
  std::uint32_t triangle;  ///< one of them
};

/// On a surface whose field is known everywhere: sum of the points' indices + that of the zero regions + that of the
/// rims = the Euler characteristic.
struct FlowTopology {
  std::vector<CriticalPoint> points;  ///< in the order of their triangles
  std::vector<ZeroRegion> zero_regions;
  int euler_characteristic = 0;
  std::size_t rims = 0;
  int point_index = 0;  ///< the sums
  int region_index = 0;
  int rim_index = 0;          ///< each rim counts as the index of the hole, closed by one polygon, less 1
  std::size_t cancelled = 0;  ///< zeros below the persistence
};

/// The zeros of the field that is linear on each triangle, without those that cancel each other where speeds up to
/// `least_persistence` (unit of the vectors) count as zero: the sublevel sets of the speed grow, and where two meet,
/// zeros of opposite index cancel, the nearest first. So a zero remains if the set around it, at that speed, has
/// another index than 0. This is the robustness of F. Chazal, A. Patel and P. Skraba (Computing the robustness of
/// roots, 2012) and B. Wang et al. (Visualizing robustness of critical points for 2D time-varying vector fields, 2013)
/// on a surface. Position and eigenvalues are those of a linear field, fitted by least squares to the vectors around
/// it: in the set that was ignored, and at least in a ring of triangles. The same to the byte in every run.
FlowTopology find_critical_points(const TangentField& field, double least_persistence);

}  // namespace nacre
