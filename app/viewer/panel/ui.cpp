// Nacre: the frame of the user interface: keys, panel, status line.
#include "app/viewer/panel/ui.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/viewer/panel/compare_panel.hpp"
#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_widgets.hpp"
#include "app/viewer/scene/free_area.hpp"
#include "app/viewer/scene/slice_views.hpp"
#include "engine/render/camera_motion.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/samples/samples.hpp"

namespace nacre {
namespace {

/// Pixels that the parts take.
struct Layout {
  float menu, status, panel;
};

Layout layout(const ViewSettings& view, int width) {
  const float row = ImGui::GetFontSize() + 2 * ImGui::GetStyle().FramePadding.y;
  const float wanted = 27 * ImGui::GetFontSize() * float(view.panel_width);
  return {row, 1.6f * row, std::floor(std::min(wanted, 0.6f * float(width)))};
}

bool on_the_right(const ViewSettings& view) { return view.panel_side == PanelSide::right; }

/// The border between panel and picture, to be pulled.
void panel_border(ViewSettings& view, int width, const Layout& l, float high) {
  const float grip = 0.4f * ImGui::GetFontSize(), edge = on_the_right(view) ? float(width) - l.panel : l.panel;
  ImGui::SetNextWindowPos(ImVec2(edge - 0.5f * grip, l.menu));
  ImGui::SetNextWindowSize(ImVec2(grip, high));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  const auto bare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground |
                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("panel border", nullptr, bare)) {
    ImGui::InvisibleButton("grip", ImVec2(grip, high));
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (ImGui::IsItemActive() && ImGui::GetIO().MouseDelta.x != 0) {
      const float by = on_the_right(view) ? -ImGui::GetIO().MouseDelta.x : ImGui::GetIO().MouseDelta.x;
      view.panel_width = std::clamp(view.panel_width + double(by) / (27 * ImGui::GetFontSize()), 0.5, 3.0);
    }
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

/// "12 s", "3:05 min"
std::string lasting(double seconds) {
  const int whole = int(seconds);
  return whole < 100 ? fmt::format("{} s", whole) : fmt::format("{}:{:02} min", whole / 60, whole % 60);
}

const char* job_of(const Session& session) { return is_mesh_input(session) ? "mesh" : "flow"; }

void stage_table(const StageTimers& timers) {
  if (!ImGui::BeginTable("stages", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  for (const char* head : {"stage", "calls", "total s", "mean ms"}) ImGui::TableSetupColumn(head);
  ImGui::TableHeadersRow();
  for (const StageTimers::Stage& stage : timers.stages()) {
    const auto column = [](const std::string& line) {
      ImGui::TableNextColumn();
      text(line);
    };
    column(stage.name);
    column(fmt::format("{}", stage.calls));
    column(fmt::format("{:.2f}", stage.seconds));
    column(fmt::format("{:.1f}", 1e3 * stage.seconds / double(std::max(1L, stage.calls))));
  }
  ImGui::EndTable();
}

void timings_tab(const Scene& scene, const UiFacts& facts) {
  const SceneTotals totals = scene.totals();
  const double frame = facts.clock.mean_seconds();
  text(fmt::format("{:.1f} frames/s, {:.1f} ms drawing", frame > 0 ? 1 / frame : 0, 1e3 * frame));
  const std::array<float, 120> history = facts.clock.milliseconds();
  const float top = std::max(20.0f, *std::max_element(history.begin(), history.end()));
  const std::string slowest =
      fmt::format("the last {}: {:.0f} ms at most", history.size(), *std::max_element(history.begin(), history.end()));
  ImGui::PlotLines("##frames", history.data(), int(history.size()), 0, slowest.c_str(), 0, top,
                   ImVec2(ImGui::GetContentRegionAvail().x, 3 * ImGui::GetFontSize()));
  stage_table(totals.timers);
  ImGui::Spacing();
  ImGui::TextWrapped("compute: %s (%s)", scene.device().name().c_str(), scene.device().backend().c_str());
  ImGui::TextWrapped("drawing: %s", facts.renderer.c_str());
  text(fmt::format("memory: {:.0f} MiB of the device", double(totals.peak_bytes) / (1 << 20)));
  text(fmt::format("copied between compute and drawing: {} bytes", totals.copied_bytes));
}

void sample_choice(Session& session) {
  const auto offer = [&](const std::string& name, const std::string& help) {
    if (ImGui::Selectable(name.c_str(), session.sample == name) && session.sample != name)
      static_cast<SessionInput&>(session) = {{}, name, 0}, session.camera.reset();
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help.c_str());
  };
  if (!ImGui::BeginCombo("sample", session.sample.empty() ? "(a file)" : session.sample.c_str())) return;
  ImGui::TextDisabled("flow on surfaces");
  for (const SampleInfo& sample : samples()) offer(sample.name, sample.help);
  ImGui::TextDisabled("volumes to mesh");
  for (const PhantomInfo& phantom : phantoms()) offer(phantom.name, phantom.help);
  ImGui::EndCombo();
}

void data_tab(Session& session, const Scene& scene, ScenePanel& panel) {
  sample_choice(session);
  if (!session.sample.empty()) {
    ImGui::InputInt("detail", &session.detail, 0, 0, ImGuiInputTextFlags_EnterReturnsTrue);
    session.detail = std::clamp(session.detail, 0, 4096);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("cells along the longest side; 0: its own");
  }
  for (const auto& file : session.inputs) ImGui::TextWrapped("%s", file.string().c_str());
  ImGui::Separator();
  panel.data_tab(session);
  for (const std::string& warning : scene.warnings()) ImGui::TextWrapped("! %s", warning.c_str());
}

void look_tab(Session& session, const Scene& scene, const UiFacts& facts, ClipPanel& clip) {
  facts.panel.look_tab(session);
  Settings& settings = session.settings;
  const auto several = [&](std::initializer_list<const char*> names) {
    for (const char* name : names) knob_widget(settings, name);
  };
  clip.draw(settings, scene.corners(), facts.camera);
  if (ImGui::CollapsingHeader("compare")) compare_section(session);
  if (ImGui::CollapsingHeader("light")) several({"light_azimuth", "light_height", "ambient"});
  if (ImGui::CollapsingHeader("picture")) several({"background", "legend", "time_stamp", "samples", "orbit"});
  if (ImGui::CollapsingHeader("window")) several({"turning", "theme", "text_size", "panel_side", "panel_width"});
}

}  // namespace

FreeArea Ui::free_area(const ViewSettings& view, int width, int height) const {
  if (!view.panel) return {0, 0, width, height};
  const Layout l = layout(view, width);
  const int beside = int(l.panel), above = int(l.menu), below = int(l.status) + TransportBar::height();
  return {on_the_right(view) ? 0 : beside, above, std::max(16, width - beside), std::max(16, height - above - below)};
}

void Ui::show_note(const std::string& line) {
  told_ = line;
  told_until_ = ImGui::GetTime() + 8;
}

bool Ui::animates() const {
  return work_began_ >= 0 || ImGui::GetTime() < told_until_ + 1 || ImGui::GetIO().WantTextInput;
}

void Ui::knob_tab(Session& session) {
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(0.42f * width);
  ImGui::InputTextWithHint("##filter", "find a knob", &filter_);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(0.28f * width);
  presets_.draw(session.settings, job_of(session));
  ImGui::SameLine();
  if (ImGui::Button("reset all")) reset_knobs(session.settings, job_of(session));
  if (ImGui::BeginChild("knobs")) knob_groups(session.settings, job_of(session), filter_);
  ImGui::EndChild();
}

/// The session's tab is shown, whoever chose it; a click on another changes the session.
void Ui::tabs(Session& session, Scene& scene, const UiFacts& facts) {
  PanelTab& tab = session.settings.view.tab;
  const bool told = tab != drawn_tab_;
  const auto item = [&](const char* name, PanelTab its, const auto& content) {
    if (!ImGui::BeginTabItem(name, nullptr, told && tab == its ? ImGuiTabItemFlags_SetSelected : 0)) return;
    if (!told) tab = its;
    content();
    ImGui::EndTabItem();
  };
  if (!ImGui::BeginTabBar("tabs")) return;
  item("data", PanelTab::data, [&] { data_tab(session, scene, facts.panel); });
  item("knobs", PanelTab::knobs, [&] { knob_tab(session); });
  item("look", PanelTab::look, [&] { look_tab(session, scene, facts, clip_); });
  item("result", PanelTab::result, [&] { facts.panel.result_tab(session); });
  item("timings", PanelTab::timings, [&] { timings_tab(scene, facts); });
  ImGui::EndTabBar();
  drawn_tab_ = tab;
}

/// At the bottom of the panel, so that nothing above moves under the cursor. Returns its height; 0: nothing failed.
float Ui::failure_window(const ViewSettings& view, const Scene& scene, const UiFacts& facts) {
  if (scene.failure().empty()) return 0;
  const Layout l = layout(view, facts.width);
  const ImGuiStyle& style = ImGui::GetStyle();
  const std::string& line = scene.failure();
  const float wrap = l.panel - 2 * style.WindowPadding.x;
  const float high = std::min(ImGui::CalcTextSize(line.c_str(), nullptr, false, wrap).y + 2 * style.WindowPadding.y,
                              0.4f * float(facts.height));
  ImGui::SetNextWindowPos(
      ImVec2(on_the_right(view) ? float(facts.width) - l.panel : 0, float(facts.height) - l.status - high));
  ImGui::SetNextWindowSize(ImVec2(l.panel, high));
  const auto fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("failure", nullptr, fixed)) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.95f, 0.4f, 0.3f, 1));
    ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::End();
  return high;
}

