// Nacre: scenes of other inputs that were left, for undo and redo: their results are there again at once.
#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "app/viewer/panel/scene_panel.hpp"

namespace nacre {

/// The newest two, as long as they need no more than 2 GiB of the device. They compute nothing meanwhile.
class LeftScenes {
 public:
  struct Left {
    OpenScene open;
    Session session;  ///< as the scene was told last
  };

  /// `session`: as the scene was told last.
  void keep(OpenScene open, Session session) {
    if (!open.scene || open.scene->corners().empty() || !open.scene->failure().empty()) return open.reset();
    open.scene->cancel();
    left_.push_back({std::move(open), std::move(session)});
    while (left_.size() > most_scenes || (!left_.empty() && bytes() > most_bytes)) drop_oldest();
  }

  /// The newest of that input, which is not kept any more.
  std::optional<Left> take(const SessionInput& input) {
    for (auto at = left_.rbegin(); at != left_.rend(); ++at)
      if (static_cast<const SessionInput&>(at->session) == input) {
        Left left = std::move(*at);
        left_.erase(std::next(at).base());
        return left;
      }
    return {};
  }

  /// Before the context goes that they live in.
  void clear() {
    while (!left_.empty()) drop_oldest();
  }

 private:
  static constexpr std::size_t most_scenes = 2, most_bytes = std::size_t(2) << 30;

  void drop_oldest() {
    left_.front().open.reset();
    left_.pop_front();
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const Left& left : left_) sum += left.open.scene->totals().peak_bytes;
    return sum;
  }

  std::deque<Left> left_;
};

}  // namespace nacre
