// Nacre: a flow as the viewer shows it: what the worker has told, on the graphics device.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/flow_worker.hpp"
#include "engine/interop/shared_buffer.hpp"
#include "engine/render/line_passes.hpp"
#include "engine/render/surface_pass.hpp"

namespace nacre {

/// Belongs to the thread of the context.
class FlowScene {
 public:
  FlowScene(Session session, std::unique_ptr<Device> device, bool loop);
  ~FlowScene();
  FlowScene(const FlowScene&) = delete;
  FlowScene& operator=(const FlowScene&) = delete;

  /// Takes what the worker has told, and asks for the next step where one is due at time `now` (seconds) and the memory
  /// for it is free. Never waits.
  void advance(double now);
  /// The same for replays: waits until one more step is there. Throws Error where a stage fails.
  void advance_and_wait(const std::atomic<bool>& stop);

  void draw(const View& view);

  void set_parameters(const FlowParameters& parameters) { worker_.set_parameters(parameters); }
  void set_colormap(const std::string& name);

  bool playing = true;
  bool edges = false;
  double steps_per_second = 25;  ///< at most

  const std::vector<Vec3d>& corners() const { return corners_; }  ///< to fit a camera to; empty: not read yet
  double radius() const { return radius_; }                       ///< of a ball around their middle
  bool textured() const { return shown_ && steps_ > 0; }
  int steps() const { return steps_; }
  double time() const { return time_; }
  const std::string& name() const { return name_; }
  const std::string& array() const { return array_; }
  const std::string& failure() const { return failure_; }  ///< what went wrong last; empty: nothing
  const std::vector<std::string>& warnings() const { return warnings_; }
  const EmbeddingInfo& embedding() const { return info_; }
  std::uint64_t copied_bytes() const { return copied_ + (shown_ ? shown_->copied_bytes() : 0); }
  std::string remark() const { return shown_ ? shown_->remark() : std::string(); }
  FlowWorker& worker() { return worker_; }

 private:
  void take(FlowEvent& event);
  void take(SurfaceRead& told);
  void take(FlowEmbedded& told);
  void take(FlowStarted& told);
  void take(FlowStepped& told);
  void take(FlowFailed& told);
  bool begin_step(bool wait);

  FlowWorker worker_;  // before what it writes to, whose device it owns
  SurfaceBuffers surface_;
  SurfaceColours colours_;
  SurfacePass surface_pass_;
  EdgePass edge_pass_;
  std::unique_ptr<SharedBuffer> shown_;
  std::vector<Vec3d> corners_;
  std::vector<std::string> warnings_;
  std::string name_, array_, failure_;
  EmbeddingInfo info_;
  double radius_ = 0, low_ = 0, high_ = 1, time_ = 0, last_step_ = -1e9;
  int steps_ = 0;
  std::uint64_t copied_ = 0;
};

}  // namespace nacre
