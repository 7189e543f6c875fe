// Nacre: focus in the viewer: the part in view is computed a second time, with cells as fine as the window's pixels,
// beside the texture of the whole; here what the worker does for it.
#include <algorithm>
#include <new>
#include <utility>

#include "app/viewer/flow/flow_worker.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/surface/flow_input.hpp"

namespace nacre {
namespace {

/// Steps before the one that is shown first: a user waits for each. Streaks look the same after none as after four;
/// without them, two steps take the noise out.
int least_warmup(const FlowParameters& parameters) { return parameters.streaks > 0 ? 1 : 2; }

}  // namespace

void FlowWorker::focus(const FlowView& view, double budget, double width, int request) {
  {
    std::scoped_lock lock(mutex_);
    stop_focusing();
    focus_wanted_ = {view, budget, width, request};
  }
  wake_.notify_all();
}

void FlowWorker::stop_focus() {
  std::scoped_lock lock(mutex_);
  stop_focusing();
  told_.notify_all();
}

void FlowWorker::drop_focus() {
  {
    std::scoped_lock lock(mutex_);
    stop_focusing();
    drops_focus_ = true;
  }
  wake_.notify_all();
}

void FlowWorker::fill_focus(float* memory, int number) {
  {
    std::scoped_lock lock(mutex_);
    focus_fills_.push_back({memory, number});
  }
  wake_.notify_all();
}

/// With the mutex held: a request that nobody has begun with is answered here, one that is being met is interrupted and
/// answered then.
void FlowWorker::stop_focusing() {
  if (focus_wanted_) {
    FlowFocused answer;
    answer.request = focus_wanted_->number;
    events_.emplace_back(std::move(answer));
    focus_wanted_.reset();
  }
  if (focusing_) interrupt_ = true;
}

/// With the mutex held. A focus needs a flow that has been started.
bool FlowWorker::has_focus_work() const {
  return drops_focus_ || !focus_fills_.empty() || (focus_wanted_ && started_ && !cancelled_);
}

void FlowWorker::run_focus(std::unique_lock<std::mutex>& lock) {
  const bool drops = std::exchange(drops_focus_, false);
  const auto fills = std::exchange(focus_fills_, {});
  const bool begins = fills.empty() && started_ && !cancelled_;  // what interrupts it must not end a step
  const auto wanted = begins ? std::exchange(focus_wanted_, {}) : std::nullopt;
  focusing_ = bool(wanted);
  interrupt_ = false;  // it was meant for a stage
  lock.unlock();
  if (drops) focus_.reset();
  for (const auto& [memory, number] : fills) tell(FlowFocusFilled{number, step_focus(memory, number)});
  if (wanted) {
    FlowFocused answer;
    answer.request = wanted->number;
    const int before = focus_ ? focus_->number : 0;
    try {
      make_focus(*wanted, answer);
    } catch (const Interrupted&) {
    } catch (const std::exception&) {  // too little memory
      answer.remark = "there is too little memory for a close-up: the texture of the whole surface is shown";
    }
    answer.ends_former = before != (focus_ ? focus_->number : 0);
    tell(std::move(answer));
  }
  take_timers(*pipeline_);
  note_focus_memory();
  if (const std::string why = lost_device(); !why.empty()) tell(FlowFailed{why});
  lock.lock();
  focusing_ = false;
}

/// Nothing where the focus that is there serves. Else embeds the part in view and starts its flow one step before the
/// one that is shown: the step from there on is the first that the viewer has memory for. Its cells get the memory that
/// all else has left; the focus before it stays as long as they have enough.
void FlowWorker::make_focus(const FocusRequest& wanted, FlowFocused& answer) {
  const bool of_thesis = settings_.flow.method == EmbeddingKind::octree && settings_.flow.octree == OctreeKind::thesis;
  if (!has_values_ || steps_made_ == 0 || of_thesis) return;
  if (focus_ && serves(focus_->shown, focus_->cell_size, wanted.view, vectors_->surface())) return;
  const auto find = [&] {
    return focus_on(widened(wanted.view, wanted.width), vectors_->surface(), parameters(), device_->arena_bytes(),
                    wanted.budget);
  };
  std::optional<Focus> found = find();
  if (focus_ && (!found || found->resolution < found->wanted)) {
    focus_.reset();
    found = find();
  }
  if (!found) return;
  if (vectors_->moves()) {
    focus_.reset();
    answer.remark = no_focus_where_it_moves;
    return;
  }
  answer.remark = coarser_than_pixels(*found);

  auto made = std::make_unique<WorkerFocus>();
  made->part = std::make_shared<SurfacePart>(std::move(found->part));
  made->shown = std::move(found->shown);
  made->cell_size = found->cell_size;
  made->pipeline = make_flow_pipeline(*device_);
  made->pipeline->watch(&interrupt_);
  made->pipeline->parameters = settings_.flow;
  made->pipeline->parameters.resolution = made->resolution = found->resolution;
  const PreparedSurface& surface = made->part->surface;
  made->pipeline->embed(flow_mesh(surface));

  const int before = std::min(steps_made_, steps_in_all_) - 1;
  FlowVectors vectors = flow_vectors(*vectors_, span_.start, flow_end(), made->part.get());
  vectors.at = [this, at = vectors.at](double t, std::span<Vec3f> out) { at(wrapped(t), out); };
  vectors.start += (vectors.end - vectors.start) * (double(before) / std::max(1, steps_in_all_));
  FlowParameters& start = made->pipeline->parameters;
  start.steps = made->steps_in_all = std::max(1, steps_in_all_ - before);
  start.warmup = least_warmup(settings_.flow);
  start.streaks = 0;  // this frame is not seen
  made->pipeline->flow().start(vectors);
  made->steps = steps_made_ - 1;

  const FlowMethod& flow = made->pipeline->flow();
  answer.geometry =
      make_surface_geometry(surface.points, surface.triangles, surface.corner_normals, surface.second_sheet);
  answer.lookup = flow.lookup();
  if (answer.lookup.kind == FlowLookup::Kind::grid) answer.rimmed = with_rims(sparse_lookup(answer.lookup));
  answer.number = made->number = ++focuses_;
  made->values = answer.lookup.means > 0 ? answer.lookup.values : 0;
  answer.part = made->part;
  focus_ = std::move(made);
}

/// The peak of the device is that of both textures.
void FlowWorker::note_focus_memory() {
  if (!focus_) return;
  std::scoped_lock lock(mutex_);
  peak_bytes_ = std::max(peak_bytes_, pipeline_->peak_bytes() + focus_->pipeline->peak_bytes());
}

/// Brings the focus of that number to the newest step. False: nothing is written to the memory, for that focus is gone.
bool FlowWorker::step_focus(float* memory, int number) {
  if (!focus_ || focus_->number != number) return false;
  try {
    FlowPipeline& pipeline = *focus_->pipeline;
    pipeline.parameters = settings_.flow;
    pipeline.parameters.resolution = focus_->resolution;
    pipeline.parameters.steps = focus_->steps_in_all;
    pipeline.flow().show_into(memory, memory && focus_->values ? memory + focus_->values : nullptr);
    do {
      pipeline.flow().step();
      ++focus_->steps;
    } while (focus_->steps < steps_made_);
    return true;
  } catch (const std::exception&) {  // too little memory, or the end: the texture of the whole stays
    focus_.reset();
    return false;
  }
}

}  // namespace nacre
