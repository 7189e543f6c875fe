// Nacre: a thread that computes for Python.
#include "worker.hpp"

#include <nanobind/stl/string.h>
#include <unistd.h>

#include <chrono>
#include <exception>
#include <mutex>
#include <nacre/error.hpp>
#include <thread>

namespace nacre::python {

struct Worker::Thread {
  std::mutex mutex;
  std::condition_variable changed;
  const std::function<void()>* job = nullptr;
  bool done = true;
  std::exception_ptr thrown;

  [[noreturn]] void live() {
    std::unique_lock lock(mutex);
    for (;;) {
      changed.wait(lock, [this] { return job != nullptr; });
      const std::function<void()>& now = *job;
      lock.unlock();
      std::exception_ptr caught;
      try {
        now();
      } catch (...) {
        caught = std::current_exception();
      }
      lock.lock();
      thrown = caught;
      job = nullptr;
      done = true;
      changed.notify_all();
    }
  }
};

/// Threads whose runs have ended. They serve the next runs, because oneTBB (2021.8) keeps 7 KiB of every thread that
/// has used it. Guarded by the interpreter's lock; never destroyed, as the process ends with them waiting.
struct Worker::IdleThreads {
  std::vector<Thread*> threads;
  long made_in = getpid();

  static IdleThreads& instance() {
    static IdleThreads* idle = new IdleThreads;
    if (idle->made_in != getpid()) idle = new IdleThreads;  // a fork does not copy threads
    return *idle;
  }
};

Worker::Worker(nb::object progress) : progress_(std::move(progress)), made_in_(getpid()) {
  std::vector<Thread*>& idle = IdleThreads::instance().threads;
  if (!idle.empty()) {
    thread_ = idle.back();
    idle.pop_back();
    return;
  }
  thread_ = new Thread;
  std::thread([thread = thread_] { thread->live(); }).detach();
}

Worker::~Worker() {
  if (is_elsewhere()) return;  // the thread was not copied, and its mutex may be held by nobody
  IdleThreads::instance().threads.push_back(thread_);
}

bool Worker::is_elsewhere() const { return made_in_ != getpid(); }

RunOptions Worker::options(const std::string& device, int threads) {
  RunOptions options;
  options.device = device;
  options.threads = threads;
  options.stop = &stop_;
  options.warn = [this](const std::string& sentence) { warnings_.push_back(sentence); };
  if (!progress_.is_none())
    options.progress = [this](const RunProgress& p) {
      with_python([&] {
        const nb::object answer = progress_(p.stage, p.fraction, p.iteration, p.particles, p.energy);
        if (nb::isinstance<nb::bool_>(answer) && !nb::cast<bool>(answer)) stop_ = true;
      });
    };
  return options;
}

void Worker::keep(nb::python_error&& error) {
  if (!raised_) raised_.emplace(std::move(error));
  stop_ = true;
}

void Worker::with_python(const std::function<void()>& action) {
  nb::gil_scoped_acquire hold;
  if (raised_) throw Interrupted();
  try {
    action();
  } catch (nb::python_error& error) {
    keep(std::move(error));
  }
  if (raised_) throw Interrupted();
}

/// Sleeps without the interpreter's lock, and looks for Ctrl-C now and then.
void Worker::wait() {
  for (;;) {
    {
      nb::gil_scoped_release release;
      std::unique_lock lock(thread_->mutex);
      if (thread_->changed.wait_for(lock, std::chrono::milliseconds(50), [this] { return thread_->done; })) return;
    }
    if (!raised_ && PyErr_CheckSignals() != 0) {
      nb::python_error error;
      keep(std::move(error));
    }
  }
}

void Worker::give_warnings() {
  std::vector<std::string> warnings;
  std::swap(warnings, warnings_);
  for (const std::string& sentence : warnings) nb::module_::import_("nacre._errors").attr("give_warning")(sentence);
}

void Worker::run(const std::function<void()>& job) {
  if (is_elsewhere())
    throw Error("this run belongs to the process that this one was forked from", "its thread was not copied",
                "begin a new run; start processes with multiprocessing.get_context(\"spawn\")");
  if (busy_.exchange(true))
    throw Error("this run is busy", "another thread, or a callback of its own, uses it", "give each thread its own");
  struct Done {
    std::atomic<bool>& busy;
    ~Done() { busy = false; }
  } done{busy_};
  stop_ = false;
  raised_.reset();
  {
    nb::gil_scoped_release release;
    const std::lock_guard lock(thread_->mutex);
    thread_->job = &job;
    thread_->done = false;
    thread_->thrown = nullptr;
    thread_->changed.notify_all();
  }
  wait();
  const std::exception_ptr thrown = std::exchange(thread_->thrown, nullptr);
  if (raised_) {
    warnings_.clear();
    nb::python_error error = std::move(*raised_);
    raised_.reset();
    throw error;
  }
  if (thrown) {
    warnings_.clear();
    std::rethrow_exception(thrown);
  }
  give_warnings();
}

}  // namespace nacre::python
