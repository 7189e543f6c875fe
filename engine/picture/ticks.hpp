// Nacre: round numbers along an axis, and the format of numbers in a picture.
#pragma once

#include <string>
#include <vector>

namespace nacre {

/// Ticks of an axis: `labels[i]` times 10^exponent is `values[i]`.
struct Ticks {
  std::vector<double> values;
  std::vector<std::string> labels;
  int exponent = 0;  ///< a multiple of 3; not 0 only if plain labels would be long
};

/// At most about `count` (at least 2) ticks at multiples of 1, 2 or 5 times a power of ten within [min, max]. If the
/// range is too narrow for single precision, there is one tick at its middle; if an end is not finite, there is none.
Ticks nice_ticks(double min, double max, int count);

/// Ticks of a logarithmic axis, 0 < min < max: at powers of ten, and at 2 and 5 times these where that is not too many;
/// like `nice_ticks` where no power of ten is near.
Ticks log_ticks(double min, double max, int count);

/// The value with `decimals` digits after the point and a true minus sign.
std::string fixed_number(double value, int decimals);

/// The value with `digits` significant digits, without trailing zeros; with a power of ten if it is very large or very
/// small.
std::string short_number(double value, int digits);

/// "×10⁻³" for -3.
std::string power_of_ten(int exponent);

}  // namespace nacre
