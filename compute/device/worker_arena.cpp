// Nacre: arenas of oneTBB that are used again.
#include "compute/device/worker_arena.hpp"

#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace nacre {
namespace {

struct IdleArenas {
  std::mutex mutex;
  std::map<int, std::vector<std::unique_ptr<tbb::task_arena>>> of_threads;
};

IdleArenas& idle_arenas() {
  static IdleArenas* instance = new IdleArenas;  // never destroyed: devices may be while statics are
  return *instance;
}

}  // namespace

WorkerArena::WorkerArena(int threads) : threads_(threads) {
  IdleArenas& idle = idle_arenas();
  const std::lock_guard lock(idle.mutex);
  std::vector<std::unique_ptr<tbb::task_arena>>& list = idle.of_threads[threads];
  if (list.empty()) {
    arena_ = std::make_unique<tbb::task_arena>(threads);
  } else {
    arena_ = std::move(list.back());
    list.pop_back();
  }
}

WorkerArena::~WorkerArena() {
  IdleArenas& idle = idle_arenas();
  const std::lock_guard lock(idle.mutex);
  try {
    idle.of_threads[threads_].push_back(std::move(arena_));
  } catch (...) {  // out of memory: this one is lost
  }
}

}  // namespace nacre
