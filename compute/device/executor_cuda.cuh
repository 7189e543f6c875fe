// Nacre: the launches on CUDA and CUB. Included by `*_cuda.cu` only.
#pragma once

#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compute/device/cuda_check.hpp"
#include "compute/device/cuda_device.hpp"
#include "compute/device/cuda_graph.hpp"
#include "compute/device/cuda_launch.cuh"
#include "compute/device/cuda_parts.hpp"
#include "compute/device/cuda_stage_clock.hpp"
#include "compute/device/executor.hpp"

namespace nacre {

template <>
class Executor<Cuda> : public ExecutorBase {
 public:
  explicit Executor(Device& device)
      : ExecutorBase(device),
        cuda_(dynamic_cast<CudaDevice&>(device)),
        stream_(cuda_.stream()),
        device_stream_(stream_),
        parts_(cuda_.number()) {
    cuda_.use();
    const char* graphs = std::getenv("NACRE_GRAPHS");
    graphs_ = !graphs || std::string_view(graphs) != "0";
    strict_ = graphs && std::string_view(graphs) == "strict";
    if (graphs_) cuda_check(cudaStreamCreateWithFlags(&capture_stream_, cudaStreamNonBlocking), "making a stream");
  }
  ~Executor() {
    cudaStreamSynchronize(device_stream_);
    if (capture_stream_) cudaStreamDestroy(capture_stream_);
  }
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Times its life on the GPU; nothing waits for it.
  class Stage {
   public:
    Stage(Executor& executor, std::string_view name)
        : executor_(executor), name_(name), launches_(executor.launches()), begin_(executor.mark()) {}
    ~Stage() {
      try {
        executor_.clock_.add(std::move(name_), begin_, executor_.mark(), executor_.launches() - launches_);
      } catch (const Error&) {  // the next checked call says the same
        executor_.clock_.drop(begin_);
      }
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

   private:
    Executor& executor_;
    std::string name_;
    long launches_;
    cudaEvent_t begin_;
  };

  Stage stage(std::string_view name) {
    if (!capturing_) clock_.collect(ExecutorBase::timers());
    return {*this, name};
  }

  /// With all stages that have ended: waits for the device.
  StageTimers& timers() {
    wait();
    return ExecutorBase::timers();
  }

  void wait() {
    device().synchronize();
    clock_.collect(ExecutorBase::timers());
  }

  /// The first call launches one by one, so that most kernels are loaded before they are captured. Where a graph cannot
  /// be made, the call launches one by one, too; after `most_failures` of them none is tried any more. NACRE_GRAPHS=0
  /// makes all calls do so, NACRE_GRAPHS=strict makes a failure an error. `body` may therefore be called twice: what it
  /// does besides launching must bear that.
  template <class Body>
  void repeat(Steps& steps, const Body& body) {
    if (capturing_) return body();
    if (!steps.record) steps.record = std::make_unique<CudaGraph>();
    auto& graph = static_cast<CudaGraph&>(*steps.record);
    if (graphs_ && graph.warm && launched_as_graph(graph, body)) return;
    const Recording recording;  // what cannot be captured is forbidden here, too
    body();
    graph.warm = true;
  }

  template <class T>
  void fill(const Array<T>& array, unsigned char value) {
    if (array.size() > 0) cuda_check(cudaMemsetAsync(array.data(), value, array.bytes(), stream_), "fill");
  }

  template <class Get>
  std::int64_t known(const Get&, std::int64_t most) const {
    return most;
  }

  template <class Kernel>
  void for_each(std::int64_t n, const Kernel& kernel) {
    begin_launch();
    if (n <= 0) return;
    static_assert(sizeof(Kernel) <= 4000, "kernel parameters go through 4 KB of constant memory");
    constexpr int threads = 256;
    if (capturing_) load(for_each_kernel<Kernel>);
    static LaunchPace pace;
    parts_.run(n, pace, stream_, capturing_, [&](std::int64_t first, std::int64_t end) {
      const auto blocks = unsigned(std::min<std::int64_t>((end - first + threads - 1) / threads, 1 << 20));
      launch_elements(blocks, threads, stream_, {first, end}, kernel);
      cuda_check(cudaGetLastError(), "kernel launch");
    });
  }

