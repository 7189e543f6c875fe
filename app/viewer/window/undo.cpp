// Nacre: changes that can be taken back.
#include "app/viewer/window/undo.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace nacre {
namespace {

constexpr std::size_t max_changes = 200;

constexpr const char* by_itself[] = {"width",    "height", "tab",        "panel",     "play",
                                     "begin_at", "loop",   "play_speed", "iteration", "crosshair"};

/// What playing and the window do by themselves is no change of the user's, and looking around is none to take back.
bool worth_keeping(const SessionEvent& change) {
  for (const auto& [name, text] : change.knobs)
    if (std::find(std::begin(by_itself), std::end(by_itself), name) == std::end(by_itself)) return true;
  return change.input.has_value();
}

}  // namespace

void Undo::note(const SessionEvent* change, const Session& before, const Session& now, bool busy) {
  const bool own = std::exchange(moved_, false);
  if (change && !own && !pending_ && worth_keeping(*change)) pending_ = before;
  if (busy || !pending_) return;
  const std::optional<SessionEvent> whole = session_change(*pending_, now);  // it may have been pulled to and fro
  if (whole && worth_keeping(*whole)) {
    past_.push_back(std::move(*pending_));
    if (past_.size() > max_changes) past_.erase(past_.begin());
    future_.clear();
  }
  pending_.reset();
}

void Undo::move(std::vector<Session>& from, std::vector<Session>& to, Session& session) {
  if (from.empty()) return;
  to.push_back(session);
  Session wanted = std::move(from.back());
  from.pop_back();
  const bool other = static_cast<const SessionInput&>(wanted) != session;
  const std::optional<Camera> camera = session.camera;
  session = std::move(wanted);
  if (!other) session.camera = camera;
  pending_.reset();
  moved_ = true;
}

}  // namespace nacre
