// Nacre: which points are near some of them.
#include "compute/meshing/near_points.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "compute/meshing/point_tree.hpp"
#include "compute/meshing/select_where.hpp"

namespace nacre {
namespace {

/// Boxes around balls, on a lattice: whether a point may be in one of the balls.
class BallBoxes {
 public:
  BallBoxes(std::span<const Vec3d> points, std::span<const std::uint32_t> balls, std::span<const double> size,
            double reach) {
    low_ = high_ = points[balls[0]];
    for (const std::uint32_t i : balls) {
      const Vec3d r = Vec3d(1, 1, 1) * (reach * size[i]);
      low_ = min(low_, points[i] - r), high_ = max(high_, points[i] + r);
      radius_ = std::max(radius_, reach * size[i]);
    }
    std::size_t cells = 1;
    for (int a = 0; a < 3; ++a) {
      const double extent = high_[a] - low_[a];
      count_[std::size_t(a)] = int(std::clamp(extent / radius_, 1.0, most));
      scale_[a] = extent > 0 ? count_[std::size_t(a)] / extent : 0;
      cells *= std::size_t(count_[std::size_t(a)]);
    }
    there_.resize(cells);
    for (const std::uint32_t i : balls) {
      const Vec3d r = Vec3d(1, 1, 1) * (reach * size[i]);
      const auto first = cell_of(points[i] - r), last = cell_of(points[i] + r);
      for (int z = first[2]; z <= last[2]; ++z)
        for (int y = first[1]; y <= last[1]; ++y)
          for (int x = first[0]; x <= last[0]; ++x) there_[number(x, y, z)] = 1;
    }
  }

  double radius() const { return radius_; }  ///< the largest

  bool may_have(const Vec3d& p) const {
    for (int a = 0; a < 3; ++a)
      if (!(p[a] >= low_[a] && p[a] <= high_[a])) return false;
    const auto [x, y, z] = cell_of(p);
    return there_[number(x, y, z)] != 0;
  }

 private:
  static constexpr double most = 64;  // cells along an axis

  std::array<int, 3> cell_of(const Vec3d& p) const {
    std::array<int, 3> cell;
    for (int a = 0; a < 3; ++a)
      cell[std::size_t(a)] = std::clamp(int((p[a] - low_[a]) * scale_[a]), 0, count_[std::size_t(a)] - 1);
    return cell;
  }
  std::size_t number(int x, int y, int z) const {
    return (std::size_t(z) * std::size_t(count_[1]) + std::size_t(y)) * std::size_t(count_[0]) + std::size_t(x);
  }

  Vec3d low_, high_, scale_;
  double radius_ = 0;
  std::array<int, 3> count_{};
  std::vector<std::uint8_t> there_;
};

}  // namespace

void for_points_near(std::span<const Vec3d> points, std::span<const std::uint32_t> some, std::span<const double> size,
                     double reach, const std::function<void(std::uint32_t, std::span<const std::uint32_t>)>& visit) {
  if (some.empty()) return;
  const BallBoxes boxes(points, some, size, reach);
  const std::vector<std::uint32_t> candidates =
      select_where(points.size(), [&](std::size_t i) { return boxes.may_have(points[i]); });
  std::vector<Vec3d> centre;
  for (const std::uint32_t i : some) centre.push_back(points[i]);
  const std::uint32_t first[2] = {0, std::uint32_t(centre.size())};
  const PointTree tree(centre, first);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, candidates.size(), 256), [&](const auto& range) {
    std::vector<PointTree::Found> found;
    std::vector<std::uint32_t> near;
    for (std::size_t k = range.begin(); k != range.end(); ++k) {
      found.clear(), near.clear();
      tree.within(0, points[candidates[k]], boxes.radius(), found);
      for (const PointTree::Found& f : found) {
        const double radius = reach * size[some[f.point]];
        if (f.distance2 <= radius * radius) near.push_back(some[f.point]);
      }
      if (!near.empty()) visit(candidates[k], near);
    }
  });
}

void mark_near(std::span<const Vec3d> points, std::span<const std::uint32_t> some, std::span<const double> size,
               double reach, std::span<std::uint8_t> marks) {
  for_points_near(points, some, size, reach,
                  [&](std::uint32_t point, std::span<const std::uint32_t>) { marks[point] = 1; });
}

}  // namespace nacre
