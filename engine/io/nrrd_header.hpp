// Nacre: checks a NRRD header before teem opens what it names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace nacre {

/// Where a NRRD stores its values.
struct NrrdStorage {
  std::vector<std::filesystem::path> files;  ///< detached data files, all regular; empty if there are none
  std::uintmax_t bytes = 0;                  ///< of these files, or of what follows the header
  std::uintmax_t header_bytes = 0;           ///< up to the values, if they follow it
};

/// Reads the text of the header. Throws Error if the file is not a NRRD, or if a data file is missing, is not regular
/// (a pipe or device would never end), or is named by a pattern that does not contain exactly one number.
NrrdStorage look_into_nrrd(const std::filesystem::path& path);

}  // namespace nacre
