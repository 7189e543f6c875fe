// Nacre: bricks of test volumes on a device, and looks into them from there.
#pragma once

#include <algorithm>
#include <vector>

#include "compute/device/random.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/tighten.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {

inline constexpr float wide_range = 40;  ///< of indicator functions: none is cut off

/// What the pipeline makes of a volume before it looks for distances; `width` of the smoothing of labels. Of indicator
/// functions the differences count: they are kept in units of `range`.
template <class Backend>
MaterialBricks bricks_of(Executor<Backend>& exec, const MeshVolume& volume, double width = 1.2,
                         CubicKernel kernel = CubicKernel::catmull_rom, TightenResult* result = nullptr,
                         float range = wide_range, double staircase = 32) {
  const Vec3d& s = volume.spacing;
  MaterialBricks b = lay_out_bricks(exec, volume.dims, s / std::min({s.x, s.y, s.z}), kernel, volume.material);
  if (volume.kind == MeshVolume::Kind::labels) {
    const TightenResult r = tighten(exec, b, width, staircase);
    if (result) *result = r;
  } else if (volume.kind == MeshVolume::Kind::indicators) {
    fill_indicators(exec, b, volume.material.numbers(), volume.values, range);
  } else {
    fill_scalar(exec, b, volume.values[0], volume.levels, 1, 0);
  }
  return b;
}

struct SamplePoint {
  MaterialBricksView field;
  const Vec3f* point;
  std::uint32_t material;
  FieldCurvature* sample;
  NACRE_HD void operator()(std::int64_t i) const {
    sample[i] = CubicStencil(field, point[i]).curvature(field, material);
  }
};

template <class Backend>
std::vector<FieldCurvature> sample_all(Executor<Backend>& exec, const MaterialBricks& b,
                                       const std::vector<Vec3f>& points, std::uint32_t material) {
  Arena::Scope scope(exec.arena());
  Array<Vec3f> in = exec.arena().template temporary<Vec3f>(points.size());
  in.upload(points);
  Array<FieldCurvature> out = exec.arena().template temporary<FieldCurvature>(points.size());
  exec.for_each(std::int64_t(points.size()), SamplePoint{b.view(), in.data(), material, out.data()});
  return out.download();
}

/// Material 1's function minus material 0's, in the units of an indicator volume.
template <class Backend>
std::vector<FieldCurvature> differences_at(Executor<Backend>& exec, const MaterialBricks& b,
                                           const std::vector<Vec3f>& points) {
  std::vector<FieldCurvature> d = sample_all(exec, b, points, 1);
  const std::vector<FieldCurvature> low = sample_all(exec, b, points, 0);
  for (std::size_t k = 0; k < d.size(); ++k) {
    d[k].value = (d[k].value - low[k].value) * wide_range;
    d[k].gradient = (d[k].gradient - low[k].gradient) * wide_range;
    d[k].xx = (d[k].xx - low[k].xx) * wide_range;
    d[k].yy = (d[k].yy - low[k].yy) * wide_range;
    d[k].zx = (d[k].zx - low[k].zx) * wide_range;
  }
  return d;
}

struct FindMaterial {
  MaterialBricksView field;
  const Vec3f* point;
  std::uint32_t* material;
  NACRE_HD void operator()(std::int64_t i) const { material[i] = material_at(field, point[i]); }
};

template <class Backend>
std::vector<std::uint32_t> materials_at(Executor<Backend>& exec, const MaterialBricks& b,
                                        const std::vector<Vec3f>& points) {
  Arena::Scope scope(exec.arena());
  Array<Vec3f> in = exec.arena().template temporary<Vec3f>(points.size());
  in.upload(points);
  Array<std::uint32_t> out = exec.arena().template temporary<std::uint32_t>(points.size());
  exec.for_each(std::int64_t(points.size()), FindMaterial{b.view(), in.data(), out.data()});
  return out.download();
}

/// Voxels whose centre is not in their own material.
struct StrayVoxels {
  MaterialBricksView field;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const {
    const Int3 n = field.voxels();
    const Int3 voxel(int(i % n.x), int(i / n.x % n.y), int(i / n.x / n.y));
    const Vec3f v = Vec3f(voxel) + Vec3f(0.5f), u = field.cells_per_unit, p(v.x / u.x, v.y / u.y, v.z / u.z);
    return field.inside(p, 2) && material_at(field, p) != field.material(voxel) ? 1 : 0;
  }
};

template <class Backend>
std::uint64_t stray_voxels(Executor<Backend>& exec, const MaterialBricks& b) {
  return exec.reduce(b.voxel_count(), std::uint64_t(0), StrayVoxels{b.view()}, Add{});
}

/// A point brought onto an interface; direction zero where that failed.
struct BringOnto {
  MaterialBricksView field;
  Junction junction;
  const Vec3f* point;
  JunctionPoint* on;
  NACRE_HD void operator()(std::int64_t i) const {
    JunctionPoint at;
    if (!project(field, junction, point[i], 2, at)) at.direction = Vec3f();
    on[i] = at;
  }
};

template <class Backend>
std::vector<JunctionPoint> bring_onto(Executor<Backend>& exec, const MaterialBricks& b, const Junction& junction,
                                      const std::vector<Vec3f>& points) {
  Arena::Scope scope(exec.arena());
  Array<Vec3f> in = exec.arena().template temporary<Vec3f>(points.size());
  in.upload(points);
  Array<JunctionPoint> out = exec.arena().template temporary<JunctionPoint>(points.size());
  exec.for_each(std::int64_t(points.size()), BringOnto{b.view(), junction, in.data(), out.data()});
  return out.download();
}

inline double degrees_between(const Vec3f& a, const Vec3f& b) {
  return std::acos(std::min(1.0, std::fabs(double(dot(a, b)))) / 1.0) * 180 / M_PI;
}

template <class T>
T median_of(std::vector<T> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace nacre::test
