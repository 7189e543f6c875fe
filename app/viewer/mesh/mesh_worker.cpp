// Nacre: the mesh pipeline on a thread of its own: what is due, and who waits for whom.
#include "app/viewer/mesh/mesh_worker.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <tuple>
#include <utility>

#include "app/parameter_names.hpp"
#include "compute/device/error.hpp"
#include "compute/pipeline/mesh_rerun.hpp"
#include "engine/system/faults.hpp"
#include "engine/system/priority.hpp"

namespace nacre {
namespace {

auto of_materials(const MaterialSettings& w) {
  return std::tie(w.labels, w.isovalue, w.threshold, w.materials, w.merge, w.min_component, w.size_image);
}

}  // namespace

MeshStage mesh_restart(const Settings& before, const Settings& after) {
  const MaterialSettings &were = before.materials, &are = after.materials;
  if (were.names != are.names || were.layer != are.layer) return MeshStage::read;
  if (of_materials(before.materials) != of_materials(after.materials)) return MeshStage::materials;
  switch (mesh_rerun(before.mesh, after.mesh)) {
    case MeshRerun::fields: return MeshStage::fields;
    case MeshRerun::relax: return MeshStage::relax;
    case MeshRerun::triangulate: return MeshStage::triangulate;
    case MeshRerun::nothing: break;
  }
  return MeshStage::done;
}

MeshWorker::MeshWorker(const Session& session, std::unique_ptr<Device> device, bool lockstep, bool low_priority,
                       bool live)
    : input_(session),
      device_(std::move(device)),
      pipeline_(make_mesh_pipeline(*device_)),
      low_priority_(low_priority),
      live_(live),
      wanted_(session.settings),
      lockstep_(lockstep) {
  pipeline_->watch(&interrupt_);
  pipeline_->progress = [this](const MeshProgress& progress) { note_progress(progress); };
  thread_ = std::thread([this] { run(); });
}

MeshWorker::~MeshWorker() { finish(); }

std::optional<MeshEvent> MeshWorker::wait(const std::atomic<bool>& stop, double patience) {
  return wait_while([this] { return at_work_ || due() != Task::none; }, stop, patience);
}

void MeshWorker::set_lockstep(bool lockstep) {
  {
    std::scoped_lock lock(mutex_);
    lockstep_ = lockstep;
  }
  wake_.notify_all();
}

void MeshWorker::grant_turn(bool all) {
  {
    std::scoped_lock lock(mutex_);
    turns_ = 1;
    all_turns_ = all_turns_ || all;
  }
  wake_.notify_all();
}

void MeshWorker::run_to(int iteration) {
  {
    std::scoped_lock lock(mutex_);
    if (run_to_ == iteration) return;
    run_to_ = iteration;
  }
  wake_.notify_all();
}

void MeshWorker::lend(const LentMemory& memory) {
  {
    std::scoped_lock lock(mutex_);
    lent_ = memory;
  }
  wake_.notify_all();
}

void MeshWorker::set_settings(const Settings& settings) {
  {
    std::scoped_lock lock(mutex_);
    MeshStage from = mesh_restart(wanted_, settings);
    const Settings before = std::exchange(wanted_, settings);
    if (from == MeshStage::done) return;
    if (find_kept(before)) return;
    if (computed_) {
      next_ = computed_->next;
      from = std::min(next_, mesh_restart(computed_->settings, settings));
      fields_ = from > MeshStage::fields;
      computed_.reset();
      back_.reset();
    }
    if (doing_ != MeshStage::done && from <= doing_) {
      restart_ = std::min(restart_, from);
      interrupt_ = true;
    } else {
      next_ = std::min(next_, from);
    }
    cancelled_ = false;
    if (from <= next_) failed_ = false;
  }
  wake_.notify_all();
}

/// With the mutex held: the knobs are as they were when there was a mesh, which is brought back. What the pipeline has
/// computed `before` stays known, for knobs to come.
bool MeshWorker::find_kept(const Settings& before) {
  if (!live_) return false;
  back_ = kept_.find([this](const Settings& kept) { return mesh_restart(kept, wanted_) == MeshStage::done; });
  if (!back_) return false;
  if (!computed_) computed_ = Computed{before, std::min({next_, doing_, restart_, MeshStage::triangulate})};
  interrupt_ = doing_ != MeshStage::done;
  restart_ = next_ = MeshStage::done;
  fields_ = computed_->next > MeshStage::fields && mesh_restart(computed_->settings, wanted_) > MeshStage::fields;
  cancelled_ = failed_ = false;
  wake_.notify_all();
  return true;
}

void MeshWorker::cancel() {
  std::scoped_lock lock(mutex_);
  cancelled_ = next_ != MeshStage::done;
  if (at_work_) interrupt_ = true;
  wake_.notify_all();
}

void MeshWorker::resume() {
  {
    std::scoped_lock lock(mutex_);
    cancelled_ = failed_ = false;
  }
  wake_.notify_all();
}

void MeshWorker::ask_slice(const SliceRequest& request) {
  {
    std::scoped_lock lock(mutex_);
    slice_ = request;
    slice_filled_ = false;
  }
  wake_.notify_all();
}

void MeshWorker::drop_slice() {
  std::scoped_lock lock(mutex_);
  slice_.reset();
}

bool MeshWorker::slice_comes() const {
  std::scoped_lock lock(mutex_);
  return slice_due();
}

void MeshWorker::write(const std::filesystem::path& file, const std::string& origin) {
  {
    std::scoped_lock lock(mutex_);
    file_ = {file, origin};
  }
  wake_.notify_all();
}

bool MeshWorker::busy() const {
  std::scoped_lock lock(mutex_);
  return at_work_ || due() != Task::none;
}

bool MeshWorker::settled() const {
  std::scoped_lock lock(mutex_);
  return next_ == MeshStage::done && !at_work_ && due() == Task::none && events_.empty();
}

bool MeshWorker::halted() const {
  std::scoped_lock lock(mutex_);
  return cancelled_ || failed_ || !lost_.empty();
}

bool MeshWorker::waits() const {
  std::scoped_lock lock(mutex_);
  return waiting_;
}

MeshProgress MeshWorker::progress() const {
  std::scoped_lock lock(mutex_);
  const bool more = next_ != MeshStage::done && !cancelled_ && !failed_ && lost_.empty();  // also between two stages
  if (doing_ == MeshStage::done && !more && !writing_) return {};
  return progress_.stage.empty() ? MeshProgress{"start", -1, 0, 0, 0} : progress_;
}

/// What comes next. A slice waits for nothing but fields; a file waits for the mesh, unless there will be none.
MeshWorker::Task MeshWorker::due() const {
  const bool halted = cancelled_ || failed_, complete = next_ == MeshStage::done;
  if (!lost_.empty()) return file_ ? Task::write : Task::none;
  if (back_) return Task::bring_back;
  if (slice_due()) return Task::slice;
  if (!complete && !halted) return Task::stage;
  if (file_) return Task::write;
  return unshown_ && memory_due() ? Task::show : Task::none;
}

void MeshWorker::run() {
  if (low_priority_) make_way();
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return ends_ || due() != Task::none; });
    if (ends_) return;
    at_work_ = true;
    const Task task = due();
    lock.unlock();
    perform(task);
    lock.lock();
    at_work_ = false;
    interrupt_ = ends_;
    lock.unlock();
    told_.notify_all();
    lock.lock();
  }
}

