// Nacre: meshes of bodies given as distances, with exact answers: topology, distances, shapes, energy.
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/volume/materials.hpp"
#include "tests/evidence/exact_bodies.hpp"

namespace nacre::test {
namespace {

/// A signed distance volume's mesh: right topology, and the surface where it should be, both ways (voxels, degrees).
MeshRun expect_exact(const char* what, const MeshVolume& volume, const std::vector<std::int64_t>& euler,
                     const std::vector<ExactInterface>& interfaces) {
  const MeshRun run = mesh_of(volume);
  expect_topology(run.mesh, euler);
  for (const ExactInterface& exact : interfaces) {
    const InterfaceError error = interface_error(run.mesh, exact);
    std::printf("%s, %d|%d: %zu facets, distance mean %.4f max %.4f, from exact %.4f, normals %.2f degrees\n", what,
                exact.lower, exact.higher, error.facets, error.to_exact_mean, error.to_exact_max, error.from_exact_max,
                error.normal_median);
    EXPECT_GT(error.facets, 0u);
    EXPECT_LE(error.to_exact_mean, 0.1);
    EXPECT_LE(error.hausdorff(), 0.1) << exact.lower << "|" << exact.higher;
    EXPECT_LE(error.normal_median, 5);
  }
  EXPECT_LE(run.distance.vertex_mean, 0.1);
  EXPECT_LE(run.distance.facet_mean, 0.1);
  print_quality(what, run);
  return run;
}

TEST(MeshEvidence, SphereGivenAsDistances) {
  const auto f = ball(middle, 12.3);
  const MeshRun run = expect_exact("sphere", scalar_volume(cube, f), {2, 2}, {{0, 1, f, on_sphere(middle, 12.3)}});
  EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.97);
}

TEST(MeshEvidence, EllipsoidGivenAsDistances) {
  const Vec3d semi(14, 10.5, 8);
  const auto f = ellipsoid(middle, semi);
  std::vector<Vec3d> points;
  for (const Vec3d& d : even_directions(1500)) points.push_back(middle + d * semi);
  ASSERT_NEAR(f(points[7]), 0, 1e-6);
  ASSERT_NEAR(f(middle + Vec3d(0, 0, 11)), -3, 1e-6);
  const MeshRun run = expect_exact("ellipsoid", scalar_volume(cube, f), {2, 2}, {{0, 1, f, points}});
  EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.97);
}

TEST(MeshEvidence, TorusGivenAsDistances) {
  const auto f = torus(middle, 9.6, 4.4);
  const MeshRun run = expect_exact("torus", scalar_volume(cube, f), {0, 0}, {{0, 1, f, on_torus(middle, 9.6, 4.4)}});
  EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.97);
}

TEST(MeshEvidence, NestedShellsGivenAsDistances) {
  const auto f = [](const Vec3d& p) { return -length(p - middle); };
  expect_exact("nested shells", scalar_volume(cube, f, {-12.4f, -9.1f, -6.2f}), {2, 4, 4, 2}, nested_shells());
}

TEST(MeshEvidence, TwoSpheresMeetInACircle) {
  const std::vector<Vec3d> centres{middle - Vec3d(5, 1, 2), middle + Vec3d(5, 1, 2)};
  const MeshRun run =
      expect_exact("two spheres", indicator_volume(cube, balls(centres, 9.7)), {2, 2, 2}, interfaces_of(centres, 9.7));
  expect_good_shapes(run);
  EXPECT_EQ(run.info.surfaces, 3);
  EXPECT_EQ(run.info.curves, 1);
  EXPECT_EQ(run.info.points, 0);
}

TEST(MeshEvidence, ThreeSpheresMeetInTwoPoints) {
  std::vector<Vec3d> centres;
  for (const double a : {0.3, 0.3 + 2 * M_PI / 3, 0.3 + 4 * M_PI / 3})
    centres.push_back(middle + Vec3d(std::cos(a), std::sin(a), 0.2 * std::sin(a)) * 6.0);
  const MeshRun run = expect_exact("three spheres", indicator_volume(cube, balls(centres, 9.2)), {2, 2, 2, 2},
                                   interfaces_of(centres, 9.2));
  expect_good_shapes(run);
  EXPECT_EQ(run.info.surfaces, 6);
  EXPECT_EQ(run.info.curves, 4);
  EXPECT_EQ(run.info.points, 2);
  EXPECT_EQ(run.info.crowded_points, 0);
}

TEST(MeshEvidence, TwoBodiesThatNearlyTouch) {  // 0.8 voxels apart
  const auto a = ball(middle - Vec3d(7.2, 1, 0), 6.87), b = ball(middle + Vec3d(7.2, 1, 0), 6.87);
  ASSERT_NEAR(2 * length(Vec3d(7.2, 1, 0)) - 2 * 6.87, 0.8, 0.01);
  const auto either = [=](const Vec3d& p) { return std::max(a(p), b(p)); };
  std::vector<Vec3d> points = on_sphere(middle - Vec3d(7.2, 1, 0), 6.87);
  for (const Vec3d& p : on_sphere(middle + Vec3d(7.2, 1, 0), 6.87)) points.push_back(p);
  expect_exact("near bodies of one material", scalar_volume(cube, either), {4, 4}, {{0, 1, either, points}});
  const MeshRun two = mesh_of(label_volume(cube, 3, [=](const Vec3d& p) { return a(p) > 0 ? 1 : b(p) > 0 ? 2 : 0; }));
  const TopologyReport report = check_topology(two.mesh, 3);
  EXPECT_TRUE(report.sound());
  EXPECT_EQ(report.materials[1].euler, 2);
  EXPECT_EQ(report.materials[2].euler, 2);
  print_quality("near bodies of two materials", two);
}

