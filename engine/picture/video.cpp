// Nacre: the destination of the frames of an animation: a folder of pictures, or a video.
#include "engine/picture/video.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compute/device/error.hpp"
#include "engine/picture/compose.hpp"
#include "engine/picture/png.hpp"
#include "engine/system/child_process.hpp"
#include "engine/system/extension.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace fs = std::filesystem;

std::string frame_name(long number) { return fmt::format("frame_{:04}.png", number); }

namespace {

using Arguments = std::vector<std::string>;

/// The number in the name of a frame; -1: it is not such a name.
long frame_number(const std::string& name) {
  long number = -1;
  return std::sscanf(name.c_str(), "frame_%9ld", &number) == 1 && number >= 0 && name == frame_name(number) ? number
                                                                                                            : -1;
}

class FrameFolder : public FrameSink {
 public:
  FrameFolder(fs::path folder, std::function<void(const std::string&)> say, std::optional<FrameRange> part)
      : folder_(std::move(folder)), say_(std::move(say)), part_(part), first_(part ? part->first : 0) {
    std::error_code failed;
    made_ = fs::create_directories(folder_, failed);
    if (!fs::is_directory(folder_))
      throw Error("cannot make the folder " + folder_.string(), failed ? failed.message() : "a file has that name",
                  advice_on_writing(failed.value()));
  }

  ~FrameFolder() override {
    std::error_code ignored;
    if (made_ && count_ == 0) fs::remove(folder_, ignored);  // if it is empty
  }

  void write(const Image& frame) override {
    if (count_ == 0) remove_earlier_frames();
    write_png(folder_ / frame_name(first_ + count_), frame);
    ++count_;
  }

  void finish() override {
    if (count_ == 0 && !(part_ && part_->first == part_->last))
      throw Error("there are no frames to write to " + folder_.string());
  }

 private:
  void remove_earlier_frames() const {
    std::error_code ignored;  // old frames are overwritten, or the next frame reports what is wrong with the folder
    std::vector<fs::path> earlier;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_, ignored))
      if (concerns(frame_number(entry.path().filename().string())) && entry.is_regular_file(ignored))
        earlier.push_back(entry.path());
    std::size_t removed = 0;
    for (const fs::path& file : earlier) removed += fs::remove(file, ignored);
    if (removed > 0 && say_)
      say_(fmt::format("removed {} frame{} of an earlier run from {}", removed, removed == 1 ? "" : "s",
                       folder_.string()));
  }

  bool concerns(long number) const {
    return number >= 0 && (!part_ || (number >= part_->first && number < part_->last));
  }

  fs::path folder_;
  std::function<void(const std::string&)> say_;
  std::optional<FrameRange> part_;
  int first_;  ///< number of the first frame
  bool made_ = false;
  int count_ = 0;
};

/// ffmpeg's options for one kind of file: the container, the encoder, the filter that gives the encoder's pixels.
struct Format {
  std::string container, filter;
  Arguments encoder;
};

/// The texture is noise to an encoder. Its usual quality would smear it, so a higher one is requested.
Format format_of(const fs::path& file) {
  const std::string extension = lower_extension(file);
  // The matrix of HDTV, stated in the stream: without it, players guess differently.
  const std::string yuv = "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p";
  const Arguments tags = {"-colorspace", "bt709", "-color_primaries", "bt709",
                          "-color_trc",  "bt709", "-color_range",     "tv"};
  Arguments h264 = {"-c:v", "libx264", "-preset", "medium", "-crf", "16"};
  Arguments vp9 = {"-c:v", "libvpx-vp9", "-crf", "22", "-b:v", "0", "-row-mt", "1", "-cpu-used", "4"};
  h264.insert(h264.end(), tags.begin(), tags.end());
  vp9.insert(vp9.end(), tags.begin(), tags.end());
  if (extension == ".mkv") return {"matroska", yuv, h264};
  if (extension == ".webm") return {"webm", yuv, vp9};
  if (extension == ".gif") return {"gif", "split[a][b];[a]palettegen[p];[b][p]paletteuse=dither=sierra2_4a", {}};
  h264.insert(h264.end(), {"-movflags", "+faststart"});
  if (extension == ".mp4") return {"mp4", yuv, h264};
  if (extension == ".mov") return {"mov", yuv, h264};
  throw Error("cannot write the video " + file.string(), "its extension is not that of a video",
              "name it .mp4, .mov, .mkv, .webm or .gif");
}

class Video : public FrameSink {
 public:
  Video(const fs::path& file, int fps, const std::atomic<bool>* stop)
      : name_(file.string()),
        fps_(fps),
        stop_(stop),
        format_(format_of(file)),
        program_(find_program("ffmpeg")),
        output_(file, OutputFile::Devices::refused) {
    assert(fps > 0);
    if (program_.empty())
      throw Error("cannot write the video " + name_, "the program ffmpeg was not found",
                  "install the package ffmpeg, or write a folder of pictures");
  }

  void write(const Image& frame) override {
    if (!child_) start(frame.width, frame.height);
    assert(frame.width == width_ && frame.height == height_);
    pack(frame);
    if (!child_->send(packed_.data(), packed_.size())) fail();
  }

  void describe(const std::string& origin) override { origin_ = origin; }

