// Nacre: how far two words are apart, for "did you mean".
#pragma once

#include <cstddef>
#include <string_view>

namespace nacre {

/// Number of letters to put in, take out or exchange to make one word of the other. Of each no more than 64 count.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace nacre
