// Nacre: the bricks of an octree, cut into ranges of equal work along the Morton curve, and what lies around a range.
#include "compute/embedding/brick_ranges.hpp"

#include <algorithm>

#include "compute/math/morton.hpp"

namespace nacre {

std::vector<std::size_t> cut_by_work(std::span<const std::uint64_t> work, int parts) {
  long double whole = 0, before = 0;
  for (const std::uint64_t w : work) whole += static_cast<long double>(w);
  std::vector<std::size_t> begin{0};
  for (std::size_t b = 0; b < work.size(); ++b) {
    const long double middle = before + 0.5L * static_cast<long double>(work[b]);
    while (int(begin.size()) < parts && middle * parts > whole * static_cast<long double>(begin.size()))
      begin.push_back(b);
    before += static_cast<long double>(work[b]);
  }
  begin.resize(std::size_t(parts) + 1, work.size());
  return begin;
}

std::vector<std::uint64_t> codes_around(std::span<const std::uint64_t> bricks, int depth, int levels) {
  std::vector<std::uint64_t> codes(bricks.begin(), bricks.end());
  const int width = 1 << levels;
  // Axis by axis: a cube around each is a line around each, of lines around each, of lines.
  for (int axis = 0; axis < 3 && depth > 0; ++axis) {
    std::vector<std::uint64_t> wider;
    wider.reserve(codes.size() * 2);
    for (const std::uint64_t code : codes) {
      const Int3 at = morton_cell(code);
      for (int d = -depth; d <= depth; ++d) {
        Int3 p = at;
        p[axis] += d;
        if (p[axis] >= 0 && p[axis] < width) wider.push_back(morton(p));
      }
    }
    std::sort(wider.begin(), wider.end());
    wider.erase(std::unique(wider.begin(), wider.end()), wider.end());
    codes = std::move(wider);
  }
  return codes;
}

}  // namespace nacre
