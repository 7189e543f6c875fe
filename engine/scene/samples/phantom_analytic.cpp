// Nacre: small volumes with exact answers: spheres, shells, an ellipsoid, bodies that nearly touch.
#include "engine/scene/samples/phantom_kit.hpp"

namespace nacre {
namespace {

constexpr Int3 cube{48, 48, 48};
const Vec3d middle(23.5);

/// Two balls of radius 13, 14 apart: each keeps its side of the plane between them.
void make_two_spheres(const PhantomGrid& grid, Phantom& phantom) {
  phantom.labels.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    const double a = length(p - middle + Vec3d(7, 0, 0)), b = length(p - middle - Vec3d(7, 0, 0));
    phantom.labels[at] = std::min(a, b) > 13 ? 0 : a < b ? 1 : 2;
  });
}

/// A ball in three sectors: three interfaces that meet in one line, which ends where four materials meet.
void make_sectors(const PhantomGrid& grid, Phantom& phantom) {
  phantom.labels.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    const Vec3d d = p - middle;
    const double turn = std::atan2(d.y, d.x) + 3.5;  // not along the voxels
    phantom.labels[at] = length(d) > 18 ? 0 : std::uint8_t(1 + int(turn * 3 / 6.2831853) % 3);
  });
}

/// A ball of radius 10 in a shell up to 14 in a shell up to 18.
void make_nested_shells(const PhantomGrid& grid, Phantom& phantom) {
  phantom.labels.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    const double r = length(p - middle);
    phantom.labels[at] = r < 10 ? 3 : r < 14 ? 2 : r < 18 ? 1 : 0;
  });
}

/// Two balls of radius 9 with 1.5 voxels between them.
void make_near_bodies(const PhantomGrid& grid, Phantom& phantom) {
  phantom.labels.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    const double a = length(p - middle + Vec3d(9.75, 0, 0)), b = length(p - middle - Vec3d(9.75, 0, 0));
    phantom.labels[at] = a < 9 ? 1 : b < 9 ? 2 : 0;
  });
}

/// An ellipsoid with semi-axes 19, 13 and 9.
void make_ellipsoid(const PhantomGrid& grid, Phantom& phantom) {
  phantom.values.resize(grid.voxels());
  grid.for_each([&](std::size_t at, const Vec3d& p) {
    phantom.values[at] = soft_value(ellipsoid_distance(p - middle, {19, 13, 9}));
  });
}

}  // namespace

std::vector<PhantomDefinition> analytic_phantoms() {
  return {{{"two-spheres", "two balls that share a disk: labels 1, 2", cube, true}, make_two_spheres},
          {{"three-sectors", "a ball in three sectors: labels 1, 2, 3", cube, true}, make_sectors},
          {{"nested-shells", "a ball in two shells: labels 1, 2, 3 inwards", cube, true}, make_nested_shells},
          {{"near-bodies", "two balls 1.5 voxels apart: labels 1, 2", cube, true}, make_near_bodies},
          {{"ellipsoid", "an ellipsoid, scalar; --isovalue 0.5", cube, false}, make_ellipsoid}};
}

}  // namespace nacre
