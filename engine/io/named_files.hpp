// Nacre: the files that other files name.
#pragma once

#include <filesystem>
#include <vector>

namespace nacre {

/// The files beside `inputs` that are read with them: the steps of a .pvd or .series, the pieces of a .pvtp or .pvtu,
/// the data of a .nhdr or .mhd, the other half of a .hdr or .img. What only VTK reads is not looked into. Throws Error
/// as the readers do.
std::vector<std::filesystem::path> named_files(const std::vector<std::filesystem::path>& inputs);

}  // namespace nacre
