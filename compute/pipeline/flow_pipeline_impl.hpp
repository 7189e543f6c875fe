// Nacre: the flow pipeline on either backend; instantiated by flow_pipeline_cpu.cpp and flow_pipeline_cuda.cu.
#pragma once

#include <utility>

#include "compute/pipeline/grid_flow.hpp"
#include "compute/pipeline/octree_flow.hpp"

namespace nacre {

/// Hands every call to the method that `parameters` named at the last `embed`.
template <class Backend>
class FlowPipelineOf final : public FlowPipeline {
 public:
  explicit FlowPipelineOf(Device& device) : exec_(device) {}

  void embed(const FlowMesh& mesh) override {
    method_.reset();
    exec_.arena().rewind(0);
    std::unique_ptr<FlowMethod> method = make_method();
    method->embed(mesh);
    exec_.wait();
    method_ = std::move(method);
  }

  void start(const FlowVectors& vectors) override {
    method().start(vectors);
    exec_.wait();
  }
  /// Waits once, at its end: then the frame is there, for whoever draws it.
  void step() override {
    method().step();
    exec_.wait();
  }
  double time() const override { return method().time(); }
  std::vector<float> shown() const override { return method().shown(); }
  void show_into(float* memory) override { method().show_into(memory); }
  FlowValues values() const override { return method().values(); }
  std::vector<std::uint8_t> render(const RenderOptions& options) override { return method().render(options); }
  std::vector<float> sample_shown(std::span<const Vec3d> points) override { return method().sample_shown(points); }
  const EmbeddingInfo& embedding() const override { return method().embedding(); }
  FlowLookup lookup() const override { return method().lookup(); }
  FlowBoxes boxes() const override { return method().boxes(); }
  void show_boxes(std::uint64_t* memory) override { method().show_boxes(memory); }
  StageTimers& timers() override { return exec_.timers(); }
  std::size_t peak_bytes() const override { return exec_.arena().peak_bytes(); }
  void watch(const std::atomic<bool>* stop) override { exec_.watch(stop); }

 private:
  FlowMethod& method() const {
    if (!method_) throw Error("no surface embedded");
    return *method_;
  }

  std::unique_ptr<FlowMethod> make_method() {
    if (parameters.method == "grid") return std::make_unique<GridFlow<Backend>>(exec_, parameters);
    if (parameters.method != "octree") throw Error("no method '" + parameters.method + "'", "", "use grid or octree");
    if (parameters.octree == "brick") return std::make_unique<OctreeFlow<Backend, BrickBand>>(exec_, parameters);
    if (parameters.octree == "source") return std::make_unique<OctreeFlow<Backend, SourceBand>>(exec_, parameters);
    throw Error("no octree '" + parameters.octree + "'", "", "use brick or source");
  }

  mutable Executor<Backend> exec_;
  std::unique_ptr<FlowMethod> method_;
};

}  // namespace nacre
