// Nacre: points by where they are, in a tree that is cut at their medians.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Groups of points, each with a tree of its own. Points are numbered as they are given.
class PointTree {
 public:
  struct Found {
    double distance2;
    std::uint32_t point;
    friend bool operator<(const Found& s, const Found& t) {
      return s.distance2 != t.distance2 ? s.distance2 < t.distance2 : s.point < t.point;
    }
  };

  /// Group g holds points first[g] .. first[g + 1] - 1. In parallel.
  PointTree(std::span<const Vec3d> points, std::span<const std::uint32_t> first);

  /// Adds to `found` the points of the group within `radius` of `position`, in no particular order.
  void within(std::uint32_t group, const Vec3d& position, double radius, std::vector<Found>& found) const {
    search(first_[group], first_[group + 1], position, radius * radius, found);
  }

 private:
  static constexpr std::uint32_t leaf = 8;  // as many points or fewer are not divided

  struct Entry {
    Vec3d position;
    std::uint32_t point;
    std::uint8_t axis;  // of the one in the middle of a range: across which it is divided
  };

  void build(std::uint32_t begin, std::uint32_t end);
  void search(std::uint32_t begin, std::uint32_t end, const Vec3d& at, double radius2, std::vector<Found>& found) const;

  std::vector<std::uint32_t> first_;
  std::vector<Entry> entry_;  // a range is divided at its middle
};

}  // namespace nacre
