// Nacre: meshes of known bodies against the voxels that sample these, and against a search through all faces.
#include "compute/pipeline/voxel_distance.hpp"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "compute/device/random.hpp"
#include "compute/embedding/triangle.hpp"
#include "tests/compute/meshes.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre {
namespace {

using test::ball;
using test::label_volume;

SurfaceMesh between(const test::Mesh& mesh, std::array<std::uint16_t, 2> materials = {0, 1}) {
  return {mesh.points, mesh.triangles, std::vector(mesh.triangles.size(), materials)};
}

/// A box whose faces are those of voxels.
test::Mesh box_mesh(const Vec3d& low, const Vec3d& high) {
  test::Mesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.points.push_back({k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  for (const auto& [a, b, c, d] : std::initializer_list<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

test::Mesh torus_mesh(const Vec3d& centre, double major, double minor, int n) {
  return test::mapped_square(3 * n, n, [&](double u, double v) {
    const double a = 2 * test::pi * u, b = 2 * test::pi * v, r = major + minor * std::cos(b);
    return centre + Vec3d(r * std::cos(a), r * std::sin(a), minor * std::sin(b));
  });
}

/// From `p` to the nearest face of the material, by looking at all.
double to_any_face(const MeshVolume& volume, std::uint16_t material, const Vec3d& p) {
  const Int3 n = volume.dims;
  const auto at = [&](Int3 v) -> int {
    for (int axis = 0; axis < 3; ++axis)
      if (v[axis] < 0 || v[axis] >= n[axis]) return 0;
    return volume.material[std::size_t(v.x + n.x * (v.y + n.y * v.z))];
  };
  double best = 1e300;
  test::for_each_voxel(n, [&](std::size_t, const Vec3d& v) {
    if (at(Int3(int(v.x), int(v.y), int(v.z))) != material) return;
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        Int3 next(int(v.x), int(v.y), int(v.z));
        next[axis] += side;
        if (at(next) == material) continue;
        Vec3d off;
        for (int k = 0; k < 3; ++k) {
          const double middle = v[k] * volume.spacing[k], half = 0.5 * volume.spacing[k];
          off[k] =
              k == axis ? middle + side * half - p[k] : std::max({middle - half - p[k], p[k] - middle - half, 0.0});
        }
        best = std::min(best, length(off));
      }
  });
  return best;
}

TEST(VoxelDistance, ASlabThatEndsOnFacesOfVoxelsIsNowhereAwayFromThem) {
  MeshVolume volume = label_volume({12, 10, 9}, 2, [](const Vec3d& p) { return p.z >= 3 && p.z <= 5 ? 1 : 0; });
  volume.spacing = {0.5, 0.7, 2};
  const SurfaceMesh mesh = between(box_mesh({-0.25, -0.35, 5}, {5.75, 6.65, 11}));
  const VoxelDistance d = voxel_distances(mesh, volume)[1];
  ASSERT_TRUE(d.measured);
  EXPECT_NEAR(d.voxel_volume, 6 * 7 * 6, 1e-9);
  EXPECT_NEAR(d.hausdorff(), 0, 1e-9);
  EXPECT_NEAR(d.mean(), 0, 1e-9);
}

TEST(VoxelDistance, AWallThatIsTooFarOutIsMeasuredFromBothSides) {
  const MeshVolume volume = label_volume({20, 20, 20}, 2, [](const Vec3d& p) {
    return p.x >= 4 && p.x <= 13 && p.y >= 4 && p.y <= 13 && p.z >= 4 && p.z <= 13 ? 1 : 0;
  });
  const VoxelDistance d = voxel_distances(between(box_mesh({3.5, 3.5, 3.5}, {13.5, 13.5, 15.5})), volume)[1];
  EXPECT_NEAR(d.mesh_max, 2, 1e-9) << "the corners of the wall";
  EXPECT_NEAR(d.faces_max, 2, 0.51) << "the middle of the body's wall sees the mesh's wall or its sides";
  // The wall of 100 is 2 away; the sides reach 2 beyond the body, 1 away in the mean; all else is on faces.
  EXPECT_NEAR(d.mesh_mean, (100 * 2 + 4 * 20 * 1) / 680.0, 0.01);
}

TEST(VoxelDistance, FarFromTheVoxelsTheSearchFindsWhatAllFacesGive) {
  const MeshVolume base = label_volume({16, 14, 15}, 3, [](const Vec3d& p) {
    return length(p - Vec3d(5, 5, 6)) < 3 ? 1 : length(p - Vec3d(10, 8, 9)) < 4 ? 2 : 0;
  });
  for (const Vec3d& spacing : {Vec3d(1, 1, 1), Vec3d(0.4, 1.1, 2.3)}) {
    MeshVolume volume = base;
    volume.spacing = spacing;
    test::Mesh one;
    const Vec3d a(-3, 2.2, 5), b(30 * spacing.x, 3.1, 7.7), c(4.4, 20 * spacing.y, 9.9);
    one.add({a, b, c});
    const VoxelDistance d = voxel_distances(between(one, {1, 2}), volume)[2];
    double most = 0;
    for (const Vec3d& p : {a, b, c}) most = std::max(most, to_any_face(volume, 2, p));
    EXPECT_NEAR(d.mesh_max, most, 1e-9);
  }
}

TEST(VoxelDistance, AmongVoxelsTheSearchFindsWhatAllFacesGive) {
  std::uint32_t drawn = 0;
  const auto random = [&drawn] { return uniform_random(3, drawn++, 0); };
  MeshVolume volume = label_volume({7, 6, 5}, 3, [&](const Vec3d&) { return int(random() * 3); });
  for (const Vec3d& spacing : {Vec3d(1, 1, 1), Vec3d(0.7, 1.1, 2.3)}) {
    volume.spacing = spacing;
    for (int n = 0; n < 300; ++n) {
      const Vec3d p((random() * 8 - 1) * spacing.x, (random() * 7 - 1) * spacing.y, (random() * 6 - 1) * spacing.z);
      test::Mesh point;
      point.add({p, p, p});
      EXPECT_NEAR(voxel_distances(between(point, {1, 2}), volume)[2].mesh_max, to_any_face(volume, 2, p), 1e-12);
    }
  }
}

/// Some have the nearest triangle of all for their own, some one nearby, and some one that is far.
TEST(VoxelDistance, FromFacesTheNearestTriangleOfTheirMaterialIsFound) {
  std::uint32_t drawn = 0;
  const auto random = [&drawn] { return uniform_random(5, drawn++, 0); };
  MeshVolume volume = label_volume({24, 8, 6}, 4, [&](const Vec3d&) { return int(random() * 4); });
  volume.spacing = {0.9, 1.1, 1.3};
  SurfaceMesh mesh;
  for (int n = 0; n < 120; ++n) {
    const bool third = n % 5 == 0;  // its triangles are at one end, and there are faces of it everywhere
    const Vec3d at((third ? 2 : 22) * random(), 8.8 * random(), 7.8 * random());
    const auto first = std::uint32_t(mesh.points.size());
    for (int k = 0; k < 3; ++k) mesh.points.push_back(at + Vec3d(random(), random(), random()));
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.materials.push_back(third ? std::array<std::uint16_t, 2>{std::uint16_t(n % 3), 3}
                                   : std::array<std::uint16_t, 2>{std::uint16_t(n % 2), 2});
  }
  const auto at = [&](const Int3& v) {
    return is_within(v, volume.dims) ? int(volume.material[std::size_t(v.x + 24 * (v.y + 8 * v.z))]) : 0;
  };
  std::vector<double> sum(4), area(4), most(4);
  for (int axis = 0; axis < 3; ++axis)
    test::for_each_voxel(volume.dims + Int3(1), [&](std::size_t, const Vec3d& v) {
      const Int3 before = Int3(int(v.x), int(v.y), int(v.z)) - Int3(1);
      Int3 behind = before;
      ++behind[axis];
      if (at(before) == at(behind)) return;
      Vec3d centre;
      for (int k = 0; k < 3; ++k) centre[k] = before[k] * volume.spacing[k];
      centre[axis] += 0.5 * volume.spacing[axis];
      const double face = volume.spacing[(axis + 1) % 3] * volume.spacing[(axis + 2) % 3];
      for (const int m : {at(before), at(behind)}) {
        double best = 1e300;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
          if (mesh.materials[t][0] == m || mesh.materials[t][1] == m) {
            const Triangle& c = mesh.triangles[t];
            const Corners corners{mesh.points[c.a], mesh.points[c.b], mesh.points[c.c]};
            best = std::min(best, length(closest_point(corners, centre) - centre));
          }
        sum[std::size_t(m)] += best * face, area[std::size_t(m)] += face;
        most[std::size_t(m)] = std::max(most[std::size_t(m)], best);
      }
    });
  const std::vector<VoxelDistance> d = voxel_distances(mesh, volume);
  EXPECT_GT(most[3], 15) << "some are far";
  for (std::size_t m = 1; m < 4; ++m) {
    EXPECT_NEAR(d[m].faces_max, most[m], 1e-9) << m;
    EXPECT_NEAR(d[m].faces_mean, sum[m] / area[m], 1e-9) << m;
  }
}

/// What a perfect mesh gets: the figures that the documentation gives.
TEST(VoxelDistance, BallsAndToriThatAreExactAreAFractionOfAVoxelAway) {
  const Vec3d c(20.3, 19.8, 20.1);
  const auto label = [](const test::PlaceFunction& f) { return [f](const Vec3d& p) { return f(p) > 0 ? 1.0 : 0.0; }; };
  const test::PlaceFunction ring = [c](const Vec3d& p) {
    const Vec3d r = p - c;
    return 4.0 - std::hypot(std::hypot(r.x, r.y) - 12, r.z);
  };
  struct Case {
    test::Mesh mesh;
    test::PlaceFunction inside;
    double volume;
  };
  for (const Case& body : {Case{test::sphere(c, 14, 80), ball(c, 14), 4 / 3.0 * test::pi * 14 * 14 * 14},
                           Case{torus_mesh(c, 12, 4, 60), ring, 2 * test::pi * test::pi * 12 * 16}}) {
    MeshVolume volume = label_volume({41, 40, 41}, 2, label(body.inside));
    volume.origin = {100, -50, 3};
    volume.axes = {Vec3d(0, 1, 0), Vec3d(-1, 0, 0), Vec3d(0, 0, 1)};
    volume.spacing = {2, 2, 2};
    SurfaceMesh mesh = between(body.mesh);
    for (Vec3d& p : mesh.points) p = Vec3d(100 - 2 * p.y, -50 + 2 * p.x, 3 + 2 * p.z);
    const VoxelDistance d = voxel_distances(mesh, volume)[1];
    EXPECT_NEAR(d.voxel_volume / 8, body.volume, 0.015 * body.volume);
    EXPECT_NEAR(d.faces_mean / 2, 0.175, 0.015);
    EXPECT_LE(d.faces_max / 2, 0.5 + 0.01);
    EXPECT_NEAR(d.mesh_mean / 2, 0.175, 0.015);
    EXPECT_LE(d.mesh_max / 2, 0.5);
  }
}

TEST(VoxelDistance, AMaterialWithoutVoxelsOrWithoutTrianglesIsNotMeasured) {
  const MeshVolume volume = label_volume({12, 12, 12}, 4, [](const Vec3d& p) {
    return p.x > 3 && p.x < 7 ? 1 : p.x > 9 ? 2 : 0;
  });
  const std::vector<VoxelDistance> d = voxel_distances(between(test::sphere({5, 5, 5}, 3, 8), {1, 3}), volume);
  ASSERT_EQ(d.size(), 4u);
  EXPECT_FALSE(d[0].measured);
  EXPECT_TRUE(d[1].measured);
  EXPECT_FALSE(d[2].measured);
  EXPECT_FALSE(d[3].measured);
  EXPECT_EQ(d[2].voxel_volume, 2 * 144);
  EXPECT_EQ(d[3].voxel_volume, 0);
}

TEST(VoxelDistance, IsTheSameToTheLastBitOnOneThreadAndOnMany) {
  const MeshVolume volume = test::label_balls();
  const SurfaceMesh mesh = between(test::sphere({12, 12, 12}, 8.5, 40), {1, 2});
  const auto measured = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return voxel_distances(mesh, volume);
  };
  const std::vector<VoxelDistance> one = measured(1), many = measured(7);
  for (std::size_t m = 1; m < one.size(); ++m) {
    EXPECT_EQ(one[m].mesh_mean, many[m].mesh_mean);
    EXPECT_EQ(one[m].faces_mean, many[m].faces_mean);
    EXPECT_EQ(one[m].hausdorff(), many[m].hausdorff());
  }
}

TEST(VoxelDistance, StopsWhenAsked) {
  const std::atomic<bool> stop = true;
  EXPECT_THROW(voxel_distances(between(test::sphere({12, 12, 12}, 8, 8)), test::label_balls(), &stop), Interrupted);
}

}  // namespace
}  // namespace nacre
