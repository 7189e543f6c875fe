// Nacre: round numbers along an axis, and the format of numbers in a picture.
#include "engine/picture/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

namespace nacre {
namespace {

/// Narrower ranges, relative to the values, are noise of single precision.
constexpr double narrowest = 1e-6;

std::string with_true_minus(const std::string& number) {
  std::string text;
  for (const char c : number) text += c == '-' ? std::string("\u2212") : std::string(1, c);
  return text;
}

int decade(double value) { return int(std::floor(std::log10(value) + 1e-9)); }

/// Labels up to 99999 and down to 0.001 are written out; beyond that, thousands are factored out.
int exponent_for(double magnitude) {
  if (!(magnitude > 0)) return 0;
  const int e = decade(magnitude);
  return e >= -3 && e < 5 ? 0 : int(std::floor(e / 3.0)) * 3;
}

double nice_step(double range, int count) {
  const double raw = range / count;
  const double power = std::pow(10.0, decade(raw));
  for (const double factor : {1.0, 2.0, 5.0})
    if (raw <= factor * power * (1 + 1e-9)) return factor * power;
  return 10 * power;
}

}  // namespace

Ticks log_ticks(double min, double max, int count) {
  Ticks ticks;
  if (!(min > 0) || !(max > min) || !std::isfinite(max)) return nice_ticks(min, max, count);
  const int first = int(std::floor(std::log10(min))), last = int(std::ceil(std::log10(max)));
  const auto take = [&](std::initializer_list<int> factors, int stride) {
    ticks.values.clear();
    for (int e = first; e <= last; ++e)
      for (const int factor : factors) {
        const double value = factor * std::pow(10.0, e);
        if (e % stride == 0 && value >= min * (1 - 1e-9) && value <= max * (1 + 1e-9)) ticks.values.push_back(value);
      }
  };
  take({1, 2, 5}, 1);
  for (int stride = 1; int(ticks.values.size()) > count + 1 && stride <= last - first; ++stride) take({1}, stride);
  if (ticks.values.size() < 2) return nice_ticks(min, max, count);
  for (const double value : ticks.values) ticks.labels.push_back(short_number(value, 3));
  return ticks;
}

std::string fixed_number(double value, int decimals) {
  const std::string number = fmt::format("{:.{}f}", value, decimals);
  const bool is_zero = number.find_first_of("123456789") == std::string::npos;
  return with_true_minus(is_zero && number[0] == '-' ? number.substr(1) : number);
}

std::string power_of_ten(int exponent) {
  static const char* const raised[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                       "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
  std::string text = exponent < 0 ? "\u00d710\u207b" : "\u00d710";
  for (const char digit : std::to_string(std::abs(exponent))) text += raised[digit - '0'];
  return text;
}

std::string short_number(double value, int digits) {
  const std::string number = fmt::format("{:.{}g}", value, digits);
  const auto e = number.find('e');
  if (e == std::string::npos) return with_true_minus(number);
  return with_true_minus(number.substr(0, e)) + power_of_ten(std::stoi(number.substr(e + 1)));
}

Ticks nice_ticks(double min, double max, int count) {
  Ticks ticks;
  if (min > max) std::swap(min, max);
  const double range = max - min, magnitude = std::max(std::abs(min), std::abs(max));
  if (!std::isfinite(range)) return ticks;
  if (range < narrowest * magnitude || range < 1e-290) {
    ticks.values = {min + range / 2};
    ticks.labels = {short_number(ticks.values[0], 6)};
    return ticks;
  }
  ticks.exponent = exponent_for(magnitude);
  const double step = nice_step(range, std::max(count, 2)), unit = std::pow(10.0, ticks.exponent);
  const int decimals = std::max(0, ticks.exponent - decade(step));
  const double first = std::ceil(min / step - 1e-6), last = std::floor(max / step + 1e-6);
  for (double i = first; i <= last; ++i) {
    ticks.values.push_back(std::clamp(i * step, min, max));
    ticks.labels.push_back(fixed_number(i * step / unit, decimals));
  }
  return ticks;
}

}  // namespace nacre
