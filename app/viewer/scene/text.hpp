// Nacre: numbers as people read them.
#pragma once

#include <fmt/format.h>

#include <string>

namespace nacre {

/// 1234567 as 1,234,567.
inline std::string grouped(long long number) {
  std::string digits = fmt::format("{}", number);
  const std::size_t sign = number < 0 ? 1 : 0;
  for (std::size_t end = digits.size(); end > sign + 3; end -= 3) digits.insert(end - 3, ",");
  return digits;
}

}  // namespace nacre
