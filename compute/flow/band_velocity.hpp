// Nacre: the vector field extended into a band of cells (sec. 6.2.1), as displacement per step, in space and time.
#pragma once

#include "compute/embedding/band.hpp"
#include "compute/embedding/closest_point_grid.hpp"
#include "compute/flow/packed_vector.hpp"
#include "compute/flow/velocity.hpp"

namespace nacre {

/// Displacements in cells per step at the beginnings of the coming steps: slot j at step j from now.
template <class View>
struct BandFlowField {
  View view;
  const std::uint32_t* slot[max_ttl + 1] = {};  ///< per cell: PackedVector
  bool steady = true;                           ///< all slots are the same

  /// At point `p` and time `u` (0..1) within step `j`: linear among the cells around it, of those that exist. False out
  /// of the band.
  NACRE_HD_INLINE bool velocity(typename View::Cursor& cursor, const BandPoint& p, int j, float u, Vec3f& v) const {
    const LinearWeights weights(p);
    CellIndex at[8];
    const unsigned there = cursor.eight(weights.first, at);
    if (!there) return false;
    float w[8];
    float total = 0;
    for (int k = 0; k < 8; ++k) {
      const bool exists = there >> k & 1;
      at[k] = exists ? at[k] : 0;
      w[k] = exists ? weights[k] : 0;
      total += w[k];
    }
    v = sum(slot[!steady && u >= 1 ? j + 1 : j], at, w);
    if (!steady && u > 0 && u < 1) v = v + (sum(slot[j + 1], at, w) - v) * u;
    if (there != 0xff) {
      if (!(total > 1e-6f)) return false;
      v = v / total;
    }
    return true;
  }

 private:
  NACRE_HD_INLINE static Vec3f sum(const std::uint32_t* values, const CellIndex* at, const float* w) {
    std::uint32_t packed[8];
    for (int k = 0; k < 8; ++k) packed[k] = values[at[k]];
    return PackedVector::sum(packed, w);
  }
};

/// Fills one slot: the vector at each cell's closest point by barycentric interpolation, its tangential part, scaled.
template <class View>
struct ExtendVelocity {
  View view;
  MeshView mesh;
  const Vec3f* vectors;  ///< one per point of the mesh, at the time of the slot
  SpeedScale scale;
  std::uint32_t* slot;

  NACRE_HD void operator()(CellIndex cell, const Int3& position, typename View::Cursor&) const {
    const CellPoint point = view.point[cell];
    const Vec3d p = Vec3d(position) + Vec3d(0.5) + Vec3d(point.offset(view.quantum));
    const Vec3f w = barycentric_in_float(mesh.corners(point.triangle), p);
    slot[cell] = PackedVector::pack(scale(mesh.tangential(vectors, point.triangle, w)));
  }
};

}  // namespace nacre
