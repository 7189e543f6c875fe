// Nacre: test bodies for the refined grid.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/compute/embedding/host_grid.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test {

/// Every texture cell that some triangle touches, looked for in the triangle's whole bounding box.
inline std::vector<bool> touched_cells(const Mesh& mesh, int refine, Int3 dims) {
  std::vector<bool> touched(std::size_t(dims.x) * dims.y * dims.z);
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const Corners t = mesh.corners(k) * double(refine);
    const Vec3d low = min(t.a, min(t.b, t.c)), high = max(t.a, max(t.b, t.c));
    for (int z = std::max(0, int(low.z) - 1); z <= std::min(dims.z - 1, int(high.z) + 1); ++z)
      for (int y = std::max(0, int(low.y) - 1); y <= std::min(dims.y - 1, int(high.y) + 1); ++y)
        for (int x = std::max(0, int(low.x) - 1); x <= std::min(dims.x - 1, int(high.x) + 1); ++x)
          if (touches_cube(t, {x + 0.5, y + 0.5, z + 0.5}, 0.5 + 1e-7))
            touched[(std::size_t(z) * dims.y + y) * dims.x + x] = true;
  }
  return touched;
}

inline int steps_apart(const Int3& a, const Int3& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

/// Surface cells are those that a triangle touches, and each has one number.
inline void check_surface_cells(const Mesh& mesh, const HostTexture& texture, std::uint32_t count) {
  const Int3 dims = texture.view.grid.dims() * Int3(texture.view.refine);
  std::vector<bool> touched = touched_cells(mesh, texture.view.refine, dims);
  EXPECT_EQ(std::size_t(std::count(touched.begin(), touched.end(), true)), std::size_t(count));
  std::size_t wrong = 0;
  for (std::uint32_t s = 0; s < count; ++s) {
    const Int3 c = texture.view.cell(s);
    const std::size_t at = (std::size_t(c.z) * dims.y + c.y) * dims.x + c.x;
    wrong += !touched[at] || texture.view.surface_cell(c) != s || texture.texel[texture.position[s]] != s;
    touched[at] = false;  // a second number for the same cell would be a mistake
  }
  EXPECT_EQ(wrong, 0u);
}

inline void check_seeds(const Mesh& mesh, const HostTexture& texture, const BruteForce& brute, std::uint32_t count,
                        int stride) {
  const double refine = texture.view.refine;
  std::size_t wrong = 0, wrong_triangle = 0;
  for (std::uint32_t s = 0; s < count; s += stride) {
    const Vec3d centre = Vec3d(texture.view.cell(s)) + Vec3d(0.5), x = centre / refine;
    const std::uint32_t t = texture.seed_triangle[s];
    ASSERT_LT(t, mesh.triangles.size());
    const auto nearest = brute(x, 1e300, t);
    const Vec3d offset(texture.seed[s].x, texture.seed[s].y, texture.seed[s].z), p = (centre + offset) / refine;
    wrong += std::fabs(length(p - x) - nearest.distance) > 1e-5 || (nearest.unique && length(p - nearest.point) > 1e-5);
    wrong_triangle += length(reference_closest_point(brute.corners(t), p) - p) > 1e-5;
    if (length(Vec3d(texture.view.seed_point(s)) - p * refine) > 1e-4) ++wrong;
  }
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(wrong_triangle, 0u);
}

/// Share of the cells within two cells of the surface that name the surface cell of their closest point, or one beside.
inline double extended_share(const HostTexture& texture, const BruteForce& brute, int stride) {
  const double refine = texture.view.refine;
  std::size_t all = 0, right = 0;
  for (std::uint32_t at = 0; at < texture.texel.size(); at += stride) {
    const std::uint32_t value = texture.texel[at];
    if ((value & RefinedGridView::extended) == 0) continue;
    const Vec3d x = (Vec3d(texture.view.texel_cell(at)) + Vec3d(0.5)) / refine;
    const std::uint32_t outer = texture.block_cell[at / texture.view.cells_per_block()];
    const auto nearest = brute(x, 1e300, texture.view.grid.triangle[outer]);
    if (nearest.distance * refine > 2) continue;
    ++all;
    if (value == none) continue;
    const Vec3d p = nearest.point * refine;
    right += steps_apart(texture.view.cell(value & ~RefinedGridView::extended), floor_cell(Vec3f(p))) <= 1;
  }
  EXPECT_GT(all, 0u);
  return double(right) / double(all);
}

/// Share of neighbours, among those other than the cell itself, that lead back with the opposite step.
inline double symmetric_share(const HostTexture& texture, std::uint32_t count) {
  std::size_t all = 0, back = 0;
  for (std::uint32_t s = 0; s < count; ++s)
    for (int k = 0; k < 6; ++k) {
      const std::uint32_t n = texture.neighbour[6 * std::size_t(s) + k];
      if (n >= count) {
        ADD_FAILURE() << "no such surface cell";
        return 0;
      }
      EXPECT_LE(steps_apart(texture.view.cell(s), texture.view.cell(n)), 4);
      if (n == s) continue;
      ++all;
      bool found = false;
      for (int j = 0; j < 6; ++j) found = found || texture.neighbour[6 * std::size_t(n) + j] == s;
      back += found;
    }
  return double(back) / double(std::max<std::size_t>(all, 1));
}

struct TextureShares {
  double extended, symmetric;
};

template <class Backend>
TextureShares check_texture(Executor<Backend>& exec, const Mesh& mesh, int cells, int refine, const std::string& what,
                            int stride = 1) {
  SCOPED_TRACE(what + ", refine " + std::to_string(refine));
  const std::size_t mark = exec.arena().mark();
  const MeshView view = upload(exec, mesh);
  const auto triangles = std::uint32_t(mesh.triangles.size());
  const ClosestPointGrid coarse = build_closest_point_grid(exec, view, triangles, Int3((cells + 3) / 4), 4, band);
  const RefinedGrid fine = build_refined_grid(exec, view, triangles, coarse, refine);
  const HostGrid grid(coarse);
  const HostTexture texture(fine, grid);
  const BruteForce brute(mesh.points, mesh.triangles);
  EXPECT_EQ(texture.neighbour.size(), 6 * std::size_t(fine.surface_cells));
  check_surface_cells(mesh, texture, fine.surface_cells);
  check_seeds(mesh, texture, brute, fine.surface_cells, stride);
  const TextureShares shares{extended_share(texture, brute, stride), symmetric_share(texture, fine.surface_cells)};
  exec.arena().rewind(mark);
  return shares;
}

template <class Backend>
void EveryRefinement(Executor<Backend>& exec) {
  for (const int refine : {1, 2, 3, 4, 5, 8}) {
    const TextureShares round = check_texture(exec, sphere({12.3, 12.1, 11.8}, 5, 8), 24, refine, "sphere", 7);
    EXPECT_GE(round.extended, refine <= 4 ? 0.99 : 0.95) << refine;
    EXPECT_GE(round.symmetric, 0.84) << refine;
    const TextureShares square =
        check_texture(exec, box({7.4, 7.3, 7.2}, {13.1, 14.4, 13.2}, 1), 22, refine, "cube", 7);
    EXPECT_GE(square.extended, refine <= 4 ? 0.96 : 0.8) << refine;  // its edges are not smooth
    EXPECT_GE(square.symmetric, 0.93) << refine;
  }
}

template <class Backend>
void LargeTriangles(Executor<Backend>& exec) {
  for (const int refine : {1, 4}) {
    const TextureShares flat =
        check_texture(exec, sheet({6.2, 6.1, 7.3}, {50, 3, 4}, {-2, 50, 6}, 1), 64, refine, "plane", 31);
    EXPECT_GE(flat.extended, 0.999) << refine;
    EXPECT_GE(flat.symmetric, 0.9) << refine;
  }
}

template <class Backend>
void SoupsAndFolds(Executor<Backend>& exec) {
  check_texture(exec, soup(40, 6, 18, 5, 41), 24, 3, "soup", 11);
  Mesh folded = sheet({7, 7, 9.1}, {8, 0, 0}, {0, 8, 0}, 4);
  folded.add(sheet({15, 7, 9.1}, {-8, 0, 0.4}, {0, 8, 0}, 4));
  check_texture(exec, folded, 22, 4, "folded", 11);
  check_texture(exec, sphere({8.3, 8.1, 7.8}, 0.02, 12), 16, 4, "tiny");
}

template <class Backend>
void AFlatSheetByHand(Executor<Backend>& exec) {  // 8 x 8 cells in the middle of a layer, 2 texture cells to a cell
  const std::size_t mark = exec.arena().mark();
  const Mesh mesh = sheet({8.1, 8.1, 9.25}, {7.8, 0, 0}, {0, 7.8, 0}, 1);
  const MeshView view = upload(exec, mesh);
  const ClosestPointGrid coarse = build_closest_point_grid(exec, view, 2, Int3(6), 4, band);
  const RefinedGrid fine = build_refined_grid(exec, view, 2, coarse, 2);
  const HostGrid grid(coarse);
  const HostTexture texture(fine, grid);
  EXPECT_EQ(fine.surface_cells, 16u * 16u);
  const RefinedGridView& t = texture.view;
  const std::uint32_t s = t.surface_cell({24, 24, 18});
  ASSERT_NE(s, none);
  EXPECT_NEAR(texture.seed[s].z, 0, 1e-6);
  const std::uint32_t* n = &texture.neighbour[6 * std::size_t(s)];
  EXPECT_EQ(n[0], t.surface_cell({23, 24, 18}));
  EXPECT_EQ(n[1], t.surface_cell({25, 24, 18}));
  EXPECT_EQ(n[2], t.surface_cell({24, 23, 18}));
  EXPECT_EQ(n[3], t.surface_cell({24, 25, 18}));
  EXPECT_EQ(n[4], s);  // above and below it projects back
  EXPECT_EQ(n[5], s);
  EXPECT_EQ(t.surface_cell({24, 24, 20}), s);
  EXPECT_EQ(t.surface_cell({24, 24, 30}), none);
  std::vector<float> values(fine.surface_cells);
  for (std::uint32_t k = 0; k < values.size(); ++k) values[k] = float(t.cell(k).x);
  EXPECT_NEAR(sample(t, values.data(), {24.8f, 24.5f, 18.5f}, -1), 24.3f, 1e-5);
  EXPECT_NEAR(sample(t, values.data(), {24.8f, 24.5f, 19.2f}, -1), 24.3f, 1e-5);
  EXPECT_EQ(sample(t, values.data(), {24.8f, 24.5f, 40.0f}, -1), -1);
  exec.arena().rewind(mark);
}

NACRE_DEVICE_TEST(RefinedGrid, EveryRefinement)
NACRE_DEVICE_TEST(RefinedGrid, LargeTriangles)
NACRE_DEVICE_TEST(RefinedGrid, SoupsAndFolds)
NACRE_DEVICE_TEST(RefinedGrid, AFlatSheetByHand)

}  // namespace nacre::test
