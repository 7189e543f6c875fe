// Nacre: bytes stored as they are, or as base64.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace nacre {

/// zlib packs at most 1032 bytes into one.
inline constexpr std::size_t zlib_ratio = 1032;

/// The value of each character of base64; -1 for others.
inline constexpr std::array<std::int8_t, 256> base64_digits = [] {
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

  /// All that follows, up to the first character that is not base64.
  std::string rest() {
    std::string out;
    out.reserve(at_most());
    for (char c = 0; read(&c, 1);) out += c;
    return out;
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

}  // namespace nacre
