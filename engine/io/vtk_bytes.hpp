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
  std::size_t header_bytes = 4;  ///< size of the counts in front of an array: 4 (UInt32) or 8 (UInt64)
  std::string compressor;        ///< as the file names it, empty for none
};

/// Unpacks the array that begins `stored`, which may go on behind it. Returns its values' bytes, in the file's order.
/// Throws Error, naming `path` and `array`, if the data are cut short, damaged, or packed otherwise than with zlib.
std::string unpack_vtk_array(std::string_view stored, bool base64, const VtkEncoding& encoding,
                             const std::filesystem::path& path, const std::string& array);

}  // namespace nacre
