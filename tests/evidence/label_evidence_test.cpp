// Nacre: meshes of bodies given as labels, with exact answers: topology, distances, no stairs, none lost.
#include <set>

#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/volume/materials.hpp"
#include "tests/evidence/exact_bodies.hpp"

namespace nacre::test {
namespace {

/// Labels say where a surface is to half a voxel; smoothing them finds it, and its normals.
void expect_no_staircase(const char* what, const MeshRun& run, const std::vector<ExactInterface>& interfaces) {
  for (const ExactInterface& exact : interfaces) {
    const InterfaceError error = interface_error(run.mesh, exact);
    std::printf("%s as labels, %d|%d: distance mean %.4f max %.4f, from exact %.4f, normals %.2f degrees\n", what,
                exact.lower, exact.higher, error.to_exact_mean, error.to_exact_max, error.from_exact_max,
                error.normal_median);
    EXPECT_GT(error.facets, 0u);
    EXPECT_LE(error.to_exact_mean, 0.25) << what << exact.lower << "|" << exact.higher;
    EXPECT_LE(error.normal_median, 5) << what << exact.lower << "|" << exact.higher;
  }
}

TEST(LabelEvidence, TwoSpheresMeetInACircle) {
  const Vec3d centre(25.3, 24.8, 25.1), half(7, 1.4, 2.8);
  const std::vector<Vec3d> centres{centre - half, centre + half};
  MeshVolume volume = indicator_volume({51, 51, 51}, balls(centres, 13.8));
  volume.kind = MeshVolume::Kind::labels;
  volume.values.clear();
  const MeshRun run = mesh_of(volume);
  expect_topology(run.mesh, {2, 2, 2});
  expect_no_staircase("two spheres", run, interfaces_of(centres, 13.8));
  expect_good_shapes(run);
}

TEST(LabelEvidence, NestedShells) {
  const MeshRun run = mesh_of(label_volume(cube, 4, [](const Vec3d& p) {
    const double r = length(p - middle);
    return r < 6.2 ? 3 : r < 9.1 ? 2 : r < 12.4 ? 1 : 0;
  }));
  expect_topology(run.mesh, {2, 4, 4, 2});
  expect_no_staircase("nested shells", run, nested_shells());
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

TEST(LabelEvidence, ShellOneVoxelThinGivenAsLabels) {
  const MeshRun run = mesh_of(label_volume(cube, 3, [](const Vec3d& p) {
    return passes(p, 10.2) ? 1 : length(p - middle) < 10.2 ? 2 : 0;
  }));
  expect_topology(run.mesh, {2, 4, 2});
  print_quality("thin shell, labels", run);
}

TEST(LabelEvidence, PlateOneVoxelThin) {
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

/// The materials at the corners of the cube between eight voxel centres that holds a point (in voxels), or of those
/// that it is within `margin` of: it is in its voxel shell if its own materials are among them.
std::set<std::uint16_t> around(const MeshVolume& volume, const Vec3d& p, double margin = 0) {
  std::set<std::uint16_t> found;
  const auto low = [&](double x) { return int(std::floor(x - margin)); };
  const auto high = [&](double x) { return int(std::floor(x + margin)) + 1; };
  for (int z = low(p.z); z <= high(p.z); ++z)
    for (int y = low(p.y); y <= high(p.y); ++y)
      for (int x = low(p.x); x <= high(p.x); ++x) {
        const bool inside = std::min({x, y, z}) >= 0 && x < volume.dims.x && y < volume.dims.y && z < volume.dims.z;
        found.insert(inside ? volume.material[(std::size_t(z) * volume.dims.y + y) * volume.dims.x + x] : 0);
      }
  return found;
}

TEST(LabelEvidence, BodiesGivenAsLabelsShowNoStaircase) {
  for (const LabelledBody& body : labelled_bodies()) {
    SCOPED_TRACE(body.name);
    const MeshVolume volume = label_volume({51, 51, 51}, 2, [&](const Vec3d& p) { return body.distance(p) > 0; });
    const MeshRun run = mesh_of(volume);
    for (const Vec3d& p : run.mesh.points) EXPECT_EQ(around(volume, p).size(), 2u) << p.x << " " << p.y << " " << p.z;
    expect_topology(run.mesh, {body.euler, body.euler});
    expect_no_staircase(body.name, run, {{0, 1, body.distance, body.points}});
    print_quality(body.name, run);
    EXPECT_GE(surface_quality(run.mesh).all.radius_ratio_mean, 0.97);
  }
}

/// Each vertex of a torso's mesh lies in the shell of its materials, to a twentieth of a voxel; on junctions at least
/// in that of two, since a third that is smoothed away from its voxels' corners may be none of the eight.
TEST(LabelEvidence, ATorsosBoundariesStayInTheirShells) {
  const MeshVolume volume = make_mesh_volume(std::vector{make_phantom("torso", 40)}, {});
  const MeshRun run = mesh_of(volume);
  std::vector<std::set<std::uint16_t>> materials(run.mesh.points.size());
  for (std::size_t t = 0; t < run.mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      materials[run.mesh.triangles[t][k]].insert(run.mesh.materials[t].begin(), run.mesh.materials[t].end());
  std::size_t strict = 0;
  for (std::size_t v = 0; v < materials.size(); ++v) {
    const Vec3d r = run.mesh.points[v] - volume.origin;
    const Vec3d p(r.x / volume.spacing.x, r.y / volume.spacing.y, r.z / volume.spacing.z);
    const std::set<std::uint16_t>& own = materials[v];
    const auto among = [&](const std::set<std::uint16_t>& found) {
      return std::size_t(std::count_if(own.begin(), own.end(), [&](std::uint16_t m) { return found.count(m) > 0; }));
    };
    EXPECT_GE(among(around(volume, p, 0.05)), 2u) << p.x << " " << p.y << " " << p.z;
    strict += among(around(volume, p)) == own.size();
  }
  std::printf("torso: %zu of %zu vertices strictly in the shell of all their materials\n", strict, materials.size());
  EXPECT_GT(strict, materials.size() - materials.size() / 200);
}

/// Points and lines where more than four materials meet survive as clusters of junctions of fewer, and are counted.
TEST(LabelEvidence, ManyMaterialsThatMeetAreAllThere) {
  struct {
    const char* name;
    int pieces;
    PlaceFunction piece;
  } const bodies[] = {
      {"six wedges", 6,
       [](const Vec3d& r) { return std::min(5.0, std::floor((std::atan2(r.y, r.x) + M_PI) / (M_PI / 3))); }},
      {"eight octants", 8, [](const Vec3d& r) { return (r.x > 0) + 2 * (r.y > 0) + 4 * (r.z > 0); }}};
  for (const auto& body : bodies) {
    SCOPED_TRACE(body.name);
    const MeshRun run = mesh_of(label_volume(cube, body.pieces + 1, [&](const Vec3d& p) {
      return length(p - middle) > 13 ? 0 : 1 + body.piece(p - middle);
    }));
    expect_topology(run.mesh, std::vector<std::int64_t>(std::size_t(body.pieces) + 1, 2));
    print_quality(body.name, run);
    std::printf("%s: %d surfaces, %d curves, %d points, %d of them of more than four materials\n", body.name,
                run.info.surfaces, run.info.curves, run.info.points, run.info.crowded_points);
    EXPECT_GT(run.info.crowded_points, 0);
    EXPECT_GE(run.info.points, run.info.crowded_points);
    const SurfaceQuality q = surface_quality(run.mesh);
    EXPECT_GE(q.all.radius_ratio_mean, 0.93);
    EXPECT_GE(q.all.radius_ratio_min, 0.15);
  }
}

}  // namespace
}  // namespace nacre::test
