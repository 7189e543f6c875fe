// Nacre: a result that is being written while frames go on.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "app/viewer/scene/scene.hpp"
#include "compute/device/error.hpp"

namespace nacre {

class Saving {
 public:
  bool on() const { return !file_.empty(); }
  std::string name() const { return file_.filename().string(); }  ///< empty: nothing is being written

  /// A mesh in the making is written when it is made. Throws Error where that cannot be, or another is being written.
  void begin(Scene& scene, const std::filesystem::path& file, const std::string& origin) {
    if (on()) throw Error(file.string() + " was not saved", name() + " is still being written", "wait for that");
    require_format(scene.result_formats(), file);
    scene.begin_write(file, origin);
    file_ = file;
  }

  /// The scene is replaced: what was being written is given up. Returns the message for the user.
  std::string drop() {
    return on() ? std::exchange(file_, {}).string() + " was not saved: another input came before that" : "";
  }

  struct Outcome {
    std::filesystem::path file;
    std::string failure;  ///< empty: it is there
  };
  /// How it went; once.
  std::optional<Outcome> poll(Scene& scene) {
    if (!on()) return {};
    std::optional<std::string> failure = scene.take_written();
    if (!failure) return {};
    return Outcome{std::exchange(file_, {}), std::move(*failure)};
  }

 private:
  std::filesystem::path file_;
};

}  // namespace nacre
