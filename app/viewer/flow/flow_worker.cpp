// Nacre: the flow pipeline on a thread of its own: what is asked of it, and what it does when.
#include "app/viewer/flow/flow_worker.hpp"

#include <chrono>
#include <new>
#include <utility>

#include "app/parameter_names.hpp"
#include "compute/device/error.hpp"
#include "engine/run/flow_maps.hpp"
#include "engine/system/faults.hpp"
#include "engine/system/priority.hpp"

namespace nacre {
namespace {

/// The error message; empty: no error. Throws Interrupted.
template <class Work>
std::string failure_of(const Work& work) {
  try {
    work();
  } catch (const Interrupted&) {
    throw;
  } catch (const std::bad_alloc&) {
    return "out of memory; lower resolution";
  } catch (const std::exception& error) {
    return with_knobs(error.what());
  }
  return {};
}

}  // namespace

FlowWorker::FlowWorker(const Session& session, std::unique_ptr<Device> device, bool loop, bool low_priority)
    : input_(session),
      device_(std::move(device)),
      pipeline_(make_flow_pipeline(*device_)),
      loop_(loop),
      low_priority_(low_priority),
      due_{FlowStage::surface, FlowStage::embed, FlowStage::start},
      wanted_(session.settings) {
  if (wanted_.view.arrows) due_.add(FlowStage::arrows);
  if (has_lines(wanted_)) due_.add(FlowStage::lines);
  if (!wanted_.probe.empty()) due_.add(FlowStage::probes);
  if (is_ftle(wanted_.color)) due_.add(FlowStage::colours);
  pipeline_->watch(&interrupt_, &share_);
  thread_ = std::thread([this] { run(); });
}

FlowWorker::~FlowWorker() { finish(); }

std::optional<FlowEvent> FlowWorker::wait(const std::atomic<bool>& stop, double patience) {
  return wait_while([this] { return working_ || has_work(); }, stop, patience);
}

bool FlowWorker::ready() const {
  std::scoped_lock lock(mutex_);
  return started_ && lost_.empty() && !cancelled_ && !next() && !step_ && doing_ != FlowStage::step && events_.empty();
}

void FlowWorker::step(float* memory, float* focus_memory, int focus) {
  {
    std::scoped_lock lock(mutex_);
    step_ = memory;
    focus_step_ = {focus_memory, focus};
  }
  wake_.notify_all();
}

bool FlowWorker::busy() const {
  std::scoped_lock lock(mutex_);
  return working_ || has_work();
}

FlowRerun FlowWorker::set_settings(const Settings& settings) {
  FlowRerun changed;
  {
    std::scoped_lock lock(mutex_);
    changed = flow_rerun(wanted_, settings);
    wanted_ = settings;
    if (changed == FlowRerun()) return changed;
    FlowRerun rerun = changed;
    cancelled_ = failed_ = false;
    rerun.remove(FlowStage::step);  // the next one takes the new values by itself
    due_.add(rerun);
    if (rerun.has(FlowStage::start)) {
      started_ = false;
      stop_focusing();
      if (step_) drop_step();
      for (const FlowStage stage : {FlowStage::surface, FlowStage::vectors, FlowStage::embed, FlowStage::start})
        if (rerun.has(stage) && doing_ && stage <= *doing_) interrupt_ = true;
    }
  }
  wake_.notify_all();
  return changed;
}

void FlowWorker::cancel() {
  std::scoped_lock lock(mutex_);
  cancelled_ = true;
  stop_focusing();
  if (doing_ && *doing_ != FlowStage::step) interrupt_ = true;
}

void FlowWorker::resume() {
  {
    std::scoped_lock lock(mutex_);
    cancelled_ = failed_ = false;
  }
  wake_.notify_all();
}

bool FlowWorker::cancelled() const {
  std::scoped_lock lock(mutex_);
  return cancelled_;
}

void FlowWorker::sample(const Vec3d& position) {
  {
    std::scoped_lock lock(mutex_);
    sample_ = position;
  }
  wake_.notify_all();
}

void FlowWorker::show_boxes(std::uint64_t* memory, int embedding) {
  {
    std::scoped_lock lock(mutex_);
    boxes_ = {memory, embedding};
  }
  wake_.notify_all();
}

void FlowWorker::write(const std::filesystem::path& file, const std::string& origin) {
  {
    std::scoped_lock lock(mutex_);
    file_ = {file, origin};
  }
  wake_.notify_all();
}

std::string FlowWorker::stage() const {
  std::scoped_lock lock(mutex_);
  if (focusing_) return "close-up";
  if (!doing_) return "";
  switch (*doing_) {
    case FlowStage::surface:
    case FlowStage::vectors: return "reading";
    case FlowStage::colours: return "colours";
    case FlowStage::arrows: return "arrows";
    case FlowStage::lines: return "topology";
    case FlowStage::probes: return "probes";
    case FlowStage::embed: return "embedding";
    case FlowStage::start: return "starting the texture";
    case FlowStage::dyes: return "dye";
    case FlowStage::step: break;
  }
  return "";
}

std::optional<FlowStage> FlowWorker::next() const {
  if (cancelled_ || failed_ || !lost_.empty()) return {};
  for (int k = 0; k < int(FlowStage::step); ++k)
    if (due_.has(FlowStage(k))) return FlowStage(k);
  return {};
}

bool FlowWorker::has_work() const {
  return file_ || (lost_.empty() && (next() || sample_ || boxes_ || step_ || has_focus_work()));
}

void FlowWorker::run() {
  if (low_priority_) make_way();
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return ends_ || has_work(); });
    if (ends_) return;
    working_ = true;
    if (const std::optional<FlowStage> stage = next()) {
      perform(*stage, lock);
    } else if (file_ || sample_ || boxes_) {
      run_errands(lock);
    } else if (has_focus_work()) {
      run_focus(lock);
    } else {
      perform(FlowStage::step, lock);
    }
    working_ = false;
    told_.notify_all();
  }
}

