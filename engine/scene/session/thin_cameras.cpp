// Nacre: fewer events for the same way of the camera.
#include "engine/scene/session/thin_cameras.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/scene/session/recording.hpp"

namespace nacre {
namespace {

constexpr double same_key = 1e-9;     // seconds
constexpr std::size_t longest = 400;  // events that may become one: it is tried with each

/// A camera at a time. Of those that may go, `event` is where it stands.
struct Key {
  double time;
  Camera camera;
  std::size_t event;
};

struct Position {
  double x, y;
};

std::optional<Position> position_in_picture(const Camera& camera, const Vec3d& point) {
  const Vec3d from_eye = point - camera.eye, right = camera.right(), forward = camera.forward();
  const double distance = length(camera.target - camera.eye), depth = dot(from_eye, forward);
  if (!camera.orthographic && depth < 1e-3 * distance) return {};
  const double scale = (camera.orthographic ? 1 : distance / depth) / camera.height;
  return Position{scale * dot(from_eye, right), scale * dot(from_eye, cross(right, forward))};
}

/// Does the camera of this event, which has one, jump, without anything that depends on it?
bool may_go(const SessionEvent& event) { return event.over == 0 && !event.input && !event.knobs.contains("camera"); }

class Thinning {
 public:
  Thinning(const Session& recording, double tolerance)
      : recording_(recording), tolerance_(tolerance), frame_(1.0 / recording.settings.fps) {}

  std::vector<SessionEvent> run() {
    if (recording_.camera) before_ = Key{0, *recording_.camera, 0};
    for (std::size_t k = 0; k < recording_.events.size(); ++k) take(k);
    thin();
    return events();
  }

 private:
  void take(std::size_t k) {
    const SessionEvent& event = recording_.events[k];
    if (event.camera && may_go(event)) {
      if (!keys_.empty() && keys_.back().time + same_key > event.time)
        drop(std::exchange(keys_.back(), key(k)).event);
      else
        keys_.push_back(key(k));
    } else if (event.camera || fits_camera(event)) {
      thin();
      before_.reset();
      if (event.camera) before_ = Key{event.time + event.over, *event.camera, k};
    }
  }
  Key key(std::size_t k) const { return {recording_.events[k].time, *recording_.events[k].camera, k}; }
  void drop(std::size_t event) { gone_.push_back(event); }

  /// The keys so far, which begin at `before_`; none: at the first of them.
  void thin() {
    std::size_t next = 0;
    if (!keys_.empty() && (!before_ || before_->time > keys_[0].time + same_key)) before_ = keys_[next++];
    while (next < keys_.size()) {
      std::size_t last = std::min(keys_.size(), next + longest) - 1;
      while (last > next && !close(next, last)) --last;
      if (last > next) join(next, last);
      before_ = keys_[last];
      next = last + 1;
    }
    keys_.clear();
  }

  double begin_of(std::size_t first) const { return std::max(before_->time, keys_[first].time - frame_); }

  void join(std::size_t first, std::size_t last) {
    for (std::size_t k = first; k <= last; ++k) drop(keys_[k].event);
    SessionEvent event;
    event.time = begin_of(first);
    event.over = keys_[last].time - event.time;
    event.camera = keys_[last].camera;
    joined_.push_back(std::move(event));
  }

  /// Is one camera that moves smoothly as good as those from `first` to `last`? It is most likely not half-way.
  bool close(std::size_t first, std::size_t last) const {
    const std::size_t count = last - first;
    for (std::size_t step = std::bit_ceil(count); step >= 2; step /= 2)
      for (std::size_t k = step / 2; k < count; k += step)
        if (!close_at(first, last, first + k)) return false;
    return close_at(first, last, first);
  }
  bool close_at(std::size_t first, std::size_t last, std::size_t k) const {
    const double end_of_hold = keys_[k + 1].time - frame_;
    return close_at(first, last, keys_[k].camera, keys_[k].time) &&
           (end_of_hold <= keys_[k].time + same_key || close_at(first, last, keys_[k].camera, end_of_hold));
  }
  bool close_at(std::size_t first, std::size_t last, const Camera& was, double time) const {
    const double begin = begin_of(first), share = (time - begin) / (keys_[last].time - begin);
    return shift_in_picture(was, between(before_->camera, keys_[last].camera, eased(share))) <= tolerance_;
  }

  std::vector<SessionEvent> events() const {
    std::vector<SessionEvent> events = recording_.events;
    for (const std::size_t k : gone_) events[k].camera.reset();
    std::erase_if(events, [](const SessionEvent& event) {
      return !event.input && event.knobs.empty() && !event.camera && !event.screenshot;
    });
    events.insert(events.end(), joined_.begin(), joined_.end());
    std::stable_sort(events.begin(), events.end(),
                     [](const SessionEvent& a, const SessionEvent& b) { return a.time < b.time; });
    return events;
  }

  const Session& recording_;
  double tolerance_, frame_;
  std::optional<Key> before_;  ///< where the camera is before the keys
  std::vector<Key> keys_;      ///< one after the other, and nothing between them moves the camera
  std::vector<std::size_t> gone_;
  std::vector<SessionEvent> joined_;
};

}  // namespace

double shift_in_picture(const Camera& a, const Camera& b) {
  if (a.orthographic != b.orthographic) return std::numeric_limits<double>::infinity();
  const double side = a.height / 2, deep = std::min(side, length(a.target - a.eye) / 2);
  const Vec3d right = a.right() * side, up = cross(a.right(), a.forward()) * side, forward = a.forward() * deep;
  double most = 0;
  for (const Vec3d& from_target : {Vec3d(0), right, -right, up, -up, forward, -forward}) {
    const auto in_a = position_in_picture(a, a.target + from_target);
    const auto in_b = position_in_picture(b, a.target + from_target);
    if (!in_a || !in_b) return std::numeric_limits<double>::infinity();
    most = std::max(most, std::hypot(in_a->x - in_b->x, in_a->y - in_b->y));
  }
  return most;
}

std::vector<SessionEvent> thin_cameras(const Session& recording, double tolerance) {
  return Thinning(recording, tolerance).run();
}

}  // namespace nacre
