// Nacre: the flow pipeline on a thread of its own, beside the frames. No OpenGL here.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "compute/device/stage_timers.hpp"
#include "compute/pipeline/flow_pipeline.hpp"
#include "engine/render/geometry.hpp"
#include "engine/render/sparse_texture.hpp"
#include "engine/scene/session.hpp"
#include "engine/scene/vectors_in_time.hpp"

namespace nacre {

// What the worker tells, in this order; after a change of knobs again from where it has to begin.

/// The surface is read.
struct SurfaceRead {
  std::string name, array;  ///< what is shown on it
  SurfaceGeometry geometry;
  std::vector<Vec3d> corners;  ///< points that triangles use
  std::vector<float> scalar;   ///< at the first time; empty: not coloured
  double low = 0, high = 1;    ///< its range over all times
  std::vector<std::string> warnings;
};

/// The embedding is there: these arrays find a surface cell.
struct FlowEmbedded {
  FlowLookup lookup;
  std::vector<std::uint32_t> rimmed;  ///< its texels with_rims
  EmbeddingInfo info;
};

/// The first values can be asked for.
struct FlowStarted {};

/// The values are in the memory that `step` was given.
struct FlowStepped {
  double time = 0;
  int number = 0;  ///< steps since the start
  std::vector<float> scalar;
};

/// A stage did not work; the worker waits for other knobs.
struct FlowFailed {
  std::string what;
};

using FlowEvent = std::variant<SurfaceRead, FlowEmbedded, FlowStarted, FlowStepped, FlowFailed>;

/// The lookup as the renderer takes it.
inline SparseLookup sparse_lookup(const FlowLookup& l) {
  return {l.bricks, l.subcells, l.refine, l.origin, l.cell_size, l.brick_index, l.block, l.texel};
}

/// Reads, embeds and starts by itself; then one step for each call of `step`. All calls come from one other thread, and
/// none waits for compute but `wait` and the destructor.
class FlowWorker {
 public:
  /// `loop`: after the last time comes the first again, without end; else it stands still there, as headless runs do.
  FlowWorker(Session session, std::unique_ptr<Device> device, bool loop);
  ~FlowWorker();
  FlowWorker(const FlowWorker&) = delete;
  FlowWorker& operator=(const FlowWorker&) = delete;

  Device& device() { return *device_; }
  const Device& device() const { return *device_; }

  /// The oldest event that was not taken.
  std::optional<FlowEvent> poll();
  /// The same, but waits for it. None where the worker has nothing to do. Gives up when `stop` is set.
  std::optional<FlowEvent> wait(const std::atomic<bool>& stop);

  /// May `step` be called? Not before FlowStarted, not before the last step's event, and not while knobs are taken over.
  bool ready() const;
  /// Makes the next step and writes what is to be shown to `memory` of the device.
  void step(float* memory);

  /// Takes other knobs over: at once where a step takes them, else it interrupts what it does and begins from there.
  void set_parameters(const FlowParameters& parameters);
  bool busy() const;  ///< with a step or a longer stage

  /// Interrupts what it does and ends the thread; the memory of a step is not written any more. Nothing may be asked for
  /// after this.
  void finish();

  StageTimers timers() const;  ///< of all stages so far
  std::string stage() const;   ///< what it does now, for the panel: "embedding"; empty: nothing
  std::size_t peak_bytes() const;

 private:
  enum class Task { none, read, embed, start, step };

  void run();
  void perform(Task task);
  void read();
  void embed();
  void start();
  void make_step();
  void tell(FlowEvent event);
  void take_timers();
  std::vector<float> scalar(double time);
  double wrapped(double time) const;

  Session session_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<FlowPipeline> pipeline_;
  std::unique_ptr<VectorsInTime> vectors_;
  bool loop_;
  int steps_made_ = 0;

  mutable std::mutex mutex_;
  std::condition_variable wake_, told_;
  std::deque<FlowEvent> events_;
  Task task_ = Task::read, doing_ = Task::none;
  Task restart_ = Task::none;  ///< where to begin when what is under way has been interrupted
  bool read_ = false, embedded_ = false, started_ = false, ends_ = false, failed_ = false;
  float* memory_ = nullptr;
  FlowParameters wanted_;
  StageTimers timers_;
  std::size_t peak_bytes_ = 0;
  std::atomic<bool> interrupt_{false};
  std::thread thread_;
};

}  // namespace nacre
