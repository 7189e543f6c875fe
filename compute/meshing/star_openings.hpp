// Nacre: agreed triangles that are taken back.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "compute/meshing/star.hpp"

namespace nacre {

/// Takes back what stars agree on, so that holes become wider; undone when it goes.
class StarOpenings {
 public:
  explicit StarOpenings(std::span<Star> stars) : stars_(stars) {}
  ~StarOpenings() { close(); }
  StarOpenings(const StarOpenings&) = delete;
  StarOpenings& operator=(const StarOpenings&) = delete;

  /// Takes back all that is agreed on at `some` items. Returns the items whose stars change.
  std::vector<std::uint32_t> open(std::span<const std::uint32_t> some);
  void close();  ///< undoes all that `open` has done

  /// The triangles that are agreed on no more, the smallest item first.
  const std::vector<Triangle>& removed() const { return removed_; }

 private:
  std::span<Star> stars_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> opened_;  // items, and what they agreed on
  std::vector<Triangle> removed_;
};

}  // namespace nacre
