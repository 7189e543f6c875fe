// Nacre: points by where they are, in a tree that is cut at their medians.
#include "compute/meshing/point_tree.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <numeric>

namespace nacre {
namespace {

constexpr std::uint32_t alone = 4096;  // as many points or fewer are divided by one thread

}  // namespace

PointTree::PointTree(std::span<const Vec3d> points, std::span<const std::uint32_t> first)
    : points_(points),
      first_(first.begin(), first.end()),
      order_(points.size()),
      position_(points.size()),
      axis_(points.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  tbb::parallel_for(std::size_t(1), first.size(), [&](std::size_t g) { build(first_[g - 1], first_[g]); });
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) { position_[i] = points_[order_[i]]; });
}

void PointTree::build(std::uint32_t begin, std::uint32_t end) {
  if (end - begin <= leaf) return;
  Vec3d lower = points_[order_[begin]], upper = lower;
  for (std::uint32_t i = begin; i < end; ++i)
    lower = min(lower, points_[order_[i]]), upper = max(upper, points_[order_[i]]);
  const Vec3d extent = upper - lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t i, std::uint32_t j) {
                     const double s = points_[i][axis], t = points_[j][axis];
                     return s != t ? s < t : i < j;
                   });
  axis_[middle] = std::uint8_t(axis);
  if (end - begin <= alone) {
    build(begin, middle);
    build(middle + 1, end);
  } else {
    tbb::parallel_invoke([&] { build(begin, middle); }, [&] { build(middle + 1, end); });
  }
}

void PointTree::search(std::uint32_t begin, std::uint32_t end, const Vec3d& at, double radius2,
                       std::vector<Found>& found) const {
  const auto look_at = [&](std::uint32_t i) {
    const Vec3d r = position_[i] - at;
    if (const double d = dot(r, r); d <= radius2) found.push_back({d, order_[i]});
  };
  while (end - begin > leaf) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    const double beyond = at[axis_[middle]] - position_[middle][axis_[middle]];
    const bool both = beyond * beyond <= radius2;
    if (both) look_at(middle);
    if (beyond < 0) {
      if (both) search(middle + 1, end, at, radius2, found);
      end = middle;
    } else {
      if (both) search(begin, middle, at, radius2, found);
      begin = middle + 1;
    }
  }
  for (std::uint32_t i = begin; i < end; ++i) look_at(i);
}

}  // namespace nacre
