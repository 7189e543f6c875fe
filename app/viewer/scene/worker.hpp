// Nacre: what the workers of flow and mesh share: a thread, and the events that it sends to another.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "compute/device/error.hpp"
#include "compute/device/stage_timers.hpp"
#include "engine/system/faults.hpp"

namespace nacre {

/// Seconds that nobody waits for.
inline constexpr double endless = 1e9;

/// A result that is to be written, and how it came about.
struct ResultFile {
  std::filesystem::path file;
  std::string origin;
};

/// A base class. Whoever derives from it starts `thread_` last, lets it run until `ends_`, and calls `finish` in its
/// destructor.
template <class Event>
class Worker {
 public:
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// The oldest event that was not taken.
  std::optional<Event> poll() {
    std::scoped_lock lock(mutex_);
    if (events_.empty()) return {};
    Event event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

  StageTimers timers() const {  ///< of all stages so far
    std::scoped_lock lock(mutex_);
    return timers_;
  }
  std::size_t peak_bytes() const {
    std::scoped_lock lock(mutex_);
    return peak_bytes_;
  }
  /// Why the device does not answer any more; empty: it does. Nothing is computed on a device that is lost.
  std::string lost_device() const {
    std::scoped_lock lock(mutex_);
    return lost_;
  }

  /// Interrupts what it does and ends the thread; lent memory is no longer written to. Nothing may be asked
  /// for after this.
  void finish() {
    if (!thread_.joinable()) return;
    {
      std::scoped_lock lock(mutex_);
      ends_ = true;
      interrupt_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

 protected:
  Worker() = default;
  ~Worker() = default;

  /// `poll`, but waits for an event while `comes()` says, with the mutex held, that there will be one, for at most
  /// `patience` seconds.
  template <class Comes>
  std::optional<Event> wait_while(const Comes& comes, const std::atomic<bool>& stop, double patience) {
    using Seconds = std::chrono::duration<double>;
    const auto begin = std::chrono::steady_clock::now();
    const auto left = [&] { return patience - Seconds(std::chrono::steady_clock::now() - begin).count(); };
    std::unique_lock lock(mutex_);
    while (events_.empty() && comes() && !stop && left() > 0) told_.wait_for(lock, Seconds(std::min(0.1, left())));
    lock.unlock();
    return poll();
  }

  void tell(Event event) {
    {
      std::scoped_lock lock(mutex_);
      events_.push_back(std::move(event));
    }
    told_.notify_all();
  }

  /// Takes over the times of a pipeline's stages, which waits for its device. After some errors a GPU refuses every
  /// call until the program ends: such a device is lost.
  template <class Pipeline>
  void take_timers(Pipeline& pipeline) {
    try {
      if (fault_due("lost-device")) throw Error("CUDA: a stage failed", "an illegal memory access was encountered");
      StageTimers timers = pipeline.timers();
      const std::size_t peak = pipeline.peak_bytes();
      std::scoped_lock lock(mutex_);
      timers_ = std::move(timers);
      peak_bytes_ = std::max(peak_bytes_, peak);
    } catch (const std::exception& error) {
      std::scoped_lock lock(mutex_);
      if (lost_.empty()) lost_ = error.what();
    }
  }
  /// Throws Error where the device is lost.
  void check_device() const {
    if (const std::string why = lost_device(); !why.empty()) throw Error(why);
  }

  mutable std::mutex mutex_;
  std::condition_variable wake_, told_;
  std::deque<Event> events_;
  bool ends_ = false;
  StageTimers timers_;
  std::size_t peak_bytes_ = 0;
  std::string lost_;
  std::atomic<bool> interrupt_{false};
  std::thread thread_;
};

}  // namespace nacre
