// Nacre: a first look into a NRRD header, before teem opens what it names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace nacre {

/// Where a NRRD keeps its values.
struct NrrdStorage {
  std::vector<std::filesystem::path> files;  ///< detached data files, all regular ones; empty where there are none
  std::uintmax_t bytes = 0;                  ///< of these files, or of what follows the header
};

/// Reads the header's text. Throws Error if the file is no NRRD, or if a data file is missing, is no regular file (a
/// pipe or device would never end), or is named by a pattern that is not one number.
NrrdStorage look_into_nrrd(const std::filesystem::path& path);

}  // namespace nacre
