// Nacre: the bytes of one VTK XML array: raw or base64, plain or in zlib blocks.
#pragma once

#include <bit>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace nacre {

/// How a VTK XML file stores its binary arrays.
struct VtkEncoding {
  std::endian order = std::endian::little;
  std::size_t header_bytes = 4;  ///< size of the counts before an array: 4 (UInt32) or 8 (UInt64)
  std::string compressor;        ///< as the file names it, empty for none
};

/// Unpacks the array at the beginning of `stored`, which may continue after it. Returns the bytes of its values, in the
/// file's byte order. Throws Error with `path` and `array` if the data are truncated, damaged, or not packed with zlib.
std::string unpack_vtk_array(std::string_view stored, bool base64, const VtkEncoding& encoding,
                             const std::filesystem::path& path, const std::string& array);

}  // namespace nacre
