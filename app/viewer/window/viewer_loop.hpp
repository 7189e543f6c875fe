// Nacre: the loop of the viewer: its state, and the calls that make a frame.
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "app/viewer/panel/ui.hpp"
#include "app/viewer/scene/framing.hpp"
#include "app/viewer/scene/scene.hpp"
#include "app/viewer/scene/scene_painter.hpp"
#include "app/viewer/scene/scene_view.hpp"
#include "app/viewer/scene/worker.hpp"
#include "app/viewer/window/camera_control.hpp"
#include "app/viewer/window/comparison.hpp"
#include "app/viewer/window/draw_demand.hpp"
#include "app/viewer/window/event_log.hpp"
#include "app/viewer/window/film.hpp"
#include "app/viewer/window/imgui_layer.hpp"
#include "app/viewer/window/kept_recording.hpp"
#include "app/viewer/window/left_scenes.hpp"
#include "app/viewer/window/recent_files.hpp"
#include "app/viewer/window/saving.hpp"
#include "app/viewer/window/session_clock.hpp"
#include "app/viewer/window/thumbnails.hpp"
#include "app/viewer/window/undo.hpp"
#include "app/viewer/window/viewer.hpp"
#include "compute/device/error.hpp"
#include "engine/gl/framebuffer.hpp"
#include "engine/gl/window.hpp"
#include "engine/picture/png.hpp"
#include "engine/run/origin.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {

/// All that a user, a script or a file changes goes through one session. What differs from the last frame is found
/// once a frame, passed to the scene and to the recorder, and can be undone.
class Viewer {
 public:
  explicit Viewer(const ViewerOptions& options);

  ~Viewer() { drop_graphics(); }

  ViewerResult run();

 private:
  void make_graphics();

  /// An interruption ends a window as the user does, with all that is written then; without one it is the caller's.
  template <class Work>
  void interruptible(const Work& work) {
    try {
      if (*options_.stop) throw Interrupted();
      work();
    } catch (const Interrupted&) {
      if (!window_) throw;
      result_.interrupted = true;
    }
  }

  void try_to_quit();

  /// What would be lost, a sentence each. A file that is being written is waited for.
  std::vector<std::string> reasons_to_stay() const;
  void drop_graphics();

  /// The graphics device was reset, and all that lay on it is gone. The session is not.
  void begin_again();
  void open();
  SceneOptions scene_options() const;
  void note_recent();
  /// A small picture of a scene that is left, for the list of recent files.
  void keep_thumbnail();
  std::vector<RecentFile> recent_files();

  /// The scene that was shown goes, and all that belongs to it.
  void leave_scene();
  Scene& scene() const { return *open_.scene; }

  // The second scene goes along with the first.
  void follow_comparison();
  bool all_settled() const { return scene().settled() && (!comparison_.on() || comparison_.scene().settled()); }
  void halt();
  void resume();
  void set_lockstep(bool on);
  SceneProgress progress() const;

  // Another input beside the one that is shown; in opening.cpp.
  struct Opening {
    OpenScene open;
    Session session, before;              ///< with that input; the session when it was asked for
    std::optional<SessionPlayer> player;  ///< plays from then on
    std::filesystem::path file;           ///< that was opened, where it is not an input; empty: none
    std::optional<Undo> history;          ///< where undo or redo has asked for it: as it is then
  };
  bool opens_beside() const;
  bool divert_input();
  /// `again`: a scene that has been left and was told to be as wanted; none: it is opened.
  void open_beside(Session wanted, std::optional<SessionPlayer> player, const std::filesystem::path& file,
                   OpenScene again = {});
  OpenScene left_scene(const Session& wanted);
  bool take_opened();
  void give_opening_up();
  void move_in_history(bool back);
  static std::string input_name(const SessionInput& input);

  /// A GPU that has failed does not come back while the program runs. The session is as it was.
  void leave_lost_device();
  bool done() const;
  void frame();

  /// A window is drawn where it has changed; not so where frames are counted or filmed.
  bool draws_on_demand() const { return window_ && options_.frames == 0 && !film_.on(); }

  /// How long the loop waits for the user if nothing has to be drawn, seconds; then it handles events of compute.
  double patience() const {
    if (!draws_on_demand()) return 0;
    if (opening_ || list_play_ || (scripted_ && !player_->ended())) return shortest_frame;
    return !all_settled() && !scene().halted() ? shortest_frame : 0.1;
  }

  DrawDemand::Shown what_is_shown(int width, int height) const;
  bool needs_frame(double time, const DrawDemand::Shown& shown, bool changed);

  /// False: the frame that waits for compute is still to come, and what is drawn until then is for the user alone.
  bool advance_scene();

  /// A video that cannot be written ends; what is seen in a window goes on.
  void add_to_video();
  /// Where the first and the second scene are drawn; without a second, the first has all, and the other is empty.
  std::array<FreeArea, 2> views(const FreeArea& area) const {
    return comparison_.on() ? halves(area) : std::array{area, FreeArea{}};
  }
  void draw_scene(Framebuffer& frame, const FreeArea& area, const std::array<float, 4>& background);
  void draw(int width, int height, double seconds);

