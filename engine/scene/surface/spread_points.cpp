// Nacre: points spread evenly over a surface.
#include "engine/scene/surface/spread_points.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "compute/device/random.hpp"
#include "compute/math/morton.hpp"

namespace nacre {
namespace {

double area_of(std::span<const Vec3d> points, const Triangle& t) {
  return 0.5 * length(cross(points[t.b] - points[t.a], points[t.c] - points[t.a]));
}

/// Darts that were kept, in cells as wide as the first distance, so that neighbours are in the 27 cells around.
class Kept {
 public:
  Kept(const Vec3d& low, double distance) : low_(low), cell_(distance) {}

  bool is_free(const Vec3d& p, double distance) const {
    const Int3 at = cell_of(p);
    for (int k = 0; k < 27; ++k) {
      const auto found = cells_.find(morton(at + Int3(k % 3, k / 3 % 3, k / 9)));
      if (found == cells_.end()) continue;
      for (const Vec3d& other : found->second)
        if (length(other - p) < distance) return false;
    }
    return true;
  }

  void add(const Vec3d& p) { cells_[morton(cell_of(p) + Int3(1))].push_back(p); }

 private:
  Int3 cell_of(const Vec3d& p) const {
    const Vec3d q = (p - low_) / cell_;
    return {int(q.x), int(q.y), int(q.z)};
  }

  Vec3d low_;
  double cell_;
  std::unordered_map<std::uint64_t, std::vector<Vec3d>> cells_;
};

struct Dart {
  SurfacePoint position;
  Vec3d point;
};

std::vector<Dart> throw_darts(std::span<const Vec3d> points, std::span<const Triangle> triangles,
                              const std::vector<double>& area_before, std::size_t count, std::uint32_t seed) {
  std::vector<Dart> darts;
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto random = [&](std::uint32_t which) { return double(uniform_random(seed, k, which)); };
    const double area = random(0) * area_before.back();
    const auto after = std::upper_bound(area_before.begin(), area_before.end(), area) - area_before.begin();
    const auto triangle = std::uint32_t(std::min<std::ptrdiff_t>(after, std::ptrdiff_t(triangles.size())) - 1);
    const double root = std::sqrt(random(1)), share = random(2);
    const Vec3d weights(1 - root, root * (1 - share), root * share);
    const Triangle& t = triangles[triangle];
    darts.push_back(
        {{triangle, Vec3f(weights)}, points[t.a] * weights.x + points[t.b] * weights.y + points[t.c] * weights.z});
  }
  return darts;
}

}  // namespace

double surface_area(std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  double area = 0;
  for (const Triangle& t : triangles) area += area_of(points, t);
  return area;
}

std::vector<SurfacePoint> spread_points(std::span<const Vec3d> points, std::span<const Triangle> triangles, int count,
                                        std::uint32_t seed) {
  std::vector<double> area_before{0};  // each triangle; at the end all of it
  for (const Triangle& t : triangles) area_before.push_back(area_before.back() + area_of(points, t));
  const double area = area_before.back();
  std::vector<SurfacePoint> positions;
  if (count < 1 || !(area > 0)) return positions;
  const auto wanted = std::size_t(count);
  std::vector<Dart> darts = throw_darts(points, triangles, area_before, wanted * (wanted < 10000 ? 12 : 4), seed);
  Vec3d low = darts.front().point;
  for (const Dart& dart : darts) low = min(low, dart.point);
  // Darts fill a plane to this distance and no further; what is missing then comes in at smaller ones.
  double distance = 0.8 * std::sqrt(area / count);
  Kept kept(low, distance);
  for (int round = 0; round < 12 && positions.size() < wanted; ++round, distance *= 0.85) {
    std::vector<Dart> left;
    for (const Dart& dart : darts) {
      if (positions.size() == wanted) break;
      if (!kept.is_free(dart.point, distance)) {
        left.push_back(dart);
        continue;
      }
      kept.add(dart.point);
      positions.push_back(dart.position);
    }
    darts = std::move(left);
  }
  return positions;
}

}  // namespace nacre
