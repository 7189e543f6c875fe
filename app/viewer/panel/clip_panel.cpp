// Nacre: clip planes in the panel, and the handle by which one is dragged in the view.
#include "app/viewer/panel/clip_panel.hpp"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_widgets.hpp"

namespace nacre {
namespace {

constexpr ImU32 ink = IM_COL32(255, 170, 20, 255), shade = IM_COL32(0, 0, 0, 150);

ImVec2 point_of(const std::array<double, 2>& pixel) { return {float(pixel[0]), float(pixel[1])}; }

float grip_radius() { return 0.6f * ImGui::GetFontSize(); }

/// An invisible round part of the view that can be dragged.
struct Grip {
  bool hovered, active, taken;
};
Grip grip(const char* name, const std::array<double, 2>& at, float radius) {
  ImGui::SetNextWindowPos(ImVec2(float(at[0]) - radius, float(at[1]) - radius));
  ImGui::SetNextWindowSize(ImVec2(2 * radius, 2 * radius));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  Grip grip{};
  if (ImGui::Begin(name, nullptr, bare_window)) {
    ImGui::InvisibleButton("grip", ImVec2(2 * radius, 2 * radius));
    grip = {ImGui::IsItemHovered(), ImGui::IsItemActive(), ImGui::IsItemActivated()};
    if (grip.hovered || grip.active) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  return grip;
}

void line(ImDrawList& list, const std::array<double, 2>& from, const std::array<double, 2>& to, float width) {
  list.AddLine(point_of(from), point_of(to), shade, width + 2);
  list.AddLine(point_of(from), point_of(to), ink, width);
}

void draw_outline(ImDrawList& list, const std::vector<Vec3d>& outline, const PictureArea& picture) {
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const auto from = picture.pixel_of(outline[k]), to = picture.pixel_of(outline[(k + 1) % outline.size()]);
    if (from && to) line(list, *from, *to, 1.5f);
  }
}

/// Seen end on, its head is a ring around the handle.
void draw_arrow(ImDrawList& list, const std::array<double, 2>& from, const std::array<double, 2>& tip, float head,
                bool lit) {
  const double dx = tip[0] - from[0], dy = tip[1] - from[1], far = std::hypot(dx, dy);
  const ImU32 colour = lit ? IM_COL32_WHITE : ink;
  if (far < 1.5 * double(head)) {
    list.AddCircle(point_of(tip), head, shade, 0, 5);
    return list.AddCircle(point_of(tip), head, colour, 0, 2.5f);
  }
  const double ux = dx / far, uy = dy / far, r = double(head);
  const std::array<double, 2> neck{tip[0] - ux * r, tip[1] - uy * r};
  line(list, from, neck, 2.5f);
  const ImVec2 left(float(neck[0] - uy * 0.6 * r), float(neck[1] + ux * 0.6 * r)),
      right(float(neck[0] + uy * 0.6 * r), float(neck[1] - ux * 0.6 * r)),
      point(float(tip[0] + ux * 0.6 * r), float(tip[1] + uy * 0.6 * r));
  list.AddTriangleFilled(left, right, point, colour);
  list.AddTriangle(left, right, point, shade);
}

std::string plane_name(std::size_t number, const Vec3d& n) {
  return fmt::format("{}: to {:.2f} {:.2f} {:.2f}###plane", number + 1, n.x + 0.0, n.y + 0.0, n.z + 0.0);
}

/// Moves a plane along its normal as far as the box reaches.
void position_slider(WorldPlane& plane, const BoxCorners& box) {
  const auto [low, high] = offset_range(plane.normal, box);
  double offset = plane.offset();
  if (ImGui::SliderScalar("##position", ImGuiDataType_Double, &offset, &low, &high, "%.4g",
                          ImGuiSliderFlags_AlwaysClamp))
    plane.point += plane.normal * (offset - plane.offset());
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive()) ImGui::SetTooltip("position along the normal");
}

}  // namespace

void ClipPanel::choose_one_of(const ViewSettings& view, int planes) {
  chosen_ = std::min(chosen_, planes - 1);  // with an empty list, the plane of the axis
  if (chosen_ == axis_plane && view.clip == PlaneAxis::none && planes > 0) chosen_ = 0;
}

void ClipPanel::add(ViewSettings& view, std::span<const Vec3d> corners, const Vec3d& normal) {
  std::vector<WorldPlane> planes = parse_clip_planes(view.clip_planes);
  if (corners.empty() || planes.size() >= most_clip_planes) return;
  const BoxCorners box = bounding_corners(corners);
  planes.push_back({normal, (box.front() + box.back()) * 0.5});
  view.clip_planes = clip_planes_text(planes);
  chosen_ = int(planes.size()) - 1;
}

void ClipPanel::add_facing(Settings& settings, std::span<const Vec3d> corners, const Camera& camera) {
  add(settings.view, corners, camera.forward());
  settings.view.panel = true;
  settings.view.tab = PanelTab::look;
  opens_ = true;
}

