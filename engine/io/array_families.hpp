// Nacre: time steps that a file stores as arrays: Velocity_000h, Velocity_006h, ...
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
  std::vector<std::string> warnings;  ///< about families that were not used
};

/// A name such as "Velocity_006h", split into its parts.
struct NumberedName {
  std::string base;  ///< "Velocity"
  std::string unit;  ///< "h"
  double number = 0;
};

/// Splits a name into a base, perhaps a separator, a number, and perhaps one or two letters. False if it has another
/// form.
bool split_numbered_name(const std::string& name, NumberedName& parts);

/// Finds families: names with the same base, unit and number of components; at least two vectors or three others. If
/// families have different numbers, the longest list wins. Families of scalars alone make no series if the file has
/// vectors that do not change, since species and modes are numbered, too.
ArrayFamilies find_array_families(const std::vector<PointArray>& arrays);

/// Stores member `step` of each family under its base name and removes the other members.
void select_step(Surface& surface, const ArrayFamilies& families, std::size_t step);

}  // namespace nacre
