// Nacre: all interfaces by number, and which of them bound which.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "compute/field/interface.hpp"

namespace nacre {

inline constexpr std::size_t most_interfaces = 65000;  ///< the tree's keys have 16 bits for them

/// Every surface, curve and kind of junction point under the number that particles name it by: first surfaces and
/// curves, as the embedding numbers them, then the kinds of points.
struct JunctionTable {
  std::vector<Junction> junctions;
  std::vector<std::uint8_t> order;  ///< per interface: its dimension
  /// Whose particles concern those of interface k: related[start[k]] .. related[start[k + 1] - 1]; itself first, then
  /// the curves and points that bound it.
  std::vector<std::uint32_t> start, related;

  std::optional<std::uint32_t> find(const Junction& junction) const;
};

/// The table of `interfaces`, the surfaces and curves of an embedding, and of `points`, one entry for each junction
/// point. Throws Error where there are more than `most_interfaces`.
JunctionTable make_junction_table(std::span<const Junction> interfaces, std::span<const Junction> points);

}  // namespace nacre
