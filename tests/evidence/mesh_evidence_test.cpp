// Nacre: meshes of bodies with exact answers: topology, distances, shapes, determinism.
#include "tests/evidence/mesh_measures.hpp"

namespace nacre::test {
namespace {

const Vec3d middle(17.3, 16.8, 17.1);  // on no voxel and no face of one
constexpr Int3 cube{35, 35, 35};

MeshRun mesh_of(const MeshVolume& volume, const MeshParameters& parameters = {}) {
  const auto device = make_cpu_device();
  return run_mesh(*device, volume, parameters);
}

/// A signed distance volume's mesh: right topology, and the surface within a tenth of a voxel both ways.
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
    EXPECT_LE(error.hausdorff(), 0.1) << exact.lower << "|" << exact.higher;
    EXPECT_LE(error.normal_median, 5);
  }
  EXPECT_LE(run.distance.vertex_mean, 0.1);
  EXPECT_LE(run.distance.facet_mean, 0.1);
  print_quality(what, run);
  return run;
}

std::vector<Vec3d> on_sphere(const Vec3d& centre, double radius, int count = 1500,
                             const std::function<bool(const Vec3d&)>& keep = {}) {
  std::vector<Vec3d> points;
  for (const Vec3d& d : even_directions(count))
    if (const Vec3d p = centre + d * radius; !keep || keep(p)) points.push_back(p);
  return points;
}

TEST(MeshEvidence, SphereGivenAsDistances) {
  const auto f = ball(middle, 12.3);
  const MeshRun run = expect_exact("sphere", scalar_volume(cube, f), {2, 2}, {{0, 1, f, on_sphere(middle, 12.3)}});
  EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.97);
}

/// Signed distance to an ellipsoid, positive inside: the foot on it lies at s_i^2 x_i / (s_i^2 + t) with the largest t that
/// puts it there.
PlaceFunction ellipsoid(const Vec3d& centre, const Vec3d& semi) {
  return [=](const Vec3d& p) {
    const Vec3d x = p - centre;
    const auto foot = [&](double t) {
      Vec3d q;
      for (int k = 0; k < 3; ++k) q[k] = semi[k] * semi[k] * x[k] / (semi[k] * semi[k] + t);
      return q;
    };
    const auto level = [&](const Vec3d& q) {
      return dot(q, Vec3d(q.x / (semi.x * semi.x), q.y / (semi.y * semi.y), q.z / (semi.z * semi.z)));
    };
    const double least = std::min({semi.x, semi.y, semi.z});
    double low = -least * least + 1e-9, high = 40 * 40;
    for (int k = 0; k < 80; ++k) {
      const double t = 0.5 * (low + high);
      (level(foot(t)) > 1 ? low : high) = t;
    }
    const double away = length(foot(0.5 * (low + high)) - x);
    return level(x) < 1 ? away : -away;
  };
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

PlaceFunction torus(const Vec3d& centre, double major, double minor) {
  return [=](const Vec3d& p) {
    const Vec3d r = p - centre;
    return minor - std::hypot(std::hypot(r.x, r.y) - major, r.z);
  };
}

std::vector<Vec3d> on_torus(const Vec3d& centre, double major, double minor) {
  std::vector<Vec3d> points;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 25; ++j) {
      const double u = i * M_PI / 30, v = j * 2 * M_PI / 25, r = major + minor * std::cos(v);
      points.push_back(centre + Vec3d(r * std::cos(u), r * std::sin(u), minor * std::sin(v)));
    }
  return points;
}

TEST(MeshEvidence, TorusGivenAsDistances) {
  const auto f = torus(middle, 9.6, 4.4);
  const MeshRun run = expect_exact("torus", scalar_volume(cube, f), {0, 0}, {{0, 1, f, on_torus(middle, 9.6, 4.4)}});
  EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.97);
}

/// Balls that keep their sides of the planes between them; the outside is where all functions are negative.
std::vector<PlaceFunction> balls(const std::vector<Vec3d>& centres, double radius) {
  std::vector<PlaceFunction> functions{[](const Vec3d&) { return 0.0; }};
  for (const Vec3d& c : centres) functions.push_back(ball(c, radius));
  return functions;
}

