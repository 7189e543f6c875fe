// Nacre: the material of each voxel, from labels that are held only once: in memory or in a file that is mapped.
#include "compute/field/material_array.hpp"

#include <algorithm>

namespace nacre {

void MaterialArray::read(std::size_t first, std::size_t count, std::uint16_t* to) const {
  visit([&](const auto* values, const std::uint16_t* table) {
    for (std::size_t i = 0; i < count; ++i) to[i] = table ? table[values[first + i]] : std::uint16_t(values[first + i]);
  });
}

std::vector<std::uint16_t> MaterialArray::copy() const {
  std::vector<std::uint16_t> all(size());
  read(0, size(), all.data());
  return all;
}

std::vector<std::uint16_t>& MaterialArray::own() {
  if (labels_) *this = MaterialArray(copy());
  return own_;
}

std::vector<std::int64_t> MaterialArray::counts(int materials) const {
  std::vector<std::int64_t> result = counts_;
  result.resize(std::size_t(materials), 0);
  if (!labels_)
    for (const std::uint16_t m : own_) ++result.at(m);
  return result;
}

bool MaterialArray::all_outside() const {
  if (labels_) return counts_.empty() || std::size_t(counts_[0]) == size_;
  return std::all_of(own_.begin(), own_.end(), [](std::uint16_t m) { return m == 0; });
}

}  // namespace nacre
