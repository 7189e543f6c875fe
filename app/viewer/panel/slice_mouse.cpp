// Nacre: what the mouse does to the slices of the layout.
#include "app/viewer/panel/slice_mouse.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <cmath>

#include "app/viewer/panel/imgui_text.hpp"
#include "engine/render/camera_motion.hpp"

namespace nacre {
namespace {

/// Where a plane through the camera's target that faces it is under the mouse.
Vec3d point_under_mouse(const Camera& camera, const FreeArea& area) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto [x, y] = position_in(area, double(mouse.x), double(mouse.y));
  return point_under(camera, x, y, area.aspect());
}

void tell(const ProbeResult& probed, const FreeArea& area) {
  ImGui::SetNextWindowPos(ImVec2(float(area.x) + 8, float(area.y) + 8));
  ImGui::SetNextWindowBgAlpha(0.7f);
  const auto quiet = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("under the cursor", nullptr, quiet))
    for (const std::string& line : probed.lines) text(line);
  ImGui::End();
}

}  // namespace

void SliceMouse::use(int k, ViewSettings& view, SliceViews& slices, const FreeArea& area) {
  const ImGuiIO& io = ImGui::GetIO();
  const Camera camera = slices.camera(k, area.aspect());
  ImGui::InvisibleButton("slice", ImVec2(float(area.width), float(area.height)));
  const bool hovered = ImGui::IsItemHovered();
  if (hovered && ImGui::IsMouseDoubleClicked(0)) {
    const ViewLayout alone = ViewLayout(int(ViewLayout::x) + k);
    view.layout = view.layout == alone ? ViewLayout::slices : alone;
    view.crosshair = before_;
    drags_ = false;
  } else if (ImGui::IsItemActivated()) {
    before_ = view.crosshair;
    drags_ = true;
  }
  if (drags_ && ImGui::IsItemActive()) view.crosshair = slices.crosshair_at(k, point_under_mouse(camera, area));
  if (!hovered) return;
  double& turned = turned_[std::size_t(k)];
  turned += double(io.MouseWheel);
  if (const int steps = int(turned); steps != 0) {
    turned -= steps;
    view.crosshair = slices.crosshair_after(k, steps);
  }
  const Vec3d point = point_under_mouse(camera, area), forward = camera.forward();
  const std::optional<ProbeResult> probed = slices.probe(k, point - forward * camera.height, forward);
  if (!probed) return;
  under_ = probed->position;
  if (!ImGui::IsItemActive()) tell(*probed, area);
}

void SliceMouse::draw(ViewSettings& view, SliceViews& slices, const ViewAreas& areas) {
  under_.reset();
  for (int k = 0; k < 3; ++k) {
    const FreeArea& area = areas.slices[std::size_t(k)];
    if (area.width <= 0 || area.height <= 0) continue;
    ImGui::SetNextWindowPos(ImVec2(float(area.x), float(area.y)));
    ImGui::SetNextWindowSize(ImVec2(float(area.width), float(area.height)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    const bool shown =
        ImGui::Begin(fmt::format("slice {}", k).c_str(), nullptr, bare_window | ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    if (shown) use(k, view, slices, area);
    ImGui::End();
  }
}

}  // namespace nacre
