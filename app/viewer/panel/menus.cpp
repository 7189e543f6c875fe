// Nacre: the menus of the viewer, its keys, and the dialogs that they open.
#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "app/viewer/panel/imgui_text.hpp"
#include "app/viewer/panel/knob_widgets.hpp"
#include "app/viewer/panel/ui.hpp"
#include "app/viewer/scene/marks.hpp"
#include "engine/io/reader.hpp"
#include "engine/io/volume_reader.hpp"
#include "engine/run/origin.hpp"
#include "engine/scene/samples/phantoms.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/session/compared.hpp"

namespace nacre {
namespace {

namespace fs = std::filesystem;

Turning other(Turning turning) { return turning == Turning::trackball ? Turning::turntable : Turning::trackball; }

Theme other(Theme theme) { return theme == Theme::dark ? Theme::light : Theme::dark; }

ViewLayout other(ViewLayout layout) { return layout == ViewLayout::single ? ViewLayout::slices : ViewLayout::single; }

/// Views of the camera and the keys that give them.
struct NamedView {
  const char *name, *view;
  char key;
};
constexpr NamedView views[] = {{"iso", "iso", 'i'},    {"from +x", "+x", 'x'}, {"from -x", "-x", 'X'},
                               {"from +y", "+y", 'y'}, {"from -y", "-y", 'Y'}, {"from +z", "+z", 'z'},
                               {"from -z", "-z", 'Z'}};

constexpr const char* keys[][2] = {{"left drag", "turn"},
                                   {"middle or right drag, shift and left", "move"},
                                   {"wheel", "nearer, farther, at the cursor"},
                                   {"f", "fit the view"},
                                   {"i", "iso view"},
                                   {"x y z", "along an axis; with shift from the other side"},
                                   {"o", "orthographic or perspective"},
                                   {"b", "turntable or trackball"},
                                   {"space", "pause and play"},
                                   {", .", "pause; one step back, one step forward"},
                                   {"d", "ruler: distance between points under the cursor; the third gives an angle"},
                                   {"c", "clip plane that faces the camera; its handle moves and turns it"},
                                   {"g", "graph of the point under the cursor through time"},
                                   {"r, R", "release dye at the point under the cursor; R: another dye"},
                                   {"l", "three slices of the volume beside the view, or the view alone"},
                                   {"n", "note at the point under the cursor"},
                                   {"1 to 9", "camera that was kept"},
                                   {"k", "keyframes"},
                                   {"e", "edges of triangles"},
                                   {"p", "panels"},
                                   {"t", "dark or light"},
                                   {"ctrl o", "open files"},
                                   {"ctrl s", "save the session"},
                                   {"ctrl e", "save the result"},
                                   {"ctrl p", "screenshot"},
                                   {"ctrl r", "record what you do; once more: end and save"},
                                   {"ctrl m", "video of every frame; once more: end"},
                                   {"ctrl z, ctrl y", "take a change back; make it again"},
                                   {"escape", "close what is open, else cancel what is computed"},
                                   {"?", "this list"},
                                   {"q, ctrl q", "quit"}};

std::vector<std::string> data_extensions() {
  std::vector<std::string> all = readable_extensions();
  for (const std::string& e : volume_extensions()) all.push_back(e);
  all.insert(all.end(), {".json", ".png"});
  return all;
}

void open_files(const std::vector<fs::path>& files, Session& session, UiRequests& requests) {
  if (files.size() == 1 && may_hold_session(files[0])) {
    requests.load_session = files[0];
    return;
  }
  static_cast<SessionInput&>(session) = {files, "", 0};
  session.camera.reset();
}

void open_sample(const std::string& name, Session& session) {
  static_cast<SessionInput&>(session) = {{}, name, 0};
  session.camera.reset();
}

template <class Sample>
void sample_menu(const char* title, const std::vector<Sample>& all, Session& session) {
  if (!ImGui::BeginMenu(title)) return;
  for (const Sample& sample : all) {
    if (ImGui::MenuItem(sample.name.c_str(), nullptr, session.sample == sample.name)) open_sample(sample.name, session);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", sample.help.c_str());
  }
  ImGui::EndMenu();
}

/// A name for a file beside others: "head-mesh.vtp", of the first input or the sample.
std::string export_name(const Session& session, const std::string& ending) {
  const std::string& sample = session.sample;
  return (!sample.empty() || session.inputs.empty() ? sample : session.inputs.front().stem().string()) + ending;
}

}  // namespace

void Ui::ask_open() {
  dialog_.open(FileDialog::Mode::open, "open", data_extensions());
  then_ = open_files;
}

void Ui::ask_save(const std::string& title, std::vector<std::string> extensions, const std::string& name,
                  std::optional<fs::path> UiRequests::*wish) {
  dialog_.open(FileDialog::Mode::save, title, std::move(extensions), name);
  then_ = [wish](const std::vector<fs::path>& files, Session&, UiRequests& requests) {
    requests.*wish = files.front();
  };
}

void Ui::ask_result(const Session& session, Scene& scene) {
  const std::vector<std::string> formats = scene.result_formats();
  if (scene.complete() && !formats.empty())
    ask_save("save result", formats, export_name(session, (scene.is_flow() ? "-flow" : "-mesh") + formats.front()),
             &UiRequests::save_result);
}

/// The first time it begins, the second it ends and asks for a name.
void Ui::switch_recording(const Session& session, const UiFacts& facts, UiRequests& requests) {
  if (facts.recording)
    ask_save("save recording", {".json"}, export_name(session, "-recording.json"), &UiRequests::save_recording);
  else
    requests.record = true;
}

void Ui::switch_film(const Session& session, const UiFacts& facts, UiRequests& requests) {
  if (!facts.film.empty())
    requests.end_film = true;
  else
    ask_save("save video", {".mp4", ".mkv", ".mov", ".webm", ".gif"}, export_name(session, ".mp4"), &UiRequests::film);
}

void Ui::file_menu(Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests) {
  if (!ImGui::BeginMenu("File")) return;
  if (ImGui::MenuItem("Open ...", "ctrl o")) ask_open();
  if (ImGui::BeginMenu("Open recent", !facts.recent.empty())) {
    for (const RecentFile& recent : facts.recent)
      if (ImGui::MenuItem(recent.file.string().c_str())) open_files({recent.file}, session, requests);
    ImGui::EndMenu();
  }
  sample_menu("Samples of flow", samples(), session);
  sample_menu("Samples of volumes", phantoms(), session);
  ImGui::Separator();
  if (ImGui::MenuItem("Save session ...", "ctrl s"))
    ask_save("save session", {".json"}, export_name(session, "-session.json"), &UiRequests::save_session);
  if (ImGui::MenuItem("Save result ...", "ctrl e", false, scene.complete())) ask_result(session, scene);
  ImGui::Separator();
  if (ImGui::MenuItem("Screenshot ...", "ctrl p")) asks_shot_ = true;
  if (ImGui::MenuItem(facts.recording ? "End the recording ..." : "Record what I do", "ctrl r", facts.recording))
    asks_record_ = true;
  if (ImGui::MenuItem("Edit a recording ...")) ask_recording();
  if (ImGui::MenuItem(!facts.film.empty() ? "End the video" : "Video of every frame ...", "ctrl m",
                      !facts.film.empty()))
    switch_film(session, facts, requests);
  ImGui::Separator();
  if (ImGui::MenuItem("Quit", "ctrl q")) requests.quit = true;
  ImGui::EndMenu();
}

/// What a second view shows. Its knobs are in the tab "look".
void Ui::compare_menu(Session& session) {
  if (!ImGui::BeginMenu("Compare with")) return;
  std::string& compare = session.settings.view.compare;
  const auto show = [&](const std::string& what) {
    compare = what;
    session.settings.view.tab = PanelTab::look;
  };
  if (ImGui::MenuItem("nothing", nullptr, compare.empty()))
    compare.clear(), session.settings.view.compare_knobs.clear();
  if (ImGui::MenuItem("the same data", nullptr, compare == compare_same)) show(compare_same);
  if (ImGui::MenuItem("a file ...")) {
    std::vector<std::string> extensions = data_extensions();
    extensions.resize(extensions.size() - 2);  // sessions
    dialog_.open(FileDialog::Mode::open, "compare with", std::move(extensions));
    then_ = [](const std::vector<fs::path>& files, Session& changed, UiRequests&) {
      changed.settings.view.compare = compare_text({files, "", 0});
    };
  }
  const auto samples_of = [&](const char* title, const auto& all) {
    if (!ImGui::BeginMenu(title)) return;
    for (const auto& sample : all)
      if (ImGui::MenuItem(sample.name.c_str())) show(compare_text({{}, sample.name, 0}));
    ImGui::EndMenu();
  };
  samples_of("a sample of flow", samples());
  samples_of("a sample of volumes", phantoms());
  ImGui::EndMenu();
}

void Ui::view_menu(Session& session, Scene& scene, UiRequests& requests) {
  if (!ImGui::BeginMenu("View")) return;
  ViewSettings& view = session.settings.view;
  if (ImGui::MenuItem("Fit", "f")) requests.fit = true;
  for (const NamedView& v : views)
    if (ImGui::MenuItem(v.name, std::string(1, v.key).c_str())) requests.look_from = v.view;
  if (session.camera) ImGui::MenuItem("Orthographic", "o", &session.camera->orthographic);
  cameras_menu(session);
  compare_menu(session);
  if (ImGui::MenuItem("Keyframes", "k", keyframes_.is_open())) keyframes_.toggle();
  bool ball = view.turning == Turning::trackball;
  if (ImGui::MenuItem("Trackball", "b", &ball)) view.turning = ball ? Turning::trackball : Turning::turntable;
  ImGui::Separator();
  ImGui::MenuItem("Edges", "e", &view.edges);
  if (ImGui::MenuItem("Three slices", "l", view.layout != ViewLayout::single, !scene.is_flow()))
    view.layout = other(view.layout);
  marks_menu(session);
  ImGui::MenuItem("Legend", nullptr, &session.settings.legend);
  ImGui::MenuItem("Panels", "p", &view.panel);
  bool light = view.theme == Theme::light;
  if (ImGui::MenuItem("Light", "t", &light)) view.theme = light ? Theme::light : Theme::dark;
  bool right = view.panel_side == PanelSide::right;
  if (ImGui::MenuItem("Panel on the right", nullptr, &right))
    view.panel_side = right ? PanelSide::right : PanelSide::left;
  ImGui::EndMenu();
}

void Ui::menus(Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests) {
  if (!ImGui::BeginMainMenuBar()) return;
  file_menu(session, scene, facts, requests);
  if (ImGui::BeginMenu("Edit")) {
    if (ImGui::MenuItem("Undo", "ctrl z", false, facts.can_undo)) requests.undo = true;
    if (ImGui::MenuItem("Redo", "ctrl y", false, facts.can_redo)) requests.redo = true;
    if (ImGui::MenuItem("Reset knobs")) reset_knobs(session.settings, is_mesh_input(session) ? "mesh" : "flow");
    ImGui::EndMenu();
  }
  view_menu(session, scene, requests);
  if (ImGui::BeginMenu("Help")) {
    if (ImGui::MenuItem("Welcome")) welcome_.show();
    if (ImGui::MenuItem("Keys and mouse", "?")) help_ = true;
    if (ImGui::MenuItem("About")) about_ = true;
    ImGui::EndMenu();
  }
  ImGui::EndMainMenuBar();
}

/// Closes the topmost of what is open: menus and popups, the dialog, errors and help; a field that is being edited
/// drops what was typed by itself. False: nothing is open.
bool Ui::close_topmost() {
  const int popups = ImGui::GetCurrentContext()->OpenPopupStack.Size;
  if (dialog_.is_open() && popups <= 1) {
    dialog_.close();
    ImGui::ClosePopupToLevel(0, true);
  } else if (popups > 0) {
    ImGui::ClosePopupToLevel(popups - 1, true);
  } else if (!error_.empty()) {
    error_.clear();
  } else if (help_ || about_) {
    help_ = about_ = false;
  } else if (welcome_.is_shown()) {
    welcome_.hide();
  } else {
    return ImGui::IsAnyItemActive();
  }
  return true;
}

/// The window of the keyframes has its own changes.
void Ui::take_back(bool again, UiRequests& requests) {
  if (keyframes_.has_keys())
    again ? keyframes_.redo() : keyframes_.undo();
  else
    (again ? requests.redo : requests.undo) = true;
}

void Ui::use_shortcuts(const Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests) {
  for (const KeyPress& pressed : facts.keys) switch (pressed.key) {
      case 27:
        if (!close_topmost()) requests.cancel = true;
        break;
      case 'O': ask_open(); break;
      case 'S':
        if (keyframes_.has_keys())
          save_keyframes();
        else
          ask_save("save session", {".json"}, export_name(session, "-session.json"), &UiRequests::save_session);
        break;
      case 'E': ask_result(session, scene); break;
      case 'P': asks_shot_ = true; break;
      case 'R': asks_record_ = true; break;
      case 'M': switch_film(session, facts, requests); break;
      case 'Z': take_back(pressed.shift, requests); break;
      case 'Y': take_back(true, requests); break;
      case 'Q': requests.quit = true; break;
      default: break;
    }
}

void Ui::use_keys(Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests) {
  const ImGuiIO& io = ImGui::GetIO();
  use_shortcuts(session, scene, facts, requests);
  // Who has typed in a field may go on after it has lost the keys: that is no shortcut.
  if (io.WantTextInput)
    typed_ = true;
  else if (ImGui::IsMousePosValid() && (!io.WantCaptureMouse || legend_mouse_.is_hovered()))
    typed_ = false;
  if (io.WantTextInput || dialog_.is_open() || typed_) return;
  ViewSettings& view = session.settings.view;
  for (const ImWchar key : io.InputQueueCharacters) {
    for (const NamedView& v : views)
      if (ImWchar(v.key) == key) requests.look_from = v.view;
    if (key >= '1' && key <= '9')
      if (const auto kept = parse_cameras(view.cameras); std::size_t(key - '1') < kept.size())
        session.camera = kept[std::size_t(key - '1')].camera;
    switch (key) {
      case 'q': requests.quit = true; break;
      case 'f': requests.fit = true; break;
      case 'o':
        if (session.camera) session.camera->orthographic = !session.camera->orthographic;
        break;
      case 'b': view.turning = other(view.turning); break;
      case 'k': keyframes_.toggle(); break;
      case 'e': view.edges = !view.edges; break;
      case 'p': view.panel = !view.panel; break;
      case 't': view.theme = other(view.theme); break;
      case 'c': clip_.add_facing(session.settings, scene.corners(), facts.camera); break;
      case 'd': measure(session, scene, facts); break;
      case 'l':
        if (!scene.is_flow()) view.layout = other(view.layout);
        break;
      case 'n': ask_note(session, facts); break;
      case 'g': plot_point(session, scene, facts); break;
      case 'r':
      case 'R': release_dye(session, scene, facts, key == 'R'); break;
      case '?': help_ = !help_; break;
      case ' ':
        transport_.toggle_play(session, scene.transport());
        if (view.play && scene.halted()) requests.resume = true;
        break;
      case ',': transport_.step(session, scene.transport(), -1); break;
      case '.': transport_.step(session, scene.transport(), 1); break;
      default: break;
    }
  }
}

void Ui::screenshot_window(const Session& session, const UiFacts& facts) {
  if (std::exchange(asks_shot_, false)) ImGui::OpenPopup("screenshot");
  if (!ImGui::BeginPopup("screenshot")) return;
  ImGui::SliderInt("scale", &shot_.scale, 1, 4, "%dx", ImGuiSliderFlags_AlwaysClamp);
  ImGui::Checkbox("without background", &shot_.transparent);
  ImGui::Checkbox("with panels, as on the screen", &shot_.panel);
  const int scale = shot_.panel ? 1 : shot_.scale;
  ImGui::Text("%d x %d pixels", facts.width * scale, facts.height * scale);
  if (ImGui::Button("save ...")) {
    ImGui::CloseCurrentPopup();
    dialog_.open(FileDialog::Mode::save, "save screenshot", {".png"}, export_name(session, ".png"));
    then_ = [this](const std::vector<fs::path>& files, Session&, UiRequests& requests) {
      shot_.file = files.front();
      requests.screenshot = shot_;
    };
  }
  ImGui::EndPopup();
}

/// Quits on a second request, or if confirmed.
void Ui::quit_window(UiRequests& requests) {
  if (quit_reasons_.empty()) return;
  constexpr const char* title = "Quit?";
  if (std::exchange(opens_quit_, false)) ImGui::OpenPopup(title);
  if (!ImGui::BeginPopupModal(title, nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings)) {
    quit_reasons_.clear();
    return;
  }
  for (const std::string& reason : quit_reasons_) text(reason);
  ImGui::Spacing();
  if (ImGui::Button("Quit")) requests.quit = true;
  ImGui::SameLine();
  if (ImGui::Button("Stay")) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void Ui::welcome_card(Session& session, const UiFacts& facts, const FreeArea& area, UiRequests& requests) {
  if (facts.opening) welcome_.hide();
  const WelcomeCard::Wish wish = welcome_.draw(area, facts.recent);
  if (wish.open) ask_open();
  if (!wish.sample.empty()) open_sample(wish.sample, session);
  if (wish.file) open_files({*wish.file}, session, requests);
  requests.tour = wish.tour;
}

void Ui::help_windows(const UiFacts& facts, const FreeArea& area) {
  const auto position = [&] {  // over the picture, and nothing shows through
    const ImVec2 middle(float(area.x) + 0.5f * float(area.width), float(area.y) + 0.5f * float(area.height));
    ImGui::SetNextWindowPos(middle, ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowBgAlpha(1);
  };
  if (help_) {
    position();
    if (ImGui::Begin("Keys and mouse", &help_, ImGuiWindowFlags_AlwaysAutoResize) && ImGui::BeginTable("keys", 2)) {
      for (const auto& [key, what] : keys) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(key);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(what);
      }
      ImGui::EndTable();
    }
    ImGui::End();
  }
  if (about_) {
    position();
    if (ImGui::Begin("About", &about_, ImGuiWindowFlags_AlwaysAutoResize)) {
      ImGui::Text("Nacre %s", NACRE_VERSION);
      ImGui::TextUnformatted("Flow on surfaces, and meshes from volumes.");
      ImGui::TextUnformatted(facts.renderer.c_str());
    }
    ImGui::End();
  }
}

}  // namespace nacre
