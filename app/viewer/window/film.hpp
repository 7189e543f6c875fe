// Nacre: the video that frames of the viewer go to: the command line's, or one that was begun in the menu.
#pragma once

#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "engine/picture/video.hpp"

namespace nacre {

class Film {
 public:
  /// `given`: the command line's, which finishes it; may be null.
  explicit Film(FrameSink* given) : given_(given) {}

  bool on() const { return own_ || given_; }
  bool from_menu() const { return own_ != nullptr; }
  const std::filesystem::path& file() const { return file_; }
  long frames() const { return frames_; }  ///< so far, of all videos
  /// Of the menu's video: "48 frames, 1.9 s". How long it lasts when it is played has little to do with how long it
  /// takes to be made.
  std::string length() const {
    const long frames = frames_ - before_;
    return fmt::format("{} frame{}, {:.1f} s", frames, frames == 1 ? "" : "s", double(frames) / fps_);
  }

  /// `stop` as `make_video`'s, and Errors. `origin`: how it comes about.
  void begin(const std::filesystem::path& file, int fps, const std::atomic<bool>* stop, const std::string& origin) {
    own_ = make_video(file, fps, stop);
    own_->describe(origin);
    file_ = file;
    fps_ = fps;
    before_ = frames_;
  }
  /// Throws Error where the frame cannot be written; such a video is over.
  void add(const Image& frame) {
    FrameSink* const sink = own_ ? own_.get() : given_;
    try {
      sink->add(frame);
      ++frames_;
    } catch (...) {
      drop();
      throw;
    }
  }
  /// Ends the menu's, if it is on. Throws Error where the file cannot be made whole.
  void finish() {
    if (const std::unique_ptr<FrameSink> ended = std::move(own_)) ended->finish();
  }

 private:
  void drop() {
    if (own_)
      own_.reset();
    else
      given_ = nullptr;
  }

  FrameSink* given_;
  std::unique_ptr<FrameSink> own_;
  std::filesystem::path file_;
  int fps_ = 1;
  long frames_ = 0, before_ = 0;  ///< written in all; before the menu's video began
};

}  // namespace nacre
