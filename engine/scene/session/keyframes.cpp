// Nacre: a recording that is edited by hand.
#include "engine/scene/session/keyframes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/scene/session/thin_cameras.hpp"
#include "engine/scene/session/window_knobs.hpp"

namespace nacre {
namespace {

constexpr double same_time = 1e-6;  // seconds
constexpr std::size_t most_kept = 100;

using Events = std::vector<SessionEvent>;

double valid(double seconds) { return seconds > 0 ? std::min(seconds, longest_session) : 0; }

double end_of(const SessionEvent& event) { return event.time + event.over; }

bool is_empty(const SessionEvent& event) {
  return !event.input && event.knobs.empty() && !event.camera && !event.screenshot;
}

double last_end_of(const Session& recording) {
  double end = 0;
  for (const SessionEvent& event : recording.events) end = std::max(end, end_of(event));
  return end;
}

/// After those of the same time.
int insert(Events& events, SessionEvent event) {
  const auto at = std::upper_bound(events.begin(), events.end(), event.time,
                                   [](double time, const SessionEvent& each) { return time < each.time; });
  const auto row = at - events.begin();
  events.insert(at, std::move(event));
  return int(row);
}

/// The last event of that time; a new one where there is none.
int row_at(Events& events, double time) {
  for (std::size_t k = events.size(); k-- > 0;)
    if (std::abs(events[k].time - time) < same_time) return int(k);
  SessionEvent event;
  event.time = time;
  return insert(events, std::move(event));
}

void add_knobs(const SessionEvent& change, SessionEvent& to) {
  for (const auto& [name, text] : change.knobs) to.knobs[name] = text;
}

/// Does it say where the camera is at `time`? A camera that sets out then does not yet.
bool leads_to(const SessionEvent& event, double time) {
  if (!event.camera && !fits_camera(event)) return false;
  return event.time < time - same_time || (event.time < time + same_time && event.over < same_time);
}

/// The camera arrives at `time`. Returns the row of the event that takes it there.
int place_camera(Session& recording, const Camera& camera, double time) {
  Events& events = recording.events;
  int last = int(events.size()) - 1;
  while (last >= 0 && !leads_to(events[std::size_t(last)], time)) --last;
  double free_from = 0;
  if (last >= 0) {
    SessionEvent& before = events[std::size_t(last)];
    const double arrival = free_from = end_of(before);
    const Camera there = before.camera.value_or(camera);
    if (arrival > time - same_time) before.camera = camera;
    if (arrival > time - same_time && before.over > 0) before.over = time - before.time;
    if (arrival > time + same_time) {  // it was under way: it stops over
      const bool sets_out = std::any_of(events.begin(), events.end(), [&](const SessionEvent& each) {
        return each.camera && std::abs(each.time - time) < same_time;
      });
      if (sets_out) return last;
      SessionEvent& on = events[std::size_t(row_at(events, time))];
      on.camera = there;
      on.over = arrival - time;
    }
    if (arrival > time - same_time) return last;
  }
  SessionEvent event;
  event.time = std::max(free_from, time - Keyframes::spacing);
  event.over = time - event.time;
  event.camera = camera;
  if (event.over > same_time) return insert(events, std::move(event));
  recording.camera = camera;  // at 0
  return Keyframes::beginning;
}

int place(Session& recording, SessionEvent change, double time) {
  Events& events = recording.events;
  if (time < same_time && (events.empty() || events.front().time >= same_time)) {
    apply_event(change, recording);
    return Keyframes::beginning;
  }
  change.time = time;
  if (change.input) return insert(events, std::move(change));
  int row = Keyframes::beginning;
  if (!change.knobs.empty()) {
    row = row_at(events, time);
    add_knobs(change, events[std::size_t(row)]);
  }
  if (change.camera) row = place_camera(recording, *change.camera, time);
  return row;
}

}  // namespace

double Keyframes::last_end() const { return last_end_of(state_.recording); }

Session Keyframes::start() const {
  Session start = state_.recording;
  start.events.clear();
  start.duration = 0;
  return start;
}

Session Keyframes::state_at(double time) const {
  Session now = start();
  SessionPlayer(state_.recording).advance(valid(time), now);
  return now;
}

/// A duration that ends with the last event goes on doing so.
void Keyframes::take(State next) {
  const double end = last_end_of(next.recording), was = last_end();
  const bool same_length = next.recording.duration == state_.recording.duration;
  if (same_length && state_.recording.duration <= was + same_time) next.recording.duration = end;
  next.recording.duration = std::max(next.recording.duration, end);
  next.version = ++newest_;
  past_.push_back(std::exchange(state_, std::move(next)));
  if (past_.size() > most_kept) past_.erase(past_.begin());
  future_.clear();
}

void Keyframes::move(std::vector<State>& from, std::vector<State>& to) {
  if (from.empty()) return;
  to.push_back(std::exchange(state_, std::move(from.back())));
  from.pop_back();
}

void Keyframes::begin(const Session& now) {
  State next{now, true, 0};
  next.recording.events.clear();
  next.recording.duration = 0;
  next.recording.settings.view.panel = false;
  const bool loses = unsaved();
  take(std::move(next));
  if (!loses) note_saved();  // a beginning alone is nothing to lose
}

void Keyframes::open(Session recording, bool saved) {
  take({std::move(recording), true, 0});
  if (saved) note_saved();
}

std::optional<int> Keyframes::add(double time, const Session& now) {
  if (!begun()) {
    begin(now);
    return beginning;
  }
  std::optional<SessionEvent> change = shown_change(state_at(time), now);
  if (!change) return {};
  State next = state_;
  const int row = place(next.recording, std::move(*change), valid(time));
  take(std::move(next));
  return row;
}

int Keyframes::add_screenshot(double time, const Screenshot& picture) {
  SessionEvent event;
  event.time = valid(time);
  event.screenshot = picture;
  State next = state_;
  const int row = insert(next.recording.events, std::move(event));
  take(std::move(next));
  return row;
}

bool Keyframes::update(int row, const Session& now) {
  State next = state_;
  if (row == beginning) {
    const std::optional<SessionEvent> change = shown_change(start(), now);
    if (!change) return false;
    apply_event(*change, next.recording);
    take(std::move(next));
    return true;
  }
  SessionEvent& event = next.recording.events[std::size_t(row)];
  if (event.input && *event.input != now) return false;
  Keyframes earlier;
  earlier.state_ = state_;
  earlier.state_.recording.events.resize(std::size_t(row));
  SessionEvent changed = shown_change(earlier.state_at(event.time), now).value_or(SessionEvent());
  changed.time = event.time;
  changed.screenshot = event.screenshot;
  if (event.camera && now.camera) changed.camera = now.camera;
  if (changed.camera && !changed.input) changed.over = event.over;
  for (const auto& [name, text] : event.knobs)
    if (is_window_knob(name)) changed.knobs[name] = text;
  if (is_empty(changed)) return false;
  event = std::move(changed);
  take(std::move(next));
  return true;
}

int Keyframes::replace(int row, SessionEvent event) {
  event.time = valid(event.time);
  event.over = event.camera && !event.input ? std::min(valid(event.over), longest_session - event.time) : 0;
  State next = state_;
  Events& events = next.recording.events;
  SessionEvent& old = events[std::size_t(row)];
  if (is_empty(event)) {
    events.erase(events.begin() + row);
    row = std::min(row, int(events.size()) - 1);
  } else if (event.time == old.time) {
    old = std::move(event);
  } else {
    events.erase(events.begin() + row);
    row = insert(events, std::move(event));
  }
  take(std::move(next));
  return row;
}

int Keyframes::duplicate(int row) {
  State next = state_;
  SessionEvent copy = next.recording.events[std::size_t(row)];
  copy.time = std::min(copy.time + std::max(copy.over, spacing), longest_session - copy.over);
  const int at = insert(next.recording.events, std::move(copy));
  take(std::move(next));
  return at;
}

void Keyframes::remove(int row) {
  State next = state_;
  next.recording.events.erase(next.recording.events.begin() + row);
  take(std::move(next));
}

void Keyframes::set_duration(double seconds) {
  State next = state_;
  next.recording.duration = valid(seconds);
  take(std::move(next));
}

std::size_t Keyframes::thin(double tolerance) {
  State next = state_;
  next.recording.events = thin_cameras(state_.recording, tolerance);
  const std::size_t gone = events().size() - next.recording.events.size();
  if (gone > 0) take(std::move(next));
  return gone;
}

}  // namespace nacre
