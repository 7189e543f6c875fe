// Nacre: reads words and numbers from text, fast and independent of the locale.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace nacre {

/// Reads text once, from front to back. Words are separated by white space; `comment` (if any) hides the rest of its
/// line.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text, char comment = '\0')
      : begin_(text.data()), at_(text.data()), end_(text.data() + text.size()), comment_(comment) {}

  /// True when nothing but white space and comments is left.
  bool at_end() {
    skip_blank();
    return at_ == end_;
  }

  std::size_t remaining() const { return std::size_t(end_ - at_); }

  /// Number of the current line, from 1. Scans the text from its start: for messages only.
  std::size_t line() const {
    std::size_t lines = 1;
    for (const char* p = begin_; p < at_; ++p) lines += *p == '\n';
    return lines;
  }

  /// The next word, empty at the end.
  std::string_view word() {
    skip_blank();
    const char* first = at_;
    while (at_ < end_ && !is_blank(*at_) && !starts_comment()) ++at_;
    return {first, std::size_t(at_ - first)};
  }

  /// The next word as a number; NaN and infinities are numbers. False, without moving, if it is not a number.
  bool number(double& value) {
    skip_blank();
    const char* first = at_ < end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [last, code] = std::from_chars(first, end_, value);
    if (code == std::errc::result_out_of_range) value = std::numeric_limits<double>::quiet_NaN();
    if (last != first && code != std::errc::invalid_argument &&
        (last == end_ || is_blank(*last) || *last == comment_)) {
      if (code == std::errc::result_out_of_range) value = is_tiny(first, last) ? 0.0 : value;
      at_ = last;
      return true;
    }
    return foreign_nan(value);
  }

  /// The next word as an integer. False, without moving, if it is not one or too large.
  bool integer(std::int64_t& value) {
    skip_blank();
    const char* first = at_ < end_ && *at_ == '+' ? at_ + 1 : at_;
    const auto [last, code] = std::from_chars(first, end_, value);
    if (code != std::errc{} || !(last == end_ || is_blank(*last) || *last == comment_)) return false;
    at_ = last;
    return true;
  }

  /// The rest of the current line; moves past its end.
  std::string_view rest_of_line() {
    const char* first = at_;
    while (at_ < end_ && *at_ != '\n') ++at_;
    const std::string_view line(first, std::size_t(at_ - first));
    if (at_ < end_) ++at_;
    return line;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  bool starts_comment() const { return comment_ != '\0' && *at_ == comment_; }

  void skip_blank() {
    while (at_ < end_) {
      if (is_blank(*at_))
        ++at_;
      else if (starts_comment())
        while (at_ < end_ && *at_ != '\n') ++at_;
      else
        return;
    }
  }

  static bool is_tiny(const char* first, const char* last) {
    const std::string_view word(first, std::size_t(last - first));
    return word.find("e-") != word.npos || word.find("E-") != word.npos;
  }

  /// "1.#QNAN" and "-1.#INF", as some old C libraries print NaN and infinity.
  bool foreign_nan(double& value) {
    const char* start = at_;
    while (at_ < end_ && !is_blank(*at_)) ++at_;
    const std::string_view text(start, std::size_t(at_ - start));
    if (text.find(".#") != text.npos) {
      value = std::numeric_limits<double>::quiet_NaN();
      return true;
    }
    at_ = start;
    return false;
  }

  const char* begin_;
  const char* at_;
  const char* end_;
  char comment_;
};

}  // namespace nacre
