// Nacre: test bodies for teams of lanes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/device/team.hpp"
#include "tests/compute/on_devices.hpp"

namespace nacre::test {

/// Item i: its lanes write 0 .. n-1 into shared memory, read each other's, and add up; n differs from item to item.
struct SumOfSquares {
  std::uint32_t* result;
  std::size_t scratch_bytes() const { return 300 * sizeof(std::uint32_t); }

  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    const int n = int(i % 300);
    std::uint32_t* shared = reinterpret_cast<std::uint32_t*>(team.scratch());
    team.each(n, [&](int k) { shared[k] = std::uint32_t(k); });
    const std::uint32_t sum = team.sum(n, 0u, [&](int k) { return shared[k] * shared[n - 1 - k]; });
    team.each(n, [&](int k) { shared[k] = sum; });  // all lanes have the same sum
    const std::uint32_t again = team.sum(n, 0u, [&](int k) { return shared[k]; });
    if (team.first()) result[i] = again;
    team.wait();
  }
};

template <class Backend>
void TeamsShareMemoryAndSums(Executor<Backend>& exec) {
  for (const std::int64_t items : {0, 1, 1000, 5000}) {
    Arena::Scope scope(exec.arena());
    Array<std::uint32_t> result = exec.arena().template temporary<std::uint32_t>(items + 1);
    result.fill_bytes(0xff);
    exec.for_each_team(items, SumOfSquares{result.data()});
    const std::vector<std::uint32_t> host = result.download();
    for (std::int64_t i = 0; i < items; ++i) {
      const std::uint32_t n = std::uint32_t(i % 300);
      std::uint32_t sum = 0;
      for (std::uint32_t k = 0; k < n; ++k) sum += k * (n - 1 - k);
      ASSERT_EQ(host[i], n * sum) << i;
    }
    EXPECT_EQ(host[items], 0xffffffffu);
  }
}

/// Item i: of 0 .. n-1 those that a hash chooses, and how many there are at the end of the item's row.
struct ChosenOnes {
  static constexpr int most = Team::lanes;
  std::uint32_t* result;
  std::size_t scratch_bytes() const { return 0; }

  NACRE_HD static int size(std::int64_t i) { return int(i % (most + 1)); }
  NACRE_HD static bool chosen(std::int64_t i, int k) {
    const int share = int(i / (most + 1) % 3);  // none, some, all
    return share == 2 || (share == 1 && ((std::uint32_t(i) * 2654435761u + std::uint32_t(k) * 40503u) >> 13 & 1) != 0);
  }
  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    std::uint32_t* row = result + i * (most + 1);
    const int count = team.compact(
        size(i), [&](int k) { return chosen(i, k); }, [&](int k, int place) { row[place] = std::uint32_t(k); });
    if (team.first()) row[most] = std::uint32_t(count);
    team.wait();
  }
};

template <class Backend>
void ChosenOnesKeepTheirOrder(Executor<Backend>& exec) {
  const std::int64_t items = 6 * (ChosenOnes::most + 1), width = ChosenOnes::most + 1;
  Arena::Scope scope(exec.arena());
  Array<std::uint32_t> result = exec.arena().template temporary<std::uint32_t>(items * width);
  result.fill_bytes(0xff);
  exec.for_each_team(items, ChosenOnes{result.data()});
  const std::vector<std::uint32_t> host = result.download();
  for (std::int64_t i = 0; i < items; ++i) {
    std::vector<std::uint32_t> expected;
    for (int k = 0; k < ChosenOnes::size(i); ++k)
      if (ChosenOnes::chosen(i, k)) expected.push_back(std::uint32_t(k));
    const auto row = host.begin() + i * width;
    ASSERT_EQ(row[ChosenOnes::most], expected.size()) << i;
    ASSERT_TRUE(std::equal(expected.begin(), expected.end(), row)) << i;
  }
}

struct Touch {
  std::uint64_t* visits;
  std::size_t scratch_bytes() const { return 0; }
  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    team.each(100, [&](int) { atomic_add(visits + i, 1); });
  }
};

template <class Backend>
void EveryLaneIndexIsVisitedOnce(Executor<Backend>& exec) {
  const std::int64_t items = 3000;
  Arena::Scope scope(exec.arena());
  Array<std::uint64_t> visits = exec.arena().template temporary<std::uint64_t>(items);
  visits.fill_bytes(0);
  exec.for_each_team(items, Touch{visits.data()});
  for (const std::uint64_t n : visits.download()) ASSERT_EQ(n, 100u);
}

template <class Backend>
void NoTeamRunsOnceStopped(Executor<Backend>& exec) {
  std::atomic<bool> stop = true;
  exec.watch(&stop);
  EXPECT_THROW(exec.for_each_team(10, Touch{nullptr}), Interrupted);
  exec.watch(nullptr);
}

NACRE_DEVICE_TEST(Team, TeamsShareMemoryAndSums)
NACRE_DEVICE_TEST(Team, ChosenOnesKeepTheirOrder)
NACRE_DEVICE_TEST(Team, EveryLaneIndexIsVisitedOnce)
NACRE_DEVICE_TEST(Team, NoTeamRunsOnceStopped)

}  // namespace nacre::test
