// Nacre: how the picture is cut into the view and the slices of a volume.
#include "app/viewer/scene/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace nacre {

Vec3d parse_crosshair(const std::string& text) {
  std::istringstream stream(text);
  Vec3d shares;
  if (!(stream >> shares.x >> shares.y >> shares.z)) return Vec3d(0.5);
  for (int a = 0; a < 3; ++a) shares[a] = std::clamp(shares[a], 0.0, 1.0);
  return shares;
}

std::string crosshair_text(const Vec3d& shares) {
  return fmt::format("{:.6g} {:.6g} {:.6g}", shares.x, shares.y, shares.z);
}

ViewAreas view_areas(ViewLayout layout, bool slices, const FreeArea& area) {
  ViewAreas areas{area, true, {}};
  if (!slices || layout == ViewLayout::single) return areas;
  if (layout != ViewLayout::slices) {
    areas.has_view = false;
    areas.slices[std::size_t(layout) - std::size_t(ViewLayout::x)] = area;
    return areas;
  }
  const int left = area.width / 2, top = area.height / 2, right = area.width - left, bottom = area.height - top;
  areas.slices[2] = {area.x, area.y, left, top};
  areas.view = {area.x + left, area.y, right, top};
  areas.slices[1] = {area.x, area.y + top, left, bottom};
  areas.slices[0] = {area.x + left, area.y + top, right, bottom};
  return areas;
}

}  // namespace nacre
