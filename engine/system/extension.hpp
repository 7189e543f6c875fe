// Nacre: the extension of a file name.
#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace nacre {

/// With its dot and in lower case: ".vtp" for a.VTP; empty if there is none.
inline std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace nacre
