// Nacre: points within balls, found through a tree of halved boxes.
#include "compute/meshing/ball_search.hpp"

#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <numeric>

namespace nacre {

BallSearch::BallSearch(std::span<const Vec3d> points) : points_(points), order_(points.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  halve(0, order_.size(), 0);
}

void BallSearch::halve(std::size_t begin, std::size_t end, int axis) {
  constexpr std::size_t alone = 1 << 14;
  if (end - begin <= leaf) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) { return order_.begin() + std::ptrdiff_t(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t i, std::uint32_t j) {
    return points_[i][axis] != points_[j][axis] ? points_[i][axis] < points_[j][axis] : i < j;
  });
  const auto left = [&, this] { halve(begin, middle, (axis + 1) % 3); };
  const auto right = [&, this] { halve(middle + 1, end, (axis + 1) % 3); };
  if (end - begin > alone) return tbb::parallel_invoke(left, right);
  left();
  right();
}

}  // namespace nacre
