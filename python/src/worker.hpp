// Nacre: a thread that computes for Python, so that Ctrl-C and other threads of Python go on meanwhile.
#pragma once

#include <nanobind/nanobind.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <nacre/run.hpp>
#include <optional>
#include <string>
#include <vector>

namespace nacre::python {

namespace nb = nanobind;

/// All that a run and its callbacks share. A run has one thread for itself: a GPU is chosen thread by thread.
class Worker {
 public:
  /// `progress`: called with (stage, fraction, iteration, particles, energy); None: no reports.
  explicit Worker(nb::object progress);
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Callbacks and the flag to stop.
  RunOptions options(const std::string& device, int threads);

  /// Runs `job` on the thread without the interpreter's lock, and waits for it. Throws what it throws; what a callback
  /// has raised in it goes before that, and so does KeyboardInterrupt after Ctrl-C. Warnings are given at the end.
  void run(const std::function<void()>& job);

  /// Calls `action`, which may raise, with the interpreter's lock. What it raises is kept for `run`, and the run stops.
  void with_python(const std::function<void()>& action);

  /// Is this another process than the one that made the worker? Then there is no thread, and nothing may be freed.
  bool is_elsewhere() const;

 private:
  struct Thread;
  struct IdleThreads;

  void wait();
  void keep(nb::python_error&& error);
  void give_warnings();

  nb::object progress_;
  Thread* thread_;
  std::atomic<bool> stop_{false}, busy_{false};
  std::optional<nb::python_error> raised_;
  std::vector<std::string> warnings_;
  long made_in_;
};

/// What a run needs to live: the worker, and the run, which is made and destroyed on its thread.
template <class Run>
class Runner {
 public:
  explicit Runner(nb::object progress) : worker_(std::make_unique<Worker>(std::move(progress))) {}
  ~Runner() {
    if (worker_->is_elsewhere()) {
      (void)worker_.release();
      (void)run_.release();
    }
  }

  Worker& worker() { return *worker_; }
  void make(const std::function<std::unique_ptr<Run>()>& maker) {
    worker_->run([&] { run_ = maker(); });
  }
  /// What `action` returns, on the thread of the worker.
  template <class Action>
  auto call(const Action& action) {
    using Result = decltype(action(*run_));
    if constexpr (std::is_void_v<Result>) {
      worker_->run([&] { action(*run_); });
    } else {
      std::optional<Result> result;
      worker_->run([&] { result = action(*run_); });
      return std::move(*result);
    }
  }
  Run& run() { return *run_; }

 private:
  std::unique_ptr<Worker> worker_;
  std::unique_ptr<Run> run_;
};

}  // namespace nacre::python
