// Nacre: test bodies for particles that are thinned and made again from those that are left.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/compute/particles/solver_cases.hpp"
#include "tests/compute/particles/tree_solver_run.hpp"

namespace nacre::test {

/// Each point so many times: of those at one point, thinning keeps one.
inline std::vector<Vec3f> repeated(const std::vector<Vec3f>& points, int times) {
  std::vector<Vec3f> all;
  for (const Vec3f& p : points) all.insert(all.end(), std::size_t(times), p);
  return all;
}

/// Rows of a hexagonal lattice with this spacing, as a parallelogram.
inline std::vector<Vec3f> hexagonal_lattice(int columns, int rows, float spacing) {
  std::vector<Vec3f> points;
  for (int k = 0; k < rows; ++k)
    for (int l = 0; l < columns; ++l)
      points.push_back({2 + spacing * (float(l) + 0.5f * float(k)), 2 + spacing * 0.8660254f * float(k), 0});
  return points;
}

inline std::vector<float> sizes_of(const std::vector<Float4>& positions) {
  std::vector<float> sizes;
  for (const Float4& p : positions) sizes.push_back(p.w);
  return sizes;
}

/// A lattice at twice the spacing becomes one at the spacing, with all of its points and the middles of its edges.
template <class Backend>
void AHexagonalLatticeIsRefinedToOne(Executor<Backend>& exec) {
  const AnalyticProjector<Plane> projector{{1}};
  const int columns = 25, rows = 20, n = columns * rows;
  const int edges = (columns - 1) * rows + columns * (rows - 1) + (columns - 1) * (rows - 1);
  TreeSolverRun<Backend> run = one_surface(exec, 4 * n);
  run.seed(projector, repeated(hexagonal_lattice(columns, rows, 2), 4), std::vector<std::uint32_t>(4 * n, 0));
  run.solver.velocity().upload(std::vector<Float4>(4 * n, Float4{1, 1, 1, 1}));
  run.solver.reset_spacing(exec);
  run.solver.rebuild(exec);
  EXPECT_EQ(run.solver.thin(exec, run.view, 2), 3 * n);
  EXPECT_EQ(sizes_of(run.positions()), std::vector<float>(std::size_t(n), 2));
  for (const double d : spacings(run.positions())) EXPECT_NEAR(d, 1, 1e-5) << "in units of its size";
  for (const Float4& v : run.velocities()) EXPECT_EQ(length(xyz_of(v)), 0) << "at rest";

  run.solver.rebuild(exec);
  run.solver.refine(exec, run.view, projector);
  EXPECT_EQ(run.count(), std::size_t(n + edges));
  EXPECT_EQ(sizes_of(run.positions()), std::vector<float>(std::size_t(n + edges), 1));
  for (const double d : spacings(run.positions())) EXPECT_NEAR(d, 1, 1e-5);
  for (const Float4& d : run.directions()) EXPECT_EQ(d.z, 1);
  EXPECT_EQ(run.interfaces(), std::vector<std::uint32_t>(std::size_t(n + edges), 0));
  for (const Float4& v : run.velocities()) EXPECT_EQ(length(xyz_of(v)), 0);
  run.solver.rebuild(exec);
  run.solver.refine(exec, run.view, projector);
  EXPECT_EQ(run.count(), std::size_t(n + edges)) << "once is enough";
}

/// The rim of a disc and the disc: the rim's particles are halved, and its links again.
template <class Backend>
void ARimIsRefinedAlongItself(Executor<Backend>& exec) {
  const AnalyticProjector<Disc> projector{{12, 1}};
  const int on_rim = 38;
  std::vector<Vec3f> rim;
  for (int k = 0; k < on_rim; ++k) {
    const float a = 2 * pi * float(k) / on_rim;
    rim.push_back({12 * std::cos(a), 12 * std::sin(a), 0});
  }
  std::vector<Vec3f> points = repeated(rim, 2);
  std::vector<std::uint32_t> interface(points.size(), 1);
  points.push_back({0, 0, 0}), interface.push_back(0);
  TreeSolverRun<Backend> run(exec, 200, {2, 1}, {{0, 1}, {1}});
  run.seed(projector, points, interface);
  run.solver.reset_spacing(exec);
  run.solver.rebuild(exec);
  EXPECT_EQ(run.solver.thin(exec, run.view, 1), on_rim);
  run.solver.rebuild(exec);
  EXPECT_EQ(run.solver.thin(exec, run.view, 2), 0) << "one particle is too few";
  run.solver.rebuild(exec);
  run.solver.refine(exec, run.view, projector);
  ASSERT_EQ(run.count(), std::size_t(2 * on_rim + 1));
  std::vector<double> angles;
  const std::vector<Float4> position = run.positions();
  for (std::size_t k = 0; k < position.size(); ++k) {
    EXPECT_EQ(position[k].w, 1);
    if (run.interfaces()[k] == 0) continue;
    EXPECT_NEAR(length(xyz_of(position[k])), 12, 1e-5);
    angles.push_back(std::atan2(position[k].y, position[k].x));
  }
  std::sort(angles.begin(), angles.end());
  for (std::size_t k = 1; k < angles.size(); ++k) EXPECT_NEAR(angles[k] - angles[k - 1], M_PI / on_rim, 1e-5);
}

/// A surface with few particles keeps them, beside one with many.
template <class Backend>
void SmallInterfacesKeepTheirParticles(Executor<Backend>& exec) {
  const AnalyticProjector<Plane> projector{{1}};
  const int few = int(fewest_on_thinned_surface) - 1, many = int(fewest_on_thinned_surface);
  std::vector<Vec3f> points = hexagonal_lattice(few, 1, 0.02f);
  std::vector<std::uint32_t> interface(points.size(), 1);
  for (const Vec3f& p : repeated(hexagonal_lattice(25, 20, 2), 4)) points.push_back(p), interface.push_back(0);
  ASSERT_EQ(int(points.size()), few + many);
  TreeSolverRun<Backend> run(exec, few + 2 * many, {2, 2}, {{0}, {1}});
  run.seed(projector, points, interface);
  run.solver.reset_spacing(exec);
  run.solver.rebuild(exec);
  EXPECT_EQ(run.solver.thin(exec, run.view, 2), many * 3 / 4);
  const auto of_the_small = [&] {
    std::vector<float> x;
    const std::vector<Float4> position = run.positions();
    const std::vector<std::uint32_t> of = run.interfaces();
    for (std::size_t k = 0; k < position.size(); ++k) {
      if (of[k] != 1) continue;
      EXPECT_EQ(position[k].w, 1);
      x.push_back(position[k].x);
    }
    std::sort(x.begin(), x.end());
    return x;
  };
  const std::vector<float> before = of_the_small();
  EXPECT_EQ(int(before.size()), few);
  run.solver.rebuild(exec);
  run.solver.refine(exec, run.view, projector);
  EXPECT_EQ(of_the_small(), before);
  EXPECT_EQ(int(run.count()), few + many / 4 + 24 * 20 + 25 * 19 + 24 * 19);
}

/// Sheets back to back, nearer than the links are long: none leads across.
template <class Backend>
void NoLinkLeadsThroughASheet(Executor<Backend>& exec) {
  const AnalyticProjector<Plane> projector{{1}};
  const int n = 500;
  const std::vector<Vec3f> sheet = repeated(hexagonal_lattice(25, 20, 2), 4);
  TreeSolverRun<Backend> run = one_surface(exec, 5 * n);
  run.seed(projector, sheet, std::vector<std::uint32_t>(sheet.size(), 0));
  std::vector<Float4> position = run.positions(), direction = run.directions();
  for (std::size_t k = 0; k < position.size(); ++k)
    if (position[k].y > 20) position[k].z = 0.5f, position[k].y -= 20, direction[k].z = -1;
  run.put(position, direction, std::vector<std::uint32_t>(sheet.size(), 0));
  run.solver.reset_spacing(exec);
  run.solver.rebuild(exec);
  run.solver.thin(exec, run.view, 2);
  run.solver.rebuild(exec);
  EXPECT_EQ(run.count(), std::size_t(n));
  run.solver.refine(exec, run.view, projector);
  const int of_eleven_rows = 24 * 11 + 25 * 10 + 24 * 10, of_nine_rows = 24 * 9 + 25 * 8 + 24 * 8;
  EXPECT_EQ(run.count(), std::size_t(n + of_eleven_rows + of_nine_rows));
}

NACRE_DEVICE_TEST(Refinement, AHexagonalLatticeIsRefinedToOne)
NACRE_DEVICE_TEST(Refinement, ARimIsRefinedAlongItself)
NACRE_DEVICE_TEST(Refinement, SmallInterfacesKeepTheirParticles)
NACRE_DEVICE_TEST(Refinement, NoLinkLeadsThroughASheet)

}  // namespace nacre::test
