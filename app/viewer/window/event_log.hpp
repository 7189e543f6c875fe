// Nacre: what the viewer says on stderr, each sentence once.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/viewer/scene/scene.hpp"

namespace nacre {

class EventLog {
 public:
  explicit EventLog(std::function<void(const std::string&)> say) : say_(std::move(say)) {}

  /// Another scene: its warnings are counted from the first.
  void forget() { warnings_ = 0; }

  /// Warnings, the last failure, and why it copies.
  void tell(const Scene& scene) {
    const std::vector<std::string>& warnings = scene.warnings();
    for (; warnings_ < warnings.size(); ++warnings_) say_("warning: " + warnings[warnings_]);
    tell_new(failure_, scene.failure());
    tell_new(remark_, scene.remark());
  }

  /// A failure, which is also shown in the window.
  void add_error(const std::string& line) { tell_new(error_, line); }

 private:
  void tell_new(std::string& said, const std::string& line) {
    if (said == line) return;
    said = line;
    if (!line.empty()) say_(line);
  }

  std::function<void(const std::string&)> say_;
  std::size_t warnings_ = 0;
  std::string failure_, remark_, error_;
};

}  // namespace nacre
