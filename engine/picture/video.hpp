// Nacre: the destination of the frames of an animation: a folder of pictures, or a video.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/picture/image.hpp"

namespace nacre {

/// Frames first .. last - 1 of a run.
struct FrameRange {
  int first = 0, last = 0;
};

/// Takes frames in the order in which they are shown.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// A frame of another size than the first is clipped or framed to that. Throws Error if the frame cannot be written;
  /// the sink cannot be used after that.
  void add(const Image& frame);

  /// Says how the frames came about (engine/run/origin.hpp), before the first of them. A video has it as its comment,
  /// except a .gif; pictures in a folder do not have it.
  virtual void describe(const std::string& origin) { (void)origin; }

  /// Completes the result. Throws Error if that fails or no frame was added. A sink that is destroyed without `finish`
  /// leaves no incomplete file.
  virtual void finish() = 0;

 protected:
  virtual void write(const Image& frame) = 0;

 private:
  int width_ = 0, height_ = 0;
};

/// Throws Error if ffmpeg would refuse frames of so many pixels.
void check_video_size(int width, int height);

/// frame_0000.png, frame_0001.png and so on in `folder`, which is made if missing. Each file is complete at any time.
/// The first frame removes those of an earlier run (files with exactly such names, no others), so that a film made of
/// the folder is of one run, however that ends; `say` gets a message with their number. A folder that was made for
/// frames and gets none is removed. Throws Error if it cannot be made.
///
/// `part`: the frames of one part of a run, whose other parts may be written to the same folder at the same time. They
/// are numbered as in the whole run, and only earlier frames with these numbers are removed.
std::unique_ptr<FrameSink> make_frame_folder(const std::filesystem::path& folder,
                                             std::function<void(const std::string&)> say = {},
                                             std::optional<FrameRange> part = {});

/// "frame_0012.png".
std::string frame_name(long number);

/// How many frames a folder holds, frame_0000.png first. Throws Error if there are none or one is missing.
int count_frames(const std::filesystem::path& folder);

/// Gives frames of a folder to `to`; null: only looks whether they are there. Throws Error that names the first one
/// that is missing or cannot be read.
void repeat_frames(const std::filesystem::path& folder, FrameRange frames, FrameSink* to);

/// Throws Error if the extension of `file` is not a kind of video that `make_video` makes.
void check_video_name(const std::filesystem::path& file);

/// A video by the program ffmpeg, `fps` frames a second: .mp4, .mov and .mkv (H.264), .webm (VP9) or .gif by the
/// extension. Odd sizes gain one column or row. Written beside `file`, renamed by `finish`. Throws Error if the
/// extension is another, if ffmpeg is missing, or if the file cannot be written. `stop` (may be null) ends every wait
/// for ffmpeg: Interrupted.
std::unique_ptr<FrameSink> make_video(const std::filesystem::path& file, int fps,
                                      const std::atomic<bool>* stop = nullptr);

/// A video of all frames of `folder`, otherwise as `make_video`; `origin` as in FrameSink::describe. Throws Error if a
/// frame is missing or cannot be read.
void make_video_of_folder(const std::filesystem::path& folder, const std::filesystem::path& file, int fps,
                          const std::string& origin, const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
