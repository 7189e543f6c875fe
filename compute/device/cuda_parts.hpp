// Nacre: long launches in parts, on a GPU that also draws a screen: its driver ends a kernel that does not let it draw.
#pragma once

#include <cuda_runtime_api.h>

#include <algorithm>
#include <cstdint>

#include "compute/device/cuda_check.hpp"
#include "compute/device/launch_pace.hpp"

namespace nacre {

/// Launches in one piece where the driver sets no limit to a kernel's time.
class CudaParts {
 public:
  explicit CudaParts(int device) {
    int limited = 0;
    cuda_check(cudaDeviceGetAttribute(&limited, cudaDevAttrKernelExecTimeout, device), "asking for a limit of time");
    if (!limited) return;
    for (cudaEvent_t* event : {&begin_, &end_}) cuda_check(cudaEventCreate(event), "making an event");
  }
  ~CudaParts() {
    if (begin_) cudaEventDestroy(begin_);
    if (end_) cudaEventDestroy(end_);
  }
  CudaParts(const CudaParts&) = delete;
  CudaParts& operator=(const CudaParts&) = delete;

  /// launch(first, end) for parts of 0 .. n-1 that together are all of it. Waits for those that could be long, to
  /// measure them; while `stream` is captured, what is known must do.
  template <class Launch>
  void run(std::int64_t n, LaunchPace& pace, cudaStream_t stream, bool captured, const Launch& launch) {
    if (!end_) return launch(0, n);
    const bool measured = !captured && !pace.is_short(n);
    for (std::int64_t first = 0, end = 0; first < n; first = end) {
      end = std::min(n, first + (measured ? pace.careful_part() : pace.part()));
      if (measured)
        pace.note(end - first, seconds_of(stream, [&] { launch(first, end); }));
      else
        launch(first, end);
    }
  }

 private:
  template <class Launch>
  float seconds_of(cudaStream_t stream, const Launch& launch) {
    cuda_check(cudaEventRecord(begin_, stream), "recording an event");
    launch();
    cuda_check(cudaEventRecord(end_, stream), "recording an event");
    cuda_check(cudaEventSynchronize(end_), "wait");
    float milliseconds = 0;
    cuda_check(cudaEventElapsedTime(&milliseconds, begin_, end_), "timing a launch");
    return milliseconds * 1e-3f;
  }

  cudaEvent_t begin_ = nullptr, end_ = nullptr;
};

}  // namespace nacre
