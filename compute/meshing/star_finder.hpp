// Nacre: the stars of items, of which only those are found again whose surroundings have changed.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compute/meshing/star_device.hpp"

namespace nacre {

/// Finds stars. Items of the last call are known again where they come in the same order, as most do where a few
/// particles move, go or come; the stars that have the same items within reach are taken from there. What it gives
/// depends on the items alone.
class StarFinder {
 public:
  /// The device must outlive the object, which alone uses it.
  explicit StarFinder(StarDevice& device) : device_(device) {}

  /// All stars, settled, with what is agreed marked.
  void find(StarItems items);

  /// Takes back what is agreed on at `some` items, until the next call of `find`. Returns the items whose stars change.
  std::vector<std::uint32_t> open(std::span<const std::uint32_t> some);
  void close();  ///< undoes all that `open` has done

  const StarItems& items() const { return items_; }          ///< of the last call
  const std::vector<Star>& stars() const { return stars_; }  ///< of each
  std::int64_t cut() const { return cut_; }                  ///< stars that the last call found again

 private:
  StarDevice& device_;
  StarItems items_;
  std::vector<Star> stars_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> opened_;  // items, and what they agreed on
  std::int64_t cut_ = 0;
};

}  // namespace nacre
