// Nacre: a team's lanes as fibers.
#include "tests/emulated/runtime/team_run.hpp"

#include <cstdint>
#include <numeric>
#include <string>
#include <utility>

#include "cuda_runtime.h"
#include "tests/emulated/runtime/settings.hpp"

namespace emulated {
namespace {
TeamRun* running_team = nullptr;
}

char launch_begins, launch_ends;

TeamRun* TeamRun::current() { return running_team; }

[[gnu::no_sanitize("thread")]] void TeamRun::lane_entry() {
  for (;;) {  // each time for another item
    TeamRun& team = *running_team;
    acquire(&launch_begins);
    (*team.work_)();
    release(&launch_ends);
    team.lane_[team.running_].state = State::done;
    team.lane_[team.running_].fiber.pause();
  }
}

void TeamRun::run(const std::function<void()>& lane, const char* kernel, std::mt19937& random) {
  work_ = &lane;
  kernel_ = kernel;
  running_team = this;
  for (Lane& l : lane_) {
    l.fiber.start(lane_entry);
    l.state = State::ready;
    l.phase = 0;
  }
  std::array<int, lanes> order;
  std::iota(order.begin(), order.end(), 0);
  do {
    shuffle(order, random);
    for (int i = 0; i < lanes; ++i) {
      const int k = order[i];
      if (lane_[k].state != State::ready) continue;
      resume(k);
      if (lane_[k].state == State::at_vote && count_votes(k / warp * warp)) i = -1;  // its warp goes on
    }
  } while (pass_barrier());
  running_team = nullptr;
}

/// Half of the times the lanes of one warp come first. Called at every barrier: a plain generator is random enough.
void TeamRun::shuffle(std::array<int, lanes>& order, std::mt19937& random) {
  if (settings().ordered) return;
  std::uint64_t state = random();
  const auto below = [&](int n) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return int((state >> 33) * std::uint64_t(n) >> 31);
  };
  for (int k = lanes - 1; k > 0; --k) std::swap(order[k], order[below(k + 1)]);
  if (below(2)) return;
  const int ahead = below(2);
  std::array<int, lanes> sorted;
  int first = 0, second = warp;
  for (const int k : order) sorted[k / warp == ahead ? first++ : second++] = k;
  order = sorted;
}

void TeamRun::resume(int k) {
  running_ = k;
  thread_index.x = unsigned(k);
  lane_[k].fiber.resume();
  running_ = -1;
}

void TeamRun::stop(State state, const void* position) {
  Lane& lane = lane_[running_];
  lane.state = state;
  lane.position = position;
  char* const meeting = &met_[state == State::at_vote ? 1 + running_ / warp : 0][lane.phase++ % 4];
  release(meeting);
  lane.fiber.pause();
  acquire(meeting);
}

void TeamRun::wait(const void* position) { stop(State::at_barrier, position); }

unsigned TeamRun::vote(const void* position, bool mine) {
  Lane& lane = lane_[running_];
  lane.mine = mine;
  stop(State::at_vote, position);
  return lane.votes;
}

/// Lets the warp that begins with lane `first` go on if all of it has voted.
bool TeamRun::count_votes(int first) {
  unsigned votes = 0;
  for (int k = first; k < first + warp; ++k) {
    if (lane_[k].state != State::at_vote) return false;
    if (lane_[k].position != lane_[first].position) broken("lanes of a warp vote at different positions", kernel_);
    votes |= unsigned(lane_[k].mine) << (k - first);
  }
  for (int k = first; k < first + warp; ++k) {
    lane_[k].votes = votes;
    lane_[k].state = State::ready;
  }
  return true;
}

/// No lane can go on by itself: all have ended (false), or all stand at one barrier, which they leave.
[[gnu::no_sanitize("thread")]] bool TeamRun::pass_barrier() {
  int waiting = 0, voting = 0, done = 0;
  for (const Lane& l : lane_) {
    waiting += l.state == State::at_barrier;
    voting += l.state == State::at_vote;
    done += l.state == State::done;
  }
  if (done == lanes) return false;
  if (waiting != lanes)
    broken("lanes diverge: " + std::to_string(waiting) + " wait at a barrier, " + std::to_string(voting) +
               " at a vote, " + std::to_string(done) + " have ended",
           kernel_);
  for (Lane& l : lane_) {
    if (l.position != lane_[0].position) broken("lanes wait at different barriers", kernel_);
    l.state = State::ready;
  }
  return true;
}

void barrier(const void* position) {
  if (!running_team) broken("a barrier outside of a team");
  running_team->wait(position);
}

unsigned ballot(const void* position, bool mine) {
  if (!running_team) broken("a vote outside of a team");
  return running_team->vote(position, mine);
}

}  // namespace emulated
