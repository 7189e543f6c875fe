// Nacre: what a built-in sample consists of, and small pieces that several samples share.
#pragma once

#include <functional>
#include <vector>

#include "engine/scene/samples/samples.hpp"

namespace nacre {

/// Points on an analytic surface with the exact unit normals there, and triangles wound by them; outward where the
/// surface is closed.
struct SampleShape {
  std::vector<Vec3d> points;
  std::vector<Vec3d> normals;
  std::vector<Triangle> triangles;
};

/// A velocity at one instant, given a point of the surface and its unit normal. It need not be tangential.
using SampleField = std::function<Vec3d(const Vec3d& point, const Vec3d& normal)>;

struct SampleDefinition {
  SampleInfo info;
  int default_detail = 0;
  int min_detail = 0;  ///< coarser than this, thin parts of the shape would be lost
  int steps = 1;
  std::function<SampleShape(int detail)> shape;
  std::function<SampleField(double time)> flow;  ///< of period 1 in time
  /// Of a shape that moves with period 1: where a point near `shape` is at a time. Then `flow` is that of the material.
  std::function<Vec3d(const Vec3d& point, double time)> position = {};
};

SampleDefinition sphere_sample();
SampleDefinition sphere_rotation_sample();
SampleDefinition torus_sample();
SampleDefinition train_sample();
SampleDefinition aircraft_sample();
SampleDefinition cylinder_sample();
SampleDefinition delta_wing_sample();
SampleDefinition pulse_sample();

/// The unit sphere without poles, of triangles of nearly equal size.
SampleShape unit_sphere_shape(int detail);

/// The definition of that name; throws Error if there is none.
const SampleDefinition& sample_definition(const std::string& name);

/// The part of `v` in the plane with unit normal `n`.
inline Vec3d tangential(const Vec3d& v, const Vec3d& n) { return v - n * dot(v, n); }

/// 0 below `low`, 1 above `high`, smooth between.
inline double smooth_step(double low, double high, double x) {
  const double s = std::fmin(std::fmax((x - low) / (high - low), 0.0), 1.0);
  return s * s * (3 - 2 * s);
}

/// A local flow pattern about `centre`, strongest (about `spin` and `spread`) at 0.7 `radius` from there and gone at
/// 2.5 `radius`. `spin` turns counter-clockwise seen from outside; `spread` > 0 is a source, < 0 a sink.
struct Eddy {
  Vec3d centre;
  double radius = 1;
  double spin = 0;
  double spread = 0;

  Vec3d operator()(const Vec3d& point, const Vec3d& normal) const {
    const Vec3d r = (point - centre) / radius;
    const double r2 = dot(r, r);
    if (r2 > 9) return {};
    return (cross(normal, r) * spin + r * spread) * (2.33 * std::exp(-r2));
  }
};

/// The sum of `eddies` at a point.
Vec3d sum_of(const std::vector<Eddy>& eddies, const Vec3d& point, const Vec3d& normal);

/// Triangles between lattice points on the boundary of a box, counted in cells from its low corner.
struct LatticeBox {
  std::vector<Int3> points;
  std::vector<Triangle> triangles;
};

/// The boundary of a box of `nx` x `ny` x `nz` cells as a closed, outward wound triangulation without poles. The
/// diagonals point to the middle of each face, so that a face may be bent into a disk.
LatticeBox lattice_box(int nx, int ny, int nz);

}  // namespace nacre
