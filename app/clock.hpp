// Nacre: the machine's time.
#pragma once

#include <chrono>

namespace nacre {

/// Seconds, of a clock that only goes forward.
inline double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace nacre
