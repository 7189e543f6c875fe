// Nacre: search in ascending lists, on both backends.
#pragma once

#include "compute/device/backend.hpp"

namespace nacre {

/// The first place in [low, high) of an ascending list whose value is not below `value`; `high` where there is none.
template <class Value, class Index>
NACRE_HD inline Index first_not_below(const Value* list, Index low, Index high, Value value) {
  while (low < high) {
    const Index middle = low + (high - low) / 2;
    if (list[middle] < value)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

}  // namespace nacre
