// Nacre: what all commands share: options, interruption, progress, the report's frame.
#pragma once

#include <CLI/App.hpp>
#include <atomic>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "app/clock.hpp"
#include "compute/device/device.hpp"
#include "compute/device/error.hpp"
#include "compute/device/stage_timers.hpp"
#include "engine/scene/settings.hpp"

namespace nacre {

inline constexpr const char* version = NACRE_VERSION;

/// Options that every command takes.
struct CommonOptions {
  std::string device = "auto";
  int threads = 0;
  bool quiet = false;
  std::string report, session, save_session;
  std::vector<std::string> set;
};

/// The words of a command line were off: exit status 2.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What `action` returns; an Error in it is one of the words: UsageError.
template <class Action>
auto checked_words(const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

/// Names and help where a command has its own.
struct CommonWords {
  std::string report_names = "--report", report_help = "write a JSON report to this file";
  std::string session_help = "take inputs, knobs and camera from a session file";
};
void add_common_options(CLI::App& command, CommonOptions& options, const CommonWords& words = {});
/// For commands whose inputs and knobs make a session.
void add_save_session(CLI::App& command, CommonOptions& options);

/// `threads` is the most that work at once anywhere in the program, from here on; 0: as many as the machine has.
void limit_threads(int threads);

/// Remembers what the knob options of a command line say, to be applied over a session's values.
class KnobOptions {
 public:
  /// Adds one option per knob that concerns the command; for those that are on or off a flag, and one with `no-`.
  KnobOptions(CLI::App& command, const std::string& name);
  /// Was this knob given, as an option or by `--set`?
  bool given(const std::string& name, const std::vector<std::string>& set) const;
  /// Applies them and `--set` to `settings`. Throws UsageError for values that are off.
  void apply(Settings& settings, const std::vector<std::string>& set) const;

 private:
  std::vector<std::pair<std::string, std::unique_ptr<std::string>>> values_;
};

/// Set by Ctrl-C (SIGINT, SIGTERM or SIGHUP). A second one removes what is half written and leaves; a third leaves at once.
const std::atomic<bool>& interrupt_flag();
void catch_interrupts();

/// A line on stderr, unless --quiet.
void say(const CommonOptions& options, const std::string& line);
void warn(const CommonOptions& options, const std::string& line);
/// The same where a result is not what was asked for: also with --quiet, which silences the way there.
void warn_of_result(const std::string& line);

/// A bar with the time left on stderr where that is a terminal; nothing otherwise.
class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();
  void update(std::string_view what, double fraction);
  void clear();

 private:
  bool on_;
  bool drawn_ = false;
  double started_;
  double last_ = -1;
};

/// Says on stderr what is being done: on a terminal a line that is gone with this, else a line that stays.
class StatusLine {
 public:
  StatusLine(bool quiet, const std::string& text);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

 private:
  bool drawn_ = false;
};

/// Of each stage "name", "seconds", "calls", "launches".
nlohmann::json stages_report(const StageTimers& timers);

/// "nacre", "command", "device", "stages", "memory".
nlohmann::json report_frame(const std::string& command, const Device& device, const StageTimers& timers,
                            std::size_t arena_bytes);
void write_text(const std::filesystem::path& file, const std::string& text);

/// Before the work: throws UsageError where the name of `file` does not end in `extension`, as the only format of `option`
/// does (a device or pipe has no such name, and takes no PNG), and Error where it cannot be written. Nothing where `file`
/// is empty.
void check_output(const std::string& file, const std::string& option, std::string_view extension);

}  // namespace nacre
