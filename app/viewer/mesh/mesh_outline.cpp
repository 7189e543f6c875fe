// Nacre: where triangles are cut by a plane.
#include "app/viewer/mesh/mesh_outline.hpp"

#include <cstdint>

namespace nacre {
namespace {

bool is_drawn(const std::vector<bool>& drawn, std::size_t material) {
  return material < drawn.size() && drawn[material];
}

}  // namespace

std::map<std::size_t, std::vector<LineSegment>> mesh_outline(const SurfaceMesh& mesh, const Vec3d& normal,
                                                             const Vec3d& origin, const std::vector<bool>& drawn) {
  std::vector<std::uint8_t> above(mesh.points.size());
  const double offset = dot(normal, origin);
  for (std::size_t v = 0; v < above.size(); ++v) above[v] = dot(normal, mesh.points[v]) >= offset;
  std::map<std::size_t, std::vector<LineSegment>> outline;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const int sum = above[triangle.a] + above[triangle.b] + above[triangle.c];
    if (sum == 0 || sum == 3) continue;
    const auto [low, high] = mesh.materials[t];
    if (!is_drawn(drawn, low) && !is_drawn(drawn, high)) continue;
    std::array<Vec3f, 2> ends;
    std::size_t found = 0;
    for (int k = 0; k < 3 && found < 2; ++k) {
      const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
      if (above[from] == above[to]) continue;
      const Vec3d p = mesh.points[from] - origin, q = mesh.points[to] - origin;
      const double a = dot(normal, p), b = dot(normal, q);
      ends[found++] = Vec3f(p + (q - p) * (a / (a - b)));
    }
    outline[high].push_back({ends[0], ends[1]});
  }
  return outline;
}

}  // namespace nacre