  template <class Kernel>
  void for_each_team(std::int64_t n, const Kernel& kernel) {
    begin_launch();
    if (n <= 0) return;
    static_assert(sizeof(Kernel) <= 4000, "kernel parameters go through 4 KB of constant memory");
    const std::size_t scratch = Team::sum_bytes + kernel.scratch_bytes();
    if (scratch > (48u << 10))
      cuda_check(
          cudaFuncSetAttribute(for_each_team_kernel<Kernel>, cudaFuncAttributeMaxDynamicSharedMemorySize, int(scratch)),
          "shared memory of a team");
    if (capturing_) load(for_each_team_kernel<Kernel>);
    static LaunchPace pace;
    parts_.run(n, pace, stream_, capturing_, [&](std::int64_t first, std::int64_t end) {
      const auto blocks = unsigned(std::min<std::int64_t>(end - first, 1 << 20));
      launch_teams(blocks, scratch, stream_, {first, end}, kernel);
      cuda_check(cudaGetLastError(), "kernel launch");
    });
  }

  template <class T>
  T exclusive_scan(const T* in, T* out, std::int64_t n) {
    Recording::forbid("a sum that the host asks for");
    if (n <= 0) {
      begin_launch();
      return T(0);
    }
    Arena::Scope scope(arena());
    Array<T> ends = arena().temporary<T>(2);
    copy(ends.data(), in + n - 1, 1);  // before the scan: in == out is allowed
    scan(in, out, n);
    copy(ends.data() + 1, out + n - 1, 1);
    const std::vector<T> last = ends.download();
    return last[0] + last[1];
  }

  template <class T>
  void scan(const T* in, T* out, std::int64_t n) {
    begin_launch();
    if (n <= 0) return;
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceScan::ExclusiveSum(scratch, bytes, in, out, n, stream_);
    });
  }

