// Nacre: the flow pipeline on a thread of its own.
#include "app/viewer/flow_worker.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <utility>

#include "app/viewer/flow_rerun.hpp"
#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "engine/scene/prepare.hpp"
#include "engine/scene/samples.hpp"
#include "engine/system/faults.hpp"

namespace nacre {
namespace {

/// A flow that loops is one that is this many times as long: a power of two, so that the times of its steps are the very
/// numbers of a flow that ends.
int rounds(const FlowParameters& parameters, bool loop) {
  int n = 1;
  while (loop && n < 1 << 16 && parameters.steps > 0 && parameters.steps < (1 << 29) / n) n *= 2;
  return n;
}

}  // namespace

FlowWorker::FlowWorker(Session session, std::unique_ptr<Device> device, bool loop)
    : session_(std::move(session)),
      device_(std::move(device)),
      pipeline_(make_flow_pipeline(*device_)),
      loop_(loop),
      wanted_(session_.settings.flow) {
  pipeline_->watch(&interrupt_);
  thread_ = std::thread([this] { run(); });
}

FlowWorker::~FlowWorker() { finish(); }

void FlowWorker::finish() {
  if (!thread_.joinable()) return;
  {
    std::scoped_lock lock(mutex_);
    ends_ = true;
    interrupt_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

std::optional<FlowEvent> FlowWorker::poll() {
  std::scoped_lock lock(mutex_);
  if (events_.empty()) return {};
  FlowEvent event = std::move(events_.front());
  events_.pop_front();
  return event;
}

std::optional<FlowEvent> FlowWorker::wait(const std::atomic<bool>& stop) {
  std::unique_lock lock(mutex_);
  while (events_.empty() && (task_ != Task::none || doing_ != Task::none) && !stop)
    told_.wait_for(lock, std::chrono::milliseconds(100));
  lock.unlock();
  return poll();
}

bool FlowWorker::ready() const {
  std::scoped_lock lock(mutex_);
  return started_ && task_ == Task::none && doing_ == Task::none && events_.empty();
}

void FlowWorker::step(float* memory) {
  {
    std::scoped_lock lock(mutex_);
    memory_ = memory;
    task_ = Task::step;
  }
  wake_.notify_all();
}

bool FlowWorker::busy() const {
  std::scoped_lock lock(mutex_);
  return task_ != Task::none || doing_ != Task::none;
}

void FlowWorker::set_parameters(const FlowParameters& parameters) {
  {
    std::scoped_lock lock(mutex_);
    const FlowRerun rerun = flow_rerun(wanted_, parameters);
    wanted_ = parameters;
    if (rerun < FlowRerun::start || !read_) return;  // what is still to be run takes them anyway
    Task from = rerun == FlowRerun::embed || !embedded_ ? Task::embed : Task::start;
    if (restart_ == Task::embed) from = Task::embed;
    started_ = false;
    if (doing_ == Task::none) {
      task_ = from;
    } else {
      restart_ = from;
      interrupt_ = true;
    }
  }
  wake_.notify_all();
}

StageTimers FlowWorker::timers() const {
  std::scoped_lock lock(mutex_);
  return timers_;
}

std::size_t FlowWorker::peak_bytes() const {
  std::scoped_lock lock(mutex_);
  return peak_bytes_;
}

std::string FlowWorker::stage() const {
  std::scoped_lock lock(mutex_);
  switch (doing_) {
    case Task::read: return "reading";
    case Task::embed: return "embedding";
    case Task::start: return "starting the texture";
    case Task::step:
    case Task::none: break;
  }
  return failed_ ? "stopped" : "";
}

void FlowWorker::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return ends_ || task_ != Task::none; });
    if (ends_) return;
    doing_ = std::exchange(task_, Task::none);
    pipeline_->parameters = wanted_;
    failed_ = false;
    const Task task = doing_;
    lock.unlock();
    perform(task);
    lock.lock();
    doing_ = Task::none;
    if (restart_ != Task::none) {
      task_ = std::exchange(restart_, Task::none);
      started_ = false;
      interrupt_ = false;
    }
    lock.unlock();
    told_.notify_all();
    lock.lock();
  }
}

