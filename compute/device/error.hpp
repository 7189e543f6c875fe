// Nacre: the one exception that a user may see.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace nacre {

/// Bad input or a failed request, told in three parts: what is wrong, why, and what to do about it.
/// The program prints it on one line: "what (why); advice". Broken promises between our own functions are assertions.
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

}  // namespace nacre
