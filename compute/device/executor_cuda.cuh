// Nacre: the launches on CUDA and CUB. Included by `*_cuda.cu` only.
#pragma once

#include <cuda_runtime.h>
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/transform_iterator.h>

#include <algorithm>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_reduce.cuh>
#include <cub/device/device_scan.cuh>

#include "compute/device/cuda_check.hpp"
#include "compute/device/executor.hpp"

namespace nacre {

template <class Kernel>
__global__ void for_each_kernel(std::int64_t n, const __grid_constant__ Kernel kernel) {
  const std::int64_t stride = std::int64_t(gridDim.x) * blockDim.x;
  for (std::int64_t i = std::int64_t(blockIdx.x) * blockDim.x + threadIdx.x; i < n; i += stride) kernel(i);
}

template <class Kernel>
__global__ void for_each_team_kernel(std::int64_t n, const __grid_constant__ Kernel kernel) {
  extern __shared__ __align__(16) unsigned char scratch[];
  Team team(scratch);
  for (std::int64_t i = blockIdx.x; i < n; i += gridDim.x) {
    kernel(team, i);
    __syncthreads();
  }
}

template <>
class Executor<Cuda> : public ExecutorBase {
 public:
  explicit Executor(Device& device) : ExecutorBase(device) {}

  /// Waits for the device at both ends, so that a stage's time is its own.
  class Stage {
   public:
    Stage(Executor& executor, std::string_view name) : executor_(executor), scope_(begin(executor), name) {}
    ~Stage() { cudaDeviceSynchronize(); }  // an error shows at the next checked call

   private:
    static StageTimers& begin(Executor& executor) {
      cuda_check(cudaDeviceSynchronize(), "wait");
      return executor.timers();
    }
    Executor& executor_;
    StageTimers::Scope scope_;
  };

  Stage stage(std::string_view name) { return {*this, name}; }

  template <class Kernel>
  void for_each(std::int64_t n, const Kernel& kernel) {
    begin_launch();
    if (n <= 0) return;
    static_assert(sizeof(Kernel) <= 4000, "kernel parameters go through 4 KB of constant memory");
    constexpr int threads = 256;
    const auto blocks = unsigned(std::min<std::int64_t>((n + threads - 1) / threads, 1 << 20));
    for_each_kernel<<<blocks, threads>>>(n, kernel);
    cuda_check(cudaGetLastError(), "kernel launch");
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
    const auto blocks = unsigned(std::min<std::int64_t>(n, 1 << 20));
    for_each_team_kernel<<<blocks, Team::lanes, scratch>>>(n, kernel);
    cuda_check(cudaGetLastError(), "kernel launch");
  }

  template <class T>
  T exclusive_scan(const T* in, T* out, std::int64_t n) {
    begin_launch();
    if (n <= 0) return T(0);
    T last_in{}, last_out{};
    device().copy_to_host(&last_in, in + n - 1, sizeof(T));  // before the scan: in == out is allowed
    with_scratch(
        [&](void* scratch, std::size_t& bytes) { return cub::DeviceScan::ExclusiveSum(scratch, bytes, in, out, n); });
    device().copy_to_host(&last_out, out + n - 1, sizeof(T));
    return last_out + last_in;
  }

  void sort(std::uint64_t* keys, std::int64_t n, int lowest = 0) {
    begin_launch();
    if (n <= 1) return;
    Arena::Scope scope(arena());
    Array<std::uint64_t> other = arena().temporary<std::uint64_t>(n);
    cub::DoubleBuffer<std::uint64_t> buffer(keys, other.data());
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortKeys(scratch, bytes, buffer, n, lowest);
    });
    if (buffer.Current() != keys)
      cuda_check(cudaMemcpyAsync(keys, buffer.Current(), n * sizeof(std::uint64_t), cudaMemcpyDeviceToDevice), "copy");
  }

  void sort_pairs(std::uint64_t* keys, std::uint32_t* values, std::int64_t n) {
    begin_launch();
    if (n <= 1) return;
    Arena::Scope scope(arena());
    Array<std::uint64_t> other_keys = arena().temporary<std::uint64_t>(n);
    Array<std::uint32_t> other_values = arena().temporary<std::uint32_t>(n);
    cub::DoubleBuffer<std::uint64_t> key_buffer(keys, other_keys.data());
    cub::DoubleBuffer<std::uint32_t> value_buffer(values, other_values.data());
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceRadixSort::SortPairs(scratch, bytes, key_buffer, value_buffer, n);
    });
    if (key_buffer.Current() != keys)
      cuda_check(cudaMemcpyAsync(keys, key_buffer.Current(), n * sizeof(std::uint64_t), cudaMemcpyDeviceToDevice),
                 "copy");
    if (value_buffer.Current() != values)
      cuda_check(cudaMemcpyAsync(values, value_buffer.Current(), n * sizeof(std::uint32_t), cudaMemcpyDeviceToDevice),
                 "copy");
  }

  template <class T, class Get, class Merge>
  T reduce(std::int64_t n, T identity, const Get& get, const Merge& merge) {
    begin_launch();
    Arena::Scope scope(arena());
    Array<T> result = arena().temporary<T>(1);
    auto values = thrust::make_transform_iterator(thrust::make_counting_iterator<std::int64_t>(0), get);
    with_scratch([&](void* scratch, std::size_t& bytes) {
      return cub::DeviceReduce::Reduce(scratch, bytes, values, result.data(), n, merge, identity);
    });
    return result.download()[0];
  }

 private:
  /// CUB's two calls: how much scratch, then the work, with scratch from the arena's tail.
  template <class Call>
  void with_scratch(const Call& call) {
    std::size_t bytes = 0;
    cuda_check(call(nullptr, bytes), "scratch size");
    Arena::Scope scope(arena());
    Array<std::uint8_t> scratch = arena().temporary<std::uint8_t>(std::max<std::size_t>(bytes, 1));
    cuda_check(call(scratch.data(), bytes), "device primitive");
  }
};

}  // namespace nacre
