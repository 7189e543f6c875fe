// Nacre: positions on junctions that are kept from one mesh to the next.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compute/pipeline/mesh_deviation.hpp"

namespace nacre {

/// Asks `onto`, whose answer for a point may not depend on the others, only for points that the call before did not
/// have, to the bit.
class KeptNearest {
 public:
  explicit KeptNearest(NearestOnJunctions onto) : onto_(std::move(onto)) {}

  const std::vector<Vec3d>& operator()(std::span<const Vec3d> points, std::span<const Junction> junctions);

 private:
  /// The slot of a point, or the empty one where it would go.
  std::size_t slot_of(const Vec3d& point, const Junction& junction) const;
  void keep(std::span<const Vec3d> points, std::span<const Junction> junctions, std::vector<Vec3d> on);

  NearestOnJunctions onto_;
  std::vector<Vec3d> points_, on_;
  std::vector<Junction> junctions_;
  std::vector<std::uint32_t> slots_;  // numbers of points
};

}  // namespace nacre
