// Nacre: another program run to its end, with what it printed.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace nacre {

struct ChildResult {
  int exit_status = -1;    ///< where it ended by itself, else -1
  int signal = 0;          ///< where a signal ended it
  bool timed_out = false;  ///< it was killed because its time was over
  bool stopped = false;    ///< it was killed because `stop` became true
  std::string output;      ///< stdout; at most 64 MiB, the rest is dropped
  std::string errors;      ///< stderr; at most 64 KiB, the rest is dropped
};

/// Runs `program` with `arguments`, no input and default signal handling, and waits for it. It is killed after `limit`,
/// or within 0.1 s once `stop` (if given) is true. Throws Error if it cannot be started.
ChildResult run_child(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                      std::chrono::milliseconds limit, const std::atomic<bool>* stop = nullptr);

}  // namespace nacre
