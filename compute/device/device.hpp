// Nacre: where memory is allocated and kernels run.
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

namespace nacre {

/// While one lives, this thread only notes its launches down, to run them later (Executor::repeat). What a Device does
/// at once would overtake them: it is forbidden then, on every backend.
class Recording {
 public:
  Recording() { ++depth_; }
  ~Recording() { --depth_; }
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Throws std::logic_error while one lives in this thread: a mistake of ours.
  static void forbid(const char* what) {
    if (depth_ > 0) throw std::logic_error(std::string(what) + " inside of a part that is repeated");
  }

 private:
  static inline thread_local int depth_ = 0;
};

/// Memory of one backend. Chosen once per run; everything a pipeline makes lives on one device.
/// Pointers from `allocate` must not be read on the host: copy them with a named call, also on the CPU.
class Device {
 public:
  virtual ~Device() = default;

  virtual std::string backend() const = 0;  ///< "cpu" or "cuda"
  virtual std::string name() const = 0;     ///< the processor, for the report
  virtual int threads() const = 0;          ///< worker threads (1 for CUDA)
  virtual bool shares_host_memory() const { return false; }
  /// What the user should know about it before work begins, as a sentence; empty where there is nothing to say.
  virtual std::string remark() const { return {}; }

  /// A block aligned to 256 bytes, not initialised. Throws Error when there is not that much.
  virtual void* allocate(std::size_t bytes) = 0;
  virtual void deallocate(void* block, std::size_t bytes) noexcept = 0;
  /// A block whose memory `commit` may have to take first, so that one that is hardly used takes little. Throws Error.
  virtual void* reserve(std::size_t bytes) { return allocate(bytes); }
  virtual void release(void* block, std::size_t bytes) noexcept { deallocate(block, bytes); }
  /// Bytes `from` to `to` of a reserved block will be used. Throws Error where there is no memory left.
  virtual void commit(void* /*block*/, std::size_t /*from*/, std::size_t /*to*/) {}
  /// What bytes `from` to `to` of a reserved block hold is not needed any more: others may have the memory.
  virtual void give_back(void* /*block*/, std::size_t /*from*/, std::size_t /*to*/) {}
  /// How much of bytes `from` to `to` of a reserved block there is memory for now: others may have taken it meanwhile.
  virtual std::size_t obtainable_bytes(const void* /*block*/, std::size_t from, std::size_t to) const {
    return to - from;
  }
  /// `advice` for a user whose work does not fit, and the other device where there is one with more memory.
  virtual std::string too_small(const std::string& advice) const { return advice; }

  virtual void copy_to_device(void* to, const void* host, std::size_t bytes) = 0;
  virtual void copy_to_host(void* host, const void* from, std::size_t bytes) = 0;
  virtual void fill(void* to, unsigned char value, std::size_t bytes) = 0;
  virtual void synchronize() = 0;

  virtual std::size_t available_bytes() const = 0;  ///< what can still be had without harming others
  /// Largest block worth asking for as an arena: memory that costs nothing until touched may be asked for generously.
  virtual std::size_t arena_bytes() const = 0;
  virtual std::size_t peak_bytes() const = 0;  ///< most device memory in use so far
};

/// The CPU with `threads` workers (0: all). With `remote`, its memory can be touched only while a kernel or a named
/// copy runs: any other access is a segmentation fault, so that a missing copy fails without a GPU.
std::unique_ptr<Device> make_cpu_device(int threads = 0, bool remote = false);

/// Number of CUDA devices: 0 where the first cannot be used, without a driver, on a GPU that this build has no code
/// for, or in a build without CUDA.
int cuda_device_count();

/// Why a machine with NVIDIA's driver does not use its GPU, as a sentence; empty where it can, or where there is no
/// driver.
std::string why_no_cuda();

/// CUDA device `number`. Its arenas reserve four fifths of what is free when they are made, but at most `arena_limit`
/// bytes (0: no limit), and take what they use. Throws Error where there is no such device or the build has no CUDA.
std::unique_ptr<Device> make_cuda_device(std::size_t arena_limit = 0, int number = 0);

/// `request`: "auto" (CUDA where usable, else CPU), "cpu", "cuda" or "cuda:NUMBER".
std::unique_ptr<Device> make_device(const std::string& request, int threads = 0);

}  // namespace nacre
