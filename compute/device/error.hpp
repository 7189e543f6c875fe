// Nacre: the exceptions of the library, and the user's wish to stop.
#pragma once

#include <atomic>

#include "include/nacre/error.hpp"

namespace nacre {

// An Error names a parameter in backquotes, `min_size`: the program prints it as the option or the knob that it is
// there. Broken promises between our own functions are assertions.

/// Has the user asked to stop? `stop` is set by a signal handler or another thread; null: nobody can ask.
inline bool is_set(const std::atomic<bool>* stop) { return stop && stop->load(std::memory_order_relaxed); }

/// Throws Interrupted where the user has asked to stop.
inline void check_stop(const std::atomic<bool>* stop) {
  if (is_set(stop)) throw Interrupted();
}

}  // namespace nacre
