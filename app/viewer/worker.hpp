// Nacre: what the workers of flow and mesh share: a thread, and the events that it tells to another.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace nacre {

/// Seconds that nobody waits for.
inline constexpr double endless = 1e9;

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

  /// Interrupts what it does and ends the thread; memory that was lent is not written any more. Nothing may be asked for
  /// after this.
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

  mutable std::mutex mutex_;
  std::condition_variable wake_, told_;
  std::deque<Event> events_;
  bool ends_ = false;
  std::atomic<bool> interrupt_{false};
  std::thread thread_;
};

}  // namespace nacre
