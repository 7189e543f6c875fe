// Nacre: items by where they are, in a tree that outlives small changes.
#pragma once

#include <optional>

#include "compute/meshing/point_tree.hpp"
#include "compute/meshing/star_items.hpp"

namespace nacre {

/// Items of one set by where they are. Where few have changed since the last set, those that have stayed keep their
/// tree, and the new ones get a small one of their own. What is found depends on the items alone.
class ItemTree {
 public:
  /// Of all items.
  void build(const StarItems& items);
  /// Of these items, of which item i of the set before is item now_of[i], `none` where it is no longer there.
  void update(const StarItems& items, std::span<const std::uint32_t> now_of);

  /// Adds to `found` the items of the surface within `radius` of `position`, in no particular order.
  void within(std::uint32_t surface, const Vec3d& position, double radius, std::vector<PointTree::Found>& found) const {
    if (group_[surface] != none) add(*old_, group_[surface], item_of_old_, position, radius, found);
    if (fresh_) add(*fresh_, surface, item_of_fresh_, position, radius, found);
  }

 private:
  static void add(const PointTree& tree, std::uint32_t group, std::span<const std::uint32_t> item_of,
                  const Vec3d& position, double radius, std::vector<PointTree::Found>& found) {
    std::size_t kept = found.size();
    const std::size_t before = kept;
    tree.within(group, position, radius, found);
    for (std::size_t k = before; k < found.size(); ++k)
      if (const std::uint32_t item = item_of[found[k].point]; item != none) found[kept++] = {found[k].distance2, item};
    found.resize(kept);
  }

  std::optional<PointTree> old_, fresh_;
  std::vector<std::array<std::uint16_t, 2>> materials_;     // per group of the old tree
  std::vector<std::uint32_t> group_;                        // per surface: of the old tree, or `none`
  std::vector<std::uint32_t> item_of_old_, item_of_fresh_;  // per point of the trees: its item, or `none`
};

}  // namespace nacre
