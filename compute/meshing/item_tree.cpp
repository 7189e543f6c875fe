// Nacre: items by where they are, in a tree that outlives small changes.
#include "compute/meshing/item_tree.hpp"

#include <algorithm>
#include <numeric>

#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

constexpr std::size_t many = 8;  // where more than this part is new, one tree of all is made

}  // namespace

void ItemTree::build(const StarItems& items) {
  old_.emplace(items.position, items.first);
  fresh_.reset();
  materials_ = items.materials;
  group_.resize(items.materials.size());
  std::iota(group_.begin(), group_.end(), 0u);
  item_of_old_.resize(items.count());
  std::iota(item_of_old_.begin(), item_of_old_.end(), 0u);
}

void ItemTree::update(const StarItems& items, std::span<const std::uint32_t> now_of) {
  std::vector<std::uint8_t> is_old(items.count(), 0);
  for (std::uint32_t& item : item_of_old_) {
    if (item == none) continue;
    item = now_of[item];
    if (item != none) is_old[item] = 1;
  }
  item_of_fresh_ = select_where(items.count(), [&](std::size_t i) { return !is_old[i]; });
  if (item_of_fresh_.size() > items.count() / many) return build(items);

  group_.assign(items.materials.size(), none);
  for (std::size_t s = 0; s < group_.size(); ++s) {
    const auto at = std::lower_bound(materials_.begin(), materials_.end(), items.materials[s]);
    if (at != materials_.end() && *at == items.materials[s]) group_[s] = std::uint32_t(at - materials_.begin());
  }
  std::vector<Vec3d> position;
  for (const std::uint32_t i : item_of_fresh_) position.push_back(items.position[i]);
  std::vector<std::uint32_t> first;
  for (const std::uint32_t begin : items.first)
    first.push_back(
        std::uint32_t(std::lower_bound(item_of_fresh_.begin(), item_of_fresh_.end(), begin) - item_of_fresh_.begin()));
  fresh_.emplace(position, first);
}

}  // namespace nacre
