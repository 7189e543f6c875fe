// Nacre: the time of the last frames.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <thread>

#include "app/clock.hpp"

namespace nacre {

inline constexpr double shortest_frame = 1.0 / 60;  ///< seconds, of one that nobody waits for

/// Sleeps until `seconds` after `begin`: a display without vertical synchronisation, or none at all, shall not cost
/// compute its cores.
inline void rest(double begin, double seconds) {
  const double left = seconds - (now() - begin);
  if (left > 0) std::this_thread::sleep_for(std::chrono::duration<double>(left));
}

class FrameClock {
 public:
  void add(double seconds) {
    kept_[next_] = float(1e3 * seconds);
    next_ = (next_ + 1) % kept_.size();
    count_ = std::min(count_ + 1, kept_.size());
  }

  /// Of those kept; 0: none.
  double mean_seconds() const {
    double sum = 0;
    for (std::size_t k = 0; k < count_; ++k) sum += kept_[k];
    return count_ > 0 ? 1e-3 * sum / double(count_) : 0;
  }

  /// The oldest first.
  std::array<float, 120> milliseconds() const {
    std::array<float, 120> ordered;
    for (std::size_t k = 0; k < kept_.size(); ++k) ordered[k] = kept_[(next_ + k) % kept_.size()];
    return ordered;
  }

 private:
  std::array<float, 120> kept_{};
  std::size_t next_ = 0, count_ = 0;
};

}  // namespace nacre
