// Nacre: winds the triangles of a surface alike that several processes have in shares.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/device/ranks.hpp"
#include "engine/scene/surface/winding.hpp"

namespace nacre {

/// A triangle of another process: which one's, and its number there.
struct Lent {
  std::uint32_t rank, number;
};

/// Triangles of this process, and before and after these those of others that touch them.
struct SharedTriangles {
  std::span<const Vec3d> points;
  std::span<const std::uint32_t> same;  ///< as for make_winding_consistent
  std::span<const Triangle> triangles;
  std::span<const Lent> owner;       ///< of each of these
  std::size_t first = 0, count = 0;  ///< its own ones
  std::uint32_t numbers = 0;         ///< more than any number of one of its own
};

enum class Winding : std::uint8_t { kept, turned, duplicate };

struct SharedWinding {
  std::vector<Winding> of_own;  ///< by the numbers of its own triangles
  WindingReport report;         ///< of all processes; where it has contradictions, nothing else counts
};

/// What make_winding_consistent does with the triangles of all processes. Collective.
SharedWinding wind_shares(Ranks& ranks, const SharedTriangles& mesh);

}  // namespace nacre
