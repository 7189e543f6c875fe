// Nacre: the desktop viewer: a window, or the same frames without a display.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/scene/framing.hpp"
#include "compute/device/device.hpp"
#include "compute/device/stage_timers.hpp"
#include "engine/picture/image.hpp"
#include "engine/picture/video.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

struct ViewerOptions {
  Session session;                                       ///< its events are played
  std::function<std::unique_ptr<Device>()> open_device;  ///< one for each input that is opened
  /// Where a device is lost in a window: that of the inputs from then on.
  std::function<std::unique_ptr<Device>()> open_spare_device;
  bool offscreen = false;
  bool live = false;     ///< offscreen: frames do not wait for compute, as in a window
  int frames = 0;        ///< ends after as many complete ones; 0: when the window is closed, or what is played ends
  bool welcome = false;  ///< the session is nobody's wish: a card says what can be opened
  bool picture = false;  ///< return the last frame
  FrameSink* video = nullptr;  ///< takes every frame; these wait for compute, in a window, too
  std::function<void(const Session& done)>
      recorded;  ///< the user's actions: reported at the end, also after a failure, and from time to time in a window
  std::filesystem::path out;  ///< where to write the result at the end; empty: nowhere
  const std::atomic<bool>* stop = nullptr;
  Framing::FirstCamera first_camera;
  /// How a result came about, to be written into it: `output` is "screenshot", "video" or "out".
  std::function<std::string(const Session& shown, const std::string& output)> origin;
  std::function<void(const Session& session)> check;  ///< of one that is opened; throws Error as for the first
  std::function<void(const std::string& line)> say;   ///< a line for stderr
};

/// How it went, for the report.
struct ViewerResult {
  std::vector<double> frame_seconds;            ///< without waiting for compute (where frames do) or for the display
  double first_frame = 0;                       ///< seconds from the start to the first frame
  double first_surface = 0, first_texture = 0;  ///< to the first frame with it; 0: there was none
  long filmed_frames = 0;                       ///< in all videos
  int steps = 0;                                ///< of the flow, or iterations of the particles
  std::uint64_t copied_bytes = 0;
  std::string renderer, version;
  std::vector<std::string> driver_messages;
  StageTimers timers;
  std::size_t peak_bytes = 0;
  std::string device_name, backend;
  int threads = 0;
  Image image;
  std::vector<std::filesystem::path> pictures;  ///< written for events
  bool interrupted = false;                     ///< a window was ended by `stop`
  Session shown;                                ///< at the end
  std::string lost_video;                       ///< why the video of a window could not be written; empty: it could
};

/// Runs until it is closed. Throws Error where there is no display, no OpenGL 4.5, or (offscreen) a stage fails;
/// Interrupted where `stop` is set and there is no window.
ViewerResult run_viewer(const ViewerOptions& options);

}  // namespace nacre
