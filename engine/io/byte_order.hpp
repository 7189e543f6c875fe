// Nacre: numbers out of bytes of either order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace nacre {

/// The number that begins at `bytes` (no alignment needed), written in `order`.
template <class T>
T load_number(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> copy{};
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<T>(copy);
}

}  // namespace nacre
