// Nacre: test bodies for the launches that algorithms are made of.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "compute/device/random.hpp"
#include "tests/compute/on_devices.hpp"
#include "tests/compute/small_cases.hpp"

namespace nacre::test {

inline constexpr std::int64_t launch_sizes[] = {0, 1, 2, 255, 65535, 65536, 65537, 1000000};

struct CountVisit {
  std::uint64_t* visits;
  NACRE_HD void operator()(std::int64_t i) const { atomic_add(visits + i, std::uint64_t(i) + 1); }
};

template <class Backend>
void ForEachVisitsEveryElementOnce(Executor<Backend>& exec) {
  for (const std::int64_t n : launch_sizes) {
    Arena::Scope scope(exec.arena());
    Array<std::uint64_t> visits = exec.arena().template temporary<std::uint64_t>(n + 1);
    visits.fill_bytes(0);
    exec.for_each(n, CountVisit{visits.data()});
    const std::vector<std::uint64_t> host = visits.download();
    for (std::int64_t i = 0; i < n; ++i) ASSERT_EQ(host[i], std::uint64_t(i) + 1) << n;
    EXPECT_EQ(host[n], 0u);
  }
}

template <class T, class Backend>
void scan_sizes(Executor<Backend>& exec, std::uint32_t mask) {
  for (const std::int64_t n : launch_sizes)
    for (const bool in_place : {false, true}) {
      Arena::Scope scope(exec.arena());
      std::vector<T> host(n), expected(n);
      for (std::int64_t i = 0; i < n; ++i) host[i] = T(philox(std::uint32_t(i), 0, 1).a & mask);
      std::exclusive_scan(host.begin(), host.end(), expected.begin(), T(0));
      Array<T> in = exec.arena().template temporary<T>(n);
      in.upload(host);
      Array<T> out = in_place ? in : exec.arena().template temporary<T>(n);
      const T total = exec.exclusive_scan(in.data(), out.data(), n);
      EXPECT_EQ(total, std::accumulate(host.begin(), host.end(), T(0))) << n;
      EXPECT_EQ(out.download(), expected) << n;
      if (!in_place) {
        EXPECT_EQ(in.download(), host) << n;
      }
    }
}

template <class Backend>
void ScanAddsWhatComesBefore(Executor<Backend>& exec) {
  scan_sizes<std::uint32_t>(exec, 0xff);
  scan_sizes<std::uint64_t>(exec, 0xffffffff);  // the sum leaves 32 bits
}

template <class Backend>
void SortOrdersKeys(Executor<Backend>& exec) {
  for (const std::int64_t n : launch_sizes) {
    Arena::Scope scope(exec.arena());
    std::vector<std::uint64_t> keys(n);
    for (std::int64_t i = 0; i < n; ++i) {
      const Random2 r = philox(std::uint32_t(i), 1, 1);
      keys[i] = std::uint64_t(r.a) << 32 | (r.b & 0xfff);
    }
    if (n > 2) keys[0] = ~std::uint64_t(0), keys[1] = keys[2];
    Array<std::uint64_t> array = exec.arena().template temporary<std::uint64_t>(n);
    array.upload(keys);
    exec.sort(array.data(), n);
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(array.download(), keys) << n;

    for (std::int64_t i = 0; i < n; ++i)
      keys[i] = std::uint64_t(philox(std::uint32_t(i), 1, 1).a % 300) << 32 | std::uint64_t(i);
    array.upload(keys);
    exec.sort(array.data(), n, 32);  // equal high halves stay in the order of the low ones
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(array.download(), keys) << n;
  }
}

struct Element {
  const std::uint64_t* values;
  NACRE_HD std::uint64_t operator()(std::int64_t i) const { return values[i]; }
};
struct Add {
  NACRE_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a + b; }
};
struct Larger {
  NACRE_HD std::uint64_t operator()(std::uint64_t a, std::uint64_t b) const { return a > b ? a : b; }
};

template <class Backend>
void ReduceMergesEveryElement(Executor<Backend>& exec) {
  for (const std::int64_t n : launch_sizes) {
    Arena::Scope scope(exec.arena());
    std::vector<std::uint64_t> host(n);
    for (std::int64_t i = 0; i < n; ++i) host[i] = philox(std::uint32_t(i), 2, 1).a;
    Array<std::uint64_t> values = exec.arena().template temporary<std::uint64_t>(n);
    values.upload(host);
    const std::uint64_t zero = 0;
    EXPECT_EQ(exec.reduce(n, zero, Element{values.data()}, Add{}), std::accumulate(host.begin(), host.end(), zero));
    EXPECT_EQ(exec.reduce(n, zero, Element{values.data()}, Larger{}),
              n ? *std::max_element(host.begin(), host.end()) : 0);
  }
}

