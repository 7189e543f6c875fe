// Nacre: points within balls, found through a tree of halved boxes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

class BallSearch {
 public:
  explicit BallSearch(std::span<const Vec3d> points);

  /// Calls visit(index) for the points closer to `centre` than `radius`, in no particular order.
  template <class Visit>
  void visit_within(const Vec3d& centre, double radius, const Visit& visit) const {
    visit_range(0, order_.size(), 0, centre, radius, visit);
  }

 private:
  static constexpr std::size_t leaf = 8;

  void halve(std::size_t begin, std::size_t end, int axis);

  template <class Visit>
  void visit_range(std::size_t begin, std::size_t end, int axis, const Vec3d& centre, double radius,
                   const Visit& visit) const {
    if (end - begin <= leaf) {
      for (std::size_t i = begin; i < end; ++i) try_point(i, centre, radius, visit);
      return;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    const double behind = centre[axis] - points_[order_[middle]][axis];
    const int next = (axis + 1) % 3;
    if (behind <= radius) visit_range(begin, middle, next, centre, radius, visit);
    try_point(middle, centre, radius, visit);
    if (behind >= -radius) visit_range(middle + 1, end, next, centre, radius, visit);
  }

  template <class Visit>
  void try_point(std::size_t i, const Vec3d& centre, double radius, const Visit& visit) const {
    const Vec3d to = points_[order_[i]] - centre;
    if (dot(to, to) < radius * radius) visit(order_[i]);
  }

  std::span<const Vec3d> points_;
  std::vector<std::uint32_t> order_;
};

}  // namespace nacre
