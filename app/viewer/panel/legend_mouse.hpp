// Nacre: the colour legend in the picture, changed by the mouse.
#pragma once

#include "app/viewer/scene/free_area.hpp"
#include "app/viewer/scene/scene.hpp"

namespace nacre {

/// Dragging the upper or lower third of the bar changes that end of the range, the middle both. A double click opens
/// the knobs of the colours beside it, a right click gives the range of the data back.
class LegendMouse {
 public:
  /// With Dear ImGui, over the legend of a view in `area`.
  void draw(Settings& settings, const LegendRange& range, const FreeArea& area);
  bool is_hovered() const { return hovered_; }

 private:
  void drag(Settings& settings, const FreeArea& bar);

  bool hovered_ = false;
  LegendRange before_;  ///< when the drag began
  float grabbed_ = 0;   ///< share of the bar from above
  double pulled_ = 0;   ///< upwards, in heights of the bar
};

/// The range after its part at `grabbed` (share of the bar from above) was pulled up by `pulled` heights of the bar.
LegendRange pulled_range(const LegendRange& range, double grabbed, double pulled);

}  // namespace nacre
