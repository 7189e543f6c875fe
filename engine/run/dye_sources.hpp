// Nacre: where dye is put on a surface.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/scene/surface/prepare.hpp"
#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// One part of the knob `dye`.
struct DyeSource {
  std::string text;          ///< as it was written
  std::vector<Vec3d> curve;  ///< points within `radius` of it: a ball, if it is one point
  double radius = 0;
  bool box = false;  ///< between `low` and `high`
  Vec3d low, high;
  std::string array;  ///< else: points where it is not 0,
  bool by_value = false;
  double value = 0;  ///< or is this
};

/// Dyes are separated by bars, and the sources of one by semicolons: "X,Y,Z,R" a ball, "X,Y,Z/.../X,Y,Z,R" a curve with
/// that radius, "X,Y,Z:X,Y,Z" a box, "ARRAY" or "ARRAY=VALUE" the points with such a value. Throws Error that names
/// `dye`.
std::vector<std::vector<DyeSource>> parse_dyes(const std::string& text);

/// The points of the triangles, in the numbers of `triangles`, that lie in a source; ascending. `first`: the surface
/// with its arrays. Throws Error where no point lies in a source, which says how far the nearest is, and where there is
/// no such array.
std::vector<std::uint32_t> points_in(const DyeSource& source, const PreparedSurface& shape,
                                     const std::vector<Triangle>& triangles, const Surface& first);

}  // namespace nacre
