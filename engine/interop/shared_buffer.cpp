// Nacre: an array that compute writes and OpenGL draws.
#include "engine/interop/shared_buffer.hpp"

#include <cassert>
#include <cstring>

#include "compute/device/error.hpp"
#include "engine/system/faults.hpp"

namespace nacre {
namespace {

constexpr GLbitfield persistent = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
constexpr GLuint64 longest_wait = 5'000'000'000;  // ns: a graphics device that does not answer for longer is lost

}  // namespace

SharedBuffer::Path SharedBuffer::best_path(const Device& device) {
  if (fault_due("other-device")) return Path::copied;
  if (device.backend() != "cuda") return Path::mapped;
  return cuda_draws_here(device) ? Path::registered : Path::copied;
}

SharedBuffer::Half::~Half() {
  link.reset();  // CUDA must release the buffer before it is deleted
  if (fence) glDeleteSync(fence);
}

SharedBuffer::SharedBuffer(Device& device, std::size_t bytes, GLenum format, Path path)
    : device_(device), bytes_(bytes), path_(path) {
  if (path == Path::mapped && device.backend() != "cpu")
    throw Error("the " + device.backend() + " device cannot write into memory of OpenGL that lies on the host");
  if (fault_due("graphics-memory")) throw Error("the graphics device has no memory left");
  for (Half& half : halves_) {
    half.buffer = Buffer(bytes, path == Path::registered ? GLbitfield(0) : persistent);
    half.texture = BufferTexture(half.buffer, format);
    if (!half.buffer) continue;
    const float zero = 0;
    glClearNamedBufferData(half.buffer.id(), GL_R32F, GL_RED, GL_FLOAT, &zero);
    if (path == Path::registered)
      half.link = link_cuda(device_, half.buffer.id());
    else
      half.mapped = half.buffer.map(persistent);
  }
  glFinish();  // the zeros must be in place before anyone writes
  if (path == Path::copied) make_staging();
}

void SharedBuffer::make_staging() {
  if (device_.backend() == "cuda") pinned_ = pin_memory(bytes_);
  staging_ = device_.allocate(bytes_);
}

SharedBuffer::~SharedBuffer() {
  if (staging_) device_.deallocate(staging_, bytes_);
}

bool SharedBuffer::is_free(Half& half, bool wait) {
  if (!half.fence) return true;
  const GLenum state = glClientWaitSync(half.fence, GL_SYNC_FLUSH_COMMANDS_BIT, wait ? longest_wait : 0);
  if (state == GL_TIMEOUT_EXPIRED && !wait) return false;
  if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED)
    throw Error("the graphics device does not answer", "", "start the viewer again");
  glDeleteSync(half.fence);
  half.fence = nullptr;
  return true;
}

void* SharedBuffer::begin_write(bool wait) {
  assert(!writing_);
  Half& half = halves_[1 - shown_];
  if (!half.buffer || !is_free(half, wait)) return nullptr;
  writing_ = true;
  switch (path_) {
    case Path::mapped: return half.mapped;
    case Path::registered: return half.link->map();
    case Path::copied: break;
  }
  return staging_;
}

void SharedBuffer::end_write() {
  if (!writing_) return;
  Half& half = halves_[1 - shown_];
  if (path_ == Path::registered) {
    half.link->unmap();
  } else if (path_ == Path::copied) {
    if (pinned_) {
      device_.copy_to_host(pinned_->data(), staging_, bytes_);
      std::memcpy(half.mapped, pinned_->data(), bytes_);
    } else {
      device_.copy_to_host(half.mapped, staging_, bytes_);
    }
    copied_ += bytes_;
  }
  writing_ = false;
  shown_ = 1 - shown_;
}

void SharedBuffer::cancel_write() {
  if (writing_ && path_ == Path::registered) halves_[1 - shown_].link->unmap();
  writing_ = false;
}

void SharedBuffer::drawn() {
  Half& half = halves_[shown_];
  if (half.fence) glDeleteSync(half.fence);
  half.fence = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
}

std::string SharedBuffer::remark() const {
  if (path_ != Path::copied) return {};
  return "what is shown is copied from the computing device: another one draws";
}

}  // namespace nacre