void Ui::panel(Session& session, Scene& scene, const UiFacts& facts) {
  ViewSettings& view = session.settings.view;
  const Layout l = layout(view, facts.width);
  const float below = l.status + failure_window(view, scene, facts);
  const float high = std::max(50.0f, float(facts.height) - l.menu - below);
  ImGui::SetNextWindowPos(ImVec2(on_the_right(view) ? float(facts.width) - l.panel : 0, l.menu));
  ImGui::SetNextWindowSize(ImVec2(l.panel, high));
  const auto fixed = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                     ImGuiWindowFlags_NoBringToFrontOnFocus;
  if (ImGui::Begin("panel", nullptr, fixed)) {
    const char* refused = facts.can_undo ? "not opened; ctrl z brings back what was there" : "not opened";
    const std::string title = scene.title();
    ImGui::TextWrapped("%s", !title.empty() ? title.c_str() : scene.failure().empty() ? "opening ..." : refused);
    ImGui::TextWrapped("%s", title.empty() ? "" : scene.state().c_str());
    tabs(session, scene, facts);
  }
  ImGui::End();
  panel_border(view, facts.width, l, high);
}

/// The running stage, its progress, and a button to cancel it; what is under the cursor.
void Ui::status(const ViewSettings& view, Scene& scene, const UiFacts& facts, UiRequests& requests) {
  const float high = layout(view, facts.width).status;
  ImGui::SetNextWindowPos(ImVec2(0, float(facts.height) - high));
  ImGui::SetNextWindowSize(ImVec2(float(facts.width), high));
  const auto fixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBringToFrontOnFocus |
                     ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("status", nullptr, fixed)) {
    const SceneProgress& progress = facts.progress;
    if (!progress.stage.empty()) {
      if (ImGui::Button("cancel")) requests.cancel = true;
      ImGui::SameLine();
      ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
      if (progress.fraction >= 0)
        ImGui::ProgressBar(float(progress.fraction), ImVec2(14 * ImGui::GetFontSize(), 0), progress.stage.c_str());
      else
        text(progress.stage + " ...");
      ImGui::SameLine();
      if (work_began_ < 0) work_began_ = ImGui::GetTime();
      text(lasting(ImGui::GetTime() - work_began_));
      ImGui::SameLine();
    } else if (scene.halted()) {
      if (ImGui::Button("compute")) requests.resume = true;
      ImGui::SameLine();
    }
    if (progress.stage.empty()) work_began_ = -1;
    const double frame = facts.clock.mean_seconds();
    text(fmt::format("{:.0f} ms a frame   {:.0f} MiB of memory", 1e3 * frame,
                     double(scene.totals().peak_bytes) / (1 << 20)));
    ImGui::SameLine();
    if (facts.recording) text("   recording");
    ImGui::SameLine();
    if (!facts.film.empty()) text("   filming: " + facts.film + "; frames wait for compute");
    ImGui::SameLine();
    if (!facts.saving.empty()) text("   saving " + facts.saving);
    ImGui::SameLine();
    if (ImGui::GetTime() < told_until_) text("   " + told_);
  }
  ImGui::End();
}

