// Nacre: a tree of boxes over triangles: its order and its boxes, on the host.
#include "compute/raycast/box_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compute/math/morton.hpp"

namespace nacre {

std::uint32_t box_leaves(std::size_t triangles) {
  std::uint32_t leaves = 1;
  while (std::size_t(leaves) * BoxTreeView::run < triangles) leaves *= 2;
  return leaves;
}

std::vector<std::uint32_t> order_along_curve(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  const auto centre = [&](const Triangle& t) { return (points[t.a] + points[t.b] + points[t.c]) / 3.0; };
  Vec3d low(1e300), high(-1e300);
  for (const Triangle& t : triangles) low = min(low, centre(t)), high = max(high, centre(t));
  const Vec3d extent = high - low;
  const double scale = 1023 / std::max({extent.x, extent.y, extent.z, 1e-300});
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(triangles.size());
  for (std::uint32_t t = 0; t < keys.size(); ++t) {
    const Vec3d at = (centre(triangles[t]) - low) * scale;
    keys[t] = {morton(Int3(int(at.x), int(at.y), int(at.z))), t};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::uint32_t> order(keys.size());
  for (std::size_t k = 0; k < keys.size(); ++k) order[k] = keys[k].second;
  return order;
}

std::vector<TriangleBox> boxes_over(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                                    std::span<const std::uint32_t> order) {
  const std::uint32_t leaves = box_leaves(triangles.size());
  std::vector<TriangleBox> box(2 * std::size_t(leaves));
  const auto below = [](double x) { return std::nextafter(float(x), -1e30f); };
  const auto above = [](double x) { return std::nextafter(float(x), 1e30f); };
  for (std::size_t k = 0; k < order.size(); ++k) {
    TriangleBox& b = box[leaves + k / BoxTreeView::run];
    for (int corner = 0; corner < 3; ++corner) {
      const Vec3d& p = points[triangles[order[k]][corner]];
      b.low = min(b.low, Vec3f(below(p.x), below(p.y), below(p.z)));
      b.high = max(b.high, Vec3f(above(p.x), above(p.y), above(p.z)));
    }
  }
  for (std::uint32_t k = leaves - 1; k > 0; --k)
    box[k] = {min(box[2 * k].low, box[2 * k + 1].low), max(box[2 * k].high, box[2 * k + 1].high)};
  return box;
}

}  // namespace nacre
