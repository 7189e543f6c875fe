// Nacre: colour maps, computed to be perceptually uniform and safe for colour-blind readers.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace nacre {

/// 256 colours in encoded sRGB, 0..1, from the lowest value to the highest. A cyclic map's last colour is one step
/// before its first.
struct Colormap {
  std::string name;
  std::string kind;  ///< sequential, diverging, cyclic or gray
  std::vector<std::array<float, 3>> table;
};

/// The colour map of that name. Throws Error (with the list of names) where there is none.
const Colormap& colormap(const std::string& name);

/// Every name, the default one first.
std::vector<std::string> colormap_names();

}  // namespace nacre
