// Nacre: the target of all drawing.
#include "engine/gl/framebuffer.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "engine/gl/errors.hpp"

namespace nacre {
namespace {

GLuint make_renderbuffer(GLenum format, int width, int height, int samples) {
  GLuint id = 0;
  glCreateRenderbuffers(1, &id);
  glNamedRenderbufferStorageMultisample(id, samples > 1 ? samples : 0, format, width, height);
  return id;
}

/// What is drawn over a transparent background is multiplied by its opacity; images are not.
void divide_by_opacity(Image& image) {
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    const int opacity = image.pixels[i + 3];
    if (opacity == 0 || opacity == 255) continue;
    for (std::size_t c = i; c < i + 3; ++c)
      image.pixels[c] = std::uint8_t(std::min(255, (image.pixels[c] * 255 + opacity / 2) / opacity));
  }
}

int allowed_samples(int asked) {
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  return std::clamp(asked, 1, std::max(most, 1));
}

}  // namespace

int Framebuffer::most_size() {
  GLint most = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &most);
  return most;
}

Framebuffer::Framebuffer(int width, int height, int samples)
    : width_(width), height_(height), samples_(allowed_samples(samples)) {
  const int most = most_size();
  if (width < 1 || height < 1 || width > most || height > most)
    throw Error("a picture of " + std::to_string(width) + "x" + std::to_string(height) + " cannot be drawn",
                "this OpenGL draws 1 to " + std::to_string(most) + " pixels each way", "choose another --size");
  names_.colour = make_renderbuffer(GL_RGBA8, width, height, samples_);
  names_.depth = make_renderbuffer(GL_DEPTH_COMPONENT32F, width, height, samples_);
  glCreateFramebuffers(1, &names_.frame);
  glNamedFramebufferRenderbuffer(names_.frame, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, names_.colour);
  glNamedFramebufferRenderbuffer(names_.frame, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, names_.depth);
  require_gl_memory(std::size_t(width) * std::size_t(height) * 8 * std::size_t(samples_));
  if (glCheckNamedFramebufferStatus(names_.frame, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw Error("a picture of " + std::to_string(width) + "x" + std::to_string(height) + " cannot be drawn",
                "the graphics driver refuses it", "choose a smaller --size");
  if (samples_ > 1) single_ = std::make_unique<Framebuffer>(width, height, 1);
}

Framebuffer::Names::~Names() {
  glDeleteFramebuffers(1, &frame);
  glDeleteRenderbuffers(1, &colour);
  glDeleteRenderbuffers(1, &depth);
}

void Framebuffer::bind() const { bind_part(0, 0, width_, height_); }

void Framebuffer::bind_part(int x, int y, int width, int height) const {
  glBindFramebuffer(GL_FRAMEBUFFER, names_.frame);
  glViewport(x, y, width, height);
}

void Framebuffer::clear(const std::array<float, 4>& colour) const {
  const float far_away = 0;
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  glClearNamedFramebufferfv(names_.frame, GL_COLOR, 0, colour.data());
  glClearNamedFramebufferfv(names_.frame, GL_DEPTH, 0, &far_away);
}

GLuint Framebuffer::resolved() const {
  if (!single_) return names_.frame;
  glBlitNamedFramebuffer(names_.frame, single_->names_.frame, 0, 0, width_, height_, 0, 0, width_, height_,
                         GL_COLOR_BUFFER_BIT, GL_NEAREST);
  return single_->names_.frame;
}

void Framebuffer::show_in_window() const {
  const GLuint picture = resolved();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width_, height_);  // here Mesa queries the current size of the window
  glBlitNamedFramebuffer(picture, 0, 0, 0, width_, height_, 0, 0, width_, height_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Image Framebuffer::read() const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, resolved());
  std::vector<std::uint8_t> upside_down(std::size_t(width_) * std::size_t(height_) * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, upside_down.data());
  Image image(width_, height_);
  const std::size_t row = std::size_t(width_) * 4;
  for (int y = 0; y < height_; ++y) std::memcpy(image.at(0, y), &upside_down[std::size_t(height_ - 1 - y) * row], row);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, names_.frame);
  divide_by_opacity(image);
  return image;
}

}  // namespace nacre
