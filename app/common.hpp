// Nacre: what all commands share: options, interruption, progress, the files.
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
#include "engine/run/report.hpp"
#include "engine/scene/settings/settings.hpp"
#include "include/nacre/version.hpp"

namespace nacre {

inline constexpr const char* version = NACRE_VERSION_STRING;

/// Options that every command takes.
struct CommonOptions {
  std::string device = "auto";
  int threads = 0;
  bool quiet = false;
  std::string report, session, save_session;
  std::vector<std::string> set;
};

/// The command line is wrong: exit status 2.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What `action` returns; an Error that it throws becomes a UsageError.
template <class Action>
auto with_usage_errors(const Action& action) {
  try {
    return action();
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

/// Option names and help texts, where a command has its own.
struct CommonOptionTexts {
  std::string report_names = "--report", report_help = "write a JSON report to this file";
  std::string session_help = "take inputs, knobs and camera from a session file";
};
void add_common_options(CLI::App& command, CommonOptions& options, const CommonOptionTexts& texts = {});
/// For commands whose inputs and knobs make a session.
void add_save_session(CLI::App& command, CommonOptions& options);

/// From here on, at most `threads` threads work at once in the whole program; 0: as many as the machine has.
void limit_threads(int threads);

/// Keeps the values of a command line's knob options until they are applied over those of a session.
class KnobOptions {
 public:
  /// Adds an option for each knob that concerns the command; two flags (`--edges`, `--no-edges`) where it is on or off.
  KnobOptions(CLI::App& command, const std::string& name);
  /// Was this knob of the table given, as an option or by `--set`?
  bool given(const std::string& name, const std::vector<std::string>& set) const;
  /// Applies them and `--set` to `settings`. Throws UsageError for values that are not allowed.
  void apply(Settings& settings, const std::vector<std::string>& set) const;

 private:
  std::vector<std::pair<std::string, std::unique_ptr<std::string>>> values_;
};

/// Set by Ctrl-C (SIGINT, SIGTERM, SIGHUP or SIGUSR1). A second one removes half-written files and ends the program; a
/// third ends it at once.
const std::atomic<bool>& interrupt_flag();
void catch_interrupts();

/// While it lives, a first Ctrl-C does not set the flag: whoever has something to finish first looks at `asked`. The
/// flag follows when it dies. A second Ctrl-C ends the program as ever.
class HeldInterrupts {
 public:
  HeldInterrupts();
  ~HeldInterrupts();
  HeldInterrupts(const HeldInterrupts&) = delete;
  HeldInterrupts& operator=(const HeldInterrupts&) = delete;
  static bool asked();
};

/// A line on stderr, unless --quiet.
void say(const CommonOptions& options, const std::string& line);
void warn(const CommonOptions& options, const std::string& line);
/// The same, also with --quiet: for a result that is not what was asked for.
void warn_of_result(const std::string& line);

/// A progress bar with the time left on stderr if that is a terminal; nothing otherwise.
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

/// Says on stderr what is being done: on a terminal in a line that this object removes at its end, else in one that
/// stays.
class StatusLine {
 public:
  StatusLine(bool quiet, const std::string& text);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

 private:
  bool drawn_ = false;
};

void write_text(const std::filesystem::path& file, const std::string& text);

/// For a check before the work begins. Throws UsageError where the name of `file` does not end in `extension`, the only
/// one that `option` takes (a device or pipe has no such name, and cannot hold a PNG), and Error where it cannot be
/// written. Does nothing where `file` is empty.
void check_output(const std::string& file, const std::string& option, std::string_view extension);

}  // namespace nacre
