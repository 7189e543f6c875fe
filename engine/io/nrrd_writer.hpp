// Nacre: writes volumes as NRRD.
#pragma once

#include <filesystem>

#include "engine/scene/volume/volume.hpp"

namespace nacre {

/// Writes one .nrrd file with header and data: little-endian, in the type of the values, with space, axes, spacing and
/// origin. Integers are compressed (gzip), other types are not. Throws Error for another extension and if writing
/// fails.
void write_nrrd(const std::filesystem::path& file, const Volume& volume);

}  // namespace nacre