void MeshWorker::perform(Task task) {
  switch (task) {
    case Task::stage: perform_stage(); break;
    case Task::slice:
      if (const std::optional<std::string> failure = failure_of([this] { fill_slice(); })) {
        drop_slice();
        tell(MeshFailed{*failure});
      }
      break;
    case Task::bring_back:
      if (const std::optional<std::string> failure = failure_of([this] { bring_back(); })) tell(MeshFailed{*failure});
      break;
    case Task::show:
      failure_of([this] {
        std::unique_lock lock(mutex_);
        const MeshProgress last = progress_;
        lock.unlock();
        show(last, false);
      });
      break;
    case Task::write: write_result(); break;
    case Task::none: break;
  }
  const bool answered = lost_device().empty();
  take_timers(*pipeline_);
  if (const std::string why = lost_device(); answered && !why.empty()) tell(MeshFailed{why});
}

/// The error message; none: no error, or an interruption.
std::optional<std::string> MeshWorker::failure_of(const std::function<void()>& work) {
  try {
    if (fault_due("out-of-memory")) throw std::bad_alloc();
    work();
  } catch (const Interrupted&) {
  } catch (const std::bad_alloc&) {
    return "out of memory; raise min_size and max_size";
  } catch (const std::exception& error) {
    return with_knobs(error.what());
  }
  return {};
}