void Ui::probe_window(const PointedView& pointed, const Camera& camera) {
  const FreeArea& area = pointed.areas.view;
  const ImGuiIO& io = ImGui::GetIO();
  if (io.WantCaptureMouse || !ImGui::IsMousePosValid()) return;
  if (io.MouseDown[0] || io.MouseDown[1] || io.MouseDown[2]) return;
  const auto [x, y] = position_in(area, io.MousePos.x, io.MousePos.y);
  const auto [from, along] = ray_under(camera, x, y, area.aspect());
  const std::optional<ProbeResult> probed = pointed.scene.probe(from, along);
  if (!probed) return;
  ImGui::SetNextWindowPos(ImVec2(float(area.x) + 8, float(area.y) + 8));  // the time is in the corner below
  ImGui::SetNextWindowBgAlpha(0.7f);
  const auto quiet = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
  if (ImGui::Begin("under the cursor", nullptr, quiet))
    for (const std::string& line : probed->lines) text(line);
  ImGui::End();
}

void Ui::error_window(const FreeArea& area) {
  if (error_.empty()) return;
  const float width = std::min(36 * ImGui::GetFontSize(), 0.9f * float(area.width));
  ImGui::SetNextWindowPos(ImVec2(float(area.x) + 0.5f * float(area.width), float(area.y) + ImGui::GetFontSize()),
                          ImGuiCond_Always, ImVec2(0.5f, 0));
  ImGui::SetNextWindowSize(ImVec2(width, 0));
  bool open = true;
  if (ImGui::Begin("this did not work", &open, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse)) {
    ImGui::TextWrapped("%s", error_.c_str());
    if (ImGui::Button("close")) open = false;
  }
  ImGui::End();
  if (!open) error_.clear();
}

