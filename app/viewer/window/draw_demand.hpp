// Nacre: when a window has to be drawn: where nothing changes, nothing is.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace nacre {

class DrawDemand {
 public:
  /// What a frame shows, as far as it changes by itself.
  struct Shown {
    std::array<int, 2> pixels{};
    std::uint64_t scene = 0;  ///< Scene::version
    std::string progress;     ///< of what is computed; empty: nothing
    std::string state;        ///< of the rest
    bool operator==(const Shown&) const = default;
  };

  /// Is a frame to be drawn at `now` (seconds)? `touched`: the user has done something, or the window has been damaged.
  /// `animates`: something on it changes with time. While it computes and nobody touches it, drawing takes a tenth of
  /// the time at most.
  bool due(double now, const Shown& shown, bool touched, bool animates) {
    if (touched || shown.pixels != shown_.pixels) {
      settling_ = frames_to_settle;
      pause_ = 0;
      return true;
    }
    const bool computes = !shown.progress.empty();
    if (now < end_ + (computes ? 9 * cost_ : 0)) return false;
    if (shown != shown_) {
      if (settling_ == 0) pause_ = animation_pause;
      settling_ = frames_to_settle;
      return true;
    }
    return (settling_ > 0 && now >= end_ + pause_) || (animates && now >= end_ + animation_pause);
  }

  /// That frame was drawn, from `begin` to `end`.
  void drawn(double begin, double end, const Shown& shown) {
    shown_ = shown;
    cost_ = end - begin;
    end_ = end;
    if (settling_ > 0) --settling_;
  }

 private:
  static constexpr int frames_to_settle = 3;      ///< Dear ImGui lays out by what it has measured in the frame before
  static constexpr double animation_pause = 0.1;  ///< seconds from one frame to the next

  Shown shown_;
  double cost_ = 0, end_ = -1e9, pause_ = 0;  ///< seconds
  int settling_ = frames_to_settle;
};

}  // namespace nacre
