// Nacre: fibers, by switching stacks.
#include "tests/emulated/runtime/fiber.hpp"

#include <sys/mman.h>

#include <cstdio>
#include <cstdlib>

#if defined(NACRE_EMULATED_SANITIZE_THREAD)
extern "C" {
void* __tsan_get_current_fiber();
void* __tsan_create_fiber(unsigned flags);
void __tsan_switch_to_fiber(void* fiber, unsigned flags);
void __tsan_acquire(void* address);
void __tsan_release(void* address);
}
#endif

#if !defined(__x86_64__)
#error "fibers are written for x86-64"
#endif

// Saves what a call must keep on this stack, leaves the stack's top in *from and goes on where `to` stopped.
extern "C" void nacre_switch_stack(void** from, void* to);
asm(R"(
.globl nacre_switch_stack
nacre_switch_stack:
  push %rbp
  push %rbx
  push %r12
  push %r13
  push %r14
  push %r15
  mov %rsp, (%rdi)
  mov %rsi, %rsp
  pop %r15
  pop %r14
  pop %r13
  pop %r12
  pop %rbx
  pop %rbp
  ret
)");

namespace emulated {

#if defined(NACRE_EMULATED_SANITIZE_THREAD)
namespace {
constexpr unsigned not_ordered = 1;  // __tsan_switch_to_fiber_no_sync
}
void release(void* address) { __tsan_release(address); }
void acquire(void* address) { __tsan_acquire(address); }
#else
void release(void*) {}
void acquire(void*) {}
#endif

[[gnu::no_sanitize("thread")]] void Fiber::start(void (*entry)()) {
  if (stack_) return;
  void* block = mmap(nullptr, stack_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (block == MAP_FAILED) std::perror("emulated device: a fiber's stack"), std::abort();
  mprotect(block, 4096, PROT_NONE);  // who needs more shall not write elsewhere
  stack_ = static_cast<char*>(block);
#if defined(NACRE_EMULATED_SANITIZE_THREAD)
  sanitizer_ = __tsan_create_fiber(0);
#endif
  // Not all at the same position of their stacks: these would share a few lines of the caches.
  static std::size_t made = 0;
  const std::size_t colour = made++ % 64 * 17 * 64;
  constexpr int kept_registers = 6;
  void** top = reinterpret_cast<void**>(stack_ + stack_bytes - 64 - colour);
  *--top = nullptr;  // the stack as it is after a call: entry has nowhere to return to
  *--top = reinterpret_cast<void*>(entry);
  for (int k = 0; k < kept_registers; ++k) *--top = nullptr;
  position_ = top;
}

[[gnu::no_sanitize("thread")]] void Fiber::resume() {
  void* const to = position_;  // read as who resumes it, for ThreadSanitizer
#if defined(NACRE_EMULATED_SANITIZE_THREAD)
  resumer_ = __tsan_get_current_fiber();
  __tsan_switch_to_fiber(sanitizer_, not_ordered);
#endif
  nacre_switch_stack(&resumed_, to);
}

[[gnu::no_sanitize("thread")]] void Fiber::pause() {
  void* const to = resumed_;
#if defined(NACRE_EMULATED_SANITIZE_THREAD)
  __tsan_switch_to_fiber(resumer_, not_ordered);
#endif
  nacre_switch_stack(&position_, to);
}

}  // namespace emulated
