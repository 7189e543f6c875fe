// Nacre: the time of a session, in which events happen and videos run.
#pragma once

namespace nacre {

/// Frames that wait for compute have a share of a second each, however long they take; the time of others is the
/// machine's.
class SessionClock {
 public:
  explicit SessionClock(int fps) : fps_(fps) {}

  double seconds() const { return double(waited_) / fps_ + passed_; }
  /// Of frames that wait, whatever becomes of the knob meanwhile.
  int fps() const { return fps_; }
  /// Frames that wait have this rate from now on.
  void set_fps(int fps) {
    passed_ = seconds();
    waited_ = 0;
    fps_ = fps;
  }

  /// A frame was shown that waited for compute; or one that did not, which took so many seconds. Returns how many
  /// frames of a video that is.
  double add_frame() {
    ++waited_;
    return 1;
  }
  double add_seconds(double seconds, int fps) {
    passed_ += seconds;
    return seconds * fps;
  }

 private:
  int fps_;
  long waited_ = 0;
  double passed_ = 0;  ///< in frames that did not wait
};

}  // namespace nacre
