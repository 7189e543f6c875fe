// Nacre: flows that were shown with other knobs come back at once when the knobs do, as they do on undo.
#include <algorithm>
#include <utility>

#include "app/viewer/flow/flow_scene.hpp"

namespace nacre {
namespace {

constexpr std::size_t most_kept_flows = 4, most_kept_bytes = std::size_t(512) << 20;

/// Whether frames look otherwise after that. Arrows, graphs of points and sources of dye are beside the frames.
bool concerns_frames(FlowRerun rerun) {
  for (const FlowStage stage : {FlowStage::arrows, FlowStage::probes, FlowStage::dyes}) rerun.remove(stage);
  return !(rerun == FlowRerun());
}

}  // namespace

/// After a change of knobs: keeps the frames for later, and brings those back that were made with these knobs. True if
/// there are some; they are looked back at, and the worker makes the texture again behind them.
bool FlowScene::exchange_frames(const Settings& settings, const FlowRerun& rerun) {
  if (!concerns_frames(rerun)) return looks_back_;
  if (rerun.has(FlowStage::surface)) kept_flows_.clear();  // what belongs to points would not fit
  if (shown_ && kept_.bytes() > 0 && !rerun.has(FlowStage::surface))
    kept_flows_.push_back({frames_of_, shown_, std::move(kept_), position_});
  forget_frames();
  frames_of_ = settings;
  const auto fits = [&](const KeptFlow& kept) {
    Settings then = kept.settings;
    then.begin_at = settings.begin_at;  // where a worker began
    return !concerns_frames(flow_rerun(then, settings));
  };
  const auto found = std::find_if(kept_flows_.rbegin(), kept_flows_.rend(), fits);
  const bool restored = found != kept_flows_.rend();
  if (restored) {
    drop_focus();
    if (shown_ != found->texture) copied_ += shown_->copied_bytes();
    shown_ = std::move(found->texture);
    kept_ = std::move(found->frames);
    results_.embedding = shown_->info;
    newest_ = -1;
    show_kept(kept_.nearest(found->position));  // what was seen may have been on its way
    kept_flows_.erase(std::next(found).base());
  }
  const auto bytes = [&] {
    std::size_t sum = 0;
    for (const KeptFlow& kept : kept_flows_) sum += kept.frames.bytes() + kept.texture->values.bytes();
    return sum;
  };
  while (kept_flows_.size() > most_kept_flows || bytes() > most_kept_bytes) kept_flows_.pop_front();
  return restored;
}

}  // namespace nacre
