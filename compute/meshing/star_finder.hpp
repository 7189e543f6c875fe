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
  void find(const StarParticles& particles);

  /// Takes back what is agreed on at `some` items, until the next call of `find`. Returns the items whose stars change.
  std::vector<std::uint32_t> open(std::span<const std::uint32_t> some);
  void close();  ///< undoes all that `open` has done

  /// The triangles that the last call has found, once.
  std::vector<Triangle> take_agreed() { return std::move(found_.agreed); }

  const FoundStars& found() const { return found_; }  ///< by the last call
  const StarItems& items() const { return found_.items; }
  const std::vector<Star>& stars() const { return found_.stars; }  ///< per item

 private:
  StarDevice& device_;
  FoundStars found_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> opened_;  // items, and what they agreed on
};

}  // namespace nacre
