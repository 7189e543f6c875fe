// Nacre: the camera of the viewer.
#include "app/viewer/camera_control.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/viewer/panel.hpp"
#include "app/viewer/scene.hpp"
#include "engine/render/camera_motion.hpp"

namespace nacre {
namespace {

void use_mouse(Camera& camera, int width, int height) {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse) return;
  const double across = std::max(1.0f, io.DisplaySize.x), down = std::max(1.0f, io.DisplaySize.y);
  const double aspect = double(width) / std::max(1, height);
  const double dx = 2 * io.MouseDelta.x / across, dy = -2 * io.MouseDelta.y / down;
  const bool moves = io.MouseDown[1] || io.MouseDown[2] || (io.MouseDown[0] && io.KeyShift);
  if (moves)
    camera = pan(camera, dx, dy, aspect);
  else if (io.MouseDown[0])
    camera = turn_table(camera, dx, dy);
  if (io.MouseWheel != 0)
    camera = dolly(camera, std::pow(0.88, double(io.MouseWheel)), 2 * io.MousePos.x / across - 1,
                   1 - 2 * io.MousePos.y / down, aspect);
}

void look_from(Camera& camera, const char* view, const Scene& scene, int width, int height) {
  if (scene.corners().empty()) return;
  const bool orthographic = camera.orthographic;
  camera = fit_camera(view, scene.corners(), width, height);
  camera.orthographic = orthographic;
}

/// All of the scene again, from where it is looked at now.
void fit(Camera& camera, const Scene& scene) {
  if (scene.corners().empty()) return;
  Vec3d low = scene.corners().front(), high = low;
  for (const Vec3d& p : scene.corners()) low = min(low, p), high = max(high, p);
  const Vec3d middle = (low + high) * 0.5, forward = camera.forward();
  const double radius = std::max(0.5 * length(high - low), 1e-30), distance = 9 * radius;
  camera.eye = middle - forward * distance;
  camera.target = middle;
  camera.height = 2.1 * radius;
}

}  // namespace

KeyWishes control_camera(Session& session, const Scene& scene, PanelState& state, int width, int height) {
  if (!session.camera) return {};
  Camera& camera = *session.camera;
  Look& look = session.settings.look;
  use_mouse(camera, width, height);
  ImGuiIO& io = ImGui::GetIO();
  KeyWishes wishes;
  if (io.WantTextInput) return wishes;
  for (const ImWchar key : io.InputQueueCharacters) switch (key) {
      case 'q': wishes.quit = true; break;
      case 'f': fit(camera, scene); break;
      case 'i': look_from(camera, "iso", scene, width, height); break;
      case 'x': look_from(camera, "+x", scene, width, height); break;
      case 'X': look_from(camera, "-x", scene, width, height); break;
      case 'y': look_from(camera, "+y", scene, width, height); break;
      case 'Y': look_from(camera, "-y", scene, width, height); break;
      case 'z': look_from(camera, "+z", scene, width, height); break;
      case 'Z': look_from(camera, "-z", scene, width, height); break;
      case 'o': camera.orthographic = !camera.orthographic; break;
      case 'e': look.edges = !look.edges; break;
      case 'p': look.panel = !look.panel; break;
      case '?': state.help = !state.help; break;
      case ' ': look.play = !look.play; break;
      default: break;
    }
  return wishes;
}

}  // namespace nacre