template <class Backend>
void NothingRunsOnceStopped(Executor<Backend>& exec) {
  std::atomic<bool> stop = false;
  exec.watch(&stop);
  Arena::Scope scope(exec.arena());
  Array<std::uint64_t> values = exec.arena().template temporary<std::uint64_t>(100);
  values.fill_bytes(0);
  exec.for_each(100, CountVisit{values.data()});
  stop = true;
  EXPECT_THROW(exec.for_each(100, CountVisit{values.data()}), Interrupted);
  EXPECT_THROW(exec.exclusive_scan(values.data(), values.data(), 100), Interrupted);
  EXPECT_THROW(exec.sort(values.data(), 100), Interrupted);
  EXPECT_THROW(exec.reduce(100, std::uint64_t(0), Element{values.data()}, Add{}), Interrupted);
  EXPECT_EQ(values.download(99, 1)[0], 100u);
  stop = false;
  EXPECT_NO_THROW(exec.for_each(100, CountVisit{values.data()}));
  exec.watch(nullptr);
}

template <class Backend>
void StagesAreTimed(Executor<Backend>& exec) {
  for (int k = 0; k < 3; ++k) {
    auto stage = exec.stage("sort");
    SortOrdersKeys(exec);
  }
  { auto stage = exec.stage("scan"); }
  const auto& stages = exec.timers().stages();
  ASSERT_EQ(stages.size(), 2u);
  EXPECT_EQ(stages[0].name, "sort");
  EXPECT_EQ(stages[0].calls, 3);
  EXPECT_GT(exec.timers().seconds("sort"), exec.timers().seconds("scan"));
  EXPECT_EQ(exec.timers().seconds("no such stage"), 0);
}

/// What needs no answer: scan, sum and fill leave their results on the device.
template <class Backend>
void ResultsStayOnTheDevice(Executor<Backend>& exec) {
  for (const std::int64_t n : launch_sizes) {
    Arena::Scope scope(exec.arena());
    Array<std::uint64_t> values = exec.arena().template temporary<std::uint64_t>(n);
    Array<std::uint64_t> sum = exec.arena().template temporary<std::uint64_t>(1);
    exec.fill(values, 0xff);
    EXPECT_EQ(values.download(), std::vector<std::uint64_t>(n, ~std::uint64_t(0)));
    exec.fill(values, 0);
    exec.for_each(n, CountVisit{values.data()});
    exec.reduce_into(sum.data(), n, std::uint64_t(0), Element{values.data()}, Add{});
    exec.scan(values.data(), values.data(), n);
    EXPECT_EQ(sum.download()[0], std::uint64_t(n) * (n + 1) / 2);
    std::vector<std::uint64_t> before(n);
    for (std::int64_t i = 0; i < n; ++i) before[i] = std::uint64_t(i) * (i + 1) / 2;
    EXPECT_EQ(values.download(), before);
  }
}

/// By a part that is repeated: the sum of 1 .. n, with a stage inside.
template <class Backend>
std::uint64_t repeated_sum(Executor<Backend>& exec, Steps& steps, std::int64_t n) {
  Arena::Scope scope(exec.arena());
  Array<std::uint64_t> values = exec.arena().template temporary<std::uint64_t>(n);
  Array<std::uint64_t> sum = exec.arena().template temporary<std::uint64_t>(1);
  exec.repeat(steps, [&] {
    auto stage = exec.stage("inside");
    exec.fill(values, 0);
    exec.for_each(n, CountVisit{values.data()});
    exec.reduce_into(sum.data(), n, std::uint64_t(0), Element{values.data()}, Add{});
  });
  return sum.download()[0];
}

template <class Backend>
void APartCanBeRepeated(Executor<Backend>& exec) {
  Steps steps;
  long calls = 0;
  for (const std::int64_t n : {1000, 1000, 70000, 0, 0, 5, 1000}) {
    EXPECT_EQ(repeated_sum(exec, steps, n), std::uint64_t(n) * (n + 1) / 2) << n;
    ++calls;
  }
  const StageTimers::Stage stage = exec.timers().stages().front();
  EXPECT_EQ(stage.name, "inside");
  EXPECT_EQ(stage.calls, calls);
  EXPECT_EQ(stage.launches, 2 * calls);
  EXPECT_GT(stage.seconds, 0);
}

