// Nacre: the stars of items, of which only those are found again whose surroundings have changed.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compute/meshing/item_tree.hpp"
#include "compute/meshing/stars.hpp"

namespace nacre {

/// Finds stars. Items of the last call are known again where they come in the same order, as most do where a few
/// particles move, go or come; the stars that have the same items within reach are taken from there. What it gives
/// depends on the items alone.
class StarFinder {
 public:
  /// All stars, settled, with what is agreed marked.
  void find(StarItems items);

  /// Takes back what is agreed on at `some` items, until the next call of `find`. Returns the items whose stars change.
  std::vector<std::uint32_t> open(std::span<const std::uint32_t> some);
  void close();  ///< undoes all that `open` has done

  const StarItems& items() const { return items_; }          ///< of the last call
  const std::vector<Star>& stars() const { return stars_; }  ///< of each
  std::int64_t cut() const { return cut_; }                  ///< stars that the last call found again

 private:
  std::vector<std::uint8_t> take_over(const StarItems& items);
  void take_back(std::size_t first);

  StarItems items_;
  std::vector<Star> stars_, spare_;
  std::vector<std::pair<std::uint32_t, Star>> unsettled_;  // stars that have changed since, as they were
  std::size_t settled_ = 0;                                // of these, before anything was opened
  ItemTree tree_;
  std::int64_t cut_ = 0;
};

}  // namespace nacre
