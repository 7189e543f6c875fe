// Nacre: where the flow leaves a surface, or comes onto it, along lines.
#pragma once

#include <vector>

#include "compute/topology/tangent_field.hpp"

namespace nacre {

/// A line that neighbouring streamlines run towards (separation) or away from (attachment).
struct SeparationLine {
  bool separation = true;
  std::vector<std::uint32_t> triangles;  ///< of each point, one of the two at its edge
  std::vector<Vec3d> points;  ///< world units, one on each edge that is crossed; the first again as the last: closed
  /// By how many powers of e the distance of neighbours shrinks, or grows, while they follow the line once.
  double strength = 0;
};

/// The parallel vector lines of D. N. Kenwright, C. Henze and C. Levit (Feature extraction of separation and attachment
/// lines, 1999): the vector u is an eigenvector of its own gradient J, det(u, J u) = 0, and the eigenvalue across it is
/// below that along it, and below 0 (separation), or above both (attachment). J of a vertex is the mean of its
/// triangles', weighted by their areas, averaged once more with those around it; det(u, J u) is linear on each
/// triangle. Only what goes the way of the flow, within 30 degrees, counts. Lines whose strength is below
/// `least_strength` are left out. The same to the byte in every run.
std::vector<SeparationLine> separation_lines(const TangentField& field, double least_strength);

}  // namespace nacre
