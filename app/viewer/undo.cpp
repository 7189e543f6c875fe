// Nacre: changes that can be taken back.
#include "app/viewer/undo.hpp"

namespace nacre {
namespace {

constexpr std::size_t max_changes = 200;

/// What playing and the window do by themselves is no change of the user's.
bool worth_keeping(const SessionEvent& change) {
  for (const auto& [name, text] : change.knobs)
    if (name != "width" && name != "height" && name != "tab" && name != "panel" && name != "play") return true;
  return change.input.has_value();
}

}  // namespace

void Undo::note(const Session& now, bool busy) {
  if (!begun_) last_ = now, begun_ = true;
  if (busy) return;
  const std::optional<SessionEvent> change = session_change(last_, now);
  if (!change) return;
  if (worth_keeping(*change)) {
    past_.push_back(last_);
    if (past_.size() > max_changes) past_.erase(past_.begin());
    future_.clear();
  }
  last_ = now;
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
  last_ = session;
}

}  // namespace nacre