void FlowWorker::perform(Task task) {
  const auto fail = [&](const std::string& what) {
    {
      std::scoped_lock lock(mutex_);
      failed_ = true;
      started_ = false;
    }
    tell(FlowFailed{what});
  };
  try {
    if (fault_due("out-of-memory")) throw std::bad_alloc();
    switch (task) {
      case Task::read: read(); [[fallthrough]];
      case Task::embed: embed(); [[fallthrough]];
      case Task::start: start(); break;
      case Task::step: make_step(); break;
      case Task::none: break;
    }
  } catch (const Interrupted&) {  // for other knobs, or the end
  } catch (const std::bad_alloc&) {
    fail("out of memory; lower resolution");
  } catch (const std::exception& error) {
    fail(error.what());
  }
  take_timers();
}

void FlowWorker::read() {
  SurfaceRead told;
  {
    StageTimers::Scope scope(pipeline_->timers(), "read");
    SurfaceSeries series =
        session_.sample.empty() ? open_surface(session_.inputs) : make_sample(session_.sample, session_.detail);
    told.name = series.name;
    told.warnings = series.warnings;
    const Surface first = series.load(0);
    PreparedSurface surface = prepare(first, session_.settings.crease, &told.warnings);
    told.array = choose_vectors(first, session_.settings.vectors).name;
    vectors_ =
        std::make_unique<VectorsInTime>(std::move(series), std::move(surface), told.array, session_.settings.color);
  }
  const PreparedSurface& surface = vectors_->surface();
  told.geometry = make_surface_geometry(surface.points, surface.triangles, surface.corner_normals);
  for (const SurfaceVertex& v : told.geometry.vertices) told.corners.push_back(surface.points[v.point]);
  told.low = vectors_->color_low();
  told.high = vectors_->color_high();
  told.scalar = scalar(vectors_->start());
  {
    std::scoped_lock lock(mutex_);
    read_ = true;
  }
  tell(std::move(told));
}

void FlowWorker::embed() {
  {
    std::scoped_lock lock(mutex_);
    doing_ = Task::embed;
    embedded_ = false;
    pipeline_->parameters = wanted_;
  }
  const PreparedSurface& surface = vectors_->surface();
  pipeline_->embed({surface.points, surface.triangles, surface.corner_normals});
  take_timers();
  FlowEmbedded told{pipeline_->lookup(), {}, pipeline_->embedding()};
  told.rimmed = with_rims(sparse_lookup(told.lookup));
  {
    std::scoped_lock lock(mutex_);
    embedded_ = true;
  }
  tell(std::move(told));
}

void FlowWorker::start() {
  {
    std::scoped_lock lock(mutex_);
    doing_ = Task::start;
  }
  const int n = rounds(pipeline_->parameters, loop_);
  FlowVectors vectors;
  vectors.at = [this](double t, std::span<Vec3f> out) { vectors_->vectors(wrapped(t), out); };
  vectors.start = vectors_->start();
  vectors.end = vectors.start + (vectors_->end() - vectors.start) * n;
  const double speed = vectors_->statistics().percentile_98;
  vectors.reference_speed = speed > 0 ? speed : 1;
  const int steps = pipeline_->parameters.steps;
  pipeline_->parameters.steps = steps * n;
  pipeline_->start(vectors);
  steps_made_ = 0;
  {
    std::scoped_lock lock(mutex_);
    started_ = restart_ == Task::none;
  }
  tell(FlowStarted{});
}

void FlowWorker::make_step() {
  pipeline_->parameters.steps *= rounds(pipeline_->parameters, loop_);
  pipeline_->show_into(memory_);
  pipeline_->step();
  ++steps_made_;
  const double time = wrapped(pipeline_->time());
  take_timers();
  tell(FlowStepped{time, steps_made_, scalar(time)});
}

double FlowWorker::wrapped(double time) const {
  const double start = vectors_->start(), period = vectors_->end() - start;
  return loop_ && period > 0 ? start + std::fmod(time - start, period) : time;
}

std::vector<float> FlowWorker::scalar(double time) {
  return vectors_->colored() ? vectors_->scalar(time) : std::vector<float>();
}

void FlowWorker::take_timers() {
  const std::size_t peak = pipeline_->peak_bytes();
  std::scoped_lock lock(mutex_);
  timers_ = pipeline_->timers();
  peak_bytes_ = peak;
}

void FlowWorker::tell(FlowEvent event) {
  {
    std::scoped_lock lock(mutex_);
    events_.push_back(std::move(event));
  }
  told_.notify_all();
}

}  // namespace nacre
