// Nacre: what all commands share.
#include "app/common.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <semaphore.h>
#include <sys/ioctl.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <thread>

#include "compute/device/error.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "engine/system/child_process.hpp"
#include "engine/system/extension.hpp"
#include "engine/system/output_file.hpp"

namespace nacre {
namespace {

std::atomic<bool> interrupted{false};

std::atomic<bool> interrupts_held{false};

/// How often Ctrl-C was pressed (or its like came), the last signal, and whom the second one wakes.
std::atomic<int> presses{0}, last_signal{0};
std::atomic<bool> someone_waits{false};
sem_t second_press;

void on_interrupt(int signal) {
  const int before = presses.fetch_add(1);
  last_signal = signal;
  if (!interrupts_held) interrupted = true;
  if (before == 1 && someone_waits)
    sem_post(&second_press);
  else if (before > 0)
    _exit(128 + signal);
}

/// A thread's life: files cannot be removed in a signal handler, which may have stopped whoever holds their list.
void leave_on_second_press() {
  while (sem_wait(&second_press) != 0) {
  }
  kill_child_processes();
  leave_without_unfinished_files(128 + last_signal);
}

/// The thread takes no signals itself: they shall wake who waits for a pipe or a child.
void wait_for_second_press() {
  sem_init(&second_press, 0, 0);
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    std::thread(leave_on_second_press).detach();
    someone_waits = true;
  } catch (const std::system_error&) {  // no thread to be had: a second press leaves at once, and leaves files
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

int columns_of_terminal() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

/// The message where `word` is no "cuda:N".
std::string is_gpu_number(const std::string& word) {
  const std::string start = "cuda:";
  const std::string digits = word.rfind(start, 0) == 0 ? word.substr(start.size()) : "";
  const bool number = !digits.empty() && digits.find_first_not_of("0123456789") == std::string::npos;
  return number ? "" : word + " is not cuda:N";
}

}  // namespace

void add_common_options(CLI::App& command, CommonOptions& options, const CommonOptionTexts& texts) {
  command.add_option("--device", options.device, "auto, cpu, cuda, or cuda:N for the GPU number N")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}) | CLI::Validator(is_gpu_number, "cuda:N"));
  command
      .add_option_function<int>(
          "--threads",
          [&options](int threads) { options.threads = std::min(threads, tbb::info::default_concurrency()); },
          "worker threads, at most one per processor (0: all)")
      ->check(CLI::Range(0, 4096));
  command.add_option(texts.report_names, options.report, texts.report_help);
  command.add_option("--session", options.session, texts.session_help);
  command.add_option("--set", options.set,
                     "KNOB=VALUE: set any knob by name; `nacre --knobs` lists them")
      ->expected(1)  // and no more: a FILE may follow
      ->allow_extra_args(false)
      ->take_all();
  command.add_flag("--quiet", options.quiet, "print only results, warnings about them, and errors");
}

void add_save_session(CLI::App& command, CommonOptions& options) {
  command.add_option("--save-session", options.save_session, "write inputs and knobs to a session file");
}

void limit_threads(int threads) {
  // Never destroyed: that may ask for memory, when nothing can be told any more.
  static auto& limit = *new std::unique_ptr<tbb::global_control>;
  if (threads > 0 && threads < tbb::info::default_concurrency())
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
}

KnobOptions::KnobOptions(CLI::App& command, const std::string& command_name) {
  Settings defaults;
  for (const Knob& knob : knobs(defaults)) {
    if (!knob.concerns(command_name)) continue;
    std::string& value = *values_.emplace_back(knob.name, std::make_unique<std::string>()).second;
    const std::string group = "Knobs: " + knob.group;
    if (std::holds_alternative<bool*>(knob.value)) {
      const std::vector<std::string> off = knob.off_options();  // all but the first are not shown in the help
      command.add_flag(knob.option() + ",!" + off.front(), value, knob.help)->take_last()->group(group);
      for (std::size_t k = 1; k < off.size(); ++k) command.add_flag("!" + off[k], value)->take_last()->group("");
      continue;
    }
    std::string help = knob.help;
    if (!knob.choices.empty() && help.find(knob.choices[0]) == help.npos)
      help += fmt::format(": {}", fmt::join(knob.choices, "|"));
    if (!knob.unit.empty()) help += " [" + knob.unit + "]";
    command.add_option(knob.option(), value, help)->default_str(knob.text())->take_last()->group(group);
    for (const std::string& old : knob.old_options()) command.add_option(old, value)->take_last()->group("");
  }
}

