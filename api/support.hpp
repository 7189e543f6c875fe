// Nacre: what all parts of the public library share: error messages, knobs, one caller at a time.
#pragma once

#include <tbb/global_control.h>

#include <memory>
#include <mutex>
#include <new>
#include <string>

#include "compute/device/device.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "include/nacre/knobs.hpp"
#include "include/nacre/run.hpp"

namespace nacre {

/// "give --max-size 2" and "raise `max_size`" as "max_size": in a program of somebody else there is no command line.
std::string with_knob_names(const std::string& text);

/// What `action` returns. An Error that it throws is reworded for library users; lack of memory becomes an Error.
template <class Action>
auto library_call(const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    throw Error(with_knob_names(error.problem()), with_knob_names(error.why()), with_knob_names(error.advice()));
  } catch (const std::bad_alloc&) {
    throw Error("out of memory", "", "lower resolution (flow), or raise max_size and min_size (mesh)");
  }
}

/// Throws Error where `knobs` has one that does not concern the job, or that has a value that is not allowed.
void apply_knobs(Settings& settings, const KnobValues& knobs, Job job);
KnobValue knob_value(const Settings& settings, const std::string& knob, Job job);

/// Throws Error in a process that was forked from one that had computed: its worker threads were not copied.
void check_process();

std::unique_ptr<Device> open_library_device(const RunOptions& options);

/// One caller at a time; with no more than so many threads.
class Caller {
 public:
  /// Throws Error where another thread is in a call of the same run.
  Caller(std::mutex& mutex, int threads);

 private:
  std::unique_lock<std::mutex> lock_;
  std::unique_ptr<tbb::global_control> limit_;
};

/// A sentence for the user; nothing where nobody listens.
inline void tell(const RunOptions& options, const std::string& sentence) {
  if (options.warn) options.warn(with_knob_names(sentence));
}

}  // namespace nacre
