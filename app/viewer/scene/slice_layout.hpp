// Nacre: draws the slices of a volume beside the view, with what is written on them.
#pragma once

#include <array>
#include <string>

#include "app/viewer/scene/layout.hpp"
#include "app/viewer/scene/slice_views.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/render/overlay_pass.hpp"

namespace nacre {

class SliceLayout {
 public:
  /// Into parts of the frame, which is bound as a whole afterwards. `background`: of the picture (a knob).
  void draw(const Framebuffer& frame, SliceViews& slices, const ViewAreas& areas, const std::string& background);

 private:
  /// What a sheet was made for.
  struct Made {
    int width = 0, height = 0;
    std::string text, background;
    bool operator==(const Made&) const = default;
  };
  OverlayPass sheets_[3];
  std::array<Made, 3> made_;
};

}  // namespace nacre