void KnobOptions::apply(Settings& settings, const std::vector<std::string>& set) const {
  with_usage_errors([&] {
    for (const auto& [name, value] : values_)
      if (!value->empty()) set_knob(settings, name, *value);
    for (const std::string& pair : set) {
      const auto equals = pair.find('=');
      if (equals == std::string::npos) throw Error("--set " + pair + " has no '='", "", "write --set KNOB=VALUE");
      set_knob(settings, pair.substr(0, equals), pair.substr(equals + 1));
    }
  });
}

bool KnobOptions::given(const std::string& name, const std::vector<std::string>& set) const {
  for (const auto& [option, value] : values_)
    if (option == name && !value->empty()) return true;
  Settings settings;
  const std::vector<Knob> table = knobs(settings);
  const auto knob = std::find_if(table.begin(), table.end(), [&](const Knob& each) { return each.name == name; });
  return std::any_of(set.begin(), set.end(), [&](const std::string& pair) {
    return knob->is_named(snake_case(pair.substr(0, pair.find('='))));
  });
}

const std::atomic<bool>& interrupt_flag() { return interrupted; }

HeldInterrupts::HeldInterrupts() { interrupts_held = true; }

HeldInterrupts::~HeldInterrupts() {
  interrupts_held = false;
  if (presses > 0) interrupted = true;
}

bool HeldInterrupts::asked() { return presses > 0; }

void catch_interrupts() {
  wait_for_second_press();
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGUSR1, &action, nullptr);  // mpirun passes it on, and leaves time to end
  struct sigaction before {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup asked not to hear of it
  std::signal(SIGXFSZ, SIG_IGN);                                          // a file size limit is an Error, not a death
  std::signal(SIGPIPE, SIG_IGN);
}

void say(const CommonOptions& options, const std::string& line) {
  if (!options.quiet) fmt::print(stderr, "{}\n", line);
}

void warn(const CommonOptions& options, const std::string& line) {
  if (!options.quiet) warn_of_result(line);
}

void warn_of_result(const std::string& line) { fmt::print(stderr, "warning: {}\n", line); }

Progress::Progress(bool quiet) : on_(!quiet && isatty(STDERR_FILENO)), started_(now()) {}

Progress::~Progress() { clear(); }

void Progress::update(std::string_view what, double fraction) {
  if (!on_ || (now() - last_ < 0.1 && fraction < 1)) return;
  last_ = now();
  const double left = fraction > 0.02 ? (last_ - started_) * (1 - fraction) / fraction : 0;
  std::string line = fmt::format("{:<10} ", what);
  const std::string end =
      fmt::format(" {:3.0f}%{}", 100 * fraction, left > 0 ? fmt::format("  {:.0f} s left", left) : "");
  const int room = columns_of_terminal() - 1;  // a line that went on in the next could not be drawn over
  if (const int bar = std::min(30, room - int(line.size() + end.size()) - 2); bar >= 5) {
    const int filled = int(bar * fraction);
    line += fmt::format("[{:#<{}}{:.<{}}]", "", filled, "", bar - filled);
  }
  line += end;
  fmt::print(stderr, "\r\033[K{}", line.substr(0, std::size_t(room)));
  std::fflush(stderr);
  drawn_ = true;
}

void Progress::clear() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
  drawn_ = false;
}

StatusLine::StatusLine(bool quiet, const std::string& text) {
  if (quiet) return;
  drawn_ = isatty(STDERR_FILENO);
  fmt::print(stderr, "{}{}", text, drawn_ ? " ..." : "\n");
  std::fflush(stderr);
}

StatusLine::~StatusLine() {
  if (drawn_) fmt::print(stderr, "\r\033[K");
}

void check_output(const std::string& file, const std::string& option, std::string_view extension) {
  if (file.empty()) return;
  const std::filesystem::path path = file;
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  const bool folder = std::filesystem::is_directory(status);
  const bool device = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) && !folder;
  const bool any_name = folder || (device && extension != ".png");  // of a folder the next says what is wrong
  if (!any_name && !extension.empty() && lower_extension(path) != extension)
    throw UsageError(fmt::format("{} takes a {} file, not '{}'", option, extension, file));
  check_writable(path);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  OutputFile out(file);
  out.write(text);
  out.commit();
}

}  // namespace nacre
