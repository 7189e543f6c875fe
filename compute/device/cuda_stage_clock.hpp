// Nacre: how long stages take on a GPU, without waiting for it where a stage begins or ends.
#pragma once

#include <cuda_runtime_api.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compute/device/cuda_check.hpp"
#include "compute/device/stage_timers.hpp"

namespace nacre {

/// Two events for each stage, recorded in the stream of its launches. Their distance is known once the stream has come
/// past them: `collect` hands it to the timers.
class CudaStageClock {
 public:
  CudaStageClock() = default;
  ~CudaStageClock() {
    for (const Span& span : spans_) recycle(span);
    for (cudaEvent_t event : spare_) cudaEventDestroy(event);
  }
  CudaStageClock(const CudaStageClock&) = delete;
  CudaStageClock& operator=(const CudaStageClock&) = delete;

  /// Records the time at which `stream` comes here. While the stream is captured, an event would only mark a dependency
  /// there; `captured` asks for a node of the graph that records it at every launch.
  cudaEvent_t mark(cudaStream_t stream, bool captured) {
    cudaEvent_t event = nullptr;
    if (!spare_.empty()) {
      event = spare_.back();
      spare_.pop_back();
    } else {
      cuda_check(cudaEventCreate(&event), "making an event");
    }
    const cudaError_t status =
        cudaEventRecordWithFlags(event, stream, captured ? cudaEventRecordExternal : cudaEventRecordDefault);
    if (status != cudaSuccess) spare_.push_back(event);
    cuda_check(status, "recording an event");
    return event;
  }

  /// A stage between two marks; its time is added to the timers when it is known.
  void add(std::string name, cudaEvent_t begin, cudaEvent_t end, long launches) {
    spans_.push_back({std::move(name), begin, end, launches});
  }
  void drop(cudaEvent_t event) { spare_.push_back(event); }

  /// Those of the stages added so far, in their order, that the GPU has left. Not while a stream is captured.
  void collect(StageTimers& timers) {
    std::size_t done = 0;
    for (; done < spans_.size(); ++done) {
      const Span& span = spans_[done];
      const cudaError_t status = cudaEventQuery(span.end);
      if (status == cudaErrorNotReady) {
        cudaGetLastError();  // an answer, not a failure
        break;
      }
      cuda_check(status, "asking for an event");
      float milliseconds = 0;
      cuda_check(cudaEventElapsedTime(&milliseconds, span.begin, span.end), "timing a stage");
      timers.add(span.name, milliseconds * 1e-3, span.launches);
      recycle(span);
    }
    spans_.erase(spans_.begin(), spans_.begin() + std::ptrdiff_t(done));
  }

  /// How many stages are not collected; those after the first `count` can be taken back, since they never ran.
  std::size_t pending() const { return spans_.size(); }
  void take_back(std::size_t count) {
    for (; spans_.size() > count; spans_.pop_back()) recycle(spans_.back());
  }

 private:
  struct Span {
    std::string name;
    cudaEvent_t begin, end;
    long launches;
  };

  void recycle(const Span& span) {
    spare_.push_back(span.begin);
    spare_.push_back(span.end);
  }

  std::vector<Span> spans_;
  std::vector<cudaEvent_t> spare_;
};

}  // namespace nacre
