// Nacre: child processes: one that runs to its end, or one that reads what we send.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace nacre {

/// The program's file in one of PATH's folders, or an empty path.
std::filesystem::path find_program(const std::string& name);

struct ChildResult {
  int exit_status = -1;    ///< if it ended by itself, otherwise -1
  int signal = 0;          ///< if a signal ended it
  bool timed_out = false;  ///< it was killed because its time was up
  bool stopped = false;    ///< it was killed because `stop` became true
  std::string output;      ///< stdout; at most 64 MiB, the rest is dropped
  std::string errors;      ///< stderr; at most 64 KiB, the rest is dropped
};

/// Runs `program` with `arguments`, no input and default signal handling, and waits for it. It is killed after `limit`,
/// or within 0.1 s after `stop` (if given) becomes true. Throws Error if it cannot be started.
ChildResult run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      std::chrono::milliseconds limit, const std::atomic<bool>* stop = nullptr);

/// A running program to whose standard input we write and whose standard error is kept. It is killed, with everything
/// that it has started, and reaped if this object is destroyed before `wait`. Ctrl-C on our terminal does not reach it:
/// we decide how it ends.
class ChildProcess {
 public:
  /// `stop` (may be null) ends every wait for the program. Throws Error if the program cannot be started.
  ChildProcess(const std::filesystem::path& program, const std::vector<std::string>& arguments,
               const std::atomic<bool>* stop = nullptr);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends all bytes. False if the program no longer reads (most likely it has ended). Throws Interrupted.
  bool send(const void* bytes, std::size_t size);

  /// Ends the program's input and waits for it. True if it ended by itself with status 0. Throws Interrupted.
  bool wait();

  /// The first line that it has written to its standard error so far, empty if none.
  std::string first_complaint() const;

 private:
  int collect();

  const std::atomic<bool>* stop_;
  pid_t process_ = -1;
  int input_ = -1;       ///< our end of its standard input
  int complaints_ = -1;  ///< a file in memory: a pipe that nobody reads could fill up and stop the program
};

/// Kills every ChildProcess that still runs, with everything that it has started, for a program that exits without
/// unwinding.
void kill_child_processes() noexcept;

}  // namespace nacre
