// Nacre: the camera of the viewer.
#include "app/viewer/camera_control.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "engine/render/camera_motion.hpp"

namespace nacre {

void move_camera(Camera& camera, const std::string& turning) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return;
  const double across = std::max(1.0f, io.DisplaySize.x), down = std::max(1.0f, io.DisplaySize.y);
  const double aspect = across / down;
  const double dx = 2 * io.MouseDelta.x / across, dy = -2 * io.MouseDelta.y / down;
  const bool moves = io.MouseDown[1] || io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift);
  if (dx == 0 && dy == 0 && io.MouseWheel == 0) return;
  if (moves)
    camera = pan(camera, dx, dy, aspect);
  else if (io.MouseDown[0])
    camera = turning == "trackball" ? turn_ball(camera, dx, dy) : turn_table(camera, dx, dy);
  if (io.MouseWheel != 0)
    camera = dolly(camera, std::pow(0.88, double(io.MouseWheel)), 2 * io.MousePos.x / across - 1,
                   1 - 2 * io.MousePos.y / down, aspect);
}

void look_from(Camera& camera, const std::string& view, std::span<const Vec3d> points, int width, int height) {
  if (points.empty()) return;
  const bool orthographic = camera.orthographic;
  camera = fit_camera(view, points, width, height);
  camera.orthographic = orthographic;
}

void fit(Camera& camera, std::span<const Vec3d> points) {
  if (points.empty()) return;
  Vec3d low = points.front(), high = low;
  for (const Vec3d& p : points) low = min(low, p), high = max(high, p);
  const Vec3d middle = (low + high) * 0.5, forward = camera.forward();
  const double radius = std::max(0.5 * length(high - low), 1e-30), distance = 9 * radius;
  camera.eye = middle - forward * distance;
  camera.target = middle;
  camera.height = 2.1 * radius;
}

}  // namespace nacre
