// Nacre: legend and time stamp of a picture of flow.
#include "engine/picture/caption.hpp"

namespace nacre {

void draw_caption(Image& image, const FlowCaption& caption) {
  if (caption.map) draw_legend(image, *caption.map, caption.low, caption.high, caption.title, caption.scale);
  if (caption.time) draw_time(image, *caption.time, "", caption.frame_time);
}

}  // namespace nacre
