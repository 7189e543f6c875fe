// Nacre: a recording that is edited by hand: how it begins, and its events, which are the keyframes.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scene/session/recording.hpp"

namespace nacre {

/// Keyframes have rows: 0 and up are the events, in the order in which they are played. Each edit can be undone. Knobs
/// of the window (window_knobs.hpp) are kept where a recording has them, but no keyframe takes them over.
class Keyframes {
 public:
  static constexpr int beginning = -1;  ///< the row of the state before the first event
  static constexpr double spacing = 2;  ///< seconds from one keyframe to the next, if nobody says otherwise

  /// Is there a beginning?
  bool begun() const { return state_.begun; }
  /// As it is played and saved.
  const Session& recording() const { return state_.recording; }
  const std::vector<SessionEvent>& events() const { return state_.recording.events; }
  double duration() const { return state_.recording.duration; }
  /// Where the last event ends.
  double last_end() const;
  /// The session before the first event.
  Session start() const;
  /// The session at `time`: what a player of the recording makes of its beginning.
  Session state_at(double time) const;

  /// A list that begins with this state, without events. Its pictures and videos have no panel.
  void begin(const Session& now);
  /// A recording to be edited. `saved`: it is in a file.
  void open(Session recording, bool saved);

  /// The list takes over how `now` differs from its own state at `time`, and is like it from then on. A camera arrives
  /// at `time`; it leaves when the last one has arrived, at most `spacing` before. A keyframe at that time is changed;
  /// a camera that is under way stops over. Returns the row; none where nothing differs. The first call begins the
  /// list.
  std::optional<int> add(double time, const Session& now);
  int add_screenshot(double time, const Screenshot& picture);
  /// The keyframe becomes what takes the state before it to `now`; its time stays. False where nothing would be left of
  /// it, and where it opens another input than is shown.
  bool update(int row, const Session& now);
  /// Another event in its place. Returns its row, which is another if its time is. An event that does nothing is
  /// removed.
  int replace(int row, SessionEvent event);
  /// A copy after it. Returns its row.
  int duplicate(int row);
  void remove(int row);
  /// Never less than `last_end`.
  void set_duration(double seconds);
  /// As thin_cameras. Returns by how many events it is shorter.
  std::size_t thin(double tolerance);

  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  void undo() { move(past_, future_); }
  void redo() { move(future_, past_); }

  /// Has anything been changed that is in no file?
  bool unsaved() const { return begun() && state_.version != saved_; }
  void note_saved() { saved_ = state_.version; }
  /// Another with each change.
  long version() const { return state_.version; }

 private:
  struct State {
    Session recording;
    bool begun = false;
    long version = 0;
  };

  void take(State next);
  void move(std::vector<State>& from, std::vector<State>& to);

  State state_;
  std::vector<State> past_, future_;
  long newest_ = 0, saved_ = 0;  ///< versions
};

}  // namespace nacre
