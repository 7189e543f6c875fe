// Nacre: closest points of a triangulated surface.
#include "include/nacre/surface.hpp"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "api/support.hpp"
#include "compute/raycast/triangle_tree.hpp"

namespace nacre {
namespace {

Vec3d checked(const std::array<double, 3>& p, const char* what, std::size_t number) {
  const Vec3d v(p[0], p[1], p[2]);
  if (!is_finite(v)) throw Error(fmt::format("{} {} is not finite", what, number), "", "leave it out");
  return v;
}

}  // namespace

ClosestPoints closest_points(std::span<const std::array<double, 3>> points,
                             std::span<const std::array<std::uint32_t, 3>> triangles,
                             std::span<const std::array<double, 3>> queries, const std::atomic<bool>* stop) {
  check_process();
  if (triangles.empty()) throw Error("the surface has no triangles");
  std::vector<Vec3d> positions(points.size());
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = Vec3d(points[i][0], points[i][1], points[i][2]);
  std::vector<Triangle> corners(triangles.size());
  for (std::size_t t = 0; t < corners.size(); ++t) {
    for (const std::uint32_t corner : triangles[t]) {
      if (corner >= points.size())
        throw Error(fmt::format("triangle {} has corner {}", t, corner),
                    fmt::format("there are {} points, counted from 0", points.size()));
      checked(points[corner], "point", corner);
    }
    corners[t] = {triangles[t][0], triangles[t][1], triangles[t][2]};
  }
  for (std::size_t i = 0; i < queries.size(); ++i) checked(queries[i], "query", i);
  const TriangleTree tree(positions, corners);
  ClosestPoints result;
  result.points.resize(queries.size());
  result.triangles.resize(queries.size());
  result.distance.resize(queries.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, queries.size(), 256), [&](const auto& range) {
    check_stop(stop);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const TriangleHit hit = *tree.closest(Vec3d(queries[i][0], queries[i][1], queries[i][2]));
      result.points[i] = {hit.position.x, hit.position.y, hit.position.z};
      result.triangles[i] = hit.triangle;
      result.distance[i] = hit.distance;
    }
  });
  return result;
}

}  // namespace nacre
