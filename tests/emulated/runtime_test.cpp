// Nacre: the emulated device enforces what a real one does, and notices what a GPU would not say.
#include <gtest/gtest.h>

#include <numeric>
#include <thread>
#include <vector>

#include "compute/device/cuda_check.hpp"
#include "compute/device/cuda_launch.cuh"

namespace nacre {
namespace {

/// A stream and memory of the device.
class EmulatedDevice : public testing::Test {
 protected:
  void SetUp() override {
    cuda_check(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "stream");
    cuda_check(cudaMalloc(reinterpret_cast<void**>(&numbers_), count * sizeof(int)), "memory");
  }
  void TearDown() override {
    cuda_check(cudaFree(numbers_), "memory");
    cuda_check(cudaStreamDestroy(stream_), "stream");
  }

  template <class Kernel>
  void run_team(const Kernel& kernel, std::size_t scratch = Team::sum_bytes) {
    launch_teams(1, scratch, stream_, {0, 1}, kernel);
    cuda_check(cudaGetLastError(), "launch");
    cuda_check(cudaStreamSynchronize(stream_), "wait");
  }

  std::vector<int> downloaded() {
    std::vector<int> host(count);
    cuda_check(cudaMemcpyAsync(host.data(), numbers_, count * sizeof(int), cudaMemcpyDeviceToHost, stream_), "copy");
    cuda_check(cudaStreamSynchronize(stream_), "wait");
    return host;
  }

  void begin_capture() { cuda_check(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeThreadLocal), "capture"); }
  cudaError_t end_capture() {
    cudaGraph_t graph = nullptr;
    const cudaError_t status = cudaStreamEndCapture(stream_, &graph);
    cudaGraphDestroy(graph);
    cudaGetLastError();
    return status;
  }

