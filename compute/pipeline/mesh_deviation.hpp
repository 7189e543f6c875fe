// Nacre: how far flat triangles are from the interfaces that they stand for.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "compute/field/interface.hpp"
#include "compute/meshing/second_order.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

/// Where points of the world come to lie on junctions, their rims left out of account.
using NearestOnJunctions = std::function<std::vector<Vec3d>(std::span<const Vec3d>, std::span<const Junction>)>;

/// Distances of a mesh from its interfaces, in the unit asked for.
struct MeshDeviation {
  std::vector<float> triangle;  ///< the largest at its middle and those of its edges; of these on curves,
                                ///< also from the curve
  /// An edge on a junction curve: its largest distance (-1: it lies on none), and the curve's third material.
  struct Rim {
    float away = -1;
    std::uint16_t third = 0xffff;
    Vec3d nearest;  ///< where on the curve its middle is nearest to
  };
  std::vector<std::array<Rim, 3>> on_rim;  ///< the edges 01 12 20
  double max = 0, mean = 0;                ///< of `triangle`
};

/// Measures `mesh`; lengths are divided by `unit`. A position without an interface nearby counts as 0.
MeshDeviation measure_deviation(const SurfaceMesh& mesh, const NearestOnJunctions& onto, double unit);

/// Mean and largest distance.
struct DeviationRange {
  double mean = 0, max = 0;
};

/// At seven points of every triangle, as it is with its nodes or (where `second` is null) flat: its middle, three
/// around that, and one on each edge, a quarter from its end. Lengths are divided by `unit`.
DeviationRange sampled_deviation(const SurfaceMesh& mesh, const SecondOrder* second, const NearestOnJunctions& onto,
                                 double unit);

}  // namespace nacre
