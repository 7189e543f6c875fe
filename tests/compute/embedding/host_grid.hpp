// Nacre: copies of the embeddings in host memory, for tests to look into.
#pragma once

#include <vector>

#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_refined_grid.hpp"
#include "tests/compute/meshes.hpp"

namespace nacre::test {

inline constexpr float band = 4.47f;  ///< what the flow pipeline asks for, in cells

/// The grid of `mesh` in a box of at least `cells`^3 cells.
template <class Backend>
ClosestPointGrid embed(Executor<Backend>& exec, const Mesh& mesh, int cells, int sub = 4, float radius = band) {
  const MeshView view = upload(exec, mesh);
  return build_closest_point_grid(exec, view, std::uint32_t(mesh.triangles.size()), Int3((cells + sub - 1) / sub), sub,
                                  radius);
}

/// A closest-point grid on the host; `view` points into the copies.
struct HostGrid {
  std::vector<std::uint32_t> brick_index, triangle, touch_start, touch_triangle;
  std::vector<std::uint64_t> brick_code;
  std::vector<Float4> offset;
  ClosestPointGridView view;

  explicit HostGrid(const ClosestPointGrid& grid)
      : brick_index(grid.brick_index.download()),
        triangle(grid.triangle.download()),
        touch_start(grid.touch_start.download()),
        touch_triangle(grid.touch_triangle.download()),
        brick_code(grid.brick_code.download()),
        offset(grid.offset.download()),
        view(grid.view()) {
    view.brick_index = brick_index.data();
    view.brick_code = brick_code.data();
    view.offset = offset.data();
    view.triangle = triangle.data();
    view.touch_start = touch_start.data();
    view.touch_triangle = touch_triangle.data();
  }
  HostGrid(const HostGrid&) = delete;

  Vec3d centre(std::uint32_t at) const { return Vec3d(view.cell(at)) + Vec3d(0.5); }
  Vec3d closest(std::uint32_t at) const { return centre(at) + Vec3d(offset[at].x, offset[at].y, offset[at].z); }
};

/// A refined grid on the host.
struct HostTexture {
  std::vector<std::uint32_t> block, texel, position, block_cell, first_surface_cell, seed_triangle, neighbour;
  std::vector<Float4> seed;
  RefinedGridView view;

  HostTexture(const RefinedGrid& fine, const HostGrid& grid)
      : block(fine.block.download()),
        texel(fine.texel.download()),
        position(fine.position.download()),
        block_cell(fine.block_cell.download()),
        first_surface_cell(fine.first_surface_cell.download()),
        seed_triangle(fine.seed_triangle.download()),
        neighbour(fine.neighbour.download()),
        seed(fine.seed.download()),
        view(fine.view(grid.view)) {
    view.block = block.data();
    view.texel = texel.data();
    view.position = position.data();
    view.block_cell = block_cell.data();
    view.first_surface_cell = first_surface_cell.data();
    view.seed_triangle = seed_triangle.data();
    view.neighbour = neighbour.data();
    view.seed = seed.data();
  }
  HostTexture(const HostTexture&) = delete;
};

}  // namespace nacre::test
