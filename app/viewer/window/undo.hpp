// Nacre: changes of knobs and inputs that can be taken back.
#pragma once

#include <optional>
#include <vector>

#include "engine/scene/session/session.hpp"

namespace nacre {

/// Keeps what the session was before each change. Cameras are not undone: they are moved all the time.
class Undo {
 public:
  /// In each frame, before any `undo`: how `now` differs from `before`, the session of the last frame (null: it does
  /// not). `busy`: the user is in the middle of something, such as pulling a slider.
  void note(const SessionEvent* change, const Session& before, const Session& now, bool busy);
  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }
  void undo(Session& session) { move(past_, future_, session); }
  void redo(Session& session) { move(future_, past_, session); }

 private:
  void move(std::vector<Session>& from, std::vector<Session>& to, Session& session);

  bool moved_ = false;              ///< the next change is `undo`'s own
  std::optional<Session> pending_;  ///< before what the user is in the middle of
  std::vector<Session> past_, future_;
};

}  // namespace nacre
