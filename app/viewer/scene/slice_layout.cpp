// Nacre: draws the slices of a volume beside the view, with what is written on them.
#include "app/viewer/scene/slice_layout.hpp"

#include <algorithm>
#include <cmath>

#include "app/viewer/scene/captions.hpp"
#include "engine/picture/lettering.hpp"
#include "engine/picture/text.hpp"

namespace nacre {
namespace {

Image caption_sheet(const SliceCaption& caption, int width, int height, const Rgba& paper) {
  Image sheet = clear_sheet(width, height, paper);
  const auto byte = [](float c) { return std::uint8_t(std::lround(255 * c)); };
  const Rgba ink{byte(caption.colour[0]), byte(caption.colour[1]), byte(caption.colour[2]), 255};
  const int line = std::max(1, height / 250);
  fill_box(sheet, 0, 0, width, line, ink);
  fill_box(sheet, 0, height - line, width, line, ink);
  fill_box(sheet, 0, 0, line, height, ink);
  fill_box(sheet, width - line, 0, line, height, ink);
  const float pixels = lettering_size(width, height);
  if (pixels <= 0) return sheet;
  const int capitals = text_cap_height(pixels), edge = 2 * line + capitals / 2;
  const Ink letters = ink_on(paper);
  const auto write = [&](int x, int y, const std::string& text) { draw_lettering(sheet, x, y, text, pixels, letters); };
  const auto middle = [&](const std::string& text) { return (width - text_width(text, pixels)) / 2; };
  write(edge, (height - capitals) / 2, caption.left);
  write(width - edge - text_width(caption.right, pixels), (height - capitals) / 2, caption.right);
  write(middle(caption.top), edge, caption.top);
  write(middle(caption.bottom), height - edge - capitals, caption.bottom);
  write(edge, height - edge - capitals, text_to_fit(caption.position, pixels, middle(caption.bottom) - 2 * edge));
  return sheet;
}

}  // namespace

void SliceLayout::draw(const Framebuffer& frame, SliceViews& slices, const ViewAreas& areas,
                       const std::string& background) {
  for (int k = 0; k < 3; ++k) {
    const FreeArea& area = areas.slices[std::size_t(k)];
    if (area.width <= 0 || area.height <= 0) continue;
    frame.bind_part(area.x, frame.height() - area.y - area.height, area.width, area.height);
    View view;
    view.camera = slices.camera(k, area.aspect());
    view.width = area.width;
    view.height = area.height;
    slices.draw(k, view);
    const SliceCaption caption = slices.caption(k);
    const Made wanted{area.width, area.height,
                      caption.position + '\n' + caption.left + caption.right + caption.bottom + caption.top,
                      background};
    Made& made = made_[std::size_t(k)];
    if (made != wanted) sheets_[k].set_image(caption_sheet(caption, area.width, area.height, paper_of(background)));
    made = wanted;
    sheets_[k].draw(view);
  }
  frame.bind();
}

}  // namespace nacre
