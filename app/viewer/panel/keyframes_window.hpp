// Nacre: the window in which a recording is made and edited: its keyframes as a list and on an axis of time.
#pragma once

#include <imgui.h>

#include <optional>
#include <string>
#include <utility>

#include "app/viewer/panel/keyframe_track.hpp"
#include "app/viewer/scene/free_area.hpp"
#include "engine/scene/session/keyframes.hpp"

namespace nacre {

class KeyframesWindow {
 public:
  /// What the loop knows.
  struct Facts {
    std::optional<double> time;  ///< of the list, where it is being played
    bool filming = false;        ///< a video is being made of it: nothing may lie over the picture
    bool recording = false;      ///< what the user does is being recorded
  };
  /// What the window cannot do itself.
  struct Wish {
    std::optional<double> play;  ///< from this time
    bool stop = false;
    bool take_recording = false;  ///< of what the user does: it ends, and is edited here
    bool open = false, save = false, film = false, screenshot = false;  ///< asks for a file
  };
  /// With Dear ImGui. What is to be seen of the list goes into the session.
  Wish draw(Session& session, const FreeArea& area, const Facts& facts);

  void toggle() { open_ = !open_; }
  bool is_open() const { return open_; }
  /// Shows this recording, with its beginning; `file`: its name; empty: it is in none.
  void edit(Session recording, const std::string& file, Session& session);
  void add_screenshot(const Screenshot& picture) { selected_ = list_.add_screenshot(playhead_, picture); }
  void note_saved(const std::string& file);
  /// Is there anything to play?
  bool can_save() const { return list_.duration() > 0 || !list_.events().empty(); }

  const Keyframes& list() const { return list_; }
  const std::string& file() const { return file_; }
  /// Does what is typed go to it? Then it takes back its own changes.
  bool has_keys() const { return open_ && focused_; }
  void undo();
  void redo();

 private:
  void menus(Session& session, const Facts& facts, Wish& wish);
  void buttons(Session& session);
  void player(Session& session, const Facts& facts, Wish& wish);
  void rows(Session& session);
  void beginning_row(Session& session);
  void event_row(int row, Session& session);
  bool select_row(int row, Session& session);
  void details();
  void thin_popup();
  bool seconds_field(const char* name, double& value);
  void add(double time, Session& session);
  void update(const Session& session);
  void remove_selected();
  void go_to(double time, Session& session);
  void go_to_selected(Session& session);
  void replace_selected(SessionEvent event) { selected_ = list_.replace(*selected_, std::move(event)); }
  bool has_event() const { return selected_ && *selected_ >= 0; }
  const SessionEvent& event() const { return list_.events()[std::size_t(*selected_)]; }

  Keyframes list_;
  KeyframeTrack track_;
  std::string file_, told_;
  bool open_ = false, focused_ = false, asks_thin_ = false;
  bool went_ = false;  ///< to a time, in this frame: playing would lead away from it
  double playhead_ = 0;
  std::optional<int> selected_;
  static constexpr int frames_to_settle = 3;  ///< what is below the list changes its height
  std::optional<int> seen_;                   ///< the row that was selected in the last frame
  int scrolls_ = 0;                           ///< to the selected row, for so many frames
  float below_ = 0;                           ///< pixels that the list leaves for the details
  ImGuiID held_ = 0;                          ///< the field that is being changed
  double held_value_ = 0;
  double tolerance_ = 0.5;                  ///< percent
  std::pair<long, double> thinned_{-1, 0};  ///< version and tolerance for which it is known
  std::size_t left_ = 0;                    ///< so many events would be
};

}  // namespace nacre
