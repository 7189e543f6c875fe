// Nacre: a block whose threads wait for each other, run as fibers.
#pragma once

#include <array>
#include <functional>
#include <random>

#include "tests/emulated/runtime/fiber.hpp"

namespace emulated {

/// The lanes of one team. From barrier to barrier they run in random order, and one of the two warps sometimes runs far
/// ahead of the other. Ends the program where they do not all come to the same barrier.
class TeamRun {
 public:
  static constexpr int lanes = 64, warp = 32;

  /// Runs `lane` in all lanes, with `thread_index` set.
  void run(const std::function<void()>& lane, const char* kernel, std::mt19937& random);

  /// Called by the lane that runs. `position`: where in the code.
  void wait(const void* position);
  unsigned vote(const void* position, bool mine);

  /// The one whose lane runs; null outside of a team.
  static TeamRun* current();

 private:
  enum class State { ready, at_barrier, at_vote, done };
  struct Lane {
    Fiber fiber;
    State state = State::ready;
    const void* position = nullptr;
    bool mine = false;
    unsigned votes = 0, phase = 0;
  };

  static void lane_entry();
  static void shuffle(std::array<int, lanes>& order, std::mt19937& random);
  void resume(int k);
  void stop(State state, const void* position);
  bool count_votes(int first);
  bool pass_barrier();

  std::array<Lane, lanes> lane_;
  int running_ = -1;
  const std::function<void()>* work_ = nullptr;
  const char* kernel_ = "";
  char met_[3][4] = {};  ///< what lanes meet at, by kind and phase: a lane far ahead must not pass for one that waits
};

/// What a launch orders for ThreadSanitizer: all lanes begin after `launch_begins` and end before `launch_ends`.
extern char launch_begins, launch_ends;

}  // namespace emulated
