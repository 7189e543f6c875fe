// Nacre: blocks and threads of an emulated kernel.
#include "tests/emulated/runtime/grid_run.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "cuda_runtime.h"
#include "tests/emulated/runtime/settings.hpp"
#include "tests/emulated/runtime/team_run.hpp"

namespace emulated {

Index thread_index, block_index, block_size, grid_size;

namespace {

constexpr unsigned char shared_rubbish = 0xfb;
constexpr std::size_t margin = 64;  // behind a block's shared memory, to see who writes there

/// A block's shared memory and lanes. There are several, which blocks take in random order: for ThreadSanitizer, those
/// of two blocks are other threads.
struct Multiprocessor {
  TeamRun team;
  volatile unsigned char* shared = static_cast<unsigned char*>(
      mmap(nullptr, shared_limit + margin, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
};
std::array<Multiprocessor, 4>& multiprocessors() {
  static auto* all = new std::array<Multiprocessor, 4>;  // never ends: fibers may stand on it
  return *all;
}

unsigned char* shared_now = nullptr;
std::mt19937 random_order{settings().seed};
char block_ends;

#if defined(NACRE_EMULATED_SANITIZE_THREAD)
/// The sanitizer shall not see this: it orders blocks by nothing.
[[gnu::no_sanitize("thread")]] void spoil(volatile unsigned char* shared, std::size_t bytes) {
  for (std::size_t k = 0; k < bytes; ++k) shared[k] = shared_rubbish;
}
#else
void spoil(volatile unsigned char* shared, std::size_t bytes) {
  std::memset(const_cast<unsigned char*>(shared), shared_rubbish, bytes);
}
#endif
[[gnu::no_sanitize("thread")]] bool is_spoilt(const volatile unsigned char* shared, std::size_t bytes) {
  for (std::size_t k = 0; k < bytes; ++k)
    if (shared[k] != shared_rubbish) return false;
  return true;
}

void run_team_block(const Launch& launch, const std::function<void()>& lane) {
  Multiprocessor& here = multiprocessors()[random_order() % multiprocessors().size()];
  shared_now = const_cast<unsigned char*>(here.shared);
  spoil(here.shared, launch.shared_bytes + margin);
  if (settings().teams_ordered) {
    acquire(&block_ends);
    release(&launch_begins);
  }
  here.team.run(lane, launch.name, random_order);
  if (settings().teams_ordered) acquire(&launch_ends), release(&block_ends);
  if (!is_spoilt(here.shared + launch.shared_bytes, margin))
    broken("a team writes behind its shared memory", launch.name);
}

#if defined(NACRE_EMULATED_SANITIZE_THREAD)
/// Threads that wait for nobody, as fibers too: races between them are seen.
struct Loner {
  Fiber fiber;
  static inline Loner* running = nullptr;
  static inline const std::function<void()>* work = nullptr;

  static void entry() {
    for (;;) {
      acquire(&launch_begins);
      (*work)();
      release(&launch_ends);
      running->fiber.pause();
    }
  }
};
void run_thread(const std::function<void()>& lane) {
  static auto* pool = new std::array<Loner, 16>;
  Loner::work = &lane;
  Loner::running = &(*pool)[random_order() % pool->size()];
  Loner::running->fiber.start(Loner::entry);
  Loner::running->fiber.resume();
}
#else
void run_thread(const std::function<void()>& lane) { lane(); }
#endif

}  // namespace

unsigned char* shared_memory() { return shared_now; }

void run_grid(const Launch& launch, const std::function<void()>& lane) {
  block_size.x = launch.threads;
  grid_size.x = launch.blocks;
  if (launch.team && launch.threads != TeamRun::lanes) broken("a team of another size", launch.name);
  std::vector<unsigned> order(launch.blocks);
  std::iota(order.begin(), order.end(), 0u);
  if (!settings().ordered) std::shuffle(order.begin(), order.end(), random_order);
  release(&launch_begins);
  for (const unsigned block : order) {
    block_index.x = block;
    if (launch.team) {
      run_team_block(launch, lane);
      continue;
    }
    for (unsigned t = 0; t < launch.threads; ++t) {
      thread_index.x = settings().ordered ? t : (t * 101 + block) % launch.threads;  // 101 is prime: each comes once
      run_thread(lane);
    }
  }
  acquire(&launch_ends);
}

}  // namespace emulated
