// Nacre: what both kinds of contexts share: functions, version, messages of the driver.
#include "engine/gl/context.hpp"

#include <GL/glew.h>

#include "compute/device/error.hpp"
#include "engine/gl/errors.hpp"
#include "engine/system/faults.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_messages = 1000;  // a driver that complains in every frame must not fill the memory

bool is_complaint(GLenum type, GLenum severity) {
  return severity != GL_DEBUG_SEVERITY_NOTIFICATION && type != GL_DEBUG_TYPE_PERFORMANCE && type != GL_DEBUG_TYPE_OTHER;
}

std::string text_of(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text ? reinterpret_cast<const char*>(text) : "";
}

}  // namespace

Error opengl_missing(const std::string& why) {
  return Error(
      "no OpenGL 4.5", why,
      "update the graphics driver, or set LIBGL_ALWAYS_SOFTWARE=1 to draw with Mesa; nacre flow and nacre mesh "
      "need no OpenGL");
}

bool Context::lost() const { return fault_due("lost-context") || glGetGraphicsResetStatus() != GL_NO_ERROR; }

std::vector<std::string> Context::messages() const {
  std::scoped_lock lock(mutex_);
  return messages_;
}

void Context::note(std::string message) {
  std::scoped_lock lock(mutex_);
  if (messages_.size() < most_messages) messages_.push_back(std::move(message));
}

void Context::begin() {
  glewExperimental = GL_TRUE;  // a core context does not list its extensions in the way that GLEW asks for first
  const GLenum status = glewInit();
  constexpr GLenum no_glx_display = 4;  // all functions are loaded; there is only no X server
  if (status != GLEW_OK && status != no_glx_display)
    throw opengl_missing(reinterpret_cast<const char*>(glewGetErrorString(status)));
  while (glGetError() != GL_NO_ERROR) {  // GLEW leaves an error behind in core contexts
  }
  renderer_ = text_of(GL_RENDERER);
  version_ = text_of(GL_VERSION);
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  if (major * 10 + minor < 45) throw opengl_missing(renderer_ + " has " + version_);
  const auto listen = [](GLenum, GLenum type, GLuint, GLenum severity, GLsizei length, const GLchar* text,
                         const void* self) {
    if (is_complaint(type, severity))
      static_cast<Context*>(const_cast<void*>(self))->note(std::string(text, length < 0 ? 0 : std::size_t(length)));
  };
  glEnable(GL_DEBUG_OUTPUT);
  glDebugMessageCallback(listen, this);
  // One convention for all passes: depth from 1 (near) to 0 (far), which keeps floating-point depth exact far away.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GREATER);
  glClearDepth(0);
}

}  // namespace nacre
