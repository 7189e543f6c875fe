// Nacre: colour maps that are known by their names.
#pragma once

#include <string_view>
#include <vector>

#include "engine/picture/oklab.hpp"

namespace nacre {

/// 256 colours in sRGB, from the lowest value to the highest, six hexadecimal digits each. `twilight` is cyclic.
extern const std::string_view viridis_table, cividis_table, twilight_table;

/// Encoded sRGB, from blue over gray to red, computed as in K. Moreland, "Diverging Color Maps for Scientific
/// Visualization", ISVC 2009.
std::vector<Color> coolwarm_colours(int count);

}  // namespace nacre
