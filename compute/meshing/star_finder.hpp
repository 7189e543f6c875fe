// Nacre: the stars of items, of which only those are found again whose surroundings have changed.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/stars.hpp"

namespace nacre {

/// Finds stars. Items of the last call are known again by their surface and position; the stars that have the same
/// items within reach are taken from there. What it gives depends on the items alone.
class StarFinder {
 public:
  /// All stars, settled, with what is agreed marked.
  std::vector<Star> find(const StarItems& items);

  std::int64_t cut() const { return cut_; }  ///< stars that the last call found again

 private:
  std::vector<std::uint8_t> take_over(const StarItems& items, const PointTree& tree, std::vector<Star>& stars) const;

  StarItems items_;
  std::vector<Star> stars_;  ///< before they were settled
  std::int64_t cut_ = 0;
};

/// Those of items that are not going to change.
inline std::vector<Star> find_stars(const StarItems& items) { return StarFinder().find(items); }

}  // namespace nacre