/// What would be waited for, or overtake the launches, is a mistake on every backend.
template <class Backend>
void NothingIsReadBackInsideOfIt(Executor<Backend>& exec) {
  Arena::Scope scope(exec.arena());
  Array<std::uint64_t> values = exec.arena().template temporary<std::uint64_t>(100);
  Steps steps;
  for (int call = 0; call < 3; ++call) {
    EXPECT_THROW(exec.repeat(steps, [&] { values.download(); }), std::logic_error);
    EXPECT_THROW(exec.repeat(steps, [&] { values.upload(std::vector<std::uint64_t>(100)); }), std::logic_error);
    EXPECT_THROW(exec.repeat(steps, [&] { values.fill_bytes(0); }), std::logic_error);
    EXPECT_THROW(exec.repeat(steps, [&] { exec.exclusive_scan(values.data(), values.data(), 100); }), std::logic_error);
    EXPECT_THROW(exec.repeat(steps, [&] { exec.reduce(100, std::uint64_t(0), Element{values.data()}, Add{}); }),
                 std::logic_error);
    EXPECT_EQ(repeated_sum(exec, steps, 1000), 500500u) << "it works on";
  }
}

/// Stopped between two launches: the first may have run or not, and all works on.
template <class Backend>
void ARepeatedPartCanBeStopped(Executor<Backend>& exec) {
  std::atomic<bool> stop = false;
  exec.watch(&stop);
  Steps steps;
  EXPECT_EQ(repeated_sum(exec, steps, 1000), 500500u);
  Arena::Scope scope(exec.arena());
  Array<std::uint64_t> values = exec.arena().template temporary<std::uint64_t>(100);
  for (int call = 0; call < 3; ++call) {
    values.fill_bytes(0);
    const auto stopped = [&] {
      auto stage = exec.stage("stopped");
      exec.for_each(100, CountVisit{values.data()});
      stop = true;
      exec.for_each(100, CountVisit{values.data()});
    };
    EXPECT_THROW(exec.repeat(steps, stopped), Interrupted);
    const std::uint64_t last = values.download(99, 1)[0];
    EXPECT_TRUE(last == 0 || last == 100) << last;
    stop = false;
    EXPECT_EQ(repeated_sum(exec, steps, 1000), 500500u);
  }
  EXPECT_EQ(exec.timers().stages().front().calls, 4);
  exec.watch(nullptr);
}

NACRE_DEVICE_TEST(Executor, ForEachVisitsEveryElementOnce)
NACRE_DEVICE_TEST(Executor, ScanAddsWhatComesBefore)
NACRE_DEVICE_TEST(Executor, SortOrdersKeys)
NACRE_DEVICE_TEST(Executor, ReduceMergesEveryElement)
NACRE_DEVICE_TEST(Executor, NothingRunsOnceStopped)
NACRE_DEVICE_TEST(Executor, StagesAreTimed)
NACRE_DEVICE_TEST(Executor, ResultsStayOnTheDevice)
NACRE_DEVICE_TEST(Executor, APartCanBeRepeated)
NACRE_DEVICE_TEST(Executor, NothingIsReadBackInsideOfIt)
NACRE_DEVICE_TEST(Executor, ARepeatedPartCanBeStopped)

/// Puts the least of what comes from anywhere into one of seven numbers of either length.
struct LeastOfSeven {
  std::uint32_t* shorter;
  std::uint64_t* longer;
  NACRE_HD void operator()(std::int64_t i) const {
    const auto value = std::uint32_t(i) * 2654435761u;
    atomic_min(shorter + i % 7, value);
    atomic_min(longer + i % 7, std::uint64_t(value) << 20);
  }
};

template <class Backend>
void the_least_of_many_is_left(Executor<Backend>& exec) {
  const std::uint32_t n = small_cases() ? 700 : 70000;
  Arena::Scope scope(exec.arena());
  const auto shorter = exec.arena().template temporary<std::uint32_t>(7);
  const auto longer = exec.arena().template temporary<std::uint64_t>(7);
  exec.fill(shorter, 0xff), exec.fill(longer, 0xff);
  exec.for_each(n, LeastOfSeven{shorter.data(), longer.data()});
  std::vector<std::uint32_t> least(7, 0xffffffffu);
  for (std::uint32_t i = 0; i < n; ++i) least[i % 7] = std::min(least[i % 7], i * 2654435761u);
  EXPECT_EQ(shorter.download(), least);
  const std::vector<std::uint64_t> wide = longer.download();
  for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(wide[k], std::uint64_t(least[k]) << 20);
}
NACRE_DEVICE_TEST(Executor, the_least_of_many_is_left)

}  // namespace nacre::test
