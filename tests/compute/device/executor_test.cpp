// Nacre: the launches on the CPU: any number of threads, stopping, and memory that pretends to be remote.
#include <chrono>
#include <csignal>
#include <string>
#include <thread>

#include "compute/device/executor_cpu.hpp"
#include "tests/compute/device/executor_body.hpp"

namespace nacre::test {
namespace {

TEST(Executor, OneThreadAndManyGiveTheSame) {
  const std::int64_t n = 300000;
  std::vector<std::uint64_t> scans[2], sorted[2];
  std::uint64_t sums[2];
  for (const int many : {0, 1}) {
    const auto device = make_cpu_device(many ? 4 : 1);
    EXPECT_EQ(device->threads(), many ? 4 : 1);
    Executor<Cpu> exec(*device);
    Array<std::uint64_t> values = exec.arena().permanent<std::uint64_t>(n);
    values.fill_bytes(0);
    exec.for_each(n, CountVisit{values.data()});
    sums[many] = exec.reduce(n, std::uint64_t(0), Element{values.data()}, Add{});
    exec.exclusive_scan(values.data(), values.data(), n);
    scans[many] = values.download();
    std::vector<std::uint64_t> keys(scans[many].rbegin(), scans[many].rend());
    values.upload(keys);
    exec.sort(values.data(), n);
    sorted[many] = values.download();
  }
  EXPECT_EQ(sums[0], std::uint64_t(n) * (n + 1) / 2);
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(scans[0], scans[1]);
  EXPECT_EQ(sorted[0], sorted[1]);
  EXPECT_EQ(sorted[0], scans[0]);
}

struct Slow {
  const std::atomic<bool>* started;
  void operator()(std::int64_t) const {
    const_cast<std::atomic<bool>*>(started)->store(true);
    const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(5);
    while (std::chrono::steady_clock::now() < end) {
    }
  }
};

TEST(Executor, ALongLaunchStopsWhenAsked) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  std::atomic<bool> stop = false, started = false;
  exec.watch(&stop);
  std::chrono::steady_clock::time_point asked;
  std::thread user([&] {
    while (!started) std::this_thread::yield();
    asked = std::chrono::steady_clock::now();
    stop = true;
  });
  EXPECT_THROW(exec.for_each(1'000'000'000, Slow{&started}), Interrupted);  // an hour's work
  user.join();
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - asked).count(), 3.0);
}

TEST(Executor, AShareToldOutOfOrderNeverFalls) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  exec.raise_share(0.5);  // nobody wants to know
  std::atomic<float> share = 0;
  exec.watch(nullptr, &share);
  exec.raise_share(0.5), exec.raise_share(0.25);
  EXPECT_EQ(share, 0.5f);
  exec.raise_share(0.75);
  EXPECT_EQ(share, 0.75f);
  exec.tell_share(0.125);  // the next call begins
  EXPECT_EQ(share, 0.125f);
}

/// What a program that forgets a copy does.
std::uint64_t read_on_the_host(bool remote) {
  const auto device = make_cpu_device(1, remote);
  Executor<Cpu> exec(*device);
  Array<std::uint64_t> values = exec.arena().permanent<std::uint64_t>(10);
  values.fill_bytes(0);
  exec.for_each(10, CountVisit{values.data()});
  return *static_cast<volatile std::uint64_t*>(values.data() + 9);
}

TEST(RemoteCpuDeathTest, AMissingCopyIsFatal) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EQ(read_on_the_host(false), 10u);
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  EXPECT_DEATH(read_on_the_host(true), "SEGV");
#else
  EXPECT_EXIT(read_on_the_host(true), testing::KilledBySignal(SIGSEGV), "");
#endif
}

TEST(RemoteCpuDeathTest, WritingAndUploadingBehindItsBackAreFatalToo) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(
      {
        const auto device = make_cpu_device(1, true);
        Arena arena(*device, 4096);
        *arena.permanent<volatile int>(1).data() = 1;
      },
      "");
}

TEST(Device, RequestsAreAnswered) {
  EXPECT_EQ(make_device("cpu", 3)->threads(), 3);
  EXPECT_EQ(make_device("cpu")->backend(), "cpu");
  EXPECT_FALSE(make_device("cpu")->name().empty());
  EXPECT_EQ(make_device("auto")->backend(), cuda_device_count() > 0 ? "cuda" : "cpu");
  EXPECT_THROW(make_device("abacus"), Error);
  if (cuda_device_count() == 0) {
    EXPECT_THROW(make_device("cuda"), Error);
  }
}

TEST(Device, MemoryIsAlignedAndCounted) {
  const auto device = make_cpu_device();
  void* block = device->allocate(1000);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 256, 0u);
  device->deallocate(block, 1000);
  EXPECT_GT(device->available_bytes(), 0u);
  EXPECT_LE(device->arena_bytes(), device->available_bytes());
  EXPECT_GT(device->peak_bytes(), 0u);
  EXPECT_THROW(device->allocate(std::size_t(1) << 60), Error);
}

TEST(Device, CudaBodiesRunWhereThereIsOne) {
  if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device";
  EXPECT_EQ(make_cuda_device()->backend(), "cuda");
}

TEST(Error, IsOneLine) {
  EXPECT_STREQ(Error("a.vtp: cannot be read", "it ends early", "copy it again").what(),
               "a.vtp: cannot be read (it ends early); copy it again");
  EXPECT_STREQ(Error("two\nlines").what(), "two lines");
  EXPECT_EQ(Error("what", "why", "advice").advice(), "advice");
}

}  // namespace
}  // namespace nacre::test