  static constexpr int count = 1000;
  cudaStream_t stream_ = nullptr;
  int* numbers_ = nullptr;
};
using EmulatedDeviceDeathTest = EmulatedDevice;

struct PutIndex {
  int* to;
  void operator()(std::int64_t i) const { to[i] = int(i); }
};

TEST_F(EmulatedDevice, NothingRunsBeforeSomebodyWaits) {
  launch_elements(4, 256, stream_, {0, count}, PutIndex{numbers_});
  EXPECT_EQ(numbers_[7], int(0xcbcbcbcb)) << "new memory holds rubbish";
  std::vector<int> expected(count);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(downloaded(), expected);
}

/// All lanes write, meet, and read what the next one wrote.
struct Neighbours {
  bool meet;
  int* result;
  void operator()(Team& team, std::int64_t) const {
    int* shared = reinterpret_cast<int*>(team.scratch());
    shared[threadIdx.x] = int(threadIdx.x);
    if (meet) __syncthreads();
    result[threadIdx.x] = shared[(threadIdx.x + 1) % Team::lanes];
  }
};

TEST_F(EmulatedDevice, ABarrierThatIsMissingShows) {
  const std::size_t scratch = Team::sum_bytes + Team::lanes * sizeof(int);
  int wrong[2] = {};
  for (const bool meet : {false, true}) {
    run_team(Neighbours{meet, numbers_}, scratch);
    const std::vector<int> found = downloaded();
    for (int k = 0; k < Team::lanes; ++k) wrong[meet] += found[k] != (k + 1) % Team::lanes;
  }
  EXPECT_GT(wrong[false], 0);
  EXPECT_EQ(wrong[true], 0);
}

struct HalfWaits {
  void operator()(Team&, std::int64_t) const {
    if (threadIdx.x < 32) __syncthreads();
  }
};
struct WaitsElsewhere {
  void operator()(Team&, std::int64_t) const {
    if (threadIdx.x % 2)
      __syncthreads();
    else
      __syncthreads();
  }
};
struct WritesBehind {
  void operator()(Team& team, std::int64_t) const {
    if (threadIdx.x == 0) team.scratch()[3] = 0;
  }
};
struct WritesPast {
  int* to;
  void operator()(std::int64_t i) const { to[1000 + (1 << 10) * i] = 0; }
};

TEST_F(EmulatedDeviceDeathTest, LanesMustComeToTheSameBarrier) {
  EXPECT_DEATH(run_team(HalfWaits{}), "diverge|different barriers");
  EXPECT_DEATH(run_team(WaitsElsewhere{}), "different barriers");
}

TEST_F(EmulatedDeviceDeathTest, WritesBehindMemoryAreSeen) {
  EXPECT_DEATH(run_team(WritesBehind{}), "behind its shared memory");
  EXPECT_DEATH(
      {
        launch_elements(1, 256, stream_, {0, 256}, WritesPast{numbers_});
        cudaStreamSynchronize(stream_);
      },
      "");
  EXPECT_DEATH(cudaFree(numbers_ + 1), "not allocated");
}

TEST_F(EmulatedDeviceDeathTest, TheDefaultStreamIsNotOurs) {
  EXPECT_DEATH(cudaMemsetAsync(numbers_, 0, 4, nullptr), "default stream");
}

TEST_F(EmulatedDevice, MuchSharedMemoryMustBeAskedFor) {
  const std::size_t much = std::size_t(50) << 10;
  EXPECT_THROW(run_team(Neighbours{true, numbers_}, much), Error);
  const auto attribute = cudaFuncAttributeMaxDynamicSharedMemorySize;
  EXPECT_EQ(cudaFuncSetAttribute(for_each_team_kernel<Neighbours>, attribute, int(much)), cudaSuccess);
  EXPECT_NO_THROW(run_team(Neighbours{true, numbers_}, much));
  EXPECT_NE(cudaFuncSetAttribute(for_each_team_kernel<Neighbours>, attribute, 1 << 20), cudaSuccess);
  cudaGetLastError();
}

TEST_F(EmulatedDevice, ACaptureForbidsWhatCannotBeRepeated) {
  void* block = nullptr;
  int host = 0;
  const std::vector<std::function<cudaError_t()>> forbidden{
      [&] { return cudaMalloc(&block, 4); },
      [&] { return cudaFree(nullptr); },
      [&] { return cudaMemcpy(&host, numbers_, 4, cudaMemcpyDeviceToHost); },
      [&] { return cudaMemcpyAsync(&host, numbers_, 4, cudaMemcpyDeviceToHost, stream_); },
      [&] { return cudaMemsetAsync(numbers_, 0, 4, nullptr); },
      [&] { return cudaStreamSynchronize(stream_); },
      [&] { return cudaDeviceSynchronize(); }};
  for (std::size_t k = 0; k < forbidden.size(); ++k) {
    begin_capture();
    EXPECT_NE(forbidden[k](), cudaSuccess) << k;
    EXPECT_EQ(end_capture(), cudaErrorStreamCaptureInvalidated) << k;
  }
  begin_capture();
  std::thread([&] { EXPECT_EQ(cudaMalloc(&block, 4), cudaSuccess) << "another thread may"; }).join();
  EXPECT_EQ(end_capture(), cudaSuccess);
  EXPECT_EQ(cudaFree(block), cudaSuccess);
}

TEST_F(EmulatedDevice, AGraphRepeatsWhatWasCaptured) {
  begin_capture();
  launch_elements(4, 256, stream_, {0, count}, PutIndex{numbers_});
  cudaGraph_t graph = nullptr;
  cuda_check(cudaStreamEndCapture(stream_, &graph), "capture");
  EXPECT_EQ(downloaded()[9], int(0xcbcbcbcb)) << "what is captured does not run";
  cudaGraphExec_t executable = nullptr;
  cuda_check(cudaGraphInstantiate(&executable, graph, 0), "graph");
  cuda_check(cudaGraphLaunch(executable, stream_), "graph");
  EXPECT_EQ(downloaded()[9], 9);
  cudaGraphExecDestroy(executable);
  cudaGraphDestroy(graph);
}

}  // namespace
}  // namespace nacre