TEST(MeshEvidence, ShellOneVoxelThinGivenAsDistances) {
  const auto f = [](const Vec3d& p) { return 0.5 - std::fabs(length(p - middle) - 10.2); };
  std::vector<Vec3d> points = on_sphere(middle, 9.7);
  for (const Vec3d& p : on_sphere(middle, 10.7)) points.push_back(p);
  const MeshRun run = expect_exact("thin shell, distances", scalar_volume(cube, f), {4, 4}, {{0, 1, f, points}});
  const double volume = 4 * M_PI / 3 * (std::pow(10.7, 3) - std::pow(9.7, 3));
  EXPECT_NEAR(check_topology(run.mesh, 2).materials[1].volume, volume, 0.01 * volume);
}

/// One smooth closed surface at uniform size.
MeshRun uniform(const PlaceFunction& f, const std::string& solver, int iterations, bool smoothed) {
  MeshParameters parameters;
  if (!smoothed) parameters.smooth = parameters.remesh = 0;
  parameters.solver = solver;
  parameters.min_size = parameters.max_size = 1;
  parameters.iterations = iterations;
  parameters.stagnation = 0;  // what can be reached within these iterations, not what is worth it
  const MeshRun run = mesh_of(scalar_volume(cube, f), parameters);
  EXPECT_LE(run.info.iterations - run.info.coarse_iterations, iterations);
  print_quality(solver.c_str(), run);
  return run;
}

TEST(MeshEvidence, UniformSizeOnASmoothSurface) {  // 88 iterations and twice six steps of smoothing: a hundred moves
  for (const PlaceFunction& f : {ball(middle, 13.2), torus(middle, 9.6, 4.4)}) {
    const TriangleQuality q = surface_quality(uniform(f, "tree", 88, true).mesh).all;
    EXPECT_GE(q.radius_ratio_mean, 0.98);
    EXPECT_GE(q.radius_ratio_min, 0.6);
    EXPECT_LE(q.share_under_25, 0.001);
  }
}

TEST(MeshEvidence, EverySolverByItself) {  // nothing smoothed or remeshed
  for (const char* solver : {"redblack", "serial", "tree"}) {
    const MeshRun run = uniform(torus(middle, 9.6, 4.4), solver, 60, false);
    expect_topology(run.mesh, {0, 0});
    EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.93) << solver;
  }
}

TEST(MeshEvidence, EnergyFallsAndCountsConverge) {
  const MeshRun run = mesh_of(scalar_volume(cube, torus(middle, 9.6, 4.4)));
  const auto& energy = run.info.energy;
  const auto& count = run.info.count;
  ASSERT_GT(energy.size(), 20u);
  EXPECT_LT(energy.back(), 0.75 * energy.front());
  EXPECT_NEAR(double(count.back()), run.info.expected_particles, 0.1 * run.info.expected_particles);
  const std::size_t half = count.size() / 2;
  const auto [least, most] = std::minmax_element(count.begin() + std::ptrdiff_t(half), count.end());
  EXPECT_LE(double(*most - *least), 0.01 * double(count.back()));
  for (std::size_t k = half + 1; k < energy.size(); ++k) EXPECT_LE(energy[k], energy[k - 1] * 1.01) << k;
}

/// From iteration to iteration, but where control has just changed the particles, be it that as many came as went; a
/// rise of `overshoot` of it is borne, of all iterations between two changes of their number together none is.
void expect_falling(const std::vector<double>& energy, const std::vector<std::int64_t>& count, double overshoot) {
  ASSERT_EQ(energy.size(), count.size());
  std::size_t controlled = 0;
  for (std::size_t k = 1; k < energy.size(); ++k) {
    if (count[k] != count[k - 1]) {
      controlled = k;
      continue;
    }
    if (k % std::size_t(MeshParameters().control_every) != 0) {
      EXPECT_LE(energy[k], energy[k - 1] * (1 + overshoot)) << k;
    }
    if (k + 1 == energy.size() || count[k + 1] != count[k]) {
      EXPECT_LT(energy[k], energy[controlled]) << controlled << " to " << k;
    }
  }
}

TEST(MeshEvidence, EnergyFallsAmongJunctionsForEverySolver) {
  for (const auto& [solver, overshoot] : {std::pair{"serial", 0.001}, {"redblack", 0.001}, {"tree", 0.01}}) {
    SCOPED_TRACE(solver);
    MeshParameters parameters;
    parameters.solver = solver;
    const MeshRun run = mesh_of(three_balls(), parameters);
    EXPECT_EQ(run.info.surfaces, 6);
    EXPECT_EQ(run.info.curves, 4);
    EXPECT_EQ(run.info.points, 2);
    expect_topology(run.mesh, {2, 2, 2, 2});
    EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.93);
    const auto& energy = run.info.energy;
    ASSERT_GT(energy.size(), 20u);
    EXPECT_LT(energy.back(), 0.75 * energy.front());
    expect_falling(energy, run.info.count, overshoot);  // the tree's heavy ball goes a little too far
    print_quality(solver, run);
  }
}

/// At its own size the heart ends with about as many particles as the source's scan.
TEST(MeshEvidence, TheHeartEndsNearItsCount) {
  MaterialOptions options;
  options.isovalues = {phantom_isovalue};
  const MeshRun run = mesh_of(make_mesh_volume(std::vector{make_phantom("heart")}, options));
  EXPECT_NEAR(double(run.mesh.points.size()), 80000, 0.05 * 80000);
  expect_good_shapes(run, 0.97);
}

}  // namespace
}  // namespace nacre::test
