// Nacre: the launches on oneTBB.
#pragma once

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_reduce.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "compute/device/cpu_device.hpp"
#include "compute/device/executor.hpp"
#include "compute/device/radix_sort.hpp"

namespace nacre {

namespace detail {

/// Scratch of this thread's team, of which there is one at a time; kept from launch to launch.
inline unsigned char* team_scratch(std::size_t bytes) {
  thread_local std::vector<unsigned char> scratch;
  if (scratch.size() < bytes) scratch.resize(bytes);
  return scratch.data();
}

}  // namespace detail

template <>
class Executor<Cpu> : public ExecutorBase {
 public:
  explicit Executor(Device& device) : ExecutorBase(device), cpu_(dynamic_cast<CpuDevice&>(device)) {}

  StageTimers::Scope stage(std::string_view name) { return {timers(), name}; }

  template <class Kernel>
  void for_each(std::int64_t n, const Kernel& kernel) {
    begin_launch();
    run(n, [&](std::int64_t first, std::int64_t last) {
      const Kernel local = kernel;  // a copy on the stack: its members cannot alias what the kernel writes
      for (std::int64_t i = first; i < last; ++i) local(i);
    });
  }

  template <class Kernel>
  void for_each_team(std::int64_t n, const Kernel& kernel) {
    begin_launch();
    run(n, [&](std::int64_t first, std::int64_t last) {
      const Kernel local = kernel;
      Team team(detail::team_scratch(Team::sum_bytes + local.scratch_bytes()));
      for (std::int64_t i = first; i < last; ++i) local(team, i);
    });
  }

  template <class T>
  T exclusive_scan(const T* in, T* out, std::int64_t n) {
    Recording::forbid("a sum that the host asks for");
    return scan(in, out, n);
  }

  template <class T>
  T scan(const T* in, T* out, std::int64_t n) {
    begin_launch();
    const std::int64_t block = 1 << 16;
    const std::int64_t blocks = (n + block - 1) / block;
    std::vector<T> sums(blocks + 1, T(0));
    run(blocks, [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t b = first; b < last; ++b) {
        T sum = 0;
        for (std::int64_t i = b * block; i < std::min(n, (b + 1) * block); ++i) sum += in[i];
        sums[b + 1] = sum;
      }
    });
    for (std::int64_t b = 0; b < blocks; ++b) sums[b + 1] += sums[b];
    run(blocks, [&](std::int64_t first, std::int64_t last) {
      for (std::int64_t b = first; b < last; ++b) {
        T sum = sums[b];
        for (std::int64_t i = b * block; i < std::min(n, (b + 1) * block); ++i) {
          const T value = in[i];
          out[i] = sum;
          sum += value;
        }
      }
    });
    return sums[blocks];
  }

  void sort(std::uint64_t* keys, std::int64_t n, int lowest = 0) {
    begin_launch();
    if (n <= 1) return;
    Arena::Scope scope(arena());
    Array<std::uint64_t> other = arena().temporary<std::uint64_t>(n);
    CpuDevice::Access access(cpu_);
    cpu_.workers().execute(
        [&] { detail::radix_sort(detail::KeysAlone{keys}, detail::KeysAlone{other.data()}, n, lowest); });
  }

  void sort_pairs(std::uint64_t* keys, std::uint32_t* values, std::int64_t n, int = 64) {
    begin_launch();
    if (n <= 1) return;
    Arena::Scope scope(arena());
    Array<std::uint64_t> other_keys = arena().temporary<std::uint64_t>(n);
    Array<std::uint32_t> other_values = arena().temporary<std::uint32_t>(n);
    CpuDevice::Access access(cpu_);
    cpu_.workers().execute([&] {
      detail::radix_sort(detail::KeysWithValues{keys, values},
                         detail::KeysWithValues{other_keys.data(), other_values.data()}, n);
    });
  }

  template <class T, class Get, class Merge>
  T reduce(std::int64_t n, T identity, const Get& get, const Merge& merge) {
    Recording::forbid("a sum that the host asks for");
    return merged(n, identity, get, merge);
  }

  template <class T, class Get, class Merge>
  void reduce_into(T* result, std::int64_t n, T identity, const Get& get, const Merge& merge) {
    const T value = merged(n, identity, get, merge);
    CpuDevice::Access access(cpu_);
    *result = value;
  }

  template <class T>
  void fill(const Array<T>& array, unsigned char value) {
    CpuDevice::Access access(cpu_);
    if (array.size() > 0) std::memset(static_cast<void*>(array.data()), value, array.bytes());
  }

  /// Memory that pretends to be remote keeps its numbers to itself.
  template <class Get>
  std::int64_t known(const Get& get, std::int64_t most) const {
    return cpu_.remote() ? most : std::int64_t(get());
  }

  template <class Body>
  void repeat(Steps&, const Body& body) {
    const Recording recording;
    body();
  }

  void wait() {}

 private:
  template <class T, class Get, class Merge>
  T merged(std::int64_t n, T identity, const Get& get, const Merge& merge) {
    begin_launch();
    CpuDevice::Access access(cpu_);
    T result = identity;
    cpu_.workers().execute([&] {
      result = tbb::parallel_deterministic_reduce(
          tbb::blocked_range<std::int64_t>(0, n, 1 << 14), identity,
          [&](const tbb::blocked_range<std::int64_t>& range, T value) {
            for (std::int64_t i = range.begin(); i < range.end(); ++i) value = merge(value, get(i));
            return value;
          },
          merge);
    });
    return result;
  }

  /// Calls body(first, last) over pieces of 0..n-1 on the device's workers; leaves early when the user asks to stop.
  template <class Body>
  void run(std::int64_t n, const Body& body) {
    const auto [from, to] = take_part();
    if (n <= 0) return;
    std::atomic<std::int64_t> done{0};
    const auto tell = [&, from = from, to = to](std::int64_t more) {
      const std::int64_t all = done.fetch_add(more, std::memory_order_relaxed) + more;
      raise_share(from + (to - from) * double(all) / double(n));
    };
    {
      CpuDevice::Access access(cpu_);
      cpu_.workers().execute([&, tells = to > from] {
        tbb::parallel_for(tbb::blocked_range<std::int64_t>(0, n), [&](const tbb::blocked_range<std::int64_t>& range) {
          for (std::int64_t first = range.begin(); first < range.end() && !stopped(); first += piece) {
            const std::int64_t last = std::min(first + piece, range.end());
            body(first, last);
            if (tells) tell(last - first);
          }
        });
      });
    }
    check_stop();
  }

  static constexpr std::int64_t piece = 1 << 10;  // elements between two checks of the stop flag

  CpuDevice& cpu_;
};

}  // namespace nacre