UiRequests Ui::draw(Session& session, Scene& scene, const UiFacts& facts) {
  UiRequests requests;
  use_keys(session, scene, facts, requests);
  ViewSettings& view = session.settings.view;
  const FreeArea area = free_area(view, facts.width, facts.height);
  const PointedView& pointed = facts.pointed;
  if (view.panel) {
    menus(session, scene, facts, requests);
    panel(session, scene, facts);
    status(view, scene, facts, requests);
    const bool played = view.play;
    transport_.draw(session, scene.transport(), {area.x, area.y + area.height, area.width, TransportBar::height()});
    if (!played && view.play && scene.halted()) requests.resume = true;
    if (session.camera && pointed.areas.has_view) {
      if (!facts.filmed) clip_.draw_handle(view, pointed.scene.corners(), {facts.camera, pointed.areas.view});
      probe_window(pointed, facts.camera);
      if (const std::optional<LegendRange> range = pointed.scene.legend_range())
        legend_mouse_.draw(session.settings, *range, pointed.areas.view);
    }
  }
  if (SliceViews* const slices = pointed.scene.slices())
    slice_mouse_.draw(view, *slices, pointed.areas);
  else
    slice_mouse_.forget();
  keyframes_window(session, facts, area, requests);
  welcome_card(session, facts, area, requests);
  error_window(area);
  if (std::exchange(asks_record_, false)) switch_recording(session, facts, requests);
  help_windows(facts, area);
  quit_window(requests);
  screenshot_window(session, facts);
  note_window(session);
  if (const auto files = dialog_.draw()) then_(*files, session, requests);
  return requests;
}

}  // namespace nacre