void MeshWorker::perform_stage() {
  MeshStage stage;
  {
    std::scoped_lock lock(mutex_);
    stage = doing_ = next_;
    made_mesh_.settings = wanted_;
    pipeline_->parameters = wanted_.mesh;
    progress_ = {};
    if (stage <= MeshStage::fields) fields_ = false;
    if (stage <= MeshStage::relax) unshown_ = false;  // what there was is gone
  }
  if (stage > MeshStage::materials && viewed_ != made_mesh_.volume) {  // an earlier mesh of another volume was shown
    viewed_ = made_mesh_.volume;
    tell(VolumeRead{viewed_, made_mesh_.corners, made_mesh_.frame});
  }
  bool complete = false;
  const std::optional<std::string> failure = failure_of([&] {
    make(stage);
    complete = true;
  });
  {
    std::scoped_lock lock(mutex_);
    if (complete) next_ = MeshStage(int(stage) + 1);
    if (complete && stage == MeshStage::fields && !computed_) fields_ = true, slice_filled_ = false;
    if (stage == MeshStage::relax) unshown_ = true;  // brought onto the surfaces since, also where it was interrupted
    next_ = std::min(next_, std::exchange(restart_, MeshStage::done));
    if (computed_) next_ = MeshStage::done;  // an earlier mesh has been asked for meanwhile
    doing_ = MeshStage::done;
    if (complete && next_ == MeshStage::done && live_ && !computed_) kept_.keep(made_mesh_);
    failed_ = failure && next_ == stage && !cancelled_;
  }
  if (failure) tell(MeshFailed{*failure});
}

void MeshWorker::make(MeshStage stage) {
  switch (stage) {
    case MeshStage::read: return read();
    case MeshStage::materials: return choose_materials();
    case MeshStage::fields: return build_fields();
    case MeshStage::relax: return relax();
    case MeshStage::triangulate: return triangulate();
    case MeshStage::measure: return measure();
    case MeshStage::done: break;
  }
}

/// In lockstep, waits until the frames have taken the events and lent memory for more; slices are filled
/// meanwhile. False where it was interrupted.
bool MeshWorker::await_turn() {
  std::unique_lock lock(mutex_);
  while (true) {
    if (interrupt_) return false;
    if (slice_due()) {
      lock.unlock();
      fill_slice();
      lock.lock();
    } else if (!lockstep_ || all_turns_ || (made_ < run_to_ && memory_due())) {
      return true;
    } else if (turns_ > 0 && memory_due()) {
      --turns_;
      return true;
    } else {
      waiting_ = true;
      wake_.wait(lock);
      waiting_ = false;
    }
  }
}

void MeshWorker::note_progress(const MeshProgress& progress) {
  take_timers(*pipeline_);
  check_device();
  {
    std::scoped_lock lock(mutex_);
    progress_ = progress;
  }
  if (progress.iteration > 0 && progress.particles > 0 && await_turn()) show(progress, true);
}

/// Fills the lent memory, if there is any, and reports.
void MeshWorker::show(const MeshProgress& progress, bool step) {
  std::optional<LentMemory> memory;
  {
    std::scoped_lock lock(mutex_);
    unshown_ = true;
    if (step) ++made_;
    if (memory_due()) memory = std::exchange(lent_, std::nullopt);
  }
  MeshIterated told{progress, step, {}, 0};
  if (memory) {
    const ShownCounts counts = pipeline_->show_particles(memory->particles);
    told.shown = counts.total() <= memory->particles.capacity ? counts : ShownCounts{};
    if (memory->boxes) told.boxes = pipeline_->show_boxes(memory->boxes, memory->box_capacity);
    if (told.boxes > memory->box_capacity) told.boxes = 0;
    std::scoped_lock lock(mutex_);
    unshown_ = false;
  }
  if (step || memory) tell(told);
}

}  // namespace nacre