/// A plane a row: chosen by a click on its name.
void ClipPanel::rows(ViewSettings& view, std::span<const Vec3d> corners, const Camera& camera) {
  std::vector<WorldPlane> planes = parse_clip_planes(view.clip_planes);
  const BoxCorners box = bounding_corners(corners);
  choose_one_of(view, int(planes.size()));
  if (view.clip != PlaneAxis::none && ImGui::RadioButton("across the axis (clip)", chosen_ == axis_plane))
    chosen_ = axis_plane;
  std::optional<std::size_t> removed;
  bool changed = false;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    WorldPlane& plane = planes[k];
    const WorldPlane before = plane;
    ImGui::PushID(int(k));
    if (ImGui::RadioButton(plane_name(k, plane.normal).c_str(), chosen_ == int(k))) chosen_ = int(k);
    ImGui::SetNextItemWidth(0.4f * ImGui::GetContentRegionAvail().x);
    position_slider(plane, box);
    ImGui::SameLine();
    if (ImGui::Button("flip")) plane.normal = -plane.normal;
    ImGui::SameLine();
    if (ImGui::Button("face")) plane.normal = camera.forward();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("turn it towards the camera");
    ImGui::SameLine();
    if (ImGui::Button("remove")) removed = k;
    ImGui::PopID();
    changed = changed || !(plane.normal == before.normal && plane.point == before.point);
  }
  if (removed) planes.erase(planes.begin() + std::ptrdiff_t(*removed));
  if (changed || removed) view.clip_planes = clip_planes_text(planes);
}

void ClipPanel::draw(Settings& settings, std::span<const Vec3d> corners, const Camera& camera) {
  if (std::exchange(opens_, false)) {
    ImGui::SetNextItemOpen(true);
    ImGui::SetScrollHereY();
  }
  if (!ImGui::CollapsingHeader("clip")) return;
  drawn_ = true;
  for (const char* name : {"clip", "clip_at", "clip_back", "back_faces"}) knob_widget(settings, name);
  if (corners.empty()) return;
  text("add a plane:");
  const auto offer = [&](const char* label, const char* help, const Vec3d& normal) {
    ImGui::SameLine();
    if (ImGui::Button(label)) add(settings.view, corners, normal);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
  };
  ImGui::PushID("add");
  offer("facing", "facing the camera; key c", camera.forward());
  offer("x", "across the x axis", {1, 0, 0});
  offer("y", "across the y axis", {0, 1, 0});
  offer("z", "across the z axis", {0, 0, 1});
  ImGui::PopID();
  rows(settings.view, corners, camera);
}

/// The plane as the mouse has it now; none: nobody drags it.
std::optional<WorldPlane> ClipPanel::dragged(const WorldPlane& plane, const BoxCorners& box,
                                             const PictureArea& picture) {
  const double arrow = 5 * double(ImGui::GetFontSize()) * picture.pixel_size(plane.point);
  const auto middle = picture.pixel_of(plane.point), tip = picture.pixel_of(plane.point + plane.normal * arrow);
  if (!middle || !tip) return {};
  const bool turns = chosen_ != axis_plane;
  const float radius = grip_radius();
  const Grip push = grip("clip plane", *middle, radius);  // the first lies over the second
  const Grip turn = turns ? grip("clip plane's direction", *tip, 1.5f * radius) : Grip{};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  draw_arrow(list, *middle, *tip, 1.5f * radius, turn.hovered || turn.active);
  list.AddCircleFilled(point_of(*middle), radius, push.hovered || push.active ? IM_COL32_WHITE : ink);
  list.AddCircle(point_of(*middle), radius, shade, 0, 1.5f);
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto take = [&](const std::array<double, 2>& at, bool by_tip) {
    held_ = Held{plane, by_tip, {double(mouse.x) - at[0], double(mouse.y) - at[1]}};
  };
  if (push.taken) take(*middle, false);
  if (turn.taken) take(*tip, true);
  if (!push.active && !turn.active) held_.reset();
  if (!held_) return {};
  const double x = double(mouse.x) - held_->offset[0], y = double(mouse.y) - held_->offset[1];
  return held_->turns ? turned_to(held_->plane, arrow, picture, x, y) : pushed_to(held_->plane, box, picture, x, y);
}

void ClipPanel::draw_handle(ViewSettings& view, std::span<const Vec3d> corners, const PictureArea& picture) {
  if (!std::exchange(drawn_, false) || corners.empty()) return held_.reset();
  std::vector<WorldPlane> planes = parse_clip_planes(view.clip_planes);
  choose_one_of(view, int(planes.size()));
  const std::optional<WorldPlane> axis = axis_clip_plane(view, corners);
  if (chosen_ == axis_plane ? !axis : planes.empty()) return held_.reset();
  const BoxCorners box = bounding_corners(corners);
  WorldPlane plane = chosen_ == axis_plane ? *axis : planes[std::size_t(chosen_)];
  const std::optional<Vec3d> handle = handle_of(plane, box);
  if (!handle) return held_.reset();
  if (!held_) plane.point = *handle;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const FreeArea& area = picture.area;
  list.PushClipRect(ImVec2(float(area.x), float(area.y)),
                    ImVec2(float(area.x + area.width), float(area.y + area.height)));
  draw_outline(list, plane_outline(plane, box), picture);
  const std::optional<WorldPlane> moved = dragged(plane, box, picture);
  list.PopClipRect();
  if (!moved) return;
  if (chosen_ == axis_plane) {
    const int a = int(view.clip) - 1;
    const double low = box.front()[a], high = box.back()[a];
    if (high > low) view.clip_at = std::clamp((moved->point[a] - low) / (high - low), 0.0, 1.0);
  } else {
    planes[std::size_t(chosen_)] = *moved;
    view.clip_planes = clip_planes_text(planes);
  }
}

}  // namespace nacre
