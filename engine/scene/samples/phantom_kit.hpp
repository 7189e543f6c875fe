// Nacre: what phantoms are made of: bodies joined on a grid of signed distances, waves for folds, and tubes.
#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/scene/samples/implicit_shapes.hpp"
#include "engine/scene/samples/phantoms.hpp"

namespace nacre {

/// What a definition fills in: one of the two.
struct Phantom {
  std::vector<std::uint8_t> labels;  ///< of a labelled one: 0 is the outside
  std::vector<float> values;         ///< of a scalar one
};

/// The grid of a phantom: voxel centres in the phantom's own unit, which is a voxel at its own detail.
struct PhantomGrid {
  Int3 dims{};
  double unit = 1;  ///< length of a voxel
  const std::atomic<bool>* stop = nullptr;

  Vec3d centre(int i, int j, int k) const { return Vec3d(i, j, k) * unit; }
  std::size_t index(int i, int j, int k) const { return (std::size_t(k) * dims.y + j) * dims.x + i; }
  std::size_t voxels() const { return std::size_t(dims.x) * dims.y * dims.z; }

  /// Calls f(index, centre) for every voxel, on all threads.
  template <class F>
  void for_each(const F& f) const {
    for_each({0, 0, 0}, dims - Int3(1), f);
  }

  /// The same for the voxels from `low` to `high`, both included.
  template <class F>
  void for_each(const Int3& low, const Int3& high, const F& f) const {
    tbb::parallel_for(low.z, high.z + 1, [&](int k) {
      check_stop(stop);
      for (int j = low.y; j <= high.y; ++j)
        for (int i = low.x; i <= high.x; ++i) f(index(i, j, k), centre(i, j, k));
    });
  }
};

/// A point of a tube's centre line. A tall tube is swept by a line along z, half of it above the centre, half below.
struct TubePoint {
  Vec3d centre;
  double radius = 1;
  double tall = 0;
};
using Tube = std::vector<TubePoint>;

/// Signed distances to a body (negative inside), voxel by voxel; right near the surface, at most `reach` outside.
class DistanceGrid {
 public:
  explicit DistanceGrid(const PhantomGrid& grid, double reach = 12)
      : grid_(grid), reach_(reach), values_(grid.voxels(), float(reach)) {}

  float operator[](std::size_t index) const { return values_[index]; }

  /// Joins the body with signed distance `f` inside of the box, its edges filleted by about `fillet`.
  template <class F>
  void unite(const Vec3d& low, const Vec3d& high, const F& f, double fillet = 0) {
    Int3 first, last;
    if (!voxel_range(low, high, first, last)) return;
    grid_.for_each(first, last, [&](std::size_t at, const Vec3d& p) { join(values_[at], f(p), fillet); });
  }

  /// Joins an ellipsoid; its distance is of first order, exact on the surface.
  void unite_ellipsoid(const Vec3d& centre, const Vec3d& semi, double fillet = 0);

  /// Joins tubes, each a chain of round cones. They are rasterised in small boxes, so that long ones cost little.
  void unite_tubes(std::span<const Tube> tubes, double fillet = 0);

 private:
  bool voxel_range(const Vec3d& low, const Vec3d& high, Int3& first, Int3& last) const;
  void join(float& value, double distance, double fillet) const {
    const double d = std::min(distance, reach_);
    value = float(fillet > 0 ? smooth_union(double(value), d, fillet) : std::min(double(value), d));
  }

  PhantomGrid grid_;
  double reach_;
  std::vector<float> values_;
};

/// First-order distance to an ellipsoid: f / |grad f| of f = |p / semi| - 1.
inline double ellipsoid_distance(const Vec3d& p, const Vec3d& semi) {
  const Vec3d u{p.x / semi.x, p.y / semi.y, p.z / semi.z};
  const Vec3d g{u.x / semi.x, u.y / semi.y, u.z / semi.z};
  const double r = length(u), slope = length(g);
  return slope > 1e-12 ? (r - 1) * r / slope : -std::min({semi.x, semi.y, semi.z});
}

/// A random wave field: plane waves of one wave number in all directions, as smooth folds have. Of variance 1.
class Waves {
 public:
  Waves(std::uint32_t seed, int count, double wave_number);

  struct Sample {
    double value;
    Vec3d gradient;
  };
  Sample operator()(const Vec3d& p) const;
  double value(const Vec3d& p) const;

 private:
  std::vector<Vec3f> waves_;
  std::vector<float> phases_;
  float scale_;
};

/// A tree of tubes that grows from `root` to all `leaves`, nearest first, each joining the tree where the way back to
/// the root stays short. Radii shrink with the number of leaves that a branch feeds, down to `twig`, and stop at
/// `trunk`.
std::vector<Tube> grow_tree(const Vec3d& root, std::vector<Vec3d> leaves, double twig, double trunk);

/// Jittered lattice points `apart` from each other for which inside(p) holds.
template <class F>
std::vector<Vec3d> scatter(const Vec3d& low, const Vec3d& high, double apart, std::uint32_t seed, const F& inside);

/// A number in -1..1 for lattice point (i, j, k).
double lattice_random(std::uint32_t seed, int i, int j, int k);

template <class F>
std::vector<Vec3d> scatter(const Vec3d& low, const Vec3d& high, double apart, std::uint32_t seed, const F& inside) {
  std::vector<Vec3d> points;
  const Vec3d size = (high - low) / apart;
  for (int k = 0; k <= int(size.z); ++k)
    for (int j = 0; j <= int(size.y); ++j)
      for (int i = 0; i <= int(size.x); ++i) {
        const Vec3d jitter{lattice_random(seed, i, j, k), lattice_random(seed + 1, i, j, k),
                           lattice_random(seed + 2, i, j, k)};
        const Vec3d p = low + (Vec3d(i, j, k) + jitter * 0.25) * apart;
        if (inside(p)) points.push_back(p);
      }
  return points;
}

/// Gives 6-connected pieces of fewer than `smallest` voxels the label that most of their neighbours have: where sheets
/// and tubes graze each other, crumbs are left over that no anatomy has.
void remove_crumbs(const PhantomGrid& grid, std::vector<std::uint8_t>& labels, std::size_t smallest);

/// Value of a scalar phantom at signed distance `d`: 1 inside, 0 outside, 0.5 on the interface, smooth everywhere.
inline float soft_value(double d) { return float(0.5 - 0.5 * std::tanh(d / 2.5)); }

/// A phantom's definition: what it is, and how it is made on a grid.
struct PhantomDefinition {
  PhantomInfo info;
  void (*make)(const PhantomGrid& grid, Phantom& phantom) = nullptr;
};

PhantomDefinition torso_phantom();
PhantomDefinition head_phantom();
PhantomDefinition heart_phantom();
PhantomDefinition lungs_phantom();
PhantomDefinition ribcage_phantom();
std::vector<PhantomDefinition> analytic_phantoms();

}  // namespace nacre
