// Nacre: the time or iteration of a scene: what a transport bar shows. No Dear ImGui here.
#pragma once

#include <cstddef>
#include <vector>

namespace nacre {

/// Positions are whole numbers from `first` to `last`: steps of a flow between the first time of the data and the last,
/// or iterations of the particles of a mesh.
struct Transport {
  enum class Kind { none, time, iterations };
  Kind kind = Kind::none;
  int first = 0, last = 0;
  int shown = -1;                  ///< position that is seen; -1: nothing is seen yet
  std::vector<bool> warm;          ///< from `first` on: can this position be shown at once?
  bool warming = false;            ///< what is seen at `shown` is still without its texture
  bool ended = false;              ///< it has come to the end and does not begin again
  double start = 0, per_step = 0;  ///< time of the data at position 0, and from one to the next; 0: steady
  std::vector<double> data_times;  ///< at which the data have values

  bool moves() const { return last > first; }
  double time_of(int position) const { return start + per_step * position; }
  bool is_warm(int position) const {
    const auto k = std::size_t(position - first);
    return position >= first && k < warm.size() && warm[k];
  }
};

/// The value of the knob `begin_at` whose first frame is that of `position`; `steps`: from the first time to the last.
inline double begin_at_of(int position, int steps) {
  const int skipped = position > 0 ? position - 1 : steps - 1;  // the first time comes again after the last
  return double(skipped < 0 ? 0 : skipped) / (steps > 0 ? steps : 1);
}

}  // namespace nacre
