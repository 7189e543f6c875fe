// Nacre: who finds stars for a StarFinder.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "compute/meshing/star.hpp"
#include "compute/meshing/star_items.hpp"
#include "compute/meshing/star_particles.hpp"
#include "compute/meshing/surface_mesh.hpp"

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

/// The stars of all items, settled, with what is agreed marked, and what is read off from them.
struct FoundStars {
  StarItems items;
  std::vector<Star> stars;
  std::vector<Triangle> agreed;           ///< that all corners agree on, each listed by its smallest item, as items
  std::vector<std::uint32_t> incomplete;  ///< items of which is_incomplete is true; ascending
  std::int64_t unsettled = 0;             ///< stars of which is_unsettled is true
  std::int64_t cut = 0;                   ///< stars that were cut anew
};

class StarDevice {
 public:
  virtual ~StarDevice() = default;

  /// Tells what has changed from the call before to the items that there are now.
  using TellChange = std::function<std::optional<ItemChange>(const StarItems&)>;

  /// Replaces `found`, what this call gave before, by the stars of these particles. Where a change is told, stars that
  /// have the same items within reach as before are not cut again; what comes out is the same without.
  virtual void find(const StarParticles& particles, const TellChange& change, FoundStars& found) = 0;
};

}  // namespace nacre
