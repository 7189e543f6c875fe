// Nacre: the flow pipeline on either backend; instantiated by flow_pipeline_cpu.cpp and flow_pipeline_cuda.cu.
#pragma once

#include <utility>

#include "compute/pipeline/grid_flow.hpp"
#include "compute/pipeline/octree_flow.hpp"

namespace nacre {

/// Owns the executor, and makes the method that `parameters` name at each `embed`.
template <class Backend>
class FlowPipelineOf final : public FlowPipeline {
 public:
  explicit FlowPipelineOf(Device& device) : exec_(device) {}
  ~FlowPipelineOf() override { method_.reset(); }  // before the executor that it runs on

  void embed(const FlowMesh& mesh) override {
    method_.reset();
    exec_.arena().rewind(0);
    std::unique_ptr<FlowMethod> method = make_method();
    method->embed(mesh);
    exec_.wait();
    method_ = std::move(method);
  }

  StageTimers& timers() override { return exec_.timers(); }
  std::size_t peak_bytes() const override { return exec_.arena().peak_bytes(); }
  void watch(const std::atomic<bool>* stop) override { exec_.watch(stop); }

 private:
  std::unique_ptr<FlowMethod> make_method() {
    if (parameters.method == EmbeddingKind::grid) return std::make_unique<GridFlow<Backend>>(exec_, parameters);
    if (parameters.octree == OctreeKind::brick)
      return std::make_unique<OctreeFlow<Backend, BrickBand>>(exec_, parameters);
    return std::make_unique<OctreeFlow<Backend, ThesisBand>>(exec_, parameters);
  }

  mutable Executor<Backend> exec_;
};

}  // namespace nacre
