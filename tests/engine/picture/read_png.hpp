// Nacre: PNG files as tests read them back.
#pragma once

#include <filesystem>

#include "engine/picture/image.hpp"

namespace nacre {

/// Any PNG, as RGBA with 8 bits a channel. Throws std::runtime_error where the file is not a whole PNG.
Image read_png(const std::filesystem::path& file);

}  // namespace nacre
