// Nacre: writes the numbers of VTK XML files in base64 between the tags. Fewer readers find appended data: raw ones are
// not XML, and VTK before 9.3 (ParaView 5.11) finds none at all, not even its own, if expat has the fixes of 2024.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/system/output_file.hpp"
#include "engine/system/utf8.hpp"

namespace nacre {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are in memory");

/// Text with only the characters that XML allows, and no markup.
inline std::string xml_escaped(const std::string& text) {
  std::string out;
  for (const char c : in_utf8(text)) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

/// How a file came about (engine/run/origin.hpp), as a comment; nothing if that is not known.
inline std::string xml_origin(const std::string& origin) {
  return origin.empty() ? std::string() : "<!-- " + origin + " -->\n";
}

/// Writes bytes to a file as base64 text.
class Base64Text {
 public:
  explicit Base64Text(OutputFile& file) : file_(file) {}

  void write(const void* data, std::size_t bytes) {
    const auto* from = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < bytes; ++i) {
      held_ = held_ << 8 | from[i];
      if (++count_ == 3) put(4);
    }
  }

  /// Writes the rest, padded. To be called once, at the end.
  void finish() {
    if (count_ > 0) {
      const int digits = count_ + 1;
      held_ <<= 8 * (3 - count_);
      put(digits);
      text_.append(std::size_t(4 - digits), '=');
    }
    file_.write(text_);
    text_.clear();
  }

 private:
  void put(int digits) {
    static constexpr char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int k = 0; k < digits; ++k) text_ += alphabet[held_ >> (18 - 6 * k) & 63];
    held_ = 0;
    count_ = 0;
    if (text_.size() >= 1 << 16) {
      file_.write(text_);
      text_.clear();
    }
  }

  OutputFile& file_;
  std::string text_;
  std::uint32_t held_ = 0;
  int count_ = 0;  ///< bytes in held_
};

/// The blocks of numbers. Each is announced first, which leaves a gap in the XML; the gap is filled when the XML is
/// written.
class Inline {
 public:
  /// The XML element of a block of `bytes` that `write` will write into the file.
  std::string announce(const std::string& type, const std::string& name, int components, std::uint64_t bytes,
                       std::function<void(Base64Text&)> write) {
    blocks_.push_back({bytes, std::move(write)});
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}{}{}</DataArray>\n", type,
        xml_escaped(name), components, gap, blocks_.size() - 1, gap);
  }

  /// `xml` contains the elements that were announced, in any order.
  void write(OutputFile& file, const std::string& xml) const {
    std::size_t begin = 0;
    for (std::size_t left; (left = xml.find(gap, begin)) != xml.npos;) {
      const std::size_t right = xml.find(gap, left + 1);
      file.write(xml.substr(begin, left - begin));
      const Block& block = blocks_.at(std::stoul(xml.substr(left + 1, right - left - 1)));
      Base64Text text(file);
      text.write(&block.bytes, sizeof block.bytes);
      block.write(text);
      text.finish();
      begin = right + 1;
    }
    file.write(xml.substr(begin));
  }

 private:
  struct Block {
    std::uint64_t bytes;
    std::function<void(Base64Text&)> write;
  };
  static constexpr char gap = '\1';  ///< marks both sides of a block's number; it does not occur in text (xml_escaped)
  std::vector<Block> blocks_;
};

/// Writes value(0), value(1), ... value(count - 1) through a small buffer.
template <class Index, class Value>
void write_generated(Base64Text& file, std::uint64_t count, const Value& value) {
  std::vector<Index> buffer(std::min<std::uint64_t>(count, 1 << 16));
  for (std::uint64_t begin = 0; begin < count; begin += buffer.size()) {
    const std::uint64_t n = std::min<std::uint64_t>(buffer.size(), count - begin);
    for (std::uint64_t i = 0; i < n; ++i) buffer[i] = Index(value(begin + i));
    file.write(buffer.data(), n * sizeof(Index));
  }
}

/// One DataArray of `count` integers from `lower` to `upper`, 32-bit if that is wide enough.
template <class Value>
std::string announce_numbers(Inline& numbers, const std::string& name, std::uint64_t count, std::int64_t lower,
                             std::int64_t upper, Value value) {
  using Narrow = std::numeric_limits<std::int32_t>;
  if (lower >= Narrow::min() && upper <= Narrow::max())
    return numbers.announce("Int32", name, 1, 4 * count,
                            [=](Base64Text& file) { write_generated<std::int32_t>(file, count, value); });
  return numbers.announce("Int64", name, 1, 8 * count,
                          [=](Base64Text& file) { write_generated<std::int64_t>(file, count, value); });
}

/// The same for indices from 0 to `largest`.
template <class Value>
std::string announce_indices(Inline& numbers, const char* name, std::uint64_t count, std::uint64_t largest,
                             Value value) {
  return announce_numbers(numbers, name, count, 0, std::int64_t(largest), value);
}

/// An integer per cell, computed when it is written.
struct CellNumbers {
  std::string name;
  std::int64_t lower = 0, upper = 0;  ///< range of what `of` returns
  std::function<std::int64_t(std::uint64_t cell)> of;
};

/// The CellData of `cells` cells; empty if there are no arrays.
inline std::string announce_cell_data(Inline& numbers, std::uint64_t cells, std::span<const CellNumbers> arrays) {
  if (arrays.empty()) return {};
  std::string xml = "<CellData>\n";
  for (const CellNumbers& a : arrays) xml += announce_numbers(numbers, a.name, cells, a.lower, a.upper, a.of);
  return xml + "</CellData>\n";
}

}  // namespace nacre
