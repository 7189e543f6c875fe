// Nacre: a flow as the viewer shows it: what the worker has told, on the graphics device.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/viewer/flow_worker.hpp"
#include "app/viewer/scene.hpp"
#include "engine/interop/shared_buffer.hpp"
#include "engine/render/line_passes.hpp"
#include "engine/render/surface_pass.hpp"

namespace nacre {

class FlowScene : public Scene {
 public:
  FlowScene(const Session& session, std::unique_ptr<Device> device, bool loop);
  ~FlowScene() override;
  FlowScene(const FlowScene&) = delete;
  FlowScene& operator=(const FlowScene&) = delete;

  void advance(double now) override;
  void advance_and_wait(const std::atomic<bool>& stop) override;
  void set_settings(const Settings& settings) override;
  void cancel() override;
  void resume() override;
  void draw(const View& view) override;
  Image overlay(int width, int height) override;
  std::uint64_t overlay_version() const override { return 0; }
  void result_panel(Session& session) override;
  std::optional<Probed> probe(const Vec3d& from, const Vec3d& along) override;
  void write_result(const std::filesystem::path& file) override;
  std::vector<std::string> result_formats() const override { return {}; }

  const std::vector<Vec3d>& corners() const override { return corners_; }
  bool complete() const override { return shown_ && steps_ > 0; }
  bool settled() const override { return false; }
  std::string title() const override;
  std::string state() const override;
  SceneProgress progress() const override { return {worker_.stage(), -1}; }
  const std::string& failure() const override { return failure_; }
  const std::vector<std::string>& warnings() const override { return warnings_; }
  std::string remark() const override { return shown_ ? shown_->remark() : std::string(); }
  int steps() const override { return steps_; }
  std::uint64_t copied_bytes() const override { return copied_ + (shown_ ? shown_->copied_bytes() : 0); }
  StageTimers timers() const override { return worker_.timers(); }
  std::size_t peak_bytes() const override { return worker_.peak_bytes(); }
  const Device& device() const override { return worker_.device(); }
  void finish() override { worker_.finish(); }

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
  Settings settings_;
  double low_ = 0, high_ = 1, time_ = 0, last_step_ = -1e9;
  int steps_ = 0;
  std::uint64_t copied_ = 0;
};

}  // namespace nacre
