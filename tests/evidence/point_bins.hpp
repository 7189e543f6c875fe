// Nacre: points in bins, to find those nearest to a position.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// Points sorted into the cubes of a dense lattice: quick where the points are about as far apart as a cube is wide.
class PointBins {
 public:
  struct Neighbour {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t index = 0;
  };

  PointBins(std::span<const Vec3d> points, double width) : points_(points), width_(width) {
    Vec3d high = low_ = points.empty() ? Vec3d() : points[0];
    for (const Vec3d& p : points) low_ = min(low_, p), high = max(high, p);
    bins_ = cell(high) + Int3(1);
    start_.assign(std::size_t(bins_.x) * bins_.y * bins_.z + 1, 0);
    for (const Vec3d& p : points) ++start_[number(cell(p)) + 1];
    for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    order_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) order_[next[number(cell(points[i]))]++] = std::uint32_t(i);
  }

  /// Calls visit(index, squared distance) for the points within `radius` of `p`.
  template <class Visit>
  void each_within(const Vec3d& p, double radius, const Visit& visit) const {
    const Int3 low = max(cell(p - Vec3d(radius)), Int3(0)), high = min(cell(p + Vec3d(radius)), bins_ - Int3(1));
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::size_t b = number({x, y, z});
          for (std::uint32_t k = start_[b]; k < start_[b + 1]; ++k) {
            const Vec3d way = points_[order_[k]] - p;
            if (const double square = dot(way, way); square <= radius * radius) visit(order_[k], square);
          }
        }
  }

  /// The `N` points nearest to `p`, the nearest first; at an infinite distance where there are fewer within `limit`.
  template <int N>
  std::array<Neighbour, N> nearest(const Vec3d& p, double limit) const {
    for (double radius = 0.75 * width_;; radius *= 2) {
      std::array<Neighbour, N> found;
      each_within(p, std::min(radius, limit), [&](std::uint32_t i, double square) {
        const double distance = std::sqrt(square);
        int k = N - 1;
        if (distance >= found[k].distance) return;
        for (; k > 0 && found[k - 1].distance > distance; --k) found[k] = found[k - 1];
        found[k] = {distance, i};
      });
      if (radius >= limit || found[N - 1].distance <= radius) return found;
    }
  }

 private:
  Int3 cell(const Vec3d& p) const {
    const Vec3d q = (p - low_) / width_;
    return {int(std::floor(q.x)), int(std::floor(q.y)), int(std::floor(q.z))};
  }
  std::size_t number(const Int3& c) const { return (std::size_t(c.z) * bins_.y + c.y) * bins_.x + c.x; }

  std::span<const Vec3d> points_;
  double width_;
  Vec3d low_{};
  Int3 bins_{};
  std::vector<std::uint32_t> start_, order_;
};

}  // namespace nacre
