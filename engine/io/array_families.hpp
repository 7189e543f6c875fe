// Nacre: time steps that a file keeps as arrays: Velocity_000h, Velocity_006h, ...
#pragma once

#include <string>
#include <vector>

#include "engine/scene/surface/surface.hpp"

namespace nacre {

/// Arrays that are one quantity at several times.
struct ArrayFamily {
  std::string base;                  ///< "Velocity"
  std::vector<std::string> members;  ///< full names, in the order of time
};

/// The families of a file that share one list of times.
struct ArrayFamilies {
  std::vector<double> times;  ///< empty if the file has no families
  std::vector<ArrayFamily> families;
  std::vector<std::string> warnings;  ///< about families that were left alone
};

/// A name such as "Velocity_006h", taken apart.
struct NumberedName {
  std::string base;  ///< "Velocity"
  std::string unit;  ///< "h"
  double number = 0;
};

/// Takes a name apart: a base, perhaps a separator, a number, perhaps one or two letters. False if it is not so built.
bool split_numbered_name(const std::string& name, NumberedName& parts);

/// Finds families: names with the same base, unit and number of components; at least two vectors or three others.
/// Where families have different numbers the longest wins. Families of scalars alone make no series where the file has
/// vectors that do not change: species and modes are numbered, too.
ArrayFamilies find_array_families(const std::vector<PointArray>& arrays);

/// Puts member `step` of each family under its base name and drops the other members.
void select_step(Surface& surface, const ArrayFamilies& families, std::size_t step);

}  // namespace nacre