  void finish() override {
    if (!child_) throw Error("cannot write the video " + name_, "it has no frames");
    // ffmpeg ends with status 0 after some failed writes, so a message on stderr counts as a failure, too.
    if (!child_->wait() || !child_->first_complaint().empty()) fail();
    output_.commit();
  }

 private:
  void start(int width, int height) {
    width_ = width;
    height_ = height;
    const std::string size = fmt::format("{}x{}", even(width), even(height));
    Arguments arguments = {"-nostdin", "-hide_banner", "-loglevel",          "error", "-y",
                           "-f",       "rawvideo",     "-pixel_format",      "rgb24", "-video_size",
                           size,       "-framerate",   std::to_string(fps_), "-i",    "pipe:0",
                           "-vf",      format_.filter};
    arguments.insert(arguments.end(), format_.encoder.begin(), format_.encoder.end());
    // Without random numbers and the version of ffmpeg, so that the same frames give the same file.
    arguments.insert(arguments.end(), {"-fflags", "+bitexact", "-flags:v", "+bitexact"});
    if (!origin_.empty()) arguments.insert(arguments.end(), {"-metadata", "comment=" + origin_});
    // "file:" prevents a colon in the name from being read as a protocol.
    arguments.insert(arguments.end(), {"-f", format_.container, "file:" + fs::absolute(output_.temporary()).string()});
    child_.emplace(program_, arguments, stop_);
    packed_.resize(std::size_t(even(width)) * std::size_t(even(height)) * 3);
  }

  static int even(int n) { return n + n % 2; }

  /// Three bytes a pixel; the last column and row are doubled if the size is odd, which 4:2:0 cannot represent.
  void pack(const Image& frame) {
    std::uint8_t* out = packed_.data();
    for (int y = 0; y < even(height_); ++y)
      for (int x = 0; x < even(width_); ++x, out += 3)
        std::memcpy(out, frame.at(std::min(x, width_ - 1), std::min(y, height_ - 1)), 3);
  }

  [[noreturn]] void fail() {
    child_->wait();
    std::string reason = child_->first_complaint();
    if (reason.empty()) reason = "ffmpeg ended early";
    const bool full = reason.find(std::strerror(ENOSPC)) != std::string::npos;
    throw Error("cannot write the video " + name_, "ffmpeg: " + reason,
                full ? advice_on_writing(ENOSPC) : "write a folder of pictures instead");
  }

  std::string name_, origin_;
  int fps_;
  const std::atomic<bool>* stop_;
  Format format_;
  fs::path program_;
  OutputFile output_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint8_t> packed_;
  std::optional<ChildProcess> child_;  ///< declared after output_: killed before the file it writes to is removed
};

}  // namespace

void FrameSink::add(const Image& frame) {
  if (width_ == 0) width_ = frame.width, height_ = frame.height;
  const bool fits = frame.width == width_ && frame.height == height_;
  write(fits ? frame : on_canvas(frame, width_, height_));
}

void check_video_size(int width, int height) {
  // The sizes that libavutil rejects: bytes of a padded picture, counted in 31 bits.
  constexpr std::int64_t most = std::numeric_limits<int>::max(), padding = 128, bytes = 8;
  if (bytes * (width + width % 2 + padding) * (height + height % 2 + padding) >= most)
    throw Error(fmt::format("frames of {} x {} pixels are too large for a video", width, height),
                fmt::format("ffmpeg takes about {} million pixels", most / bytes / 1000000), "choose a smaller size");
}

std::unique_ptr<FrameSink> make_frame_folder(const fs::path& folder, std::function<void(const std::string&)> say,
                                             std::optional<FrameRange> part) {
  return std::make_unique<FrameFolder>(folder, std::move(say), part);
}

int count_frames(const fs::path& folder) {
  std::error_code failed;
  long frames = 0, last = -1;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    const long number = frame_number(entry.path().filename().string());
    frames += number >= 0;
    last = std::max(last, number);
  }
  if (failed) throw Error("cannot read the folder " + folder.string(), failed.message());
  if (frames == 0)
    throw Error("there are no frames in " + folder.string(), "", "write them with --frames " + folder.string());
  for (long number = 0; number <= last; ++number)
    if (!fs::exists(folder / frame_name(number)))
      throw Error(fmt::format("{} is missing in {}", frame_name(number), folder.string()),
                  fmt::format("it has {} of {} frames", frames, last + 1), "make that part of the run");
  return int(frames);
}

void repeat_frames(const fs::path& folder, FrameRange frames, FrameSink* to) {
  for (int number = frames.first; number < frames.last; ++number) {
    const fs::path file = folder / frame_name(number);
    if (!fs::exists(file))
      throw Error(fmt::format("{} is missing in {}", frame_name(number), folder.string()), "the run has made it before",
                  "put it back, or begin the run anew without its checkpoint");
    if (to) to->add(read_png(file));
  }
}

void check_video_name(const fs::path& file) { format_of(file); }

std::unique_ptr<FrameSink> make_video(const fs::path& file, int fps, const std::atomic<bool>* stop) {
  return std::make_unique<Video>(file, fps, stop);
}

void make_video_of_folder(const fs::path& folder, const fs::path& file, int fps, const std::string& origin,
                          const std::atomic<bool>* stop) {
  const std::unique_ptr<FrameSink> video = make_video(file, fps, stop);
  video->describe(origin);
  repeat_frames(folder, {0, count_frames(folder)}, video.get());
  video->finish();
}

}  // namespace nacre
