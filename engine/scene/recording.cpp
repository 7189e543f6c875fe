// Nacre: recordings, played and written down.
#include "engine/scene/recording.hpp"

#include <algorithm>
#include <cmath>

namespace nacre {
namespace {

/// The camera's own axes: right, up, backward.
struct Frame {
  Vec3d right, up, back;
};

Frame frame_of(const Camera& c) {
  const Vec3d right = c.right(), back = c.forward() * -1.0;
  return {right, cross(back, right), back};
}

Vec3d rotated(const Vec3d& v, const Vec3d& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

/// The rotation that takes one frame to another: unit axis and angle, 0..pi.
std::pair<Vec3d, double> rotation(const Frame& a, const Frame& b) {
  // R = sum of b_k a_k^T; its axis is the skew part, its angle follows from the trace.
  const Vec3d skew = (cross(a.right, b.right) + cross(a.up, b.up) + cross(a.back, b.back)) * 0.5;
  const double cosine = (dot(a.right, b.right) + dot(a.up, b.up) + dot(a.back, b.back) - 1) / 2;
  const double angle = std::atan2(length(skew), cosine);
  if (length(skew) > 1e-9) return {normalized(skew), angle};
  if (cosine > 0) return {Vec3d(0, 0, 1), 0};
  // Half a turn: R + 1 = 2 axis axis^T; any column that is not zero will do.
  for (const Vec3d& column : {a.up + b.up, a.right + b.right, a.back + b.back})
    if (length(column) > 1e-6) return {normalized(column), angle};
  return {a.up, angle};
}

}  // namespace

Camera between(const Camera& from, const Camera& to, double share) {
  if (share <= 0) return from;
  if (share >= 1) return to;
  const auto [axis, angle] = rotation(frame_of(from), frame_of(to));
  const double near = length(from.eye - from.target), far = length(to.eye - to.target);
  const double distance = near * std::pow(far / near, share);
  Camera camera = to;
  camera.target = from.target + (to.target - from.target) * share;
  camera.eye = camera.target + rotated(frame_of(from).back, axis, angle * share) * distance;
  camera.up = rotated(frame_of(from).up, axis, angle * share);
  camera.height = from.height * std::pow(to.height / from.height, share);
  return camera;
}

SessionPlayer::SessionPlayer(Session recording) : recording_(std::move(recording)) {}

std::vector<Screenshot> SessionPlayer::advance(double time, Session& now) {
  std::vector<Screenshot> pictures;
  constexpr double same = 1e-9;  // seconds: times of frames are sums of rounded numbers
  for (; next_ < recording_.events.size() && recording_.events[next_].time <= time + same; ++next_) {
    const SessionEvent& event = recording_.events[next_];
    const std::optional<Camera> before = now.camera;
    apply_event(event, now);
    if (event.input && !event.camera) now.camera.reset();  // to be fitted
    if (event.input || event.camera) glide_.reset();
    if (event.camera && event.over > 0 && before) glide_ = {*before, *event.camera, event.time, event.over};
    if (event.screenshot) pictures.push_back(*event.screenshot);
  }
  if (glide_) {
    const double share = (time - glide_->begin) / glide_->over;
    const double eased = share >= 1 ? 1 : share * share * (3 - 2 * share);  // starts and ends at rest
    now.camera = between(glide_->from, glide_->to, eased);
    if (share >= 1) glide_.reset();
  }
  return pictures;
}

SessionRecorder::SessionRecorder(const Session& start, int fps) : start_(start), last_(start), fps_(fps) {
  start_.events.clear();
  start_.duration = 0;
}

/// The first frame at or after `time`.
double SessionRecorder::frame_time(double time) const { return std::ceil(time * fps_ - 1e-6) / fps_; }

void SessionRecorder::note(double time, const Session& now, const std::vector<Screenshot>& pictures) {
  std::optional<SessionEvent> event = session_change(last_, now);
  last_ = now;
  if (!event && pictures.empty()) return;
  if (!event) event.emplace();
  event->time = frame_time(time);
  // Two frames of a fast display in one of the recording's: the later change wins.
  if (!events_.empty() && events_.back().time == event->time && !events_.back().screenshot && !event->input) {
    SessionEvent& same = events_.back();
    for (const auto& [name, text] : event->knobs) same.knobs[name] = text;
    if (event->camera) same.camera = event->camera;
  } else {
    events_.push_back(*event);
  }
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    if (events_.back().screenshot) events_.push_back({events_.back().time, {}, {}, {}, 0, {}});
    events_.back().screenshot = pictures[k];
  }
}

Session SessionRecorder::recording(double time) const {
  Session session = start_;
  session.events = events_;
  session.duration = frame_time(time);
  return session;
}

}  // namespace nacre
