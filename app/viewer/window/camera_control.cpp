// Nacre: the camera of the viewer.
#include "app/viewer/window/camera_control.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/render/camera_motion.hpp"

namespace nacre {

void move_camera(Camera& camera, Turning turning, const FreeArea& area, double extent, const FindSurface& find) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return;
  const double dx = 2 * io.MouseDelta.x / std::max(1, area.width);
  const double dy = -2 * io.MouseDelta.y / std::max(1, area.height);
  if (dx == 0 && dy == 0 && io.MouseWheel == 0) return;
  if (io.MouseDown[1] || io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift))
    camera = pan(camera, dx, dy, area.aspect());
  else if (io.MouseDown[0])
    camera = turning == Turning::trackball ? turn_ball(camera, dx, dy) : turn_table(camera, dx, dy);
  if (io.MouseWheel == 0) return;
  const auto [x, y] = position_in(area, io.MousePos.x, io.MousePos.y);
  const auto [from, along] = ray_under(camera, x, y, area.aspect());
  if (const std::optional<Vec3d> met = find(from, along)) camera = look_at_depth(camera, *met);
  double factor = std::pow(0.88, double(io.MouseWheel));
  if (extent > 0) factor = limited_zoom(camera, factor, extent);
  camera = dolly(camera, factor, x, y, area.aspect());
}

}  // namespace nacre
