// Nacre: the sides of a mesh's triangles, edge by edge.
#include "compute/pipeline/mesh_sides.hpp"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <tuple>

namespace nacre {

std::vector<MeshSide> sides_of(const SurfaceMesh& mesh) {
  std::vector<MeshSide> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), mesh.materials[t], t, std::uint8_t(k)});
    }
  tbb::parallel_sort(sides.begin(), sides.end(), [](const MeshSide& s, const MeshSide& t) {
    return std::tie(s.a, s.b, s.materials, s.triangle) < std::tie(t.a, t.b, t.materials, t.triangle);
  });
  return sides;
}

Junction curve_between(std::uint16_t a, std::uint16_t b, std::uint16_t c) {
  std::array<std::uint16_t, 3> m{a, b, c};
  std::sort(m.begin(), m.end());
  return Junction(m[0], m[1], m[2]);
}

Junction curve_of(std::span<const MeshSide> sides) {
  std::array<std::uint16_t, 3> met;
  std::size_t count = 0;
  for (const MeshSide& s : sides)
    for (const std::uint16_t m : s.materials) {
      if (std::find(met.begin(), met.begin() + count, m) != met.begin() + count) continue;
      if (count == met.size()) return Junction();
      met[count++] = m;
    }
  if (count < met.size()) return Junction();
  return curve_between(met[0], met[1], met[2]);
}

}  // namespace nacre
