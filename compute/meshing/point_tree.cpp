// Nacre: points by where they are, in a tree that is cut at their medians.
#include "compute/meshing/point_tree.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

namespace nacre {
namespace {

constexpr std::uint32_t alone = 4096;  // as many points or fewer are divided by one thread

}  // namespace

PointTree::PointTree(std::span<const Vec3d> points, std::span<const std::uint32_t> first)
    : first_(first.begin(), first.end()), entry_(points.size()) {
  tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t i) {
    entry_[i] = {points[i], std::uint32_t(i), 0};
  });
  tbb::parallel_for(std::size_t(1), first.size(), [&](std::size_t g) { build(first_[g - 1], first_[g]); });
}

void PointTree::build(std::uint32_t begin, std::uint32_t end) {
  if (end - begin <= leaf) return;
  Vec3d lower = entry_[begin].position, upper = lower;
  for (std::uint32_t i = begin; i < end; ++i)
    lower = min(lower, entry_[i].position), upper = max(upper, entry_[i].position);
  const Vec3d extent = upper - lower;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(entry_.begin() + begin, entry_.begin() + middle, entry_.begin() + end,
                   [axis](const Entry& i, const Entry& j) {
                     const double s = i.position[axis], t = j.position[axis];
                     return s != t ? s < t : i.point < j.point;
                   });
  entry_[middle].axis = std::uint8_t(axis);
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
    const Vec3d r = entry_[i].position - at;
    if (const double d = dot(r, r); d <= radius2) found.push_back({d, entry_[i].point});
  };
  while (end - begin > leaf) {
    const std::uint32_t middle = begin + (end - begin) / 2;
    const int axis = entry_[middle].axis;
    const double beyond = at[axis] - entry_[middle].position[axis];
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
