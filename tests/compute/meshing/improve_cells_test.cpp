// Nacre: tests of the improvement of cells.
#include "compute/meshing/improve_cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "compute/device/error.hpp"

namespace nacre {
namespace {

double shape(const std::vector<Vec3d>& p, const std::array<std::uint32_t, 4>& v) {
  return cell_shape(p[v[0]], p[v[1]], p[v[2]], p[v[3]]);
}

double volume(const std::vector<Vec3d>& p, const MaterialCells& cells) {
  double sum = 0;
  for (const auto& v : cells.cells.vertices)
    sum += dot(p[v[1]] - p[v[0]], cross(p[v[2]] - p[v[0]], p[v[3]] - p[v[0]])) / 6;
  return sum;
}

MaterialCells all_of_one_material(const std::vector<Vec3d>& points) {
  MaterialCells cells;
  cells.cells = delaunay(points);
  cells.cells.circumcentres.clear();
  cells.material.assign(cells.cells.vertices.size(), 1);
  return cells;
}

void expect_neighbours_agree(const MaterialCells& cells) {
  for (std::size_t i = 0; i < cells.material.size(); ++i)
    for (int k = 0; k < 4; ++k) {
      const std::int32_t n = cells.cells.neighbours[i][k];
      if (n < 0) continue;
      const auto& back = cells.cells.neighbours[n];
      ASSERT_TRUE(std::find(back.begin(), back.end(), std::int32_t(i)) != back.end());
      for (int j = 0; j < 4; ++j) {
        const auto& there = cells.cells.vertices[n];
        ASSERT_EQ(std::count(there.begin(), there.end(), cells.cells.vertices[i][j]), j != k);
      }
    }
}

TEST(CellShape, KnownCells) {
  EXPECT_NEAR(cell_shape({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}), std::sqrt(8) / 3, 1e-12);
  EXPECT_NEAR(cell_shape({1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}), -std::sqrt(8) / 3, 1e-12);  // turned
  // At the edge along z two facets meet at a given angle; the other two are upright to it.
  const auto wedge = [](double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return cell_shape({0, 0, 0}, {1, 0, 0}, {std::cos(angle), std::sin(angle), 0}, {0, 0, 1});
  };
  EXPECT_NEAR(wedge(10), std::sin(10 * std::numbers::pi / 180), 1e-12);
  EXPECT_NEAR(wedge(170), 0.5 * std::sin(170 * std::numbers::pi / 180), 1e-12);
  EXPECT_EQ(cell_shape({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 1}), 0);
}

/// Points of a lattice with a flat cell in its middle: four next to a square.
TEST(ImproveCells, FlatCellsGo) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 125; ++i) points.push_back({double(i % 5), double(i / 5 % 5), double(i / 25)});
  const std::size_t fixed = points.size();
  auto random = [state = std::uint64_t(1)]() mutable {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return double(state >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 64; ++i)
    points.push_back({i % 4 + 0.1 + 0.8 * random(), i / 4 % 4 + 0.1 + 0.8 * random(), i / 16 + 0.1 + 0.8 * random()});
  MaterialCells cells = all_of_one_material(points);
  const double before = volume(points, cells);
  const std::vector<Vec3d> was = points;
  const CellImprovement result = improve_cells(points, fixed, cells);
  EXPECT_GT(result.bad_before, 0);
  EXPECT_LT(result.bad_after, result.bad_before / 3);
  EXPECT_GT(result.flips, 0);
  EXPECT_GT(result.moves, 0);
  EXPECT_NEAR(volume(points, cells), before, 1e-9);
  EXPECT_TRUE(std::equal(was.begin(), was.begin() + std::ptrdiff_t(fixed), points.begin()));
  for (const auto& v : cells.cells.vertices) EXPECT_GT(shape(points, v), -1e-12);
  expect_neighbours_agree(cells);
}

/// Two cells on a wide common triangle, tips close to it on both sides: one material may turn them into three around
/// the line between the tips, two materials may not.
TEST(ImproveCells, FacetsBetweenMaterialsStay) {
  const std::vector<Vec3d> corners = {{2, 0, 0}, {-1, 1.7, 0}, {-1, -1.7, 0}, {0, 0, 0.3}, {0, 0, -0.3}};
  for (const bool same : {true, false}) {
    std::vector<Vec3d> points = corners;
    MaterialCells cells;
    cells.cells.vertices = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    cells.cells.neighbours = {{-1, -1, -1, 1}, {-1, -1, -1, 0}};
    cells.material = {1, std::uint16_t(same ? 1 : 2)};
    const double before = volume(points, cells);
    const CellImprovement result = improve_cells(points, points.size(), cells);
    EXPECT_EQ(result.flips, same);
    EXPECT_EQ(cells.material.size(), same ? 3u : 2u);
    EXPECT_NEAR(volume(points, cells), before, 1e-12);
    expect_neighbours_agree(cells);
  }
}

TEST(ImproveCells, NothingToDoAndStop) {
  std::vector<Vec3d> none;
  MaterialCells empty;
  EXPECT_EQ(improve_cells(none, 0, empty).bad_before, 0);
  std::vector<Vec3d> points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.5, 1e-3}};
  MaterialCells cells = all_of_one_material(points);
  const std::atomic<bool> stop = true;
  EXPECT_THROW(improve_cells(points, 4, cells, &stop), Interrupted);
  EXPECT_EQ(improve_cells(points, 4, cells).bad_after, 1);  // nothing can be done, and nothing is
  EXPECT_EQ(cells.material.size(), 1u);
}

}  // namespace
}  // namespace nacre
