// Nacre: the time of a flow in the viewer: what is shown again, what is computed, and where it starts over.
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/viewer/flow/flow_scene.hpp"

namespace nacre {

/// Gives the worker all but a jump to another time: that is made by the cheapest means. Returns what has to be done
/// again.
FlowRerun FlowScene::pass_on(const Settings& settings, bool jumps) {
  Settings wanted = settings;
  wanted.begin_at = begun_at_;
  FlowRerun rerun = worker_.set_settings(wanted);
  const bool back = looks_back_;
  const int position = position_;
  const bool kept = exchange_frames(settings, rerun);
  if (rerun.has(FlowStage::start) || position_ < 0) {  // again, from where the knob says
    if (begun_at_ == settings.begin_at) return rerun;
    begun_at_ = settings.begin_at;
    rerun.add(worker_.set_settings(settings));
  } else if (jumps) {
    const int steps = steps_in_all(), skipped = std::clamp(int(std::lround(settings.begin_at * steps)), 0, steps);
    seek(position_after(skipped + 1 - skipped_));
  } else if (back && !kept &&
             (rerun.has(FlowStage::colours) || rerun.has(FlowStage::lines))) {  // what was shown is gone
    restart_at(position);
  }
  return rerun;
}

/// Of a step by its number since the worker's start.
int FlowScene::position_after(int steps) const {
  const int all = steps_in_all(), sum = skipped_ + steps;
  if (!loops_) return std::min(sum, all);
  if (settings_.view.loop) return sum % all;
  return sum <= all ? sum : (sum - 1) % all + 1;
}

int FlowScene::next_position() const {
  return settings_.view.loop ? (position_ + 1) % steps_in_all() : std::min(position_ + 1, steps_in_all());
}

bool FlowScene::ended() const { return !settings_.view.loop && position_ >= steps_in_all(); }

void FlowScene::seek(int position) {
  if (position == position_) {  // a step in progress is for later
    looks_back_ =
        looks_back_ || (!settings_.view.play && kept_.find(position) && written() && written()->values.writing());
    return;
  }
  if (kept_.find(position)) return show_kept(position);
  const bool follows = !looks_back_ && !warming_ && newest_ == position_ && position == next_position();
  if (!follows) return restart_at(position);
  stale_ = true;  // one more step will do
}

/// From the noise. Colours and vectors come at once; the texture that was seen stays until there is another.
void FlowScene::restart_at(int position) {
  drop_focus();
  looks_back_ = false;
  warming_ = true;
  position_ = position;
  begun_at_ = begin_at_of(position, steps_in_all());
  Settings wanted = settings_;
  wanted.begin_at = begun_at_;
  worker_.set_settings(wanted);
}

void FlowScene::show_kept(int position) {
  const KeptFrame& frame = *kept_.find(position);
  position_ = position;
  looks_back_ = position != newest_;
  warming_ = stale_ = false;
  show_moment(frame.moment);
  ++version_;
}

/// Brings the worker to the time of a frame that is looked back at, by the cheapest means.
void FlowScene::warm_up_behind() {
  moved_since_ = false;
  if (!std::exchange(looks_back_, false) || newest_ == position_) return;
  if (newest_ < 0 && position_after(1) == position_)
    stale_ = true;  // it has started just before
  else
    restart_at(position_);
}

/// Goes on from a frame that was looked back at, as far as frames are at hand; then the worker goes on, or starts over.
/// False: the next frame is the worker's.
bool FlowScene::play_kept() {
  if (!looks_back_ || stale_) return looks_back_ = looks_back_ && !stale_, false;
  const int next = next_position();
  if (kept_.find(next)) return show_kept(next), true;
  restart_at(next);
  return false;
}

/// The texture is another one from now on.
void FlowScene::forget_frames() {
  kept_.clear();
  looks_back_ = false;
}

void FlowScene::take(FlowMoment& told) {
  if (!warming_) return;
  show_moment(told);
}

Transport FlowScene::transport() const {
  Transport t;
  if (results_.data.array.empty()) return t;
  t.kind = Transport::Kind::time;
  const int steps = steps_in_all();
  const bool loop = loops_ && settings_.view.loop;
  t.first = loop ? 0 : 1;
  t.last = loop ? steps - 1 : steps;
  t.shown = position_;
  for (int p = t.first; p <= t.last; ++p) t.warm.push_back(kept_.find(p) != nullptr);
  t.warming = warming_;
  t.ended = ended();
  t.start = results_.span.first;
  t.per_step = results_.span.frame_time;
  for (const double time : results_.data.times)
    if (time >= results_.span.first && time <= results_.span.end) t.data_times.push_back(time);
  return t;
}

}  // namespace nacre
