// Nacre: the launches that algorithms are made of. Algorithms include this file; `x_cpu.cpp` and `x_cuda.cu` add the
// definition for their backend (executor_cpu.hpp, executor_cuda.cuh) and instantiate.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>

#include "compute/device/arena.hpp"
#include "compute/device/backend.hpp"
#include "compute/device/stage_timers.hpp"
#include "compute/device/team.hpp"

namespace nacre {

/// What a part that is repeated leaves behind from call to call; empty at first. One for each such part.
struct Steps {
  struct Record {
    virtual ~Record() = default;
  };
  std::unique_ptr<Record> record;
};

/// What every launch of one pipeline shares, whatever the backend.
class ExecutorBase {
 public:
  explicit ExecutorBase(Device& device) : device_(device), arena_(device, device.arena_bytes()) {}

  Device& device() { return device_; }
  Arena& arena() { return arena_; }
  StageTimers& timers() { return timers_; }

  /// `stop`: set from a signal handler or another thread; the next launch throws Interrupted. `share`: how much of a
  /// long call is done, 0..1, for another thread to read. Either may be null.
  void watch(const std::atomic<bool>* stop, std::atomic<float>* share = nullptr) { stop_ = stop, share_ = share; }
  bool stopped() const { return is_set(stop_); }
  void check_stop() const { nacre::check_stop(stop_); }

  void tell_share(double share) {
    if (share_) share_->store(float(share), std::memory_order_relaxed);
  }
  /// The same from several threads at a time, which may come out of order: the share never falls.
  void raise_share(double share) {
    float before = share_ ? share_->load(std::memory_order_relaxed) : 0;
    while (share_ && before < float(share) &&
           !share_->compare_exchange_weak(before, float(share), std::memory_order_relaxed)) {
    }
  }
  /// The next launch is this part of the work of a long call: the share is `from`, and on the CPU grows to `to`
  /// meanwhile.
  void next_is(double from, double to) {
    tell_share(from);
    part_ = {from, to};
  }

 protected:
  /// Where a launch begins and ends in the share, which it tells; equal where nobody has said so, or wants to know.
  std::array<double, 2> take_part() {
    const std::array<double, 2> part = std::exchange(part_, {});
    return share_ ? part : std::array<double, 2>{};
  }

  /// At the head of every launch.
  void begin_launch() {
    check_stop();
    timers_.count_launch();
  }

 private:
  Device& device_;
  Arena arena_;
  StageTimers timers_;
  const std::atomic<bool>* stop_ = nullptr;
  std::atomic<float>* share_ = nullptr;
  std::array<double, 2> part_{};
};

/// Executor<Cpu> and Executor<Cuda> both give:
///
///   for_each(n, kernel)              kernel(i) for i in 0..n-1, in any order and in parallel
///   for_each_team(n, kernel)         kernel(team, i): the lanes of a team (team.hpp) work on item i together, with
///                                    kernel.scratch_bytes() bytes of shared memory
///   exclusive_scan(in, out, n)       out[i] = in[0] + .. + in[i-1]; returns the sum of all; in == out allowed
///   scan(in, out, n)                 the same without the sum, which the host would have to wait for
///   sort(keys, n, lowest = 0)        ascending 64-bit keys; by their bits from `lowest` up, stably, so that those
///                                    below need not be sorted where they ascend before
///   sort_pairs(keys, values, n, bits = 64)  the same by the lowest `bits`, the others being alike; values go with keys
///   reduce(n, identity, get, merge)  merge of get(i) over all i; the same result on any number of threads only if
///                                    merge is exact (integers, minimum, maximum)
///   reduce_into(result, n, identity, get, merge)  the same into *result, on the device: nothing waits for it
///   fill(array, byte)                all bytes of an array, in the order of the launches
///   known(get, most)                 get(), a number that the device holds, where it can be had without waiting (on
///                                    the CPU); else `most`, which it does not exceed
///   repeat(steps, body)              body(), which launches and reads nothing back. On CUDA from the second call on
///                                    its launches become one, a graph, which is kept in `steps`
///   wait()                           until all is done
///   stage(name)                      a scope that times a stage, the device's work included
///
/// Kernels are plain function objects; pointers in them are device pointers.
template <class Backend>
class Executor;

/// What `reduce` sums up with.
struct Add {
  template <class T>
  NACRE_HD T operator()(const T& a, const T& b) const {
    return a + b;
  }
};

namespace detail {

template <class T>
void lower_to(T* to, T value) {
  T before = __atomic_load_n(to, __ATOMIC_RELAXED);
  while (value < before && !__atomic_compare_exchange_n(to, &before, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
  }
}

}  // namespace detail

/// Adds to memory that many threads add to; exact, so the order does not matter.
NACRE_HD_INLINE void atomic_add(std::uint64_t* to, std::uint64_t value) {
#if defined(__CUDA_ARCH__)
  atomicAdd(reinterpret_cast<unsigned long long*>(to), static_cast<unsigned long long>(value));
#else
  __atomic_fetch_add(to, value, __ATOMIC_RELAXED);
#endif
}

/// The same for 32 bits; gives the value before, which is another for each of those that add.
NACRE_HD_INLINE std::uint32_t atomic_add(std::uint32_t* to, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(to, value);
#else
  return __atomic_fetch_add(to, value, __ATOMIC_RELAXED);
#endif
}

/// Makes a number in memory, which other threads do the same to, no larger than `value`.
NACRE_HD_INLINE void atomic_min(std::uint32_t* to, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
  atomicMin(to, value);
#else
  detail::lower_to(to, value);
#endif
}
NACRE_HD_INLINE void atomic_min(std::uint64_t* to, std::uint64_t value) {
#if defined(__CUDA_ARCH__)
  atomicMin(reinterpret_cast<unsigned long long*>(to), static_cast<unsigned long long>(value));
#else
  detail::lower_to(to, value);
#endif
}

/// Sets bits.
NACRE_HD_INLINE void atomic_or(std::uint64_t* to, std::uint64_t bits) {
#if defined(__CUDA_ARCH__)
  atomicOr(reinterpret_cast<unsigned long long*>(to), static_cast<unsigned long long>(bits));
#else
  __atomic_fetch_or(to, bits, __ATOMIC_RELAXED);
#endif
}

/// Writes a flag in global memory that several threads may write at once with the same value.
NACRE_HD_INLINE void relaxed_store(std::uint32_t* to, std::uint32_t value) {
#if defined(__CUDA_ARCH__)
  __stcg(to, value);
#else
  __atomic_store_n(to, value, __ATOMIC_RELAXED);
#endif
}

/// Reads what another thread may be writing by `relaxed_store`: its value before or after.
NACRE_HD_INLINE std::uint32_t relaxed_load(const std::uint32_t* from) {
#if defined(__CUDA_ARCH__)
  return __ldcg(from);
#else
  return __atomic_load_n(from, __ATOMIC_RELAXED);
#endif
}

}  // namespace nacre
