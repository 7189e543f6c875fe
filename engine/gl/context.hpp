// Nacre: an OpenGL 4.5 core context, in a window or without any display.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace nacre {

/// A context that is current on the thread that made it, until it dies. All of engine/gl, interop and render runs on
/// that thread.
class Context {
 public:
  virtual ~Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  virtual void make_current() = 0;

  const std::string& renderer() const { return renderer_; }  ///< e.g. "llvmpipe (LLVM 15.0.6, 256 bits)"
  const std::string& version() const { return version_; }

  /// Has the graphics device been reset (a crash of its driver, another GPU)? All of the context's objects are gone
  /// then.
  bool lost() const;

  /// What the driver has complained about so far: errors, undefined or deprecated use. Its notes on speed and memory
  /// are left out.
  std::vector<std::string> messages() const;

 protected:
  Context() = default;

  /// Loads the functions, checks the version and listens to the driver. The context is current. Throws Error.
  void begin();
  /// Called by the driver, on any thread.
  void note(std::string message);

 private:
  std::string renderer_, version_;
  mutable std::mutex mutex_;
  std::vector<std::string> messages_;
};

/// A context without window or display (EGL): Mesa's surfaceless platform, or a device's own. Draw into a Framebuffer.
/// `prefer_cuda`: the GPU that CUDA computes on is asked first. Throws Error where EGL or OpenGL 4.5 is missing.
std::unique_ptr<Context> make_offscreen_context(bool prefer_cuda = false);

}  // namespace nacre
