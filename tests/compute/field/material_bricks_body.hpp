// Nacre: test bodies for the bricks of materials: values, faces, many materials.
#pragma once

#include "compute/device/error.hpp"
#include "tests/compute/field/field_cases.hpp"

namespace nacre::test {

const Vec3d ball_centre(11.3, 12.1, 11.8);

template <class Backend>
void CentresHaveTheValuesOfTheFile(Executor<Backend>& exec) {
  const auto f = ball(ball_centre, 7);
  const MeshVolume indicators = indicator_volume({24, 25, 23}, {[](const Vec3d&) { return 0.25; }, f});
  const MeshVolume scalar = scalar_volume({24, 25, 23}, f, {0.5f, 3});
  const MaterialBricks by_indicator = bricks_of(exec, indicators), by_level = bricks_of(exec, scalar);
  std::vector<Vec3f> centres;
  std::vector<double> value;
  for_each_voxel(indicators.dims, [&](std::size_t, const Vec3d& p) {
    if (std::fabs(f(p) - 0.5) > 2.5) return;  // near both interfaces: their blocks have bricks
    centres.push_back(in_fields(p));
    value.push_back(f(p));
  });
  ASSERT_GT(centres.size(), 1000u);
  const auto by_difference = differences_at(exec, by_indicator, centres);
  const auto s0 = sample_all(exec, by_level, centres, 0), s1 = sample_all(exec, by_level, centres, 1);
  for (std::size_t k = 0; k < centres.size(); ++k) {
    ASSERT_NEAR(by_difference[k].value, value[k] - 0.25, 1e-5) << k;
    ASSERT_NEAR(s0[k].value, 0.5 - value[k], 1e-5) << k;
    ASSERT_NEAR(s1[k].value, std::min(value[k] - 0.5, 3 - value[k]), 1e-5) << k;
  }
}

template <class Backend>
void FarFromInterfacesTheValuesAreConstant(Executor<Backend>& exec) {
  const MeshVolume volume = label_volume({40, 24, 24}, 3, [](const Vec3d& p) {
    return p.x < 20 ? 1 : p.x < 39 ? 2 : 0;
  });
  const MaterialBricks b = bricks_of(exec, volume);
  const std::vector<Vec3f> middle{in_fields({8, 12, 12})};  // four voxels around its block are of one material
  EXPECT_EQ(sample_all(exec, b, middle, 1)[0].value, 1);
  EXPECT_EQ(sample_all(exec, b, middle, 2)[0].value, 0);
  EXPECT_LT(length(sample_all(exec, b, middle, 1)[0].gradient), 1e-6f);
  EXPECT_EQ(materials_at(exec, b, middle)[0], 1u);
  EXPECT_LT(b.bricks, 3 * b.block_count());
}

/// What reaches the volume's faces ends half a voxel outside of its last centres, whatever its kind and spacing.
template <class Backend>
void MaterialsAreClosedAtTheFaces(Executor<Backend>& exec) {
  const auto slope = [](const Vec3d& p) { return 3 + 0.1 * p.x; };
  const auto half = [](const Vec3d& p) { return p.x < 9.7 ? 1 : 2; };
  MeshVolume labels = label_volume({20, 18, 16}, 3, half);
  labels.spacing = {2, 1.5, 3};
  const MeshVolume scalar = scalar_volume({20, 18, 16}, slope, {1});
  const MeshVolume indicators =
      indicator_volume({20, 18, 16}, {[](const Vec3d&) { return -5.0; }, [](const Vec3d& p) { return 9.7 - p.x; },
                                      [](const Vec3d& p) { return p.x - 9.7; }});
  const MeshVolume* const volumes[] = {&labels, &scalar, &indicators};
  for (const MeshVolume* volume : volumes) {
    const MaterialBricks b = bricks_of(exec, *volume);
    const Vec3f u = b.cells_per_unit;
    std::vector<Vec3f> points;
    const Vec3d n(volume->dims);
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-0.5, n[axis] - 0.5})
        for (const double off : {-0.1, 0.1}) {
          Vec3d p = (n - Vec3d(1.0)) * 0.3;
          p[axis] = side + off;
          const Vec3f q = in_fields(p);
          points.push_back({q.x / u.x, q.y / u.y, q.z / u.z});
        }
    const auto found = materials_at(exec, b, points);
    for (std::size_t k = 0; k < found.size(); ++k) {
      const bool inside = (k / 2 % 2 == 0) == (k % 2 == 1);
      EXPECT_EQ(found[k] != 0, inside) << "kind " << int(volume->kind) << ", point " << k;
    }
  }
}

