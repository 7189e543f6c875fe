// Nacre: what is drawn over a frame.
#include "app/viewer/panel.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>
#include <variant>

#include "engine/picture/colormap.hpp"
#include "engine/scene/knobs.hpp"

namespace nacre {
namespace {

void text(const std::string& words) { ImGui::TextUnformatted(words.data(), words.data() + words.size()); }

void stage_table(const StageTimers& timers) {
  if (!ImGui::BeginTable("stages", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  for (const char* head : {"stage", "calls", "total s", "mean ms"}) ImGui::TableSetupColumn(head);
  ImGui::TableHeadersRow();
  for (const StageTimers::Stage& stage : timers.stages()) {
    const auto column = [](const std::string& words) {
      ImGui::TableNextColumn();
      text(words);
    };
    column(stage.name);
    column(fmt::format("{}", stage.calls));
    column(fmt::format("{:.2f}", stage.seconds));
    column(fmt::format("{:.1f}", 1e3 * stage.seconds / double(std::max(1L, stage.calls))));
  }
  ImGui::EndTable();
}

/// One knob of the table; numbers are clamped to its range. True where it was changed and let go.
bool knob_widget(const Knob& knob) {
  const std::string label = knob.name + (knob.unit.empty() ? "" : " [" + knob.unit + "]");
  bool done = false;
  if (auto* const* whole = std::get_if<int*>(&knob.value)) {
    int value = **whole;
    if (ImGui::InputInt(label.c_str(), &value, 1, 16, ImGuiInputTextFlags_EnterReturnsTrue) || value != **whole) {
      **whole = std::clamp(value, int(knob.min), int(knob.max));
      done = true;
    }
  } else if (auto* const* real = std::get_if<double*>(&knob.value)) {
    float value = float(**real);
    ImGui::SliderFloat(label.c_str(), &value, float(knob.min), float(knob.max), "%.3g");
    if (value != float(**real)) **real = std::clamp(double(value), knob.min, knob.max);
    done = ImGui::IsItemDeactivatedAfterEdit();
  } else if (auto* const* choice = std::get_if<std::string*>(&knob.value); choice && !knob.choices.empty()) {
    if (ImGui::BeginCombo(label.c_str(), (*choice)->c_str())) {
      for (const std::string& each : knob.choices)
        if (ImGui::Selectable(each.c_str(), each == **choice) && each != **choice) **choice = each, done = true;
      ImGui::EndCombo();
    }
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", knob.help.c_str());
  return done;
}

void knob_panels(Settings& settings, const char* job) {
  std::string group;
  bool open = false;
  for (const Knob& knob : knobs(settings)) {
    if (!knob.concerns(job)) continue;
    if (knob.group != group) open = ImGui::CollapsingHeader((group = knob.group).c_str());
    if (open) knob_widget(knob);
  }
}

void help_window(bool& open) {
  if (!ImGui::Begin("Keys and mouse", &open, ImGuiWindowFlags_AlwaysAutoResize)) return ImGui::End();
  for (const char* line :
       {"left drag: turn", "middle or right drag, or shift and left: move", "wheel: nearer, farther, at the cursor",
        "f: fit    i: iso    x y z: along an axis, with shift from the other side", "o: orthographic",
        "space: stop and go    e: edges of triangles", "p: panel    ?: this list    q: quit"})
    ImGui::TextUnformatted(line);
  ImGui::End();
}

}  // namespace

void FrameClock::add(double seconds) {
  kept_[next_] = float(1e3 * seconds);
  next_ = (next_ + 1) % kept_.size();
  count_ = std::min(count_ + 1, kept_.size());
}

double FrameClock::mean_seconds() const {
  double sum = 0;
  for (std::size_t k = 0; k < count_; ++k) sum += kept_[k];
  return count_ > 0 ? 1e-3 * sum / double(count_) : 0;
}

std::array<float, 120> FrameClock::milliseconds() const {
  std::array<float, 120> ordered;
  for (std::size_t k = 0; k < kept_.size(); ++k) ordered[k] = kept_[(next_ + k) % kept_.size()];
  return ordered;
}

Interface::Interface(Window* window) : window_(window) {
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // no file beside the user's data
  io.LogFilename = nullptr;
  if (window_) {
    io.FontGlobalScale = window_->scale();
    ImGui::GetStyle().ScaleAllSizes(window_->scale());
    ImGui_ImplGlfw_InitForOpenGL(window_->handle(), true);
  }
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Interface::~Interface() {
  ImGui_ImplOpenGL3_Shutdown();
  if (window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

void Interface::begin(int width, int height, double seconds) {
  ImGui_ImplOpenGL3_NewFrame();
  if (window_) {
    ImGui_ImplGlfw_NewFrame();
  } else {
    ImGui::GetIO().DisplaySize = ImVec2(float(width), float(height));
    ImGui::GetIO().DeltaTime = float(std::max(seconds, 1e-4));
  }
  ImGui::NewFrame();
}

void Interface::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void draw_panel(PanelState& state, Session& session, Scene& scene, const FrameClock& clock,
                const std::string& renderer) {
  if (state.help) help_window(state.help);
  Settings& settings = session.settings;
  if (!settings.look.panel) return;
  ImGui::SetNextWindowPos(ImVec2(10, 10), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(330, 430), ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Nacre")) {
    const double frame = clock.mean_seconds();
    text(scene.title().empty() ? "opening ..." : scene.title());
    text(fmt::format("{:.1f} frames/s   {:.1f} ms", frame > 0 ? 1 / frame : 0, 1e3 * frame));
    const std::array<float, 120> history = clock.milliseconds();
    ImGui::PlotLines("##frames", history.data(), int(history.size()), 0, nullptr, 0, 200, ImVec2(-1, 36));
    const std::string stage = scene.progress().stage;
    text(stage.empty() ? scene.state() : stage + " ...");
    if (!scene.failure().empty()) ImGui::TextWrapped("%s", scene.failure().c_str());
    stage_table(scene.timers());
    text(fmt::format("{} ({})", scene.device().name(), scene.device().backend()));
    text(renderer);
    text(fmt::format("{:.0f} MiB   copied {} bytes", double(scene.peak_bytes()) / (1 << 20), scene.copied_bytes()));
    ImGui::Checkbox("play", &settings.look.play);
    ImGui::SameLine();
    ImGui::Checkbox("edges", &settings.look.edges);
    ImGui::SameLine();
    if (ImGui::Button("?")) state.help = true;
    knob_panels(settings, is_mesh_input(session) ? "mesh" : "flow");
  }
  ImGui::End();
}

}  // namespace nacre
