// Nacre: where the frames of an animation go: a folder of pictures, or a video.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "engine/picture/image.hpp"

namespace nacre {

/// Takes frames in the order of their showing.
class FrameSink {
 public:
  virtual ~FrameSink() = default;

  /// One of another size than the first is cut off or framed to that. Throws Error where the frame cannot be written; the
  /// sink is of no further use then.
  void add(const Image& frame);

  /// Makes the result whole. Throws Error where that fails or no frame was added. A sink that goes without `finish`
  /// leaves no half-written file.
  virtual void finish() = 0;

 protected:
  virtual void write(const Image& frame) = 0;

 private:
  int width_ = 0, height_ = 0;
};

/// Throws Error where ffmpeg would refuse frames of so many pixels.
void check_video_size(int width, int height);

/// frame_0000.png, frame_0001.png and so on in `folder`, which is made if missing. Each file is whole at any time. With the
/// first frame those of an earlier run go (files with just such names, no others), so that a film made of the folder is of
/// one run, however that ends; `say` is told how many. A folder that was made for them and gets none goes again. Throws
/// Error where it cannot be made.
std::unique_ptr<FrameSink> make_frame_folder(const std::filesystem::path& folder,
                                             std::function<void(const std::string&)> say = {});

/// Throws Error where the extension of `file` says no kind of video that `make_video` makes.
void check_video_name(const std::filesystem::path& file);

/// A video by the program ffmpeg, `fps` frames a second: .mp4, .mov and .mkv (H.264), .webm (VP9) or .gif by the name's
/// extension. Odd sizes gain one column or row. Written beside `file`, renamed by `finish`. Throws Error where the
/// extension is another, ffmpeg is missing, or the file cannot be written. `stop` (may be null) ends what waits for ffmpeg:
/// Interrupted.
std::unique_ptr<FrameSink> make_video(const std::filesystem::path& file, int fps,
                                      const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
