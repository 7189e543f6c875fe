// Nacre: menus, panel and dialogs over the picture. They change the session; what concerns the program they wish for.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/panel/clip_panel.hpp"
#include "app/viewer/panel/file_dialog.hpp"
#include "app/viewer/panel/frame_clock.hpp"
#include "app/viewer/panel/keyframes_window.hpp"
#include "app/viewer/panel/knob_presets.hpp"
#include "app/viewer/panel/legend_mouse.hpp"
#include "app/viewer/panel/scene_panel.hpp"
#include "app/viewer/panel/slice_mouse.hpp"
#include "app/viewer/panel/transport_bar.hpp"
#include "app/viewer/panel/welcome_card.hpp"
#include "app/viewer/scene/free_area.hpp"
#include "app/viewer/scene/scene.hpp"
#include "engine/gl/window.hpp"

namespace nacre {

/// The view that the mouse is over.
struct PointedView {
  Scene& scene;
  ViewAreas areas;
};

/// Facts about the loop, for the panels.
struct UiFacts {
  ScenePanel& panel;
  PointedView pointed;
  SceneProgress progress;  ///< of what is computed, or read
  const FrameClock& clock;
  std::string renderer;
  const std::vector<RecentFile>& recent;
  bool can_undo = false, can_redo = false;
  bool recording = false;  ///< of what the user does
  std::string film;        ///< how long the video is to which every frame goes; empty: none
  std::string saving;      ///< a file that is being written; empty: none
  int width = 0, height = 0;
  Camera camera;                              ///< of what is seen
  std::vector<KeyPress> keys;                 ///< since the last frame
  bool opening = false;                       ///< something is being read, and will be shown when it can be
  bool filmed = false;                        ///< every frame goes to a video
  std::optional<double> keyframes_time = {};  ///< of the list of keyframes, where it is being played
  bool films_keyframes = false;
};

/// What the user wants of the program.
struct UiRequests {
  bool quit = false, undo = false, redo = false, cancel = false, resume = false;
  bool record = false;  ///< begin
  bool end_film = false;
  std::string look_from;  ///< a view such as "+x"
  bool fit = false;
  std::optional<std::filesystem::path> load_session, save_session, save_result, save_recording, film;
  std::optional<Screenshot> screenshot;
  std::string tour;  ///< text of a session to be played; empty: none
  // Of the list of keyframes.
  std::optional<double> play_keyframes;  ///< from this time
  bool stop_keyframes = false, take_recording = false;
  std::optional<std::filesystem::path> edit_recording, save_keyframes, film_keyframes;
};

class Ui {
 public:
  /// Makes all of it, between ImGuiLayer::begin and end.
  UiRequests draw(Session& session, Scene& scene, const UiFacts& facts);

  /// Where the picture is to be, in a window of this size. As wide as the panel allows; never empty.
  FreeArea free_area(const ViewSettings& view, int width, int height) const;

  /// A line at the bottom for some seconds: something was saved.
  void show_note(const std::string& line);
  /// Something did not work: in a window of its own, panel or not, until that is closed.
  void show_error(const std::string& line) { error_ = line; }

  /// Asks whether to quit although, a line for each reason; UiRequests::quit then means it.
  void ask_quit(std::vector<std::string> reasons) {
    quit_reasons_ = std::move(reasons);
    opens_quit_ = true;
  }
  /// Does something on it change with time alone: how long it computes, a note, the cursor of a field?
  bool animates() const;
  bool asks_quit() const { return !quit_reasons_.empty(); }

  KeyframesWindow& keyframes() { return keyframes_; }
  const KeyframesWindow& keyframes() const { return keyframes_; }

  /// A card for newcomers over the picture, until something is opened.
  void welcome() { welcome_.show(); }

 private:
  using Then =
      std::function<void(const std::vector<std::filesystem::path>& files, Session& session, UiRequests& requests)>;

  void use_keys(Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests);
  void take_back(bool again, UiRequests& requests);
  void use_shortcuts(const Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests);
  void menus(Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests);
  void file_menu(Session& session, Scene& scene, const UiFacts& facts, UiRequests& requests);
  void view_menu(Session& session, Scene& scene, UiRequests& requests);
  void panel(Session& session, Scene& scene, const UiFacts& facts);
  float failure_window(const ViewSettings& view, const Scene& scene, const UiFacts& facts);
  void tabs(Session& session, Scene& scene, const UiFacts& facts);
  void knob_tab(Session& session);
  void status(const ViewSettings& view, Scene& scene, const UiFacts& facts, UiRequests& requests);
  void screenshot_window(const Session& session, const UiFacts& facts);
  void probe_window(const PointedView& pointed, const Camera& camera);
  void error_window(const FreeArea& area);
  void quit_window(UiRequests& requests);
  void welcome_card(Session& session, const UiFacts& facts, const FreeArea& area, UiRequests& requests);
  void help_windows(const UiFacts& facts, const FreeArea& area);
  // Marks; in marks_ui.cpp.
  std::optional<Vec3d> under_cursor(const Session& session, const UiFacts& facts);
  void measure(Session& session, Scene& scene, const UiFacts& facts);
  void plot_point(Session& session, Scene& scene, const UiFacts& facts);
  void release_dye(Session& session, Scene& scene, const UiFacts& facts, bool another);
  void ask_note(Session& session, const UiFacts& facts);
  void note_window(Session& session);
  void marks_menu(Session& session);
  void cameras_menu(Session& session);
  void compare_menu(Session& session);
  // In keyframes_ui.cpp.
  void ask_recording();
  void save_keyframes();
  void keyframes_window(Session& session, const UiFacts& facts, const FreeArea& area, UiRequests& requests);
  bool close_topmost();
  void ask_open();
  void ask_result(const Session& session, Scene& scene);
  void switch_film(const Session& session, const UiFacts& facts, UiRequests& requests);
  void switch_recording(const Session& session, const UiFacts& facts, UiRequests& requests);
  void ask_save(const std::string& title, std::vector<std::string> extensions, const std::string& name,
                std::optional<std::filesystem::path> UiRequests::*wish);

  FileDialog dialog_;
  TransportBar transport_;
  WelcomeCard welcome_;
  KnobPresets presets_;
  ClipPanel clip_;
  SliceMouse slice_mouse_;
  LegendMouse legend_mouse_;
  KeyframesWindow keyframes_;
  Then then_;  ///< what happens to the dialog's files
  Screenshot shot_;
  bool help_ = false, about_ = false, asks_shot_ = false, asks_record_ = false;
  bool typed_ = false;  ///< in a field, and the mouse has not been over the view since
  bool opens_quit_ = false;
  std::vector<std::string> quit_reasons_;  ///< not empty: it is asked whether to quit
  std::string filter_, told_, error_;
  std::optional<PanelTab> drawn_tab_;
  std::string note_, camera_name_;  ///< being typed
  std::optional<Vec3d> note_place_;
  bool opens_note_ = false;
  double told_until_ = 0, work_began_ = -1;  ///< on Dear ImGui's clock; -1: no work goes on
};

}  // namespace nacre
