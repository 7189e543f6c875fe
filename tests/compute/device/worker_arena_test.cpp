// Nacre: tests of arenas that are used again.
#include "compute/device/worker_arena.hpp"

#include <gtest/gtest.h>

#include <set>

namespace nacre {
namespace {

TEST(WorkerArena, IsUsedAgain) {
  std::set<const tbb::task_arena*> arenas;
  for (int k = 0; k < 5; ++k) {
    WorkerArena workers(3);
    EXPECT_EQ(workers.get().max_concurrency(), 3);
    arenas.insert(&workers.get());
  }
  EXPECT_EQ(arenas.size(), 1u);
}

TEST(WorkerArena, HoldersHaveTheirOwn) {
  WorkerArena one(3), two(3), other(2);
  EXPECT_NE(&one.get(), &two.get());
  EXPECT_EQ(other.get().max_concurrency(), 2);
}

}  // namespace
}  // namespace nacre
