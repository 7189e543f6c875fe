// Nacre: recordings: what a user did and when, played again on any clock. The same events give the same session.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/scene/session.hpp"

namespace nacre {

/// Plays the events of a session.
class SessionPlayer {
 public:
  explicit SessionPlayer(Session recording);

  /// Brings `now` to `time` (seconds, never less than at the last call): makes the changes of all events up to then, and
  /// moves the camera where one is on its way. Returns the pictures to be taken of this frame.
  std::vector<Screenshot> advance(double time, Session& now);

  double duration() const { return recording_.duration; }

 private:
  struct Glide {
    Camera from, to;
    double begin, over;
  };

  Session recording_;
  std::size_t next_ = 0;  ///< event
  std::optional<Glide> glide_;
};

/// Between two cameras, 0 <= share <= 1: about the target, at even speed of angle and logarithm of distance.
Camera between(const Camera& from, const Camera& to, double share);

/// Writes down what changes. Times are those of the frames of a clock with `fps` frames a second, so that a recording of a
/// replay is the recording again.
class SessionRecorder {
 public:
  SessionRecorder(const Session& start, int fps);

  /// The session as it is in the frame at `time` (seconds since the start), and the pictures taken of it.
  void note(double time, const Session& now, const std::vector<Screenshot>& pictures = {});

  /// The camera has been fitted to what was read: no doing of the user's. A replay fits it, too.
  void accept_camera(const Camera& camera) { last_.camera = camera; }

  /// From the start to `time`.
  Session recording(double time) const;

 private:
  double frame_time(double time) const;

  Session start_, last_;
  int fps_;
  std::vector<SessionEvent> events_;
};

}  // namespace nacre
