// Nacre: sums of floating-point numbers that do not depend on the order of their terms, nor on who adds which of them.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

namespace nacre {

/// The exact sum of doubles, as a fixed-point number long enough for all of them (Kulisch). Several are added up by
/// adding their words, as 64-bit integers that wrap around: so processes get the sum of all their terms by Ranks::sum.
class ExactSum {
 public:
  /// Numbers that are not finite count as 0.
  void add(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const auto exponent = int(bits >> 52 & 0x7ff);
    std::uint64_t mantissa = bits & ((std::uint64_t(1) << 52) - 1);
    if (exponent == 0x7ff) return;
    if (exponent > 0) mantissa |= std::uint64_t(1) << 52;
    const int shift = exponent > 0 ? exponent - 1 : 0, first = shift / 32, offset = shift % 32;
    const std::uint64_t low = (mantissa & 0xffffffff) << offset, high = (mantissa >> 32) << offset;
    const std::uint64_t part[3] = {low & 0xffffffff, (low >> 32) + (high & 0xffffffff), high >> 32};
    for (int k = 0; k < 3; ++k) {
      std::uint64_t& word = word_[std::size_t(first + k)];
      word = bits >> 63 ? word - part[k] : word + part[k];
    }
    if (++added_ == most_added) carry();
  }

  void add(const ExactSum& other) {
    carry();
    ExactSum reduced = other;
    reduced.carry();
    for (std::size_t k = 0; k < words; ++k) word_[k] += reduced.word_[k];
    added_ += 2;
  }

  /// To be added to those of others.
  std::span<std::uint64_t> raw() {
    carry();
    return word_;
  }

  /// Rounded, the same for the same terms in whatever order.
  double value() const {
    ExactSum sum = *this;
    sum.carry();
    const bool negative = std::int64_t(sum.word_[words - 1]) < 0;
    if (negative) {
      for (std::uint64_t& word : sum.word_) word = 0 - word;
      sum.carry();
    }
    std::size_t top = words;
    while (top > 0 && sum.word_[top - 1] == 0) --top;
    double value = 0;
    for (std::size_t k = top; k > 0 && k + 4 > top; --k)
      value += std::ldexp(double(sum.word_[k - 1]), 32 * int(k - 1) - 1074);
    return negative ? -value : value;
  }

 private:
  static constexpr std::size_t words = 68;  // of 32 bits, from 2^-1074 on; the rest of each is for carries
  static constexpr std::uint32_t most_added = 1u << 29;

  /// Leaves 32 bits in each word but the last, which has the sign.
  void carry() {
    for (std::size_t k = 0; k + 1 < words; ++k) {
      word_[k + 1] += std::uint64_t(std::int64_t(word_[k]) >> 32);
      word_[k] &= 0xffffffff;
    }
    added_ = 0;
  }

  std::array<std::uint64_t, words> word_{};
  std::uint32_t added_ = 0;
};

}  // namespace nacre
