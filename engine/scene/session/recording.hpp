// Nacre: recordings: what a user did and when, played again on any clock. The same events give the same session.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scene/session/session.hpp"

namespace nacre {

/// Plays the events of a session.
class SessionPlayer {
 public:
  explicit SessionPlayer(Session recording);

  /// Brings `now` to `time` (seconds, never less than at the last call): makes the changes of all events up to then,
  /// and moves the camera during a camera event. If the user moves it meanwhile, that holds until the next
  /// event's camera. Returns the pictures to be taken of this frame.
  std::vector<Screenshot> advance(double time, Session& now);

  /// Is there an event to play?
  bool plays() const { return !recording_.events.empty(); }

  /// Of the last call; none: below 0.
  double time() const { return time_; }

  /// Was there something to play, and has it been brought to its duration? So the last frame is the first at or after
  /// it.
  bool ended() const;

 private:
  struct Glide {
    Camera from, to, last;
    double begin, over;
  };

  void move_camera(double time, Session& now);

  Session recording_;
  std::size_t next_ = 0;  ///< event
  double time_ = -1;      ///< of the last call
  std::optional<Glide> glide_;
};

/// Between two cameras, 0 <= share <= 1: about the target, at even speed of angle and logarithm of distance.
Camera between(const Camera& from, const Camera& to, double share);

/// The share of its way that a camera has made after a share of its time: it starts and ends at rest.
double eased(double share);

/// Writes down what changes. Times are those of the frames of a clock with `fps` frames a second: the first frame at or
/// after what happened. All that happens within one such frame is one event, so that a recording of a replay is the
/// recording again. A camera that has been fitted to what was opened belongs to it, and is written there.
class SessionRecorder {
 public:
  SessionRecorder(const Session& start, int fps);

  /// The session as it is at `time` (seconds since the start, never less than at the last call), and the pictures taken
  /// of it.
  void note(double time, const Session& now, const std::vector<Screenshot>& pictures = {});
  /// The same where the session is as it was at the last call: it need not be compared.
  void note_unchanged(double time, const std::vector<Screenshot>& pictures = {});

  /// From the start to what was noted last.
  Session recording() const;

  std::size_t events() const { return events_.size(); }  ///< of frames that are over

 private:
  void begin_frame(double time);
  void close_frame();
  std::optional<Camera>& camera_of_opened();  ///< of what was opened last and waits for one

  Session start_, before_, now_;  ///< before_: at the end of the last frame of the clock that is written
  int fps_;
  long frame_ = 0;        ///< of the clock: not written yet
  bool changed_ = false;  ///< since `before_`
  std::vector<Screenshot> pictures_;
  std::vector<SessionEvent> events_;
};

}  // namespace nacre
