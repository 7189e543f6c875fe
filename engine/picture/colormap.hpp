// Nacre: colour maps, computed to be perceptually uniform and safe for colour-blind readers.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace nacre {

/// 256 colours in encoded sRGB, 0..1, from the lowest value to the highest. The last colour of a cyclic map is one step
/// before its first.
struct Colormap {
  std::string name;
  std::string kind;  ///< sequential, diverging, cyclic or gray
  std::vector<std::array<float, 3>> table;
};

/// The colour map of that name. Throws Error (with the list of names) if there is none.
const Colormap& colormap(const std::string& name);

/// All names, the default one first.
std::vector<std::string> colormap_names();

}  // namespace nacre