  /// What the hand takes hold of is what is seen, as far as it has turned.
  void move_by_hand(Camera& camera, const PointedView& pointed);

  /// From where it is seen now, as far as it has turned.
  void fit_what_is_seen() {
    session_.camera = orbit(*session_.camera, std::exchange(turned_, 0));
    framing_.fit(session_, scene(), area_);
  }

  void take_picture(const Screenshot& picture);

  /// The session that shows what is seen now.
  Session shown_session() const;

  /// And turns a camera that orbits: by as much in a second as in a second of a video.
  void count_time(double frame_begin, bool advanced);

  /// In a window an error is a line for the user, who goes on; without one it ends the program.
  template <class Action>
  void attempt(const Action& action) {
    if (!window_) return action();
    try {
      action();
    } catch (const Interrupted&) {
      throw;
    } catch (const std::exception& error) {
      show_error(error.what());
    }
  }

  void show_error(const std::string& line);
  void obey(const UiRequests& requests);
  void tell_saved();
  void obey_recording(const UiRequests& requests);

  // The list of keyframes, played and filmed; in keyframes_play.cpp.
  struct ListPlay {
    bool films;
    Settings window;  ///< when it began
  };
  void obey_keyframes(const UiRequests& requests);
  void edit_recording(Session recording, const std::string& name);
  void play_keyframes(double from);
  void film_keyframes(const std::filesystem::path& file);
  void stop_keyframes();
  /// Once a frame: `shown`: what the list says of this frame has been drawn.
  void follow_keyframes(bool shown);
  std::optional<double> keyframes_time() const;

  /// A session or a recording.
  void save(const std::filesystem::path& file, const std::string& text);

  /// A recording's events, from now on; those that have been played before it came here are over.
  void begin_playing(SessionPlayer player) {
    player_.emplace(std::move(player));
    played_since_ = time_.seconds() - std::max(0.0, player_->time());
    scripted_ = player_->plays();
  }

  /// Its state; where it is a recording, that is played. Also what a picture shows.
  void load_session(const std::filesystem::path& file) { play(open_session(file), file); }
  void play(Session loaded, const std::filesystem::path& file);
  std::array<int, 2> size() const {
    if (window_) return window_->pixels();
    return {session_.settings.width, session_.settings.height};
  }

  /// Per pixel. Software renderers pay for each: there, frames that somebody waits for have one.
  int samples() const {
    const bool software = result_.renderer.find("llvmpipe") != std::string::npos;
    return session_.settings.samples > 1 && (waits() || !software) ? 4 : 1;
  }

  bool waits() const { return (options_.offscreen && !options_.live) || film_.on(); }

  /// What has been changed since the last frame: by the user, the script, a file. True where anything has.
  bool take_changes();
  void note_last_changes() {
    if (recording_.on() && session_change(told_, session_)) recording_.note_last(session_);
  }

  void write_recording() {
    note_last_changes();
    recording_.write();
  }

  void open_dropped();
  void note_times(double begin, double end);
  void finish();

  const ViewerOptions& options_;
  Session session_, told_;
  std::optional<SessionPlayer> player_;
  KeptRecording recording_;
  Film film_;
  Saving saving_;
  SessionClock time_;
  double started_, last_ = 0;              ///< on the machine's clock
  double turned_ = 0;                      ///< degrees, of a camera that orbits
  double played_since_ = 0;                ///< on the session's clock
  std::vector<Screenshot> late_pictures_;  ///< of a frame that still waits for compute
  std::unique_ptr<Context> context_;
  Window* window_ = nullptr;  ///< the context, where it is one
  std::optional<ImGuiLayer> imgui_;
  std::optional<ScenePainter> painter_;
  std::optional<Framebuffer> frame_;
  OpenScene open_;
  std::optional<Opening> opening_;
  std::optional<ListPlay> list_play_;
  LeftScenes left_;
  Comparison comparison_;
  Ui ui_;
  Undo undo_;
  RecentFiles recent_;
  Thumbnails thumbnails_;
  UiRequests requests_;
  Framing framing_;
  FreeArea area_;  ///< of the view
  FrameClock clock_;
  DrawDemand demand_;
  bool quit_ = false, spare_ = false;
  bool may_differ_ = true;      ///< the session, from the last one passed on: comparing costs more than waiting
  bool redraw_ = false;         ///< the window has events
  bool unsaved_ = false;        ///< the user has changed what a result depends on
  bool scripted_ = false;       ///< changes are those of a recording
  bool settled_knobs_ = false;  ///< the next change is the data's
  int counted_ = 0;
  EventLog event_log_;
  std::vector<std::filesystem::path> dropped_;
  ViewerResult result_;
};

}  // namespace nacre
