// Nacre: how large boundaries are, and how thin the materials there, by their voxels.
#pragma once

#include <cmath>

#include "compute/field/boundary_area.hpp"
#include "tests/compute/field/field_cases.hpp"

namespace nacre::test {

/// The volume whose material is 1 where `inside` says so, with voxels twice as high as they are wide.
template <class Backend>
BoundaryArea area_of(Executor<Backend>& exec, const PlaceFunction& inside) {
  MeshVolume volume = label_volume({48, 48, 48}, 2, inside);
  return boundary_area(exec, lay_out_bricks(exec, volume.dims, Vec3d(1, 1, 2), CubicKernel::b_spline, volume.material));
}

template <class Backend>
void APlateIsAsThinAsItsRows(Executor<Backend>& exec) {
  const BoundaryArea area = area_of(exec, [](const Vec3d& p) { return p.z >= 20 && p.z < 23; });
  const double faces = 2 * 48 * 48 + 4 * 48 * 3 * 2;  // its own, and those at the faces of the volume
  EXPECT_NEAR(area.usual, faces / 1.5, 1e-6 * faces);
  EXPECT_NEAR(area.least, faces / (1.1 * std::sqrt(3.0)), 1e-6 * faces);
  ASSERT_EQ(area.thin.size(), 1u) << "across the other axes it has no end, or is 48 voxels wide";
  EXPECT_NEAR(area.thin[0].thickness, 6 * std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(area.thin[0].area, 2 * 48 * 48 / 1.5, 1e-6 * faces);
}
NACRE_DEVICE_TEST(BoundaryArea, APlateIsAsThinAsItsRows)

/// A shell is thin on both of its sides, also where the material beside it is thick.
template <class Backend>
void AShellIsThinEverywhere(Executor<Backend>& exec) {
  const auto radius = [](const Vec3d& p) { return length((p - Vec3d(24, 24, 24)) * Vec3d(1, 1, 2)); };
  const BoundaryArea shell = area_of(exec, [=](const Vec3d& p) { return std::fabs(radius(p) - 18) < 1.5; });
  const BoundaryArea ball = area_of(exec, [=](const Vec3d& p) { return radius(p) < 18; });
  double thin = 0, particles = 0;
  for (const BoundaryArea::Thin& part : shell.thin) {
    thin += part.area;
    particles += part.area / (part.thickness * part.thickness);
  }
  EXPECT_GT(thin, 0.8 * shell.usual);
  EXPECT_NEAR(particles / (shell.usual / 9), 1, 0.35) << "as many as if the shell were 3 thick everywhere";
  thin = 0;
  for (const BoundaryArea::Thin& part : ball.thin) thin += part.area;
  EXPECT_LT(thin, 0.15 * ball.usual);
}
NACRE_DEVICE_TEST(BoundaryArea, AShellIsThinEverywhere)

}  // namespace nacre::test
