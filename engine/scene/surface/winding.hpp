// Nacre: which points coincide, and triangles wound alike.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// The same for equal positions.
std::uint64_t position_hash(const Vec3d& p);

/// For each point the smallest index of a point at exactly the same position (itself, where there is none before it).
std::vector<std::uint32_t> first_at_position(std::span<const Vec3d> points);

/// What lies across the three sides of each triangle. Entry 3 * triangle + corner is the side that starts there.
struct SidePairs {
  static constexpr std::uint32_t no_twin = 0xffffffffu;    ///< 4, 6, ... triangles share the edge, or it is a duplicate
  static constexpr std::uint32_t open_edge = 0xfffffffeu;  ///< an odd number: the part is not closed
  std::vector<std::uint32_t> twin;                         ///< the side across, or one of these
  std::vector<char> duplicate;                             ///< per triangle: an earlier one has the same three points
};

/// `same`, `triangles`: as below.
SidePairs pair_sides(std::span<const std::uint32_t> same, std::span<const Triangle> triangles);

/// Whether the triangles on two sides of an edge are wound in opposite ways.
inline bool opposed(std::span<const std::uint32_t> same, std::span<const Triangle> triangles, std::uint32_t side,
                    std::uint32_t other) {
  return same[triangles[side / 3][int(side % 3)]] == same[triangles[other / 3][int(other % 3)]];
}

/// Six times the volume between triangles and a point, in whole numbers: the same sum in any order.
struct WholeVolume {
  std::int64_t high = 0, low = 0;  ///< high * 2^32 + low

  /// `extent`: no corner is farther from `origin`, along any axis.
  [[gnu::noinline]] void add(const Vec3d& origin, double extent, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                             bool flipped);
  void add(const WholeVolume& other) { high += other.high, low += other.low; }
  int sign() const {
    const std::int64_t all = high + (low >> 32), rest = low & 0xffffffff;
    return all < 0 ? -1 : all > 0 || rest > 0 ? 1 : 0;
  }
};

/// How far `p` is from `origin`, along the axis where it is farthest.
inline double axis_distance(const Vec3d& origin, const Vec3d& p) {
  const Vec3d d = p - origin;
  return std::fmax(std::fabs(d.x), std::fmax(std::fabs(d.y), std::fabs(d.z)));
}

/// What `make_winding_consistent` did.
struct WindingReport {
  std::size_t duplicates = 0;        ///< triangles dropped because an earlier one has the same three points
  std::size_t flipped = 0;           ///< triangles turned over to agree with the majority of their part
  std::size_t turned_parts = 0;      ///< closed parts that faced inwards
  std::size_t turned_triangles = 0;  ///< of closed parts that faced inwards
  std::size_t closed_triangles = 0;  ///< of all closed parts
  std::size_t contradictions = 0;    ///< edges whose two triangles cannot agree: the surface is one-sided
};

/// Winds `triangles` consistently across all edges with exactly two triangles, drops duplicates, and turns closed parts
/// outwards. `open`: gets 1 for each triangle that is left if its part is not closed. `same[point]` as from
/// `first_at_position`; no triangle may use one position twice. Linear in triangles, but for sorting the triangles
/// around each point.
WindingReport make_winding_consistent(std::span<const Vec3d> points, std::span<const std::uint32_t> same,
                                      std::vector<Triangle>& triangles, std::vector<std::uint8_t>* open = nullptr);

}  // namespace nacre
