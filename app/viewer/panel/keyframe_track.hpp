// Nacre: keyframes on an axis of time, to be pulled, and the time that is seen.
#pragma once

#include <imgui.h>

#include <optional>

#include "engine/scene/session/keyframes.hpp"

namespace nacre {

class KeyframeTrack {
 public:
  /// Pixels that it is high, with the lettering of now.
  static float height();

  /// What the user does to it in this frame.
  struct Wish {
    std::optional<double> scrub;  ///< to see this time
    std::optional<int> select;    ///< a row
    std::optional<double> move;   ///< the selected row, to this time: when it is let go
    bool go = false;              ///< a double click on the selected row
  };
  /// With Dear ImGui, as wide as there is room.
  Wish draw(const Keyframes& list, std::optional<int> selected, double playhead);

 private:
  /// Where times are on the screen.
  struct Axis {
    ImVec2 low, high;
    float row, left, wide;
    double end;
    float x_of(double time) const { return left + wide * float(time / end); }
    double seconds_per_pixel() const { return end / double(wide); }
    float camera_lane() const { return low.y + 1.5f * row; }
    float knob_lane() const { return low.y + 2.4f * row; }
  };
  struct Mark {
    int row;
    bool camera;
    double begin, end;  ///< seconds
  };

  Axis place(const Keyframes& list, double playhead);
  static void ruler(const Axis& axis);
  void marks(const Axis& axis, const Keyframes& list, std::optional<int> selected) const;
  static void mark(const Axis& axis, const Mark& mark, bool selected);
  static std::optional<int> row_under(const Axis& axis, const Keyframes& list);
  static double time_under(const Axis& axis, const Keyframes& list);
  Wish use(const Axis& axis, const Keyframes& list, std::optional<int> selected);

  double end_ = 0;             ///< of the axis: it stands still while something is pulled
  std::optional<int> pulled_;  ///< a row
  double by_ = 0;              ///< seconds that it has been pulled
  bool scrubs_ = false;
};

}  // namespace nacre
