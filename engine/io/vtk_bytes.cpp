// Nacre: decodes base64 and zlib blocks of VTK XML files.
#include "engine/io/vtk_bytes.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "engine/io/byte_order.hpp"
#include "engine/io/byte_stream.hpp"
#include "engine/io/file_bytes.hpp"

namespace nacre {
namespace {

/// One array being unpacked, with what its error messages need.
class Unpacker {
 public:
  Unpacker(std::string_view stored, bool base64, const VtkEncoding& encoding, const std::filesystem::path& path,
           const std::string& array)
      : stream_(stored, base64), encoding_(encoding), path_(path), array_(array) {}

  std::string plain() {
    const std::size_t size = read_count();
    if (size > stream_.at_most()) fail("is cut short");
    std::string values(size, '\0');
    read(values.data(), size);
    return values;
  }

  std::string zlib_blocks() {
    const std::size_t blocks = read_count();
    if (blocks == 0) return {};
    const std::size_t block_size = read_count();
    const std::size_t last_size = read_count();
    if (blocks > stream_.at_most() / encoding_.header_bytes) fail("is cut short");
    std::vector<std::size_t> packed_sizes(blocks);
    std::size_t packed_total = 0;
    for (std::size_t& size : packed_sizes) {
      size = read_count();
      const std::size_t left = stream_.at_most();  // decreases, since the sizes themselves are part of the stream
      if (packed_total > left || size > left - packed_total) fail("is cut short");
      packed_total += size;
    }
    const std::size_t most = packed_total * zlib_ratio;
    const std::size_t full_blocks = last_size > 0 ? blocks - 1 : blocks;
    if (last_size > most || (full_blocks > 0 && block_size > most / full_blocks))
      fail("promises more than its packed data can hold");
    std::string values;
    std::string packed, block;
    for (std::size_t i = 0; i < blocks; ++i) {
      packed.resize(packed_sizes[i]);
      read(packed.data(), packed.size());
      block.resize(i + 1 == blocks && last_size > 0 ? last_size : block_size);
      uLongf unpacked = uLongf(block.size());
      const int state = uncompress(reinterpret_cast<Bytef*>(block.data()), &unpacked,
                                   reinterpret_cast<const Bytef*>(packed.data()), uLong(packed.size()));
      if (state != Z_OK || unpacked != block.size()) fail("has a damaged zlib block");
      values += block;
    }
    return values;
  }

  [[noreturn]] void fail(const char* what) const { fail_reading(path_, fmt::format("array '{}' {}", array_, what)); }

 private:
  void read(char* out, std::size_t count) {
    if (!stream_.read(out, count)) fail("is cut short");
  }

  std::size_t read_count() {
    char bytes[8] = {};
    read(bytes, encoding_.header_bytes);
    return encoding_.header_bytes == 8 ? std::size_t(load_number<std::uint64_t>(bytes, encoding_.order))
                                       : load_number<std::uint32_t>(bytes, encoding_.order);
  }

  ByteStream stream_;
  const VtkEncoding& encoding_;
  const std::filesystem::path& path_;
  const std::string& array_;
};

}  // namespace

std::string unpack_vtk_array(std::string_view stored, bool base64, const VtkEncoding& encoding,
                             const std::filesystem::path& path, const std::string& array) {
  Unpacker unpacker(stored, base64, encoding, path, array);
  if (encoding.compressor.empty()) return unpacker.plain();
  if (encoding.compressor == "vtkZLibDataCompressor") return unpacker.zlib_blocks();
  fail_reading(path, fmt::format("it is packed with {}", encoding.compressor),
               "save it with zlib compression or uncompressed");
}

}  // namespace nacre
