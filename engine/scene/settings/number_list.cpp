// Nacre: numbers in the text of a knob.
#include "engine/scene/settings/number_list.hpp"

#include <charconv>
#include <cmath>

namespace nacre {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  return begin == text.npos ? "" : text.substr(begin, end - begin + 1);
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

std::optional<std::vector<double>> parse_numbers(const std::string& text) {
  std::vector<double> all;
  for (const std::string& part : split(text, ',')) {
    const std::string digits = trimmed(part);
    double value = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value))
      return {};
    all.push_back(value);
  }
  return all;
}

}  // namespace nacre
