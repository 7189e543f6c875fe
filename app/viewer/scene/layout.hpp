// Nacre: how the picture is cut into the view and the slices of a volume. No OpenGL here.
#pragma once

#include <array>
#include <string>

#include "app/viewer/scene/free_area.hpp"
#include "compute/math/vec.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// Where the crosshair of the slices is: "a b c", shares of the volume along its own axes; the middle where that says
/// nothing.
Vec3d parse_crosshair(const std::string& text);
std::string crosshair_text(const Vec3d& shares);

struct ViewAreas {
  FreeArea view;                   ///< of the camera; all of it where slices alone are drawn
  bool has_view = true;            ///< the view is drawn
  std::array<FreeArea, 3> slices;  ///< across x, y and z; without a width: not drawn
};

/// `slices`: the scene has them, else there is the view alone. In quarters: the slice across z, the view; across y,
/// across x.
ViewAreas view_areas(ViewLayout layout, bool slices, const FreeArea& area);

}  // namespace nacre
