// Nacre: tests of the repair of labels.
#include "compute/meshing/repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "compute/meshing/interfaces.hpp"
#include "compute/meshing/topology.hpp"
#include "tests/compute/meshing/labelled_points.hpp"

namespace nacre {
namespace {

/// A grid of points, a little irregular, so that no five lie on a sphere.
std::vector<Vec3d> grid_points(int n) {
  std::vector<Vec3d> points;
  std::uint64_t state = 1;
  const auto jitter = [&] {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return 0.3 * (double(state >> 11) * 0x1p-53 - 0.5);
  };
  for (int i = 0; i < n * n * n; ++i) {
    const double x = i % n + jitter(), y = i / n % n + jitter(), z = i / n / n + jitter();
    points.push_back({x, y, z});
  }
  return points;
}

std::set<std::uint16_t> kinds(const std::vector<std::uint16_t>& label) { return {label.begin(), label.end()}; }

TEST(Repair, LeavesSoundLabelsAlone) {
  const std::vector<Vec3d> points = test::points_on_double_bubble(0.5, 0.08);
  const DelaunayCells cells = delaunay(points);
  auto label = test::labels_of(cells, [](const Vec3d& p) { return test::double_bubble_material(0.5, p); });
  const auto before = label;
  const LabelRepair repair = repair_labels(points, cells, label);
  EXPECT_EQ(repair.changed, 0);
  EXPECT_EQ(repair.left, 0);
  EXPECT_EQ(label, before);
}

/// Cells labelled at random make a foam that touches itself nearly everywhere.
TEST(Repair, RandomLabelsBecomeManifold) {
  for (const int materials : {2, 3, 5}) {
    const std::vector<Vec3d> points = grid_points(6);
    const DelaunayCells cells = delaunay(points);
    std::vector<std::uint16_t> label(cells.vertices.size());
    std::uint32_t state = 7;
    for (std::uint16_t& m : label) m = std::uint16_t(((state = state * 1664525u + 1013904223u) >> 16) % materials);
    const TopologyReport before = check_topology(extract_interfaces(points, cells, label), materials);
    ASSERT_FALSE(before.sound());
    const auto kinds_before = kinds(label);
    auto again = label;
    const LabelRepair repair = repair_labels(points, cells, label);
    repair_labels(points, cells, again);
    EXPECT_EQ(label, again);
    EXPECT_EQ(kinds(label), kinds_before);
    EXPECT_GT(repair.changed, 0);
    const TopologyReport after = check_topology(extract_interfaces(points, cells, label), materials);
    const auto defects = [](const TopologyReport& r) {
      return r.nonmanifold_edges + r.pinched_edges + r.nonmanifold_vertices + r.pinched_vertices;
    };
    EXPECT_EQ(repair.left, 0);
    EXPECT_EQ(defects(after), 0) << materials << " materials, before: " << defects(before);
    for (const MaterialTopology& m : after.materials) EXPECT_TRUE(m.closed);
  }
}

/// Two balls whose surfaces are sampled too coarsely to keep them apart.
TEST(Repair, BodiesThatNearlyTouchComeApartOrTogether) {
  for (const double gap : {0.0, 0.01, 0.03, 0.1, 0.2}) {
    std::vector<Vec3d> points = test::points_on_sphere(300, 1, {-1 - gap / 2, 0, 0});
    for (const Vec3d& p : test::points_on_sphere(310, 1, {1 + gap / 2, 0.1, 0})) points.push_back(p);
    const DelaunayCells cells = delaunay(points);
    auto label = test::labels_of(cells, [&](const Vec3d& p) {
      return length(p - Vec3d(-1 - gap / 2, 0, 0)) < 1 || length(p - Vec3d(1 + gap / 2, 0.1, 0)) < 1;
    });
    const LabelRepair repair = repair_labels(points, cells, label);
    EXPECT_EQ(repair.left, 0) << gap;
    const TopologyReport report = check_topology(extract_interfaces(points, cells, label), 2);
    EXPECT_TRUE(report.sound()) << gap;
    EXPECT_EQ(report.materials[1].euler, 2 * report.materials[1].components) << gap;
    EXPECT_NEAR(report.materials[1].volume, 8.2, 0.3) << gap;
  }
}

TEST(Repair, LastCellOfABodyStays) {
  const std::vector<Vec3d> points = grid_points(6);
  const DelaunayCells cells = delaunay(points);
  std::vector<std::uint16_t> label(cells.vertices.size(), 1);
  // Two cells that share an edge and no facet, around an inner edge: one material touches itself, neither may go.
  std::size_t first = label.size() / 2, second = 0;
  for (std::size_t i = 0; i < cells.vertices.size() && second == 0; ++i) {
    int common = 0;
    for (const std::uint32_t v : cells.vertices[i])
      common += std::count(cells.vertices[first].begin(), cells.vertices[first].end(), v) == 1;
    if (common == 2) second = i;
  }
  ASSERT_NE(second, 0u);
  label[first] = label[second] = 2;
  repair_labels(points, cells, label);
  EXPECT_EQ(label[first], 2);
  EXPECT_EQ(label[second], 2);
  const TopologyReport report = check_topology(extract_interfaces(points, cells, label), 3);
  EXPECT_EQ(report.nonmanifold_edges + report.pinched_edges, 0);  // a bridge was built instead
}

/// Two cells of a large star that share its vertex alone, all else labelled 1.
struct TouchingCells {
  std::vector<Vec3d> points = grid_points(6);
  DelaunayCells cells = delaunay(points);
  std::vector<std::uint16_t> label = std::vector<std::uint16_t>(cells.vertices.size(), 1);
  std::vector<char> on_hull = std::vector<char>(points.size());
  std::size_t first = 0, second = 0;