/// The interfaces of `balls`: pieces of spheres and of the planes between equal ones.
std::vector<ExactInterface> interfaces_of(const std::vector<Vec3d>& centres, double radius) {
  std::vector<ExactInterface> interfaces;
  const auto nearest = [=](const Vec3d& p, std::size_t k) {
    return std::all_of(centres.begin(), centres.end(),
                       [&](const Vec3d& c) { return length(p - centres[k]) <= length(p - c) + 1e-9; });
  };
  for (std::size_t k = 0; k < centres.size(); ++k) {
    const auto own = [=](const Vec3d& p) { return nearest(p, k); };
    interfaces.push_back({0, std::uint16_t(k + 1), ball(centres[k], radius), on_sphere(centres[k], radius, 1500, own)});
    for (std::size_t l = k + 1; l < centres.size(); ++l) {
      const Vec3d n = normalized(centres[l] - centres[k]), m = (centres[k] + centres[l]) / 2.0;
      const Vec3d s = normalized(cross(n, Vec3d(0.3, 0.2, 1))), t = cross(n, s);
      std::vector<Vec3d> points;
      for (int i = -20; i <= 20; ++i)
        for (int j = -20; j <= 20; ++j)
          if (const Vec3d p = m + s * (i * 0.05 * radius) + t * (j * 0.05 * radius);
              length(p - centres[k]) < radius && nearest(p, k) && nearest(p, l))
            points.push_back(p);
      interfaces.push_back(
          {std::uint16_t(k + 1), std::uint16_t(l + 1), [=](const Vec3d& p) { return dot(p - m, n); }, points});
    }
  }
  return interfaces;
}

/// Triangles away from junctions have no small angle (99.9%) and no small ratio; near them none is a sliver.
void expect_good_shapes(const MeshRun& run) {
  const SurfaceQuality q = surface_quality(run.mesh);
  EXPECT_GE(q.all.radius_ratio_mean, 0.95);
  EXPECT_GE(q.all.radius_ratio_min, 0.15);
  EXPECT_GE(q.away_from_junctions.radius_ratio_min, 0.3);
  EXPECT_LE(q.away_from_junctions.share_under_25, 0.001);
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
  const MeshRun one = mesh_of(scalar_volume(cube, either));
  expect_topology(one.mesh, {4, 4});
  print_quality("near bodies of one material", one);
  const MeshRun two = mesh_of(label_volume(cube, 3, [=](const Vec3d& p) { return a(p) > 0 ? 1 : b(p) > 0 ? 2 : 0; }));
  const TopologyReport report = check_topology(two.mesh, 3);
  EXPECT_TRUE(report.sound());
  EXPECT_EQ(report.materials[1].euler, 2);
  EXPECT_EQ(report.materials[2].euler, 2);
  print_quality("near bodies of two materials", two);
}

TEST(MeshEvidence, NestedShells) {
  const MeshRun run = mesh_of(label_volume(cube, 4, [](const Vec3d& p) {
    const double r = length(p - middle);
    return r < 6.2 ? 3 : r < 9.1 ? 2 : r < 12.4 ? 1 : 0;
  }));
  expect_topology(run.mesh, {2, 4, 4, 2});
  print_quality("nested shells", run);
  EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.95);
}

/// Every voxel that the sphere passes through: the thinnest shell that has no gap of a corner or an edge.
bool passes(const Vec3d& voxel, double radius) {
  double nearest = 0, farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::fabs(voxel[axis] - middle[axis]);
    nearest += std::pow(std::max(d - 0.5, 0.0), 2);
    farthest += std::pow(d + 0.5, 2);
  }
  return nearest <= radius * radius && farthest >= radius * radius;
}

TEST(MeshEvidence, ShellOneVoxelThinGivenAsLabels) {
  const MeshRun run = mesh_of(label_volume(cube, 3, [](const Vec3d& p) {
    return passes(p, 10.2) ? 1 : length(p - middle) < 10.2 ? 2 : 0;
  }));
  expect_topology(run.mesh, {2, 4, 2});
  print_quality("thin shell, labels", run);
}

TEST(MeshEvidence, ShellOneVoxelThinGivenAsDistances) {
  const auto f = [](const Vec3d& p) { return 0.5 - std::fabs(length(p - middle) - 10.2); };
  const MeshRun run = mesh_of(scalar_volume(cube, f));
  expect_topology(run.mesh, {4, 4});
  print_quality("thin shell, distances", run);
}

TEST(MeshEvidence, PlateOneVoxelThin) {
  const MeshRun run = mesh_of(label_volume(
      {28, 26, 12}, 2, [](const Vec3d& p) { return p.z == 6 && p.x > 3 && p.x < 24 && p.y > 3 && p.y < 22 ? 1 : 0; }));
  expect_topology(run.mesh, {2, 2});
  print_quality("plate", run);
}

