// Nacre: recordings, played and written down.
#include "engine/scene/session/recording.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nacre {
namespace {

constexpr double same = 1e-9;  // seconds: times of frames are sums of rounded numbers

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

double eased(double share) {
  if (share <= 0) return 0;
  return share >= 1 ? 1 : share * share * (3 - 2 * share);
}

SessionPlayer::SessionPlayer(Session recording) : recording_(std::move(recording)) {}

std::vector<Screenshot> SessionPlayer::advance(double time, Session& now) {
  std::vector<Screenshot> pictures;
  for (; next_ < recording_.events.size() && recording_.events[next_].time <= time + same; ++next_) {
    const SessionEvent& event = recording_.events[next_];
    move_camera(event.time, now);
    const std::optional<Camera> before = now.camera;
    apply_event(event, now);
    if (event.camera || fits_camera(event)) glide_.reset();
    if (event.over > 0 && before && !event.input) {
      glide_ = {*before, *event.camera, *before, event.time, event.over};
      now.camera = before;
    }
    if (event.screenshot) pictures.push_back(*event.screenshot);
  }
  move_camera(time, now);
  time_ = time;
  return pictures;
}

void SessionPlayer::move_camera(double time, Session& now) {
  if (glide_ && now.camera != glide_->last) glide_.reset();  // somebody else has it
  if (!glide_) return;
  const double share = (time - glide_->begin) / glide_->over;
  now.camera = glide_->last = between(glide_->from, glide_->to, eased(share));
  if (share >= 1) glide_.reset();
}

bool SessionPlayer::ended() const {
  return (!recording_.events.empty() || recording_.duration > 0) && time_ + same >= recording_.duration;
}

SessionRecorder::SessionRecorder(const Session& start, int fps) : start_(start), fps_(fps) {
  start_.events.clear();
  start_.duration = 0;
  before_ = now_ = start_;
}

void SessionRecorder::note(double time, const Session& now, const std::vector<Screenshot>& pictures) {
  begin_frame(time);
  static_cast<SessionInput&>(now_) = now;
  now_.settings = now.settings;
  now_.camera = now.camera;
  changed_ = true;
  pictures_.insert(pictures_.end(), pictures.begin(), pictures.end());
}

void SessionRecorder::note_unchanged(double time, const std::vector<Screenshot>& pictures) {
  begin_frame(time);
  pictures_.insert(pictures_.end(), pictures.begin(), pictures.end());
}

void SessionRecorder::begin_frame(double time) {
  // Nothing may change after a picture in the same frame: a replay makes all changes before it takes pictures.
  const long next = pictures_.empty() ? frame_ : frame_ + 1;
  const long frame = std::max(next, long(std::ceil(time * fps_ - 1e-6)));
  if (frame > frame_) close_frame();
  frame_ = frame;
}

void SessionRecorder::close_frame() {
  const bool changed = std::exchange(changed_, false);
  SessionEvent event;
  if (changed) event = session_change(before_, now_).value_or(SessionEvent());
  event.time = double(frame_) / fps_;
  const std::optional<Camera> camera = std::exchange(event.camera, std::nullopt);
  if (fits_camera(event))
    event.camera = now_.camera;
  else if (camera && !before_.camera)
    camera_of_opened() = camera;
  else
    event.camera = camera;
  if (event.input || !event.knobs.empty() || event.camera || !pictures_.empty()) events_.push_back(event);
  for (std::size_t k = 0; k < pictures_.size(); ++k) {
    if (k > 0) events_.push_back({event.time, {}, {}, {}, 0, {}});
    events_.back().screenshot = pictures_[k];
  }
  pictures_.clear();
  if (changed) before_ = now_;
}

std::optional<Camera>& SessionRecorder::camera_of_opened() {
  const auto opened = std::find_if(events_.rbegin(), events_.rend(), fits_camera);
  return opened == events_.rend() ? start_.camera : opened->camera;
}

Session SessionRecorder::recording() const {
  SessionRecorder whole = *this;
  whole.close_frame();
  Session session = whole.start_;
  session.events = whole.events_;
  session.duration = double(frame_) / fps_;
  return session;
}

}  // namespace nacre
