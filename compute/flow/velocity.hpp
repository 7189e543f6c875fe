// Nacre: the vector field on the closest-point grid, as displacement per step, in space and time.
#pragma once

#include <cmath>

#include "compute/embedding/closest_point_grid.hpp"

namespace nacre {

inline constexpr int max_ttl = 16;

/// Displacement in cells per step, at the beginning of a step and at its end.
struct FlowField {
  ClosestPointGridView grid;
  const Float4* slot[2] = {};
  bool steady = true;  ///< both are the same

  /// At point `p` (cells) and time `u` (0..1) within the step. False out of the band.
  NACRE_HD_INLINE bool velocity(const Vec3f& p, float u, Vec3f& v) const {
    LinearCells cells;
    if (!cells.find(grid, p)) return false;
    Lanes result = cells.interpolate(slot[!steady && u >= 1 ? 1 : 0]);
    if (!steady && u > 0 && u < 1) result = result + (cells.interpolate(slot[1]) - result) * u;
    v = xyz(result);
    return true;
  }
};

#if defined(NACRE_PACKETS)
/// The same of several points at a time; `found` loses those out of the band.
inline Vec3<Packet::Float> velocities(const FlowField& field, const Vec3<Packet::Float>& p, float u,
                                      Packet::Mask& found) {
  const LinearCellsOfPacket cells(field.grid, p, found);
  found = cells.found;
  const Vec3<Packet::Float> first = cells.interpolate(field.slot[!field.steady && u >= 1 ? 1 : 0]);
  if (field.steady || u <= 0 || u >= 1) return first;
  return multiply_add(cells.interpolate(field.slot[1]) - first, Packet::all(u), first);
}
#endif

/// How a speed becomes a displacement.
struct SpeedScale {
  float reference;     ///< the speed that moves `displacement` cells a step (98th percentile of the data)
  float displacement;  ///< cells
  float power;         ///< 1: in proportion; 0: all alike, as in a line integral convolution
  float limit;         ///< fastest displacement, in units of `displacement`
  float usual;         ///< displacement of a speed of 1 where it is in proportion

  SpeedScale(float reference, float displacement, float power, float limit)
      : reference(reference), displacement(displacement), power(power), limit(limit), usual(displacement / reference) {}

  NACRE_HD Vec3f operator()(const Vec3f& v) const {
    const float squared = dot(v, v), least = 1e-6f * reference, most = limit * reference;
    if (!(squared > least * least)) return {};
    if (power == 1 && squared <= most * most) return v * usual;  // without a root
    const float speed = std::sqrt(squared);
    float moved = speed / reference;
    if (power != 1) moved = std::pow(moved, power);
    moved = moved < limit ? moved : limit;
    return v * (moved * displacement / speed);
  }
};

/// Fills one slot: the vector at each cell's closest point by barycentric interpolation, its tangential part, scaled.
struct EmbedVelocity {
  MeshView mesh;
  ClosestPointGridView grid;
  const Vec3f* vectors;  ///< one per point of the mesh, at the time of the slot
  SpeedScale scale;
  float reach;  ///< cells farther from the surface are never asked
  Float4* slot;

  NACRE_HD void operator()(std::int64_t i) const {
    const Float4 o = grid.offset[i];
    if (o.w > reach) {
      slot[i] = {0, 0, 0, 0};
      return;
    }
    const std::uint32_t t = grid.triangle[i];
    const Vec3d p = Vec3d(grid.cell(std::uint32_t(i))) + Vec3d(0.5) + Vec3d(o.x, o.y, o.z);
    const Vec3f w = barycentric_in_float(mesh.corners(t), p);
    const Vec3f d = scale(mesh.tangential(vectors, t, w));
    slot[i] = {d.x, d.y, d.z, 0};
  }
};

}  // namespace nacre
