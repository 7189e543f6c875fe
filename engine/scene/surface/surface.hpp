// Nacre: a triangulated surface with data on its points, in host memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "compute/math/vec.hpp"

namespace nacre {

/// One named array on the points of a surface: `values[point * components + component]`.
struct PointArray {
  std::string name;
  int components = 1;
  std::vector<float> values;

  std::size_t size() const { return components > 0 ? values.size() / components : 0; }
};

/// Triangles, points (world coordinates, the file's unit) and arrays on the points at one time.
struct Surface {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  std::vector<PointArray> arrays;

  /// The array of that name, or nullptr.
  const PointArray* find(const std::string& name) const {
    for (const PointArray& array : arrays)
      if (array.name == name) return &array;
    return nullptr;
  }
};

/// The shapes of a series that moves.
struct SeriesMotion {
  std::size_t groups = 0;          ///< runs of steps that have the same triangles
  std::vector<std::size_t> group;  ///< of each step, from 0, ascending
  std::vector<Vec3d> low, high;    ///< of each step: the box around its triangles
};

/// A surface over time. One step is a steady surface; `load(k)` may be called in any order and more than once.
struct SurfaceSeries {
  std::string name;                              ///< what to call it: a file name or a sample's name
  std::vector<double> times;                     ///< one per step, increasing; at least one
  std::function<Surface(std::size_t)> load;      ///< throws Error if the step cannot be read
  std::vector<std::string> warnings;             ///< what was dropped or assumed on opening, each a full sentence
  bool moves = false;                            ///< points or triangles differ from step to step
  std::shared_ptr<const SeriesMotion> motion{};  ///< of a series that moves, once `examine_motion` has looked at it

  std::size_t steps() const { return times.size(); }
};

}  // namespace nacre
