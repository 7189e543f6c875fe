// Nacre: what the executor does where a graph cannot be made.
#include <gtest/gtest.h>

#include "compute/device/executor_cuda.cuh"

namespace nacre {
namespace {

struct AddOne {
  std::uint32_t* to;
  NACRE_HD void operator()(std::int64_t i) const { ++to[i]; }
};

/// Another kernel, which the first call does not launch.
struct AddTen {
  std::uint32_t* to;
  NACRE_HD void operator()(std::int64_t i) const { to[i] += 10; }
};

long graphs_made(const Steps& steps) { return static_cast<const CudaGraph&>(*steps.record).made(); }

class GraphsOfTheExecutor : public testing::Test {
 protected:
  void SetUp() override { numbers_.fill_bytes(0); }
  void TearDown() override { emulated::break_captures(0); }

  void expect_all(std::uint32_t value) { EXPECT_EQ(numbers_.download(), std::vector<std::uint32_t>(100, value)); }

  std::unique_ptr<Device> device_ = make_cuda_device(std::size_t(1) << 20);
  Executor<Cuda> exec_{*device_};
  Array<std::uint32_t> numbers_ = exec_.arena().permanent<std::uint32_t>(100);
  Steps steps_;
};

TEST_F(GraphsOfTheExecutor, ACaptureThatFailsIsLaunchedOneByOne) {
  emulated::break_captures(2);
  for (std::uint32_t call = 1; call <= 6; ++call) {
    exec_.repeat(steps_, [&] {
      auto stage = exec_.stage("add");
      exec_.for_each(100, AddOne{numbers_.data()});
    });
    expect_all(call);
  }
  EXPECT_EQ(graphs_made(steps_), 1) << "from the fourth call on";
  for (const StageTimers::Stage& stage : exec_.timers().stages()) EXPECT_EQ(stage.calls, 6) << stage.name;
}

TEST_F(GraphsOfTheExecutor, AfterManyFailuresNoneIsTried) {
  emulated::break_captures(1000);
  for (std::uint32_t call = 1; call <= 10; ++call) {
    exec_.repeat(steps_, [&] { exec_.for_each(100, AddOne{numbers_.data()}); });
    expect_all(call);
  }
  emulated::break_captures(0);
  exec_.repeat(steps_, [&] { exec_.for_each(100, AddOne{numbers_.data()}); });
  expect_all(11);
  EXPECT_EQ(graphs_made(steps_), 0);
}

TEST_F(GraphsOfTheExecutor, AKernelThatIsNewInACaptureIsLoadedBeside) {
  for (int call = 0; call < 2; ++call)
    exec_.repeat(steps_, [&] {
      exec_.for_each(100, AddOne{numbers_.data()});
      if (call == 1) exec_.for_each(100, AddTen{numbers_.data()});
    });
  expect_all(12);
  EXPECT_EQ(graphs_made(steps_), 1);
}

TEST_F(GraphsOfTheExecutor, AnArenaMayGrowInsideACapture) {
  const auto device = make_cuda_device(std::size_t(8) << 20);
  Executor<Cuda> exec(*device);
  std::vector<std::uint32_t> found;
  for (const std::size_t count : {std::size_t(10), std::size_t(1) << 20}) {
    const Array<std::uint32_t> result = exec.arena().permanent<std::uint32_t>(100);
    exec.repeat(steps_, [&] {
      Arena::Scope scope(exec.arena());
      const Array<std::uint32_t> more = exec.arena().temporary<std::uint32_t>(count);
      exec.fill(more, 0);
      exec.for_each(10, AddOne{more.data()});
      exec.fill(result, 0);
      exec.for_each(100, AddTen{result.data()});
    });
    EXPECT_EQ(result.download(), std::vector<std::uint32_t>(100, 10)) << count;
  }
  EXPECT_EQ(graphs_made(steps_), 1);
}

}  // namespace
}  // namespace nacre
