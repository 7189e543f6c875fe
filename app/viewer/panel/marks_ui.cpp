// Nacre: ruler, notes and kept cameras: their keys, menus and fields.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "app/viewer/panel/ui.hpp"
#include "app/viewer/scene/marks.hpp"
#include "engine/picture/dye_colours.hpp"
#include "engine/render/camera_motion.hpp"
#include "engine/scene/surface/extent.hpp"

namespace nacre {

/// The point of the scene that the mouse is over; none: it is over a panel, or over nothing.
std::optional<Vec3d> Ui::under_cursor(const Session& session, const UiFacts& facts) {
  if (slice_mouse_.under()) return slice_mouse_.under();
  const ImGuiIO& io = ImGui::GetIO();
  std::optional<ProbeResult> probed;
  const FreeArea& area = facts.pointed.areas.view;
  if (session.camera && facts.pointed.areas.has_view && !io.WantCaptureMouse && ImGui::IsMousePosValid()) {
    const auto [x, y] = position_in(area, io.MousePos.x, io.MousePos.y);
    const auto [from, along] = ray_under(facts.camera, x, y, area.aspect());
    probed = facts.pointed.scene.probe(from, along);
  }
  if (!probed) show_note("point at the surface with the mouse, then press the key");
  return probed ? std::optional(probed->position) : std::nullopt;
}

/// One more point of the ruler; after the third it begins again.
void Ui::measure(Session& session, Scene& scene, const UiFacts& facts) {
  const std::optional<Vec3d> point = under_cursor(session, facts);
  if (!point) return;
  std::string& ruler = session.settings.view.ruler;
  std::vector<Vec3d> points = parse_ruler(ruler);
  if (points.size() >= 3) points.clear();
  points.push_back(*point);
  ruler = ruler_text(points);
  std::string text;
  for (const std::string& line : ruler_lines(points, scene.unit())) text += (text.empty() ? "" : ", ") + line;
  show_note(text.empty() ? "ruler: d at the second point" : "ruler: " + text);
}

/// One more source of the last dye, or of another one.
void Ui::release_dye(Session& session, Scene& scene, const UiFacts& facts, bool another) {
  if (!scene.is_flow()) return show_note("dye: for flows only");
  const std::optional<Vec3d> point = under_cursor(session, facts);
  if (!point) return;
  std::string& dye = session.settings.dye;
  if (another && std::size_t(std::count(dye.begin(), dye.end(), '|')) + 1 >= most_dyes)
    return show_note(fmt::format("dye: there are {} colours", most_dyes));
  constexpr double share = 0.015;  // of the diagonal
  const double radius = share * Extent(scene.corners()).diagonal();
  if (!dye.empty()) dye += another ? '|' : ';';
  dye += fmt::format("{:.6g},{:.6g},{:.6g},{:.3g}", point->x, point->y, point->z, radius);
}

/// One more point of which the panel shows what is there through time.
void Ui::plot_point(Session& session, Scene& scene, const UiFacts& facts) {
  if (!scene.is_flow()) return show_note("graph: for flows only");
  const std::optional<Vec3d> point = under_cursor(session, facts);
  if (!point) return;
  std::string& probe = session.settings.probe;
  if (!probe.empty()) probe += ';';
  probe += fmt::format("{:.6g},{:.6g},{:.6g}", point->x, point->y, point->z);
  show_note("graph: in the tab \"result\"");
}

void Ui::ask_note(Session& session, const UiFacts& facts) {
  note_place_ = under_cursor(session, facts);
  opens_note_ = note_place_.has_value();
  note_.clear();
}

void Ui::note_window(Session& session) {
  if (!note_place_) return;
  constexpr const char* title = "note";
  const bool begins = std::exchange(opens_note_, false);
  if (begins) ImGui::OpenPopup(title);
  if (!ImGui::BeginPopup(title)) {
    note_place_.reset();
    return;
  }
  if (begins) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(20 * ImGui::GetFontSize());
  if (ImGui::InputTextWithHint("##note", "what is here; enter", &note_, ImGuiInputTextFlags_EnterReturnsTrue)) {
    std::string& notes = session.settings.view.notes;
    std::vector<PlacedNote> all = parse_notes(notes);
    if (note_.find_first_not_of(' ') != std::string::npos) all.push_back({*note_place_, note_});
    notes = notes_text(all);
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

void Ui::marks_menu(Session& session) {
  ViewSettings& view = session.settings.view;
  if (!ImGui::BeginMenu("Marks")) return;
  ImGui::TextDisabled("d: ruler, n: note, r: dye, g: graph, at the point under the cursor");
  if (ImGui::MenuItem("Remove all dye", nullptr, false, !session.settings.dye.empty())) session.settings.dye.clear();
  if (ImGui::MenuItem("Remove the ruler", nullptr, false, !view.ruler.empty())) view.ruler.clear();
  if (ImGui::BeginMenu("Remove a note", !view.notes.empty())) {
    std::vector<PlacedNote> notes = parse_notes(view.notes);
    for (std::size_t k = 0; k < notes.size(); ++k)
      if (ImGui::MenuItem(fmt::format("{}##{}", notes[k].text, k).c_str())) {
        notes.erase(notes.begin() + std::ptrdiff_t(k));
        view.notes = notes_text(notes);
        break;
      }
    ImGui::EndMenu();
  }
  ImGui::EndMenu();
}

void Ui::cameras_menu(Session& session) {
  if (!ImGui::BeginMenu("Cameras", session.camera.has_value())) return;
  std::string& text = session.settings.view.cameras;
  std::vector<SavedCamera> kept = parse_cameras(text);
  ImGui::SetNextItemWidth(10 * ImGui::GetFontSize());
  const std::string usual = fmt::format("view {}", kept.size() + 1);
  const bool typed =
      ImGui::InputTextWithHint("##name", usual.c_str(), &camera_name_, ImGuiInputTextFlags_EnterReturnsTrue);
  ImGui::SameLine();
  if (ImGui::Button("keep this one") || typed) {
    kept.push_back({camera_name_.empty() ? usual : camera_name_, *session.camera});
    camera_name_.clear();
    text = cameras_text(kept);
  }
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const std::string key = k < 9 ? fmt::format("{}", k + 1) : "";
    if (ImGui::MenuItem(fmt::format("{}##{}", kept[k].name, k).c_str(), key.c_str())) session.camera = kept[k].camera;
  }
  if (ImGui::BeginMenu("Forget one", !kept.empty())) {
    for (std::size_t k = 0; k < kept.size(); ++k)
      if (ImGui::MenuItem(fmt::format("{}##{}", kept[k].name, k).c_str())) {
        kept.erase(kept.begin() + std::ptrdiff_t(k));
        text = cameras_text(kept);
        break;
      }
    ImGui::EndMenu();
  }
  ImGui::EndMenu();
}

}  // namespace nacre
