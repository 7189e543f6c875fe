// Nacre: Morton codes: cells that are near each other in space get near numbers.
#pragma once

#include <cstdint>

#include "compute/device/backend.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

namespace detail {
/// Inserts two zero bits after each of the lowest 21 bits.
NACRE_HD constexpr std::uint64_t spread3(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x001f00000000ffff;
  v = (v | v << 16) & 0x001f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}

NACRE_HD constexpr std::int32_t gather3(std::uint64_t v) {
  v &= 0x1249249249249249;
  v = (v | v >> 2) & 0x10c30c30c30c30c3;
  v = (v | v >> 4) & 0x100f00f00f00f00f;
  v = (v | v >> 8) & 0x001f0000ff0000ff;
  v = (v | v >> 16) & 0x001f00000000ffff;
  v = (v | v >> 32) & 0x1fffff;
  return std::int32_t(v);
}
}  // namespace detail

/// Code of a cell with coordinates in 0..2^21-1: the bits of x, y, z interleaved, x lowest. The code of (23, 6, 14) is
/// 6649 (thesis, sec. 6.1.2, prints 6641, which is the code of (21, 6, 14)).
NACRE_HD constexpr std::uint64_t morton(Int3 cell) {
  return detail::spread3(std::uint64_t(cell.x)) | detail::spread3(std::uint64_t(cell.y)) << 1 |
         detail::spread3(std::uint64_t(cell.z)) << 2;
}

NACRE_HD constexpr Int3 morton_cell(std::uint64_t code) {
  return {detail::gather3(code), detail::gather3(code >> 1), detail::gather3(code >> 2)};
}

}  // namespace nacre
