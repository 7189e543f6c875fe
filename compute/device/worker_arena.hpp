// Nacre: arenas of oneTBB that are used again, because their memory never comes back.
#pragma once

#include <oneapi/tbb/task_arena.h>

#include <memory>

namespace nacre {

/// An arena of so many threads, for its holder alone as long as it lives. oneTBB (2021.8) keeps 10 KiB of every arena
/// in which work was done, so those that are given back serve the next ones with as many threads.
class WorkerArena {
 public:
  explicit WorkerArena(int threads);
  ~WorkerArena();
  WorkerArena(const WorkerArena&) = delete;
  WorkerArena& operator=(const WorkerArena&) = delete;

  tbb::task_arena& get() { return *arena_; }

 private:
  int threads_;
  std::unique_ptr<tbb::task_arena> arena_;
};

}  // namespace nacre