/// Bodies with exact answers, given as binary labels.
struct LabelledBody {
  const char* name;
  PlaceFunction distance;  ///< signed, positive inside
  std::vector<Vec3d> points;
  std::int64_t euler;
};

std::vector<LabelledBody> labelled_bodies() {
  const Vec3d centre(25.3, 24.8, 25.1), semi(20, 15, 11.5);
  std::vector<LabelledBody> bodies;
  bodies.push_back({"ball", ball(centre, 20), on_sphere(centre, 20), 2});
  bodies.push_back({"ellipsoid", ellipsoid(centre, semi), {}, 2});
  for (const Vec3d& d : even_directions(1500)) bodies.back().points.push_back(centre + d * semi);
  bodies.push_back({"torus", torus(centre, 14.5, 7), on_torus(centre, 14.5, 7), 0});
  return bodies;
}

/// The cube between eight voxel centres that holds a point has corners of both materials: its voxel shell.
bool in_shell(const MeshVolume& volume, const Vec3d& p) {
  bool found[2] = {};
  for (int k = 0; k < 8; ++k) {
    const Int3 v(int(std::floor(p.x)) + (k & 1), int(std::floor(p.y)) + (k >> 1 & 1), int(std::floor(p.z)) + (k >> 2));
    found[volume.material[(std::size_t(v.z) * volume.dims.y + v.y) * volume.dims.x + v.x]] = true;
  }
  return found[0] && found[1];
}

TEST(MeshEvidence, BodiesGivenAsLabelsShowNoStairs) {
  for (const LabelledBody& body : labelled_bodies()) {
    SCOPED_TRACE(body.name);
    const MeshVolume volume = label_volume({51, 51, 51}, 2, [&](const Vec3d& p) { return body.distance(p) > 0; });
    const MeshRun run = mesh_of(volume);
    for (const Vec3d& p : run.mesh.points) EXPECT_TRUE(in_shell(volume, p)) << p.x << " " << p.y << " " << p.z;
    expect_topology(run.mesh, {body.euler, body.euler});
    const InterfaceError error = interface_error(run.mesh, {0, 1, body.distance, body.points});
    std::printf("%s as labels: distance mean %.4f max %.4f, from exact %.4f, normals %.2f degrees\n", body.name,
                error.to_exact_mean, error.to_exact_max, error.from_exact_max, error.normal_median);
    EXPECT_LE(error.to_exact_mean, 0.25);
    EXPECT_LE(error.normal_median, 5);
    print_quality(body.name, run);
    EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.97);
  }
}

/// One smooth closed surface at uniform size.
MeshRun uniform(const PlaceFunction& f, const std::string& solver, int iterations = 100) {
  MeshParameters parameters;
  parameters.solver = solver;
  parameters.min_size = parameters.max_size = 1;
  parameters.iterations = iterations;
  parameters.stagnation = 0;  // what can be reached within these iterations, not what is worth it
  const MeshRun run = mesh_of(scalar_volume(cube, f), parameters);
  EXPECT_LE(run.info.iterations, iterations);
  print_quality(solver.c_str(), run);
  return run;
}

TEST(MeshEvidence, UniformSizeOnASmoothSurface) {
  for (const PlaceFunction& f : {ball(middle, 13.2), torus(middle, 9.6, 4.4)}) {
    const TriangleQuality q = surface_quality(uniform(f, "tree").mesh).all;
    EXPECT_GE(q.radius_ratio_mean, 0.98);
    EXPECT_GE(q.radius_ratio_min, 0.6);
    EXPECT_LE(q.share_under_25, 0.001);
  }
}

TEST(MeshEvidence, TheOtherSolvers) {
  for (const char* solver : {"redblack", "serial"}) {
    const MeshRun run = uniform(torus(middle, 9.6, 4.4), solver, 60);
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

/// From iteration to iteration, but where control has just changed the particles; a rise of `overshoot` of it is borne, of
/// all iterations between two controls together none is.
void expect_falling(const std::vector<double>& energy, const std::vector<std::int64_t>& count, double overshoot) {
  ASSERT_EQ(energy.size(), count.size());
  std::size_t controlled = 0;
  for (std::size_t k = 1; k < energy.size(); ++k) {
    if (count[k] != count[k - 1]) {
      controlled = k;
      continue;
    }
    EXPECT_LE(energy[k], energy[k - 1] * (1 + overshoot)) << k;
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

}  // namespace
}  // namespace nacre::test
