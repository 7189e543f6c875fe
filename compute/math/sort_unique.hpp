// Nacre: lists without repetitions.
#pragma once

#include <algorithm>
#include <vector>

namespace nacre {

/// Makes the items ascend, each once.
template <class Item>
void sort_unique(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace nacre
