// Nacre: a thread of a kernel that can wait in the middle of its work while others run, all on one thread of the CPU.
#pragma once

#include <cstddef>

namespace emulated {

/// A stack of its own, and where it stands. One runs at a time.
class Fiber {
 public:
  Fiber() = default;
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  /// The first `resume` calls `entry`, which never returns: it pauses where its work is done, and is resumed for the
  /// next. ThreadSanitizer counts the calls that were not left, so none may be given up. A second call does
  /// nothing.
  void start(void (*entry)());
  /// Lets it run until it pauses.
  void resume();
  /// Of the one that runs: goes back to who resumed it.
  void pause();

 private:
  static constexpr std::size_t stack_bytes = std::size_t(320) << 10;

  char* stack_ = nullptr;
  void* position_ = nullptr;   ///< top of its stack while it waits
  void* resumed_ = nullptr;    ///< top of the stack of who resumed it
  void* sanitizer_ = nullptr;  ///< what ThreadSanitizer takes for a thread
  void* resumer_ = nullptr;
};

/// Tells ThreadSanitizer that what happened before `release` happens before what follows `acquire` of the same address.
/// Fibers are not ordered otherwise, although they run one after the other: so races are seen.
void release(void* address);
void acquire(void* address);

}  // namespace emulated
