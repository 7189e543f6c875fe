// Nacre: who finds stars for a StarFinder.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/meshing/star.hpp"
#include "compute/meshing/star_items.hpp"

namespace nacre {

/// Which of the items that there are now were there at the call before.
struct ItemChange {
  /// Where an item has come or gone.
  struct Position {
    Vec3d at;
    std::uint32_t surface;  ///< as surfaces are numbered now
  };
  std::vector<std::uint32_t> old_of;  ///< per item: its number before, or `none`
  std::vector<std::uint32_t> new_of;  ///< per item before: its number now, or `none`
  std::vector<Position> positions;    ///< of all items that have come or gone
};

class StarDevice {
 public:
  virtual ~StarDevice() = default;

  /// Puts the stars of all items into `stars`, settled, with what is agreed marked. With a `change`, those that have
  /// the same items within reach as at the call before are not cut again; what comes out is the same without. Returns
  /// how many were cut.
  virtual std::int64_t find(const StarItems& items, const ItemChange* change, std::vector<Star>& stars) = 0;
};

}  // namespace nacre