/// Where an interface of the outside runs into a face, no fin stands out of it: a steep step, barely over the level on
/// one of its sides, whose interpolation overshoots.
template <class Backend>
void NothingStandsOutOfTheFaces(Executor<Backend>& exec) {
  const auto inside = [](const Vec3d& p) { return p.x - 9.5 + 0.5 * (p.y - 8) < 0; };
  const MeshVolume scalar = scalar_volume({20, 18, 16}, [&](const Vec3d& p) { return inside(p) ? 3.0 : -40.0; }, {0});
  const MeshVolume indicators = indicator_volume({20, 18, 16}, {[&](const Vec3d& p) { return inside(p) ? 0 : 0.8; },
                                                                [&](const Vec3d& p) { return inside(p) ? 0.08 : 0; }});
  std::vector<Vec3f> points;
  for (double z = -4; z < -1.9; z += 0.125)
    for (double y = 0; y < 17; y += 0.125)
      for (double x = 0; x < 19; x += 0.125) points.push_back(in_fields({x, y, z}));
  for (const MeshVolume* volume : {&scalar, &indicators}) {
    const auto found = materials_at(exec, bricks_of(exec, *volume, 1.2, CubicKernel::catmull_rom, nullptr, 1), points);
    EXPECT_EQ(std::count_if(found.begin(), found.end(), [](auto material) { return material != 0; }), 0)
        << "kind " << int(volume->kind);
  }
}

/// An interface that runs into a face stays straight up to it: what closes the volume does not push it aside. (Beyond
/// the face its functions go on as they end, which bends it a little in the last half voxel.)
template <class Backend>
void InterfacesRunStraightIntoTheFaces(Executor<Backend>& exec) {
  const auto f = [](const Vec3d& p) {
    return 0.05 * (p.x + 0.6 * p.y - 14.2);
  };  // far flatter than the outside is deep
  const MeshVolume volume =
      indicator_volume({20, 18, 16}, {[](const Vec3d&) { return -8.0; }, f, [=](const Vec3d& p) { return -f(p); }});
  const MaterialBricks b = bricks_of(exec, volume);
  std::vector<Vec3f> points;
  for (double z = 0; z < 15.6; z += 0.25)
    for (double y = -0.25; y < 17.5; y += 0.25) points.push_back(in_fields({14.2 - 0.6 * y + 0.3, y, z - 0.25}));
  for (const JunctionPoint& at : bring_onto(exec, b, Junction(1, 2), points)) {
    ASSERT_GT(length(at.direction), 0.5f);
    ASSERT_NEAR(f(Vec3d(at.p) - Vec3d(volume_padding + 0.5)) / 0.05, 0, 0.25);
  }
}

template <class Backend>
void SixtyTwoLabelsFitTogether(Executor<Backend>& exec) {
  const MeshVolume volume = label_volume({32, 32, 32}, 63, [](const Vec3d& p) {  // cubes of 4 voxels
    return 1 + (int(p.x) / 4 + 8 * (int(p.y) / 4) + 64 * (int(p.z) / 4)) * 37 % 62;
  });
  TightenResult result;
  const MaterialBricks b = bricks_of(exec, volume, 1.2, CubicKernel::catmull_rom, &result);
  EXPECT_EQ(result.left, 0);
  EXPECT_EQ(stray_voxels(exec, b), 0u);
}

