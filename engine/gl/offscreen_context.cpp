// Nacre: a context without a display, by EGL.
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstring>
#include <utility>

#include "engine/gl/context.hpp"
#include "engine/gl/errors.hpp"

namespace nacre {
namespace {

constexpr EGLint cuda_device_nv = 0x323A;  // EGL_CUDA_DEVICE_NV, of EGL_NV_device_cuda

/// Devices that EGL can draw with; those that CUDA knows come first if that is preferred.
std::vector<EGLDisplay> device_displays(bool cuda_only) {
  const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  const auto attribute = reinterpret_cast<PFNEGLQUERYDEVICEATTRIBEXTPROC>(eglGetProcAddress("eglQueryDeviceAttribEXT"));
  std::array<EGLDeviceEXT, 32> devices{};
  EGLint count = 0;
  if (!query || !attribute || !query(EGLint(devices.size()), devices.data(), &count)) return {};
  std::vector<EGLDisplay> displays;
  for (int k = 0; k < count; ++k) {
    EGLAttrib number = -1;
    if (cuda_only && (!attribute(devices[k], cuda_device_nv, &number) || number != 0)) continue;
    displays.push_back(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[k], nullptr));
  }
  return displays;
}

class OffscreenContext final : public Context {
 public:
  OffscreenContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {
    try {
      make_current();
      begin();
    } catch (...) {
      release();
      throw;
    }
  }

  // The display stays initialised, since other contexts may use it.
  ~OffscreenContext() override { release(); }

  void make_current() override {
    if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw opengl_missing("EGL cannot draw without a surface");
  }

 private:
  void release() {
    if (eglGetCurrentContext() == context_) eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }

  EGLDisplay display_;
  EGLContext context_;
};

/// A 4.5 core context on `display`, or EGL_NO_CONTEXT.
EGLContext create(EGLDisplay display) {
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API))
    return EGL_NO_CONTEXT;
  // Asks to be informed of resets, if the driver can do that.
  constexpr EGLint strategy = EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY;
  for (const EGLint told : {EGL_LOSE_CONTEXT_ON_RESET, EGL_NO_RESET_NOTIFICATION}) {
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                             4,
                             EGL_CONTEXT_MINOR_VERSION,
                             5,
                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                             EGL_CONTEXT_OPENGL_DEBUG,
                             EGL_TRUE,
                             strategy,
                             told,
                             EGL_NONE};
    const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    if (context != EGL_NO_CONTEXT) return context;
  }
  return EGL_NO_CONTEXT;
}

}  // namespace

std::unique_ptr<Context> make_offscreen_context(bool prefer_cuda) {
  std::vector<EGLDisplay> displays = prefer_cuda ? device_displays(true) : std::vector<EGLDisplay>();
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (extensions && std::strstr(extensions, "EGL_MESA_platform_surfaceless"))
    displays.push_back(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  for (EGLDisplay display : device_displays(false)) displays.push_back(display);
  for (EGLDisplay display : displays)
    if (const EGLContext context = create(display); context != EGL_NO_CONTEXT)
      return std::make_unique<OffscreenContext>(display, context);
  throw opengl_missing(displays.empty() ? "EGL knows no way to draw without a display" : "EGL gives no such context");
}

}  // namespace nacre
