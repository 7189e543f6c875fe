// Nacre: the recording of what the user does, and its file, where it has one from the start.
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "app/viewer/panel/frame_clock.hpp"
#include "engine/scene/session/recording.hpp"

namespace nacre {

class KeptRecording {
 public:
  /// `write` (may be empty) is called with the whole recording.
  explicit KeptRecording(std::function<void(const Session&)> write) : write_(std::move(write)) {}

  bool on() const { return recorder_.has_value(); }
  bool has_file() const { return bool(write_); }
  /// `time`: on the session's clock, here and below.
  void begin(const Session& session, int fps, double time) {
    recorder_.emplace(session, fps);
    since_ = noted_ = time;
  }
  /// One that is written to a file goes on to the end.
  void end() {
    if (!write_) recorder_.reset();
  }
  /// `changed`: the session, where it is not as it was at the last call; else null.
  void note(double time, const Session* changed, const std::vector<Screenshot>& pictures) {
    if (!recorder_) return;
    noted_ = time;
    if (changed)
      recorder_->note(time - since_, *changed, pictures);
    else
      recorder_->note_unchanged(time - since_, pictures);
  }
  /// Of the frame that was noted last, when no other will come.
  void note_last(const Session& changed) { note(noted_, &changed, {}); }
  Session recording() const { return recorder_->recording(); }

  /// A crash or a power cut costs the last seconds. Long ones are written less often. Throws Error as `write` does.
  void keep() {
    const double begin = now();
    if (!recorder_ || !write_ || recorder_->events() == kept_events_ || begin < keep_after_) return;
    kept_events_ = recorder_->events();
    keep_after_ = begin + 1;  // also where it cannot be written
    write();
    keep_after_ = now() + std::max(1.0, 50 * (now() - begin));
  }
  void write() const {
    if (recorder_ && write_) write_(recorder_->recording());
  }

 private:
  std::function<void(const Session&)> write_;
  std::optional<SessionRecorder> recorder_;
  double since_ = 0, noted_ = 0;  ///< on the session's clock
  std::size_t kept_events_ = 0;   ///< written so far
  double keep_after_ = 0;         ///< on the machine's clock
};

}  // namespace nacre
