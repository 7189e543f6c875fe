// Nacre: which material each Delaunay cell of a surface mesh's points lies in.
#include "compute/meshing/cell_materials.hpp"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/meshing/incidence.hpp"
#include "compute/meshing/interface_facets.hpp"

namespace nacre {
namespace {

constexpr std::uint16_t unknown = 0xffff;

[[noreturn]] void not_closed() {
  throw Error("the surface cannot be filled", "it does not close off its materials from each other",
              "report how this mesh was made: a surface that Nacre makes is closed");
}

/// Corners of facet k of a cell, smallest first, in the order seen from outside of it.
Triangle facet(const std::array<std::uint32_t, 4>& cell, int k) {
  const auto [a, b, c] = facet_corners[k];
  Triangle t{cell[a], cell[b], cell[c]};
  while (t.a > t.b || t.a > t.c) t = {t.b, t.c, t.a};
  return t;
}

/// Finds a triangle of the mesh by its corners.
class TriangleFinder {
 public:
  explicit TriangleFinder(const SurfaceMesh& mesh) : mesh_(mesh), vertices_(mesh.triangles, mesh.points.size()) {}

  /// Index of the triangle with the corners of `t`, or -1; `turned`: it runs the other way round.
  std::int64_t find(const Triangle& t, bool& turned) const {
    if (std::max({t.a, t.b, t.c}) >= vertices_.size()) return -1;
    for (const std::uint32_t corner : vertices_.corners(t.a)) {
      const Triangle& other = mesh_.triangles[corner / 3];
      const std::uint32_t next = other[int((corner + 1) % 3)], last = other[int((corner + 2) % 3)];
      if (!(next == t.b && last == t.c) && !(next == t.c && last == t.b)) continue;
      turned = next != t.b;
      return corner / 3;
    }
    return -1;
  }

 private:
  const SurfaceMesh& mesh_;
  VertexTable vertices_;
};

/// Each cell at a triangle takes the material of its side. `at` receives the triangle of each facet where there is one.
void seed(const DelaunayCells& cells, const SurfaceMesh& mesh, CellMaterials& result, std::vector<char>& is_wall) {
  const TriangleFinder finder(mesh);
  is_wall.assign(4 * cells.vertices.size(), 0);
  std::vector<std::array<std::int32_t, 2>>& cells_at = result.cells_at;
  cells_at.assign(mesh.triangles.size(), {-2, -2});
  tbb::parallel_for(std::size_t(0), cells.vertices.size(), [&](std::size_t i) {
    for (int k = 0; k < 4; ++k) {
      bool turned = false;
      const std::int64_t t = finder.find(facet(cells.vertices[i], k), turned);
      if (t < 0) continue;
      is_wall[4 * i + std::size_t(k)] = 1;
      // A triangle is seen from the side of its first material, a facet from outside of its cell.
      const int side = turned ? 0 : 1;
      result.material[i] = mesh.materials[std::size_t(t)][std::size_t(side)];
      cells_at[std::size_t(t)][std::size_t(side)] = std::int32_t(i);
      if (cells.neighbours[i][k] < 0) cells_at[std::size_t(t)][std::size_t(1 - side)] = -1;
    }
  });
  for (std::size_t t = 0; t < cells_at.size(); ++t)
    if (cells_at[t][0] == -2 || cells_at[t][1] == -2) result.missing.push_back(std::uint32_t(t));
}

void flood(const DelaunayCells& cells, const std::vector<char>& is_wall, std::vector<std::uint16_t>& material) {
  std::vector<std::int32_t> front;
  for (std::size_t i = 0; i < material.size(); ++i)
    if (material[i] != unknown) front.push_back(std::int32_t(i));
  while (!front.empty()) {
    const std::int32_t cell = front.back();
    front.pop_back();
    for (int k = 0; k < 4; ++k) {
      const std::int32_t beyond = cells.neighbours[cell][k];
      if (is_wall[4 * std::size_t(cell) + std::size_t(k)] || beyond < 0 || material[beyond] != unknown) continue;
      material[beyond] = material[cell];
      front.push_back(beyond);
    }
  }
}

void check_closed(const DelaunayCells& cells, const SurfaceMesh& mesh, const std::vector<char>& is_wall,
                  const CellMaterials& result) {
  for (std::size_t i = 0; i < cells.vertices.size(); ++i)
    for (int k = 0; k < 4; ++k) {
      const std::int32_t beyond = cells.neighbours[i][k];
      const std::uint16_t there = beyond < 0 ? std::uint16_t(0) : result.material[beyond];
      if (!is_wall[4 * i + std::size_t(k)] && there != result.material[i]) not_closed();
    }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t side = 0; side < 2; ++side) {
      const std::int32_t cell = result.cells_at[t][side];
      if ((cell < 0 ? std::uint16_t(0) : result.material[cell]) != mesh.materials[t][side]) not_closed();
    }
}

}  // namespace

CellMaterials cell_materials(const DelaunayCells& cells, const SurfaceMesh& mesh) {
  CellMaterials result;
  result.material.assign(cells.vertices.size(), unknown);
  std::vector<char> is_wall;
  seed(cells, mesh, result, is_wall);
  if (!result.missing.empty()) {
    result.material.clear();
    return result;
  }
  flood(cells, is_wall, result.material);
  check_closed(cells, mesh, is_wall, result);
  return result;
}

std::vector<std::uint16_t> materials_at(std::span<const Vec3d> positions, std::span<const Vec3d> points,
                                        const DelaunayCells& cells, std::span<const std::uint16_t> material) {
  constexpr int longest_walk = 100'000;  // exact predicates need far fewer; rounding may walk in a circle
  std::vector<std::uint16_t> result(positions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, positions.size(), 4096), [&](const auto& range) {
    std::int32_t cell = 0;
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      std::int32_t next = cell;
      for (int steps = 0; next >= 0 && steps < longest_walk; ++steps) {
        cell = next;
        const auto& v = cells.vertices[cell];
        int k = 0;
        for (; k < 4; ++k) {
          const auto [a, b, c] = facet_corners[(k + steps) % 4];
          const Vec3d p = points[v[a]];
          if (dot(cross(points[v[b]] - p, points[v[c]] - p), positions[i] - p) > 0) break;
        }
        if (k == 4) break;  // within
        next = cells.neighbours[cell][(k + steps) % 4];
      }
      result[i] = next < 0 ? std::uint16_t(0) : material[cell];
    }
  });
  return result;
}

}  // namespace nacre
