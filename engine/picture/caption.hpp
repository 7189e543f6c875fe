// Nacre: legend and time stamp of a picture of flow: the same for pictures without OpenGL and for the viewer.
#pragma once

#include <optional>
#include <string>

#include "engine/picture/colormap.hpp"
#include "engine/picture/image.hpp"
#include "engine/picture/legend.hpp"

namespace nacre {

struct FlowCaption {
  const Colormap* map = nullptr;  ///< of the legend; null: none
  double low = 0, high = 1;       ///< at its ends
  LegendScale scale;              ///< how it is read
  std::string title;              ///< above it
  std::optional<double> time;     ///< of the stamp; without it there is no stamp
  double frame_time = 0;          ///< of the data, from frame to frame
};

/// Draws legend and stamp.
void draw_caption(Image& image, const FlowCaption& caption);

}  // namespace nacre
