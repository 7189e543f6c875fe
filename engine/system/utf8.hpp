// Nacre: UTF-8 text that may be invalid: its code points, and its valid part.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace nacre {

/// Removes the first code point from `text`, which must not be empty. Bytes that are not UTF-8 give U+FFFD, one byte
/// each; control characters give a space.
inline char32_t take_code_point(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80         ? 1
                             : first >> 5 == 0x6  ? 2
                             : first >> 4 == 0xE  ? 3
                             : first >> 3 == 0x1E ? 4
                                                  : 0;
  constexpr char32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
  char32_t point = length == 1 ? first : first & (0x7F >> length);
  bool whole = length > 0 && length <= text.size();
  for (std::size_t i = 1; whole && i < length; ++i) {
    whole = (byte(i) & 0xC0) == 0x80;
    point = (point << 6) | (byte(i) & 0x3F);
  }
  const bool surrogate = point >= 0xD800 && point < 0xE000;
  if (!whole || point < smallest[length] || point > 0x10FFFF || surrogate) {
    text.remove_prefix(1);
    return 0xFFFD;
  }
  text.remove_prefix(length);
  return point < 0x20 || point == 0x7F ? U' ' : point;
}

/// As much of `text` as fits into `most` bytes, in whole characters that any reader accepts: what is not UTF-8 (or not
/// a character) becomes U+FFFD, a control character a space.
inline std::string in_utf8(std::string_view text, std::size_t most = std::string_view::npos) {
  std::string out;
  while (!text.empty()) {
    std::string_view character = text;
    const char32_t point = take_code_point(text);
    character.remove_suffix(text.size());
    if (point == U' ') character = " ";
    if (point >= 0xFFFD && point <= 0xFFFF) character = "\xEF\xBF\xBD";
    if (out.size() + character.size() > most) break;
    out += character;
  }
  return out;
}

}  // namespace nacre
