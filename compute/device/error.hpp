// Nacre: the one exception that a user may see, and the user's wish to stop.
#pragma once

#include <atomic>
#include <stdexcept>
#include <string>
#include <utility>

namespace nacre {

/// Bad input or a failed request, told in three parts: what is wrong, why, and what to do about it.
/// The program prints it on one line: "what (why); advice". A parameter is named in backquotes, `min_size`: the program
/// prints it as the option or the knob that it is there. Broken promises between our own functions are assertions.
class Error : public std::runtime_error {
 public:
  explicit Error(std::string what, std::string why = {}, std::string advice = {})
      : std::runtime_error(join(what, why, advice)), advice_(std::move(advice)) {}

  const std::string& advice() const { return advice_; }

 private:
  static std::string join(const std::string& what, const std::string& why, const std::string& advice) {
    std::string line = what;
    if (!why.empty()) line += " (" + why + ")";
    if (!advice.empty()) line += "; " + advice;
    for (char& c : line)
      if (c == '\n' || c == '\r') c = ' ';
    return line;
  }

  std::string advice_;
};

/// The user asked to stop (Ctrl-C or Cancel). Not an error: the program exits with 130, the viewer carries on.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// Has the user asked to stop? `stop` is set by a signal handler or another thread; null: nobody can ask.
inline bool is_set(const std::atomic<bool>* stop) { return stop && stop->load(std::memory_order_relaxed); }

/// Throws Interrupted where the user has asked to stop.
inline void check_stop(const std::atomic<bool>* stop) {
  if (is_set(stop)) throw Interrupted();
}

}  // namespace nacre
