// Nacre: the exceptions of the library.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "export.hpp"

namespace nacre {

/// Bad input or a failed request, told in three parts: what is wrong, why, and what to do about it. `what()` has all
/// three on one line: "problem (why); advice".
class NACRE_API Error : public std::runtime_error {
 public:
  explicit Error(std::string problem, std::string why = {}, std::string advice = {})
      : std::runtime_error(join(problem, why, advice)),
        problem_(std::move(problem)),
        why_(std::move(why)),
        advice_(std::move(advice)) {}

  const std::string& problem() const noexcept { return problem_; }
  const std::string& why() const noexcept { return why_; }        ///< may be empty
  const std::string& advice() const noexcept { return advice_; }  ///< may be empty

 private:
  static std::string join(const std::string& problem, const std::string& why, const std::string& advice) {
    std::string line = problem;
    if (!why.empty()) line += " (" + why + ")";
    if (!advice.empty()) line += "; " + advice;
    for (char& c : line)
      if (c == '\n' || c == '\r') c = ' ';
    return line;
  }

  std::string problem_, why_, advice_;
};

/// The user asked to stop. Not an error: what was computed so far is dropped, and the caller carries on.
class NACRE_API Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace nacre
