// Nacre: times of the data between two.
#pragma once

#include <vector>

#include "engine/scene/surface/vectors_in_time.hpp"

namespace nacre {

/// From `from` to `from + duration`, ascending or descending: all steps of the data between, in every cycle where these
/// come round, and at least `intervals` equal intervals. Vectors are linear in time between two of them; analytic ones
/// nearly, at 64 times in a unit of time.
std::vector<double> moments(const VectorsInTime& input, double from, double duration, int intervals);

}  // namespace nacre