template <class Backend>
void TooManyInOnePlaceIsAnError(Executor<Backend>& exec) {
  const MeshVolume volume = label_volume({8, 8, 8}, 513, [](const Vec3d& p) { return 1 + p.x + 8 * p.y + 64 * p.z; });
  try {
    bricks_of(exec, volume);
    FAIL() << "513 materials in one block";
  } catch (const Error& error) {
    EXPECT_NE(error.advice().find("`merge`"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("64"), std::string::npos);
  }
}

/// Across the borders of bricks, with voxels of different edges: quadratics are exact, derivatives included.
template <class Backend>
void DerivativesAcrossBricks(Executor<Backend>& exec) {
  const Vec3d s(1, 1.25, 2);
  const auto f = [&](const Vec3d& index) {
    const Vec3d p = index * s;
    return (p.x - 12.3) + 0.04 * (p.y - 14) * (p.y - 14) - 0.03 * (p.x - 12) * (p.z - 20) + 0.02 * p.z;
  };
  MeshVolume volume = indicator_volume({25, 22, 20}, {[](const Vec3d&) { return 0.0; }, f});
  volume.spacing = s;
  const MaterialBricks b = bricks_of(exec, volume);
  std::vector<Vec3f> points;
  std::vector<Vec3d> at;
  for (int k = 0; k < 4000; ++k) {
    const Vec3d index(3 + 19 * uniform_random(1, k, 0), 3 + 16 * uniform_random(1, k, 1),
                      3 + 14 * uniform_random(1, k, 2));
    if (std::fabs(f(index)) > 1.5) continue;
    at.push_back(index * s);
    points.push_back(Vec3f((index + Vec3d(volume_padding + 0.5)) * s));
  }
  ASSERT_GT(points.size(), 200u);
  const auto found = differences_at(exec, b, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3d p = at[k];
    EXPECT_NEAR(found[k].value, f({p.x / s.x, p.y / s.y, p.z / s.z}), 2e-4);
    EXPECT_NEAR(found[k].gradient.x, 1 - 0.03 * (p.z - 20), 1e-3);
    EXPECT_NEAR(found[k].gradient.y, 0.08 * (p.y - 14), 1e-3);
    EXPECT_NEAR(found[k].gradient.z, -0.03 * (p.x - 12) + 0.02, 1e-3);
    EXPECT_NEAR(found[k].yy, 0.08, 3e-3);
    EXPECT_NEAR(found[k].zx, -0.03, 3e-3);
    EXPECT_NEAR(found[k].xx, 0, 3e-3);
  }
}

/// The B-spline smooths, but leaves what is linear.
template <class Backend>
void TheSplineLeavesPlanes(Executor<Backend>& exec) {
  const auto f = [](const Vec3d& p) { return 0.8 * (p.x - 9.7) - 0.6 * (p.y - 8); };
  const MaterialBricks b =
      bricks_of(exec, indicator_volume({20, 18, 16}, {[](const Vec3d&) { return 0.0; }, f}), 0, CubicKernel::b_spline);
  std::vector<Vec3f> points;
  for (int k = 0; k < 500; ++k) {
    const double y = 5 + 6 * uniform_random(2, k, 0), away = 2 * uniform_random(2, k, 1) - 1;
    points.push_back(in_fields({9.7 + 0.75 * (y - 8) + away, y, 4 + 8 * uniform_random(2, k, 2)}));
  }
  const auto found = differences_at(exec, b, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_NEAR(found[k].value, f(Vec3d(points[k]) - Vec3d(volume_padding + 0.5)), 1e-4);
    EXPECT_LT(length(found[k].gradient - Vec3f(0.8f, -0.6f, 0)), 1e-4f);
  }
}

NACRE_DEVICE_TEST(MaterialBricks, CentresHaveTheValuesOfTheFile)
NACRE_DEVICE_TEST(MaterialBricks, FarFromInterfacesTheValuesAreConstant)
NACRE_DEVICE_TEST(MaterialBricks, MaterialsAreClosedAtTheFaces)
NACRE_DEVICE_TEST(MaterialBricks, NothingStandsOutOfTheFaces)
NACRE_DEVICE_TEST(MaterialBricks, InterfacesRunStraightIntoTheFaces)
NACRE_DEVICE_TEST(MaterialBricks, SixtyTwoLabelsFitTogether)
NACRE_DEVICE_TEST(MaterialBricks, TooManyInOnePlaceIsAnError)
NACRE_DEVICE_TEST(MaterialBricks, DerivativesAcrossBricks)
NACRE_DEVICE_TEST(MaterialBricks, TheSplineLeavesPlanes)

}  // namespace nacre::test
