// Nacre: child processes: one that runs to its end, or one that reads what we send.
#include "engine/system/child_process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <set>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "compute/device/error.hpp"

extern "C" char** environ;

namespace nacre {
namespace fs = std::filesystem;
namespace {

using Clock = std::chrono::steady_clock;

constexpr int longest_pause = 50;  // ms until a request to stop is noticed

[[noreturn]] void fail(const fs::path& program, int error_number) {
  throw Error("cannot start " + program.string(), std::generic_category().message(error_number));
}

void close_and_forget(int& file) {
  if (file >= 0) ::close(file);
  file = -1;
}

enum class Group {
  ours,  ///< Ctrl-C on the terminal also reaches the child
  own,
};

/// Starts a program with default signals and these three streams (-1: /dev/null). Returns 0 or an errno.
int spawn(const fs::path& program, const std::vector<std::string>& arguments, const std::array<int, 3>& streams,
          Group group, pid_t& process) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (int i = 0; i < 3; ++i)
    if (streams[std::size_t(i)] >= 0)
      posix_spawn_file_actions_adddup2(&actions, streams[std::size_t(i)], i);
    else
      posix_spawn_file_actions_addopen(&actions, i, "/dev/null", i == 0 ? O_RDONLY : O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t all, none;
  sigfillset(&all);
  sigemptyset(&none);
  posix_spawnattr_setsigdefault(&attributes, &all);  // even if this program ignores a signal, it must stop the child
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  const int flags = POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | (group == Group::own ? POSIX_SPAWN_SETPGROUP : 0);
  posix_spawnattr_setflags(&attributes, short(flags));

  std::vector<char*> argv = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const int failed = ::posix_spawn(&process, program.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (failed) process = -1;
  return failed;
}

/// The status word of waitpid; -1 if there was nothing to wait for.
int reap(pid_t process) {
  int status = 0;
  pid_t ended = -1;
  do ended = ::waitpid(process, &status, 0);
  while (ended < 0 && errno == EINTR);
  return ended == process ? status : -1;
}

/// Whether the child has ended and can be reaped, or there is nothing to wait for.
bool has_ended(pid_t process) {
  siginfo_t info{};
  return ::waitid(P_PID, id_t(process), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ? errno != EINTR : info.si_pid != 0;
}

/// Both ends of a pipe, closed on destruction.
struct Pipe {
  int read_end = -1, write_end = -1;

  explicit Pipe(const fs::path& program) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail(program, errno);
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    close_and_forget(read_end);
    close_and_forget(write_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
};

/// A started process, killed and reaped on destruction at the latest.
struct Guard {
  pid_t process = -1;

  Guard() = default;
  ~Guard() {
    if (process <= 0) return;
    ::kill(process, SIGKILL);
    reap(process);
  }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  int wait() {
    const int status = reap(process);
    process = -1;
    return status;
  }
};

/// Children that read what we send. A child that may have been reaped is never in the list, since its number could be
/// another's by now.
struct Running {
  std::mutex mutex;
  std::set<pid_t> processes;
};

Running& running() {
  static Running* instance = new Running;  // never destroyed: children may end during the destruction of static objects
  return *instance;
}

struct Sink {
  int* end;
  std::string* text;
  std::size_t limit;
};

/// Reads what is available; closes the end at the end of file.
void drain(const Sink& sink) {
  std::array<char, 65536> buffer;
  const ssize_t n = ::read(*sink.end, buffer.data(), buffer.size());
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (n <= 0) return close_and_forget(*sink.end);
  sink.text->append(buffer.data(), std::min(std::size_t(n), sink.limit - std::min(sink.limit, sink.text->size())));
}

/// Reads both pipes until the child has closed them (true), or until `give_up` returns true (false).
template <class GiveUp>
bool drain_until(const std::array<Sink, 2>& sinks, const GiveUp& give_up) {
  while (*sinks[0].end >= 0 || *sinks[1].end >= 0) {
    if (give_up()) return false;
    pollfd polled[2] = {{*sinks[0].end, POLLIN, 0}, {*sinks[1].end, POLLIN, 0}};  // poll skips closed ends (-1)
    if (::poll(polled, 2, longest_pause) <= 0) continue;
    for (int i = 0; i < 2; ++i)
      if (polled[i].revents != 0) drain(sinks[std::size_t(i)]);
  }
  return true;
}

}  // namespace

fs::path find_program(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');) {
    fs::path file = fs::path(folder.empty() ? "." : folder) / name;
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0) return file;
  }
  return {};
}

ChildResult run_child(const fs::path& program, const std::vector<std::string>& arguments,
                      std::chrono::milliseconds limit, const std::atomic<bool>* stop) {
  Pipe out(program), err(program);
  Guard child;
  if (const int failed = spawn(program, arguments, {-1, out.write_end, err.write_end}, Group::ours, child.process))
    fail(program, failed);
  close_and_forget(out.write_end);
  close_and_forget(err.write_end);
  ChildResult result;
  const std::array<Sink, 2> sinks = {Sink{&out.read_end, &result.output, std::size_t(64) << 20},
                                     Sink{&err.read_end, &result.errors, std::size_t(64) << 10}};
  const auto deadline = Clock::now() + limit;
  const auto give_up = [&] {
    result.stopped = stop && stop->load();
    result.timed_out = !result.stopped && Clock::now() >= deadline;
    return result.stopped || result.timed_out;
  };
  if (!drain_until(sinks, give_up)) ::kill(child.process, SIGKILL);
  const int status = child.wait();
  if (WIFEXITED(status)) result.exit_status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

ChildProcess::ChildProcess(const fs::path& program, const std::vector<std::string>& arguments,
                           const std::atomic<bool>* stop)
    : stop_(stop) {
  // A socket and not a pipe: only for a socket can SIGPIPE be avoided when the reader is gone.
  int ends[2] = {-1, -1};
  complaints_ = ::memfd_create("complaints", MFD_CLOEXEC);
  int failed = complaints_ < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0 ? errno : 0;
  input_ = ends[0];
  if (!failed) failed = spawn(program, arguments, {ends[1], -1, complaints_}, Group::own, process_);
  close_and_forget(ends[1]);
  if (!failed) {
    const std::lock_guard lock(running().mutex);
    running().processes.insert(process_);
    return;
  }
  close_and_forget(input_);
  close_and_forget(complaints_);
  fail(program, failed);
}

ChildProcess::~ChildProcess() {
  close_and_forget(input_);
  if (process_ > 0) ::kill(-process_, SIGKILL);
  collect();
  close_and_forget(complaints_);
}

bool ChildProcess::send(const void* bytes, std::size_t size) {
  const char* next = static_cast<const char*>(bytes);
  while (size > 0) {
    check_stop(stop_);
    pollfd polled{input_, POLLOUT, 0};
    if (::poll(&polled, 1, longest_pause) <= 0) continue;
    const ssize_t sent = ::send(input_, next, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && (errno == EINTR || errno == EAGAIN)) continue;
    if (sent < 0) return false;
    next += sent;
    size -= std::size_t(sent);
  }
  return true;
}

bool ChildProcess::wait() {
  close_and_forget(input_);
  while (process_ > 0 && !has_ended(process_)) {
    check_stop(stop_);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  const int status = collect();
  return status != -1 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

int ChildProcess::collect() {
  if (process_ <= 0) return -1;
  {
    const std::lock_guard lock(running().mutex);
    running().processes.erase(process_);
  }
  return reap(std::exchange(process_, -1));
}

std::string ChildProcess::first_complaint() const {
  char text[512];
  const ssize_t size = ::pread(complaints_, text, sizeof text, 0);
  std::string line(text, size > 0 ? std::size_t(size) : 0);
  return line.substr(0, line.find_first_of("\r\n"));
}

void kill_child_processes() noexcept try {
  const std::lock_guard lock(running().mutex);
  for (const pid_t process : running().processes) ::kill(-process, SIGKILL);
} catch (...) {  // on exit: nothing better can be done
}

}  // namespace nacre