  std::size_t common(std::size_t i, std::size_t j) const {
    const auto &s = cells.vertices[i], &t = cells.vertices[j];
    return std::size_t(
        std::count_if(s.begin(), s.end(), [&](auto v) { return std::count(t.begin(), t.end(), v) > 0; }));
  }
  /// No corner of it is on the hull.
  bool inner(std::size_t i) const {
    const auto& v = cells.vertices[i];
    return std::none_of(v.begin(), v.end(), [&](std::uint32_t p) { return on_hull[p]; });
  }
  TouchingCells() {
    std::vector<int> star(points.size());
    for (std::size_t i = 0; i < cells.vertices.size(); ++i)
      for (std::size_t k = 0; k < 4; ++k)
        if (cells.neighbours[i][k] < 0)
          for (std::size_t j = 1; j < 4; ++j) on_hull[cells.vertices[i][(k + j) % 4]] = 1;
    for (std::size_t i = 0; i < cells.vertices.size(); ++i)
      for (const std::uint32_t v : cells.vertices[i]) star[v] += inner(i);
    const auto centre = std::uint32_t(std::max_element(star.begin(), star.end()) - star.begin());
    EXPECT_GT(star[centre], 20) << "too many for one change to fill the gap";
    std::vector<std::size_t> around;
    for (std::size_t i = 0; i < cells.vertices.size(); ++i)
      if (inner(i) && std::count(cells.vertices[i].begin(), cells.vertices[i].end(), centre) == 1) around.push_back(i);
    for (const std::size_t i : around)
      for (const std::size_t j : around)
        if (common(i, j) == 1) first = i, second = j;
    EXPECT_NE(first, second);
  }
};

/// Bodies so small that nothing but crumbs of them is left: of two crumbs that touch, one does for both.
TEST(Repair, ACrumbThatTouchesItsOwnMaterialGoes) {
  TouchingCells c;
  c.label[c.first] = c.label[c.second] = 2;
  const LabelRepair repair = repair_labels(c.points, c.cells, c.label);
  EXPECT_EQ(repair.left, 0);
  EXPECT_TRUE(repair.defects.empty());
  EXPECT_EQ(repair.changed, 1);
  EXPECT_EQ(std::count(c.label.begin(), c.label.end(), 2), 1) << "the material is not lost";
  EXPECT_TRUE(check_topology(extract_interfaces(c.points, c.cells, c.label), 3).sound());
}

TEST(Repair, ACrumbOfSeveralCellsGoesAsAWhole) {
  TouchingCells c;
  const std::uint16_t body = 2;
  c.label[c.first] = body;
  // A neighbour of the second cell that does not touch the first one.
  c.label[c.second] = body;
  std::size_t added = 0;
  for (const std::int32_t n : c.cells.neighbours[c.second])
    if (added == 0 && c.inner(std::size_t(n)) && c.common(std::size_t(n), c.first) == 0) added = std::size_t(n);
  ASSERT_NE(added, 0u);
  c.label[added] = body;
  const LabelRepair repair = repair_labels(c.points, c.cells, c.label);
  EXPECT_EQ(repair.left, 0);
  EXPECT_GE(std::count(c.label.begin(), c.label.end(), body), 1);
  EXPECT_TRUE(check_topology(extract_interfaces(c.points, c.cells, c.label), 3).sound());
}

/// What is left says where.
TEST(Repair, TheLastOfAMaterialStaysAndIsNamed) {
  TouchingCells c;
  c.label[c.first] = 2;
  c.label[c.second] = 3;
  const LabelRepair repair = repair_labels(c.points, c.cells, c.label);
  EXPECT_EQ(repair.left, std::int64_t(repair.defects.size()));
  EXPECT_EQ(c.label[c.first], 2);
  EXPECT_EQ(c.label[c.second], 3);
}

TEST(Repair, FlatPocketsAreFilled) {
  // A square of four points in the plane between two halves: a flat cell whose circumcentre may be anywhere.
  std::vector<Vec3d> points = grid_points(6);
  points.push_back({2.2, 2.2, 2.5});
  points.push_back({2.8, 2.2, 2.5});
  points.push_back({2.8, 2.8, 2.5 + 1e-9});
  points.push_back({2.2, 2.8, 2.5});
  const DelaunayCells cells = delaunay(points);
  auto label = test::labels_of(cells, [](const Vec3d& p) { return p.z < 2.5 ? 1 : 2; });
  const auto is_pocket = [&](const std::array<std::uint32_t, 4>& v) {
    return *std::min_element(v.begin(), v.end()) >= 216;
  };
  const auto pocket = std::find_if(cells.vertices.begin(), cells.vertices.end(), is_pocket) - cells.vertices.begin();
  ASSERT_LT(std::size_t(pocket), label.size());
  label[std::size_t(pocket)] = 3;
  std::size_t inner = 0, at = 0;  // elsewhere there is some of it: the roundest inner cell
  for (double best = 1e9; at < label.size(); ++at) {
    const bool on_hull = std::count(cells.neighbours[at].begin(), cells.neighbours[at].end(), -1) > 0;
    const double radius = length(points[cells.vertices[at][0]] - cells.circumcentres[at]);
    if (!on_hull && at != std::size_t(pocket) && std::abs(radius - 0.9) < best) {
      best = std::abs(radius - 0.9);
      inner = at;
    }
  }
  label[inner] = 3;
  const LabelRepair repair = repair_labels(points, cells, label);
  EXPECT_EQ(repair.pockets, 1);
  EXPECT_NE(label[std::size_t(pocket)], 3);
  EXPECT_EQ(label[inner], 3);
}

}  // namespace
}  // namespace nacre
