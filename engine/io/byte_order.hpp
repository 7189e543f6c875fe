// Nacre: reads numbers from bytes of either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace nacre {

/// The number that starts at `bytes` (no alignment needed), stored in `order`.
template <class T>
T load_number(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> copy{};
  std::memcpy(copy.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(copy.begin(), copy.end());
  return std::bit_cast<T>(copy);
}

}  // namespace nacre
