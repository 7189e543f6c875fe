// Nacre: test bodies for the closest-point grid.
#pragma once

#include "tests/compute/embedding/check_closest_points.hpp"
#include "tests/compute/on_devices.hpp"

namespace nacre::test::closest_point_grid_bodies {

template <class Backend>
void expect_exact(Executor<Backend>& exec, const Mesh& mesh, int cells, int sub, const std::string& what) {
  const std::size_t mark = exec.arena().mark();
  const HostGrid grid(embed(exec, mesh, cells, sub));
  find_faults(grid, BruteForce(mesh.points, mesh.triangles)).expect_none(what + ", sub " + std::to_string(sub));
  exec.arena().rewind(mark);
}

// Other structures have bodies of the same names: in one namespace the linker would run one of them for all.

template <class Backend>
void RoundAndSquare(Executor<Backend>& exec) {
  expect_exact(exec, sphere({15.3, 15.1, 14.8}, 8, 12), 30, 4, "sphere");
  expect_exact(exec, torus({15.3, 15.1, 14.8}, 7, 2.5, 10), 30, 4, "torus");
  expect_exact(exec, box({7, 7, 7}, {20, 18, 16}, 1), 28, 4, "cube on cell faces");
  expect_exact(exec, box({7.4, 7.3, 7.2}, {16.1, 16.4, 16.2}, 6), 24, 4, "cube");
}

template <class Backend>
void EveryBrickSize(Executor<Backend>& exec) {
  for (const int sub : {3, 5, 6, 7, 8}) {
    expect_exact(exec, sphere({15.3, 15.1, 14.8}, 8, 8), 30, sub, "sphere");
    expect_exact(exec, soup(12, 6, 24, 5, 22), 30, sub, "soup");
  }
}

template <class Backend>
void RandomSoups(Executor<Backend>& exec) {
  expect_exact(exec, soup(40, 6, 24, 6, 21), 30, 4, "large triangles");
  expect_exact(exec, soup(600, 6, 20, 0.7, 22), 26, 4, "small triangles");
  Mesh mixed = soup(300, 6, 20, 0.3, 23);
  mixed.add(soup(10, 6, 20, 7, 24));
  expect_exact(exec, mixed, 26, 4, "both");
}

template <class Backend>
void FiftyCellsWide(Executor<Backend>& exec) {
  expect_exact(exec, sheet({6.2, 6.1, 7.3}, {50, 3, 4}, {-2, 50, 9}, 1), 64, 4, "plane");
  expect_exact(exec, sheet({6, 6, 8}, {50, 0, 0}, {0, 50, 0}, 1), 62, 4, "plane on cell faces");
}

template <class Backend>
void FoldedSheets(Executor<Backend>& exec) {
  Mesh folded = sheet({7, 7, 12.1}, {12, 0, 0}, {0, 12, 0}, 8);
  folded.add(sheet({19, 7, 12.1}, {-12, 0, 0.4}, {0, 12, 0}, 8));
  folded.add(sheet({7, 7, 12.5}, {12, 0, 0.3}, {0, 12, 0.3}, 1));
  expect_exact(exec, folded, 26, 4, "folded");
}

template <class Backend>
void TinyTriangles(Executor<Backend>& exec) {
  Mesh tiny = sphere({8.3, 8.1, 7.8}, 0.02, 24);  // edges of a few thousandths of a cell
  tiny.add(sheet({6.1, 6.2, 8.9}, {4, 0, 0}, {0, 4, 1}, 2));
  expect_exact(exec, tiny, 16, 4, "tiny");
}

template <class Backend>
void Slivers(Executor<Backend>& exec) {
  Random random(25);
  Mesh mesh;
  for (int k = 0; k < 40; ++k) {
    const Vec3d a = random.point(6, 20), b = random.point(6, 20);
    const double thin = k % 4 == 0 ? 0 : k % 4 == 1 ? 1e-12 : k % 4 == 2 ? 1e-8 : 1e-5;
    mesh.add(Corners{a, b, a + (b - a) * random() + random.point(-1, 1) * thin});
  }
  expect_exact(exec, mesh, 26, 4, "slivers");
}

template <class Backend>
void OneTriangleAndOnePoint(Executor<Backend>& exec) {
  Mesh one;
  one.add(Corners{{6.5, 6.5, 6.5}, {7.5, 6.5, 6.5}, {6.5, 7.5, 6.5}});
  expect_exact(exec, one, 14, 4, "one triangle");
  Mesh point;
  point.add(Corners{{7, 7, 7}, {7, 7, 7}, {7, 7, 7}});
  expect_exact(exec, point, 14, 4, "a point");
}

NACRE_DEVICE_TEST(ClosestPointGrid, RoundAndSquare)
NACRE_DEVICE_TEST(ClosestPointGrid, EveryBrickSize)
NACRE_DEVICE_TEST(ClosestPointGrid, RandomSoups)
NACRE_DEVICE_TEST(ClosestPointGrid, FiftyCellsWide)
NACRE_DEVICE_TEST(ClosestPointGrid, FoldedSheets)
NACRE_DEVICE_TEST(ClosestPointGrid, TinyTriangles)
NACRE_DEVICE_TEST(ClosestPointGrid, Slivers)
NACRE_DEVICE_TEST(ClosestPointGrid, OneTriangleAndOnePoint)

}  // namespace nacre::test::closest_point_grid_bodies
