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
#include "engine/io/file_bytes.hpp"

namespace nacre {
namespace {

// zlib packs at most 1032 bytes into one.
constexpr std::size_t zlib_ratio = 1032;

constexpr std::array<std::int8_t, 256> base64_digits = [] {
  std::array<std::int8_t, 256> digits{};
  digits.fill(-1);
  constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < alphabet.size(); ++i) digits[static_cast<unsigned char>(alphabet[i])] = std::int8_t(i);
  return digits;
}();

/// Reads the stored bytes in order. Base64 may consist of several pieces, each with its own padding.
class ByteStream {
 public:
  ByteStream(std::string_view stored, bool base64) : stored_(stored), base64_(base64) {}

  /// An upper bound of the bytes that can follow.
  std::size_t at_most() const { return base64_ ? held_ + (stored_.size() - at_) / 4 * 3 : stored_.size() - at_; }

  bool read(char* out, std::size_t count) {
    if (!base64_) {
      if (count > stored_.size() - at_) return false;
      std::memcpy(out, stored_.data() + at_, count);
      at_ += count;
      return true;
    }
    while (count > 0) {
      if (held_ == 0 && !decode_four()) return false;
      const std::size_t taken = std::min(count, held_);
      std::memcpy(out, group_.data() + (group_size_ - held_), taken);
      held_ -= taken;
      out += taken;
      count -= taken;
    }
    return true;
  }

 private:
  /// Decodes four characters to up to three bytes.
  bool decode_four() {
    std::uint32_t bits = 0;
    int digits = 0, padding = 0;
    while (digits + padding < 4) {
      if (at_ == stored_.size()) return false;
      const unsigned char c = static_cast<unsigned char>(stored_[at_]);
      if (c == ' ' || (c >= '\t' && c <= '\r')) {
        ++at_;
        continue;
      }
      if (c == '=' && digits >= 2) {
        ++padding;
        bits <<= 6;
      } else if (base64_digits[c] >= 0 && padding == 0) {
        ++digits;
        bits = bits << 6 | std::uint32_t(base64_digits[c]);
      } else {
        return false;
      }
      ++at_;
    }
    group_ = {char(bits >> 16), char(bits >> 8), char(bits)};
    group_size_ = held_ = std::size_t(3 - padding);
    return true;
  }

  std::string_view stored_;
  bool base64_;
  std::size_t at_ = 0;
  std::array<char, 3> group_{};
  std::size_t group_size_ = 0;
  std::size_t held_ = 0;
};

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
