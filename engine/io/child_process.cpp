// Nacre: another program run to its end, with what it printed.
#include "engine/io/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

#include "compute/device/error.hpp"

extern "C" char** environ;

namespace nacre {
namespace {

using Clock = std::chrono::steady_clock;

[[noreturn]] void fail(const std::filesystem::path& program, int error_number) {
  throw Error(fmt::format("cannot start {}", program.string()), std::generic_category().message(error_number));
}

/// Both ends of a pipe, closed when it dies.
struct Pipe {
  int read_end = -1, write_end = -1;

  explicit Pipe(const std::filesystem::path& program) {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail(program, errno);
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    close_end(read_end);
    close_end(write_end);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  static void close_end(int& end) {
    if (end >= 0) ::close(end);
    end = -1;
  }
};

/// A started process, killed and collected at the latest when this dies.
class Child {
 public:
  Child(const std::filesystem::path& program, const std::vector<std::string>& arguments, const Pipe& out,
        const Pipe& err) {
    std::vector<char*> argv = {const_cast<char*>(program.c_str())};
    for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out.write_end, 1);
    posix_spawn_file_actions_adddup2(&actions, err.write_end, 2);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes, &all);  // what this program ignores must still stop the child
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    const int error_number = ::posix_spawn(&pid_, program.c_str(), &actions, &attributes, argv.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error_number != 0) fail(program, error_number);
  }
  ~Child() {
    if (running_) {
      kill();
      wait();
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void kill() const { ::kill(pid_, SIGKILL); }

  /// The status word of waitpid.
  int wait() {
    int status = 0;
    while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    running_ = false;
    return status;
  }

 private:
  pid_t pid_ = -1;
  bool running_ = true;
};

struct Sink {
  int* end;
  std::string* text;
  std::size_t limit;
};

/// Reads what is there; closes the end at the end of file.
void drain(const Sink& sink) {
  std::array<char, 65536> buffer;
  const ssize_t n = ::read(*sink.end, buffer.data(), buffer.size());
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (n <= 0) return Pipe::close_end(*sink.end);
  sink.text->append(buffer.data(), std::min(std::size_t(n), sink.limit - std::min(sink.limit, sink.text->size())));
}

/// Reads both pipes until the child closed them (true), or `give_up` says so (false).
template <class GiveUp>
bool drain_until(const std::array<Sink, 2>& sinks, const GiveUp& give_up) {
  while (*sinks[0].end >= 0 || *sinks[1].end >= 0) {
    if (give_up()) return false;
    pollfd polled[2] = {{*sinks[0].end, POLLIN, 0}, {*sinks[1].end, POLLIN, 0}};  // poll skips closed ends (-1)
    if (::poll(polled, 2, 50) <= 0) continue;
    for (int i = 0; i < 2; ++i)
      if (polled[i].revents != 0) drain(sinks[std::size_t(i)]);
  }
  return true;
}

}  // namespace

ChildResult run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      std::chrono::milliseconds limit, const std::atomic<bool>* stop) {
  Pipe out(program), err(program);
  Child child(program, arguments, out, err);
  Pipe::close_end(out.write_end);
  Pipe::close_end(err.write_end);
  ChildResult result;
  const std::array<Sink, 2> sinks = {Sink{&out.read_end, &result.output, std::size_t(64) << 20},
                                     Sink{&err.read_end, &result.errors, std::size_t(64) << 10}};
  const auto deadline = Clock::now() + limit;
  const auto give_up = [&] {
    result.stopped = stop && stop->load();
    result.timed_out = !result.stopped && Clock::now() >= deadline;
    return result.stopped || result.timed_out;
  };
  if (!drain_until(sinks, give_up)) child.kill();
  const int status = child.wait();
  if (WIFEXITED(status)) result.exit_status = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

}  // namespace nacre
