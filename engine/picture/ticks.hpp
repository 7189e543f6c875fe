// Nacre: round numbers along an axis, and how numbers are written in a picture.
#pragma once

#include <string>
#include <vector>

namespace nacre {

/// Marks on an axis: `labels[i]` times 10^exponent is `values[i]`.
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
  int exponent = 0;  ///< a multiple of 3; not 0 only where plain labels would be long
};

/// At most about `count` (at least 2) ticks at multiples of 1, 2 or 5 times a power of ten within [min, max]. Where the
/// range is too narrow to be told apart in single precision there is one tick, at its middle; none where an end is not
/// finite.
Ticks nice_ticks(double min, double max, int count);

/// The value with `decimals` digits after the point and a true minus sign.
std::string fixed_number(double value, int decimals);

/// The value with `digits` significant digits, trailing zeros dropped; with a power of ten where it is very large or
/// very small.
std::string short_number(double value, int digits);

/// "×10⁻³" for -3.
std::string power_of_ten(int exponent);

}  // namespace nacre
