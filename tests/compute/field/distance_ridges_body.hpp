// Nacre: test bodies for signed distances whose ridges lie near the interface.
#pragma once

#include "tests/compute/field/field_cases.hpp"

namespace nacre::test {

/// A body by its distance, in units of the smallest spacing around the volume's middle, and points of its surface.
struct RidgedBody {
  PlaceFunction distance;
  std::vector<Vec3d> points;
};

/// Three directions at right angles, none along an axis.
struct Turned {
  Vec3d n = normalized(Vec3d(0.5, 0.7, 0.3)), s = normalized(cross(n, Vec3d(0, 0, 1))), t = cross(n, s);
};

/// A wall between two planes.
inline RidgedBody wall(double width) {
  const auto [n, s, t] = Turned();
  RidgedBody body{[=, n = n](const Vec3d& p) { return width / 2 - std::fabs(dot(p, n)); }, {}};
  for (int i = -25; i <= 25; ++i)
    for (int j = -25; j <= 25; ++j)
      for (const double side : {-0.5, 0.5}) body.points.push_back(s * (0.31 * i) + t * (0.31 * j) + n * (width * side));
  return body;
}

inline RidgedBody shell(double radius, double width) {
  RidgedBody body{[=](const Vec3d& p) { return width / 2 - std::fabs(length(p) - radius); }, {}};
  for (const Vec3d& d : even_directions(3000))
    for (const double side : {-0.5, 0.5}) body.points.push_back(d * (radius + width * side));
  return body;
}

inline RidgedBody rod(double radius) {
  const auto [n, s, t] = Turned();
  RidgedBody body{[=, n = n](const Vec3d& p) { return radius - length(p - n * dot(p, n)); }, {}};
  for (int k = 0; k < 4000; ++k)
    body.points.push_back(n * (0.002 * k - 4) + (s * std::cos(0.7 * k) + t * std::sin(0.7 * k)) * radius);
  return body;
}

inline RidgedBody two_balls(double radius, double gap) {
  const Vec3d displacement = normalized(Vec3d(7.2, 1.3, 2.1)) * (radius + gap / 2);
  const auto a = ball(displacement, radius), b = ball(displacement * -1.0, radius);
  RidgedBody body{[=](const Vec3d& p) { return std::max(a(p), b(p)); }, {}};
  for (const Vec3d& d : even_directions(4000))
    for (const double side : {-1.0, 1.0})
      if (const Vec3d p = displacement * side + d * radius; length(p) < 9) body.points.push_back(p);
  return body;
}

/// The distance in 32 units of space, cut at `levels`; the world's origin is the body's middle.
inline MeshVolume volume_of(const PlaceFunction& distance, const Vec3d& spacing,
                            const std::vector<float>& levels = {0}) {
  const Int3 dims{int(32 / spacing.x), int(32 / spacing.y), int(32 / spacing.z)};
  const Vec3d middle = Vec3d(dims) / 2.0 + Vec3d(0.3, -0.2, 0.1);
  MeshVolume volume = scalar_volume(
      dims, [=](const Vec3d& p) { return distance((p - middle) * spacing); }, levels);
  volume.spacing = spacing;
  volume.origin = middle * spacing * -1.0;
  return volume;
}

struct InterfaceOffset {
  double most = 0, mean = 0;
  std::int64_t on_ridge = 0;
};

/// How far from the points of a surface its interface is read, in smallest spacings. With `as_is` the values stay as
/// the file has them.
template <class Backend>
InterfaceOffset interface_offset(Executor<Backend>& exec, const MeshVolume& volume, const std::vector<Vec3d>& points,
                                 const Junction& interface = {0, 1}, bool as_is = false) {
  const std::size_t mark = exec.arena().mark();
  const Vec3d& spacing = volume.spacing;
  MaterialBricks b = lay_out_bricks(exec, volume.dims, spacing, CubicKernel::catmull_rom, volume.material);
  InterfaceOffset offset;
  const float slope = as_is ? 0 : distance_slope(volume.dims, Vec3f(spacing), volume.values[0], volume.levels[0]);
  offset.on_ridge = fill_scalar(exec, b, volume.values[0], volume.levels, 1, slope);
  EXPECT_EQ(stray_voxels(exec, b), 0u);
  std::vector<Vec3f> from;
  for (const Vec3d& p : points) from.push_back(Vec3f(p - volume.origin + spacing * (volume_padding + 0.5)));
  const std::vector<JunctionPoint> on = bring_onto(exec, b, interface, from);
  for (std::size_t k = 0; k < on.size(); ++k) {
    EXPECT_GT(length(on[k].direction), 0) << k;
    const double away = length(Vec3d(on[k].p - from[k]));
    offset.most = std::max(offset.most, away);
    offset.mean += away / double(on.size());
  }
  exec.arena().rewind(mark);
  return offset;
}

/// Reads the body as it stands and with its ridges taken out, and says by how much that helps.
template <class Backend>
void check_body(Executor<Backend>& exec, const char* what, const RidgedBody& body, double most,
                const Vec3d& spacing = {1, 1, 1}) {
  SCOPED_TRACE(what);
  const MeshVolume volume = volume_of(body.distance, spacing);
  const InterfaceOffset before = interface_offset(exec, volume, body.points, {0, 1}, true);
  const InterfaceOffset after = interface_offset(exec, volume, body.points);
  std::printf("%s: %.3f at most, %.4f on average; as it stands %.3f, %.4f\n", what, after.most, after.mean, before.most,
              before.mean);
  EXPECT_GT(after.on_ridge, 0);
  EXPECT_LE(after.most, most);
  EXPECT_LE(after.most, 0.6 * before.most);
  EXPECT_LE(after.mean, 0.6 * before.mean);
}

template <class Backend>
void SheetsThatFaceEachOther(Executor<Backend>& exec) {
  check_body(exec, "wall of 1", wall(1), 0.01);
  check_body(exec, "wall of 0.6", wall(0.6), 0.01);
  check_body(exec, "wall of 1.7", wall(1.7), 0.01);
  check_body(exec, "shell of 1", shell(10.2, 1), 0.02);
  check_body(exec, "shell of 2", shell(10.2, 2), 0.02);
  check_body(exec, "rod of 0.7", rod(0.7), 0.03);
  check_body(exec, "rod of 1.1", rod(1.1), 0.015);
  check_body(exec, "balls 0.8 apart", two_balls(6.87, 0.8), 0.07);
  check_body(exec, "balls 0.6 apart", two_balls(12, 0.6), 0.06);
}

template <class Backend>
void VoxelsOfOtherShapes(Executor<Backend>& exec) {
  check_body(exec, "wall of 1 in flat voxels", wall(1), 0.01, {1, 1, 1.6});
  check_body(exec, "shell of 1.5 in flat voxels", shell(10.2, 1.5), 0.04, {1, 1.3, 1.6});
}

/// A gap is what a wall is on the other side; a file may count in any unit.
template <class Backend>
void EitherSideAndAnyUnit(Executor<Backend>& exec) {
  const RidgedBody body = shell(10.2, 1);
  const auto offset = [&](const PlaceFunction& f) {
    return interface_offset(exec, volume_of(f, {1, 1, 1}), body.points);
  };
  const InterfaceOffset plain = offset(body.distance);
  const InterfaceOffset gap = offset([&](const Vec3d& p) { return -body.distance(p); });
  const InterfaceOffset metres = offset([&](const Vec3d& p) { return 1e-3 * body.distance(p); });
  const InterfaceOffset cut = offset([&](const Vec3d& p) { return std::clamp(body.distance(p), -3.2, 3.2); });
  for (const InterfaceOffset& other : {gap, metres}) {
    EXPECT_NEAR(other.most, plain.most, 0.003);
    EXPECT_NEAR(double(other.on_ridge), double(plain.on_ridge), 0.01 * double(plain.on_ridge));
  }
  EXPECT_LE(cut.most, 0.03);
}

/// What a ridge's removal adds grows fast: another level would be moved.
template <class Backend>
void SeveralLevelsStay(Executor<Backend>& exec) {
  const MeshVolume volume = volume_of(wall(1).distance, {1, 1, 1}, {-2, 0});
  const std::vector<Vec3d> points = wall(1).points;
  const InterfaceOffset offset = interface_offset(exec, volume, points, {1, 2});
  EXPECT_EQ(offset.on_ridge, 0);
  EXPECT_EQ(offset.most, interface_offset(exec, volume, points, {1, 2}, true).most);
}

template <class Backend>
void WhatHasNoSuchRidgeStays(Executor<Backend>& exec) {
  const auto round = [](const Vec3d& p) { return 9.1 - length(p); };
  const auto soft = [](const Vec3d& p) { return std::tanh((9.1 - length(p)) / 2.5); };
  const auto scanned = [](const Vec3d& p) {
    return (9.1 - length(p)) * (1 + 0.5 * std::sin(0.8 * p.x + 0.3) * std::sin(0.7 * p.y));
  };
  for (const PlaceFunction& f : {PlaceFunction(round), PlaceFunction(soft), PlaceFunction(scanned)}) {
    const MeshVolume volume = volume_of(f, {1, 1, 1});
    std::vector<Vec3d> points;
    for (const Vec3d& d : even_directions(500)) points.push_back(d * 9.1);
    const InterfaceOffset offset = interface_offset(exec, volume, points);
    EXPECT_EQ(offset.on_ridge, 0);
    EXPECT_EQ(offset.most, interface_offset(exec, volume, points, {0, 1}, true).most);
  }
}

/// Only distances have a slope of their own.
template <class Backend>
void SlopesOfDistances(Executor<Backend>&) {
  const auto slope = [](const PlaceFunction& f, const Vec3d& spacing) {
    const MeshVolume v = volume_of(f, spacing);
    return distance_slope(v.dims, Vec3f(spacing), v.values[0], v.levels[0]);
  };
  EXPECT_NEAR(slope(shell(10.2, 1).distance, {1, 1, 1}), 1, 0.03);
  EXPECT_NEAR(slope([](const Vec3d& p) { return 40 * (length(p) - 8); }, {1, 1.3, 1.6}), 40, 1.5);
  EXPECT_EQ(slope([](const Vec3d& p) { return std::tanh((9.1 - length(p)) / 2.5); }, {1, 1, 1}), 0);
  EXPECT_EQ(slope([](const Vec3d& p) { return 9e3 - dot(p, p) * dot(p, p); }, {1, 1, 1}), 0);
  EXPECT_EQ(slope([](const Vec3d&) { return 1.0; }, {1, 1, 1}), 0);  // nothing to measure
  EXPECT_EQ(slope([](const Vec3d& p) { return length(p) < 9 ? 1.0 : -1.0; }, {1, 1, 1}), 0);
}

NACRE_DEVICE_TEST(DistanceRidges, SheetsThatFaceEachOther)
NACRE_DEVICE_TEST(DistanceRidges, VoxelsOfOtherShapes)
NACRE_DEVICE_TEST(DistanceRidges, EitherSideAndAnyUnit)
NACRE_DEVICE_TEST(DistanceRidges, SeveralLevelsStay)
NACRE_DEVICE_TEST(DistanceRidges, WhatHasNoSuchRidgeStays)
NACRE_DEVICE_TEST(DistanceRidges, SlopesOfDistances)

}  // namespace nacre::test
