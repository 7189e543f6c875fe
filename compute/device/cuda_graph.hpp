// Nacre: launches that were captured from a stream, as one launch.
#pragma once

#include <cuda_runtime_api.h>

#include "compute/device/cuda_check.hpp"
#include "compute/device/device.hpp"
#include "compute/device/executor.hpp"

namespace nacre {

/// Captures what this thread launches in `stream` during its life. The stream is used for nothing else.
class CudaCapture {
 public:
  /// Other threads may do what they like meanwhile; this one must not do what cannot be captured.
  explicit CudaCapture(cudaStream_t stream) : stream_(stream) {
    cuda_check(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeThreadLocal), "beginning a capture");
  }
  /// Where `end` was not reached, what was captured is dropped and the stream is as before.
  ~CudaCapture() {
    if (!ended_ && cudaStreamEndCapture(stream_, &graph_) != cudaSuccess) cudaGetLastError();
    if (graph_) cudaGraphDestroy(graph_);
  }
  CudaCapture(const CudaCapture&) = delete;
  CudaCapture& operator=(const CudaCapture&) = delete;

  /// The graph, which lives as long as this.
  cudaGraph_t end() {
    ended_ = true;
    cuda_check(cudaStreamEndCapture(stream_, &graph_),
               "capturing the launches of a step (NACRE_GRAPHS=0 runs without)");
    return graph_;
  }

 private:
  cudaStream_t stream_;
  cudaGraph_t graph_ = nullptr;
  bool ended_ = false;
  const Recording recording_;
};

/// The executable graph of a part that is repeated.
class CudaGraph final : public Steps::Record {
 public:
  CudaGraph() = default;
  ~CudaGraph() override { clear(); }
  CudaGraph(const CudaGraph&) = delete;
  CudaGraph& operator=(const CudaGraph&) = delete;

  /// Makes it do what `graph` does and launches it. Where only arguments and sizes differ from the last time it is
  /// updated, else made again.
  void launch(cudaGraph_t graph, cudaStream_t stream) {
    if (executable_ && !update(graph)) clear();
    stream_ = stream;
    if (!executable_) {
      cuda_check(cudaGraphInstantiate(&executable_, graph, 0), "making a graph of the launches of a step");
      ++made_;
    }
    cuda_check(cudaGraphLaunch(executable_, stream), "launching a graph");
  }

  long made() const { return made_; }  ///< how often it was made, not updated
  bool warm = false;                   ///< has run once without a graph

 private:
  bool update(cudaGraph_t graph) {
    cudaGraphExecUpdateResultInfo info{};
    const cudaError_t status = cudaGraphExecUpdate(executable_, graph, &info);
    if (status == cudaSuccess) return true;
    cudaGetLastError();
    if (status != cudaErrorGraphExecUpdateFailure) cuda_check(status, "updating a graph");
    return false;
  }

  void clear() {
    if (!executable_) return;
    cudaStreamSynchronize(stream_);  // it may still run
    cudaGraphExecDestroy(executable_);
    executable_ = nullptr;
  }

  cudaGraphExec_t executable_ = nullptr;
  cudaStream_t stream_ = nullptr;
  long made_ = 0;
};

}  // namespace nacre