/// What was asked for between two stages.
void FlowWorker::run_errands(std::unique_lock<std::mutex>& lock) {
  const auto file = std::exchange(file_, {});
  const auto position = std::exchange(sample_, {});
  const auto boxes = std::exchange(boxes_, {});
  interrupt_ = false;  // it was meant for a stage
  lock.unlock();
  try {
    if (file) tell(FlowWritten{failure_of([&] { write_values(*file); })});
    const std::string failure = failure_of([&] {
      if (position) answer_sample(*position);
      if (boxes) write_boxes(boxes->first, boxes->second);
    });
    if (!failure.empty()) tell(FlowFailed{failure});
  } catch (const Interrupted&) {  // the end: nobody waits for answers any more
  }
  take_timers(*pipeline_);
  if (const std::string why = lost_device(); !why.empty()) tell(FlowFailed{why});
  lock.lock();
}

void FlowWorker::perform(FlowStage stage, std::unique_lock<std::mutex>& lock) {
  due_.remove(stage);
  if (stage == FlowStage::surface && !vectors_) {  // which chooses vectors and colours, too
    due_.remove(FlowStage::vectors);
    if (!is_ftle(wanted_.color)) due_.remove(FlowStage::colours);
  }
  if (stage == FlowStage::step) {
    memory_ = *std::exchange(step_, {});
    focus_memory_ = std::exchange(focus_step_, {});
  }
  doing_ = stage;
  settings_ = wanted_;
  interrupt_ = false;
  lock.unlock();
  bool interrupted = false;
  std::string failure;
  try {
    failure = failure_of([&] {
      if (fault_due("out-of-memory")) throw std::bad_alloc();
      make(stage);
    });
  } catch (const Interrupted&) {  // for other knobs, or the end
    interrupted = true;
  }
  take_timers(*pipeline_);
  lock.lock();
  doing_.reset();
  share_ = -1;
  if (!lost_.empty() && failure.empty()) failure = lost_;
  if (interrupted || !failure.empty()) undo(stage, failure);
}

/// Afterwards the thread knows what is still to be done. An empty `failure`: it was interrupted.
void FlowWorker::undo(FlowStage stage, const std::string& failure) {
  if (!failure.empty()) events_.emplace_back(FlowFailed{failure});
  const bool choice = (stage >= FlowStage::vectors && stage <= FlowStage::probes) || stage == FlowStage::dyes;
  if (choice && !failure.empty()) return;  // all goes on with what was chosen before
  if (stage == FlowStage::step) {
    drop_step();
    stage = FlowStage::start;
  }
  due_.add(stage);
  if (!choice) started_ = false;
  failed_ = !failure.empty();
}

void FlowWorker::drop_step() {
  step_.reset();
  if (lost_.empty()) events_.emplace_back(std::in_place_type<FlowInterrupted>);
}

void FlowWorker::make(FlowStage stage) {
  switch (stage) {
    case FlowStage::surface: return read();
    case FlowStage::vectors:
    case FlowStage::colours: return choose();
    case FlowStage::arrows: return place_arrows();
    case FlowStage::lines: return find_lines();
    case FlowStage::probes: return find_probes();
    case FlowStage::embed: return embed();
    case FlowStage::start: return start();
    case FlowStage::dyes: return change_dyes();
    case FlowStage::step: return make_step();
  }
}

}  // namespace nacre
