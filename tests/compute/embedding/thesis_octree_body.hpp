// Nacre: test bodies for the thesis octree.
#pragma once

#include <algorithm>
#include <string>

#include "compute/embedding/build_thesis_octree.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/reference.hpp"

namespace nacre::test::thesis_octree_bodies {

/// A source octree on the host; `view` points into the copies.
struct HostThesisOctree {
  std::vector<std::uint64_t> code;
  std::vector<CellPoint> point;
  std::vector<std::uint32_t> touched, neighbour;
  std::vector<ThesisNode> node;
  ThesisOctreeView view;

  explicit HostThesisOctree(const ThesisOctree& tree)
      : code(tree.code.download()),
        point(tree.point.download()),
        touched(tree.touched.download()),
        neighbour(tree.neighbour.download()),
        node(tree.node.download()),
        view(tree.view()) {
    view.code = code.data();
    view.point = point.data();
    view.touched = touched.data();
    view.node = node.data();
    view.neighbour = neighbour.empty() ? nullptr : neighbour.data();
  }
  HostThesisOctree(const HostThesisOctree&) = delete;

  Vec3d closest(CellIndex c) const {
    const Int3 position = morton_cell(code[c]);
    return Vec3d(position) + Vec3d(0.5) + Vec3d(point[c].offset(view.quantum));
  }
};

inline constexpr double source_radius = 5;

template <class Backend>
ThesisOctree thesis_octree_of(Executor<Backend>& exec, const Mesh& mesh, int levels, bool neighbour_index = false,
                              double radius = source_radius, const ThesisSubgrids& subgrids = {}) {
  return build_thesis_octree(exec, upload(exec, mesh), std::uint32_t(mesh.triangles.size()), levels, radius,
                             neighbour_index, subgrids);
}

/// What is wrong with a tree, against brute force.
struct ThesisFaults {
  std::size_t stored = 0;  ///< cells looked at that are stored, and must be
  std::size_t missing = 0, extra = 0;
  std::size_t wrong_point = 0;     ///< off by more than 1e-5 of a cell, in place or distance
  std::size_t wrong_triangle = 0;  ///< the point does not lie on the triangle that is named
  std::size_t wrong_touch = 0;
};

inline void check_cell(const HostThesisOctree& tree, const BruteForce& brute, const Int3& position,
                       ThesisFaults& faults) {
  ThesisOctreeView::Cursor cursor(tree.view);
  const CellIndex c = cursor.find(position);
  const Vec3d x = Vec3d(position) + Vec3d(0.5);
  const std::uint32_t hint = c == no_cell ? none : tree.point[c].triangle;
  const BruteForce::Nearest nearest = brute(x, double(tree.view.radius) + 1e-9, hint);
  if (c == no_cell) {
    faults.missing += nearest.distance < double(tree.view.radius) - 1e-9;
    return;
  }
  if (nearest.triangle == none || hint >= brute.size()) {
    ++faults.extra;
    return;
  }
  ++faults.stored;
  const Vec3d p = tree.closest(c);
  faults.wrong_point +=
      std::fabs(length(p - x) - nearest.distance) > 1e-5 || (nearest.unique && length(p - nearest.point) > 1e-5);
  faults.wrong_triangle += length(reference_closest_point(brute.corners(hint), p) - p) > 1e-5;
  bool touched = false;
  for (std::uint32_t t = 0; t < brute.size() && !touched; ++t)
    touched = nearest.distance < 0.87 && touches_cube(brute.corners(t), x, 0.5 + 1e-7);
  faults.wrong_touch += touched != tree.view.touches(c);
}

/// Looks at every `stride`-th cell of the domain.
template <class Backend>
void expect_thesis_octree(Executor<Backend>& exec, const Mesh& mesh, int levels, const std::string& what,
                          int stride = 1) {
  const std::size_t mark = exec.arena().mark();
  const HostThesisOctree tree(thesis_octree_of(exec, mesh, levels));
  const BruteForce brute(mesh.points, mesh.triangles);
  ThesisFaults faults;
  const int n = tree.view.size();
  for (std::int64_t k = 0; k < std::int64_t(n) * n * n; k += stride)
    check_cell(tree, brute, {int(k % n), int(k / n % n), int(k / n / n)}, faults);
  EXPECT_GT(faults.stored, 0u) << what;
  EXPECT_EQ(faults.missing, 0u) << what;
  EXPECT_EQ(faults.extra, 0u) << what;
  EXPECT_EQ(faults.wrong_point, 0u) << what;
  EXPECT_EQ(faults.wrong_triangle, 0u) << what;
  EXPECT_EQ(faults.wrong_touch, 0u) << what;
  exec.arena().rewind(mark);
}

inline std::vector<std::uint32_t> children(const std::vector<ThesisNode>& nodes) {
  std::vector<std::uint32_t> all;
  for (const ThesisNode& n : nodes) all.insert(all.end(), n.child, n.child + 8);
  return all;
}

/// Everything that a tree holds is the same.
inline void expect_same(const HostThesisOctree& a, const HostThesisOctree& b, const std::string& what) {
  EXPECT_EQ(a.code, b.code) << what;
  EXPECT_EQ(a.touched, b.touched) << what;
  EXPECT_EQ(a.neighbour, b.neighbour) << what;
  EXPECT_EQ(children(a.node), children(b.node)) << what;
  const auto same = [](const CellPoint& p, const CellPoint& q) {
    return p.low == q.low && p.high == q.high && p.triangle == q.triangle;
  };
  EXPECT_TRUE(std::equal(a.point.begin(), a.point.end(), b.point.begin(), b.point.end(), same)) << what;
}

// Other structures have bodies of the same names: in one namespace the linker would run one of them for all.

template <class Backend>
void RoundAndSquare(Executor<Backend>& exec) {
  expect_thesis_octree(exec, sphere({15.3, 15.1, 14.8}, 8, 12), 2, "sphere");
  expect_thesis_octree(exec, torus({15.3, 15.1, 14.8}, 7, 2.5, 10), 2, "torus");
  expect_thesis_octree(exec, box({7, 7, 7}, {20, 18, 16}, 1), 2, "cube on cell faces");
}

template <class Backend>
void OneTriangleAndOnePoint(Executor<Backend>& exec) {
  Mesh one;
  one.add(Corners{{6.5, 6.5, 6.5}, {9.5, 6.5, 6.5}, {6.5, 9.5, 6.5}});
  expect_thesis_octree(exec, one, 1, "one triangle");
  Mesh point;
  point.add(Corners{{3, 3, 3}, {3, 3, 3}, {3, 3, 3}});
  expect_thesis_octree(exec, point, 0, "a point in the smallest domain");
}

template <class Backend>
void FoldedSheets(Executor<Backend>& exec) {
  Mesh folded = sheet({7, 7, 12.1}, {12, 0, 0}, {0, 12, 0}, 8);
  folded.add(sheet({19, 7, 12.1}, {-12, 0, 0.4}, {0, 12, 0}, 8));
  folded.add(sheet({7, 7, 12.5}, {12, 0, 0.3}, {0, 12, 0.3}, 1));
  expect_thesis_octree(exec, folded, 2, "folded");
}

template <class Backend>
void Soups(Executor<Backend>& exec) {
  expect_thesis_octree(exec, soup(40, 6, 26, 9, 21), 2, "large triangles");
  expect_thesis_octree(exec, soup(10'000, 6, 58, 2, 22), 3, "10^4 triangles", 61);
  expect_thesis_octree(exec, soup(60, -20, 50, 20, 23), 2, "beyond the domain");
}

template <class Backend>
void Slivers(Executor<Backend>& exec) {
  Random random(25);
  Mesh mesh;
  for (int k = 0; k < 40; ++k) {
    const Vec3d a = random.point(6, 26), b = random.point(6, 26);
    const double thin = k % 4 == 0 ? 0 : k % 4 == 1 ? 1e-12 : k % 4 == 2 ? 1e-8 : 1e-5;
    mesh.add(Corners{a, b, a + (b - a) * random() + random.point(-1, 1) * thin});
  }
  expect_thesis_octree(exec, mesh, 2, "slivers");
}

/// What a body sees of one cell: written by cell, so that a cell that is visited twice or not at all shows.
struct Visits {
  std::uint32_t* visits;
  std::uint32_t* wrong;
  const std::uint64_t* code;
  template <class Cursor>
  NACRE_HD void operator()(CellIndex cell, const Int3& position, Cursor& cursor) const {
    atomic_add(visits + cell, 1u);
    CellIndex at[8];
    const unsigned there = cursor.eight(position, at);
    const bool right = code[cell] == morton(position) && cursor.find(position) == cell && (there & 1) && at[0] == cell;
    if (!right) atomic_add(wrong, 1u);
  }
  template <class Cursor>
  NACRE_HD void operator()(CellIndex surface_cell, CellIndex cell, const Int3& position, Cursor& cursor) const {
    if (surface_cell != cell || cursor.find_surface(position) != cell) atomic_add(wrong, 1u);
    (*this)(cell, position, cursor);
  }
};

template <class Backend>
void EveryCellIsVisitedOnce(Executor<Backend>& exec) {
  Arena& arena = exec.arena();
  for (const bool index : {false, true}) {
    const ThesisOctree tree = thesis_octree_of(exec, sphere({15.3, 15.1, 14.8}, 8, 12), 2, index);
    for (const bool surface : {false, true}) {
      Arena::Scope scope(arena);
      Array<std::uint32_t> visits = arena.template temporary<std::uint32_t>(tree.cells + 1);
      visits.fill_bytes(0);
      const Visits body{visits.data(), visits.data() + tree.cells, tree.code.data()};
      if (surface)
        for_each_surface_cell(exec, tree.view(), body);
      else
        for_each_cell(exec, tree.view(), body);
      const std::vector<std::uint32_t> seen = visits.download();
      EXPECT_EQ(std::size_t(std::count(seen.begin(), seen.end() - 1, 1u)), tree.cells);
      EXPECT_EQ(seen.back(), 0u);
    }
    arena.rewind(0);
  }
}

template <class Backend>
void SubgridsDoNotShow(Executor<Backend>& exec) {
  Mesh mesh = torus({15.3, 14.1, 16.8}, 8, 3, 10);
  mesh.add(soup(20, 2, 30, 6, 41));
  const double radius = 2.5;
  const HostThesisOctree whole(thesis_octree_of(exec, mesh, 2, true, radius, {32, 0}));
  for (const int edge : {8, 16})
    expect_same(whole, HostThesisOctree(thesis_octree_of(exec, mesh, 2, true, radius, {edge, 0})),
                "edge " + std::to_string(edge));
  expect_same(whole, HostThesisOctree(thesis_octree_of(exec, mesh, 2, true, radius, {32, 900})), "lists that are cut");
  exec.arena().rewind(0);
}

NACRE_DEVICE_TEST(ThesisOctree, RoundAndSquare)
NACRE_DEVICE_TEST(ThesisOctree, OneTriangleAndOnePoint)
NACRE_DEVICE_TEST(ThesisOctree, FoldedSheets)
NACRE_DEVICE_TEST(ThesisOctree, Soups)
NACRE_DEVICE_TEST(ThesisOctree, Slivers)
NACRE_DEVICE_TEST(ThesisOctree, EveryCellIsVisitedOnce)
NACRE_DEVICE_TEST(ThesisOctree, SubgridsDoNotShow)

}  // namespace nacre::test::thesis_octree_bodies