  void sort(std::uint64_t* keys, std::int64_t n, int lowest = 0) {
    begin_launch();
    if (n <= 1) return;
    Arena::Scope scope(arena());
    Array<std::uint64_t> other = arena().temporary<std::uint64_t>(n);
    cub::DoubleBuffer<std::uint64_t> buffer(keys, other.data());
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortKeys(scratch, bytes, buffer, n, lowest, 64, stream_);
    });
    copy(keys, buffer.Current(), n);
  }

  void sort_pairs(std::uint64_t* keys, std::uint32_t* values, std::int64_t n, int bits = 64) {
    begin_launch();
    if (n <= 1) return;
    Arena::Scope scope(arena());
    Array<std::uint64_t> other_keys = arena().temporary<std::uint64_t>(n);
    Array<std::uint32_t> other_values = arena().temporary<std::uint32_t>(n);
    cub::DoubleBuffer<std::uint64_t> key_buffer(keys, other_keys.data());
    cub::DoubleBuffer<std::uint32_t> value_buffer(values, other_values.data());
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortPairs(scratch, bytes, key_buffer, value_buffer, n, 0, bits, stream_);
    });
    copy(keys, key_buffer.Current(), n);
    copy(values, value_buffer.Current(), n);
  }

  template <class T, class Get, class Merge>
  T reduce(std::int64_t n, T identity, const Get& get, const Merge& merge) {
    Recording::forbid("a sum that the host asks for");
    Arena::Scope scope(arena());
    Array<T> result = arena().temporary<T>(1);
    reduce_into(result.data(), n, identity, get, merge);
    return result.download()[0];
  }

  template <class T, class Get, class Merge>
  void reduce_into(T* result, std::int64_t n, T identity, const Get& get, const Merge& merge) {
    begin_launch();
    auto values = thrust::make_transform_iterator(thrust::make_counting_iterator<std::int64_t>(0), get);
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceReduce::Reduce(scratch, bytes, values, result, n, merge, identity, stream_);
    });
  }

 private:
  /// While it lives, launches go to the stream that is captured.
  class Diversion {
   public:
    explicit Diversion(Executor& executor) : executor_(executor), stages_(executor.clock_.pending()) {
      executor_.stream_ = executor_.capture_stream_;
      executor_.capturing_ = true;
    }
    ~Diversion() {
      executor_.stream_ = executor_.device_stream_;
      executor_.capturing_ = false;
      if (!kept_) executor_.clock_.take_back(stages_);
    }
    Diversion(const Diversion&) = delete;
    Diversion& operator=(const Diversion&) = delete;

    /// Their launches are under way: stages inside will have their times.
    void keep_stages() const { kept_ = true; }

   private:
    Executor& executor_;
    std::size_t stages_;
    mutable bool kept_ = false;
  };

  void begin_launch() {
    ExecutorBase::begin_launch();
    use_device();
  }

  /// Not during a capture, which has begun on the device and asks for as little besides launches as can be.
  void use_device() const {
    if (!capturing_) cuda_.use();
  }

  /// CUDA loads a kernel when it is first launched, which waits for the device: not during a capture.
  template <class Function>
  static void load(Function* kernel) {
    static std::atomic<bool> loaded = false;  // one for each kernel: its type names it
    if (loaded) return;
    cudaStreamCaptureMode mode = cudaStreamCaptureModeRelaxed;
    cudaThreadExchangeStreamCaptureMode(&mode);
    cudaFuncAttributes attributes{};
    const cudaError_t status = cudaFuncGetAttributes(&attributes, kernel);
    cudaThreadExchangeStreamCaptureMode(&mode);
    cuda_check(status, "loading a kernel");
    loaded = true;
  }

  /// False where CUDA would not have it; nothing of `body` has run then.
  template <class Body>
  bool launched_as_graph(CudaGraph& graph, const Body& body) {
    cuda_.use();
    try {
      CudaCapture capture(capture_stream_);
      const Diversion diversion(*this);
      body();
      graph.launch(capture.end(), device_stream_);
      diversion.keep_stages();
      return true;
    } catch (const Error&) {  // a mistake of ours and the user's wish to stop are others
      if (strict_) throw;
      if (++failures_ >= most_failures) graphs_ = false;
      return false;
    }
  }

  long launches() { return ExecutorBase::timers().launches(); }
  cudaEvent_t mark() {
    use_device();
    return clock_.mark(stream_, capturing_);
  }

  template <class T>
  void copy(T* to, const T* from, std::int64_t n) {
    if (to != from) cuda_check(cudaMemcpyAsync(to, from, n * sizeof(T), cudaMemcpyDeviceToDevice, stream_), "copy");
  }

  /// CUB's two calls: how much scratch, then the work, with scratch from the arena's tail.
  template <class Call>
  void with_scratch(const Call& call) {
    std::size_t bytes = 0;
    cuda_check(call(nullptr, bytes), "scratch size");
    Arena::Scope scope(arena());
    Array<std::uint8_t> scratch = arena().temporary<std::uint8_t>(std::max<std::size_t>(bytes, 1));
    cuda_check(call(scratch.data(), bytes), "device primitive");
  }

  static constexpr int most_failures = 5;

  CudaDevice& cuda_;
  cudaStream_t stream_;         ///< where launches go
  cudaStream_t device_stream_;  ///< where they run
  cudaStream_t capture_stream_ = nullptr;
  bool graphs_ = true, strict_ = false, capturing_ = false;
  int failures_ = 0;  ///< graphs that could not be made
  CudaParts parts_;
  CudaStageClock clock_;
};

}  // namespace nacre
