// Nacre: the flow pipeline on either backend; instantiated by flow_pipeline_cpu.cpp and flow_pipeline_cuda.cu.
#pragma once

#include <memory>
#include <utility>

#include "compute/pipeline/grid_flow.hpp"
#include "compute/pipeline/grid_pattern.hpp"
#include "compute/pipeline/octree_flow.hpp"

namespace nacre {

/// Owns the executors, and makes the method that `parameters` name at each `embed`.
template <class Backend>
class FlowPipelineOf final : public FlowPipeline {
 public:
  explicit FlowPipelineOf(Device& device) : device_(device), exec_(std::make_unique<Executor<Backend>>(device)) {}
  ~FlowPipelineOf() override { method_.reset(); }  // before the executor that it runs on

  void embed(const FlowMesh& mesh) override {
    method_.reset();
    exec_->arena().rewind(0);
    std::unique_ptr<FlowMethod> method = make_method(*exec_);
    method->embed(mesh);
    exec_->wait();
    method_ = std::move(method);
  }

  /// In an arena of its own, so that the flow before is there until the other one is complete. The two take turns.
  double carry(const FlowMesh& mesh, const FlowVectors& vectors, FlowCarry how) override {
    const FlowMethod& before = flow();
    if (!spare_) spare_ = std::make_unique<Executor<Backend>>(device_);
    spare_->watch(stop_, share_);
    spare_->arena().rewind(0);
    spare_->timers() = exec_->timers();
    std::unique_ptr<FlowMethod> method = make_method(*spare_);
    {
      auto stage = spare_->stage("rebuild");
      method->embed(mesh);
      spare_->wait();
    }
    double found = 0;
    {
      auto stage = spare_->stage("carry");
      found = method->resume(vectors, before, how);
      spare_->wait();
    }
    method_ = std::move(method);
    std::swap(exec_, spare_);
    return found;
  }

  StageTimers& timers() override { return exec_->timers(); }
  std::size_t peak_bytes() const override {
    return exec_->arena().peak_bytes() + (spare_ ? spare_->arena().peak_bytes() : 0);
  }
  void watch(const std::atomic<bool>* stop, std::atomic<float>* share) override {
    stop_ = stop, share_ = share;
    exec_->watch(stop, share);
  }

 private:
  std::unique_ptr<FlowMethod> make_method(Executor<Backend>& exec) {
    if (ranks && (parameters.method == EmbeddingKind::grid || parameters.octree != OctreeKind::brick))
      throw Error("several processes share only an octree of bricks", "", "use `method` octree and `octree` brick");
    if (ranks && device_.backend() != "cpu")
      throw Error("several processes work only on CPUs", "this one has " + device_.name(), "choose the CPU");
    require_pattern(parameters);
    if (parameters.texture != FlowTexture::streaks) return std::make_unique<GridPattern<Backend>>(exec, parameters);
    if (parameters.method == EmbeddingKind::grid) return std::make_unique<GridFlow<Backend>>(exec, parameters);
    if (parameters.octree == OctreeKind::brick)
      return std::make_unique<OctreeFlow<Backend, BrickBand>>(exec, parameters, ranks);
    return std::make_unique<OctreeFlow<Backend, ThesisBand>>(exec, parameters);
  }

  Device& device_;
  std::unique_ptr<Executor<Backend>> exec_, spare_;  ///< spare: null before the first `carry`
  const std::atomic<bool>* stop_ = nullptr;
  std::atomic<float>* share_ = nullptr;
};

}  // namespace nacre
