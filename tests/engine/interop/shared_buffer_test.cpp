// Nacre: the array that compute writes and OpenGL draws.
#include "engine/interop/shared_buffer.hpp"

#include <numeric>
#include <vector>

#include "compute/device/executor_cpu.hpp"
#include "tests/engine/gl/offscreen.hpp"

namespace nacre {
namespace {

using Interop = test::Offscreen;
constexpr std::int64_t count = 1000;

struct FillRamp {
  float* to;
  float first;
  void operator()(std::int64_t i) const { to[i] = first + float(i); }
};

std::vector<float> ramp(float first) {
  std::vector<float> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

/// What a draw would read.
std::vector<float> seen(const SharedBuffer& buffer) {
  std::vector<float> values(buffer.bytes() / 4);
  glGetNamedBufferSubData(buffer.shown().id(), 0, GLsizeiptr(buffer.bytes()), values.data());
  return values;
}

void write(SharedBuffer& buffer, Executor<Cpu>& exec, float first) {
  void* memory = buffer.begin_write(true);
  ASSERT_NE(memory, nullptr);
  exec.for_each(count, FillRamp{static_cast<float*>(memory), first});
  buffer.end_write();
}

TEST_F(Interop, CpuWritesStraightIntoOpenGl) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  SharedBuffer buffer(*device, count * 4, GL_R32F);
  EXPECT_EQ(buffer.path(), SharedBuffer::Path::mapped);
  EXPECT_EQ(seen(buffer), std::vector<float>(count, 0.0f));
  for (int step = 0; step < 10; ++step) {
    write(buffer, exec, float(100 * step));
    EXPECT_EQ(seen(buffer), ramp(float(100 * step)));
    buffer.drawn();
  }
  EXPECT_EQ(buffer.copied_bytes(), 0u);
  EXPECT_TRUE(buffer.remark().empty());
}

TEST_F(Interop, WhatIsShownStaysWhileTheNextIsWritten) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  SharedBuffer buffer(*device, count * 4, GL_R32F);
  write(buffer, exec, 7);
  void* memory = buffer.begin_write(true);
  exec.for_each(count, FillRamp{static_cast<float*>(memory), 9});
  EXPECT_TRUE(buffer.writing());
  EXPECT_EQ(seen(buffer), ramp(7));
  buffer.end_write();
  EXPECT_EQ(seen(buffer), ramp(9));
  buffer.end_write();  // nothing begun: nothing happens
  EXPECT_EQ(seen(buffer), ramp(9));
}

TEST_F(Interop, AnInterruptedWriteIsNotShown) {
  const auto device = make_cpu_device(2);
  Executor<Cpu> exec(*device);
  SharedBuffer buffer(*device, count * 4, GL_R32F);
  write(buffer, exec, 3);
  exec.for_each(count / 2, FillRamp{static_cast<float*>(buffer.begin_write(true)), 5});
  buffer.cancel_write();
  EXPECT_FALSE(buffer.writing());
  EXPECT_EQ(seen(buffer), ramp(3));
  write(buffer, exec, 6);
  EXPECT_EQ(seen(buffer), ramp(6));
}

TEST_F(Interop, MemoryThatADrawReadsIsFreeOnceItIsDone) {
  const auto device = make_cpu_device(1);
  Executor<Cpu> exec(*device);
  SharedBuffer buffer(*device, count * 4, GL_R32F);
  buffer.drawn();
  write(buffer, exec, 1);  // now the half that was drawn is the one to write
  buffer.drawn();
  glFinish();
  EXPECT_NE(buffer.begin_write(), nullptr);  // without waiting
}

TEST_F(Interop, AnotherDevicesMemoryIsCopiedAndCounted) {
  const auto device = make_cpu_device(2, true);  // its memory may not be touched by OpenGL
  Executor<Cpu> exec(*device);
  SharedBuffer buffer(*device, count * 4, GL_R32F, SharedBuffer::Path::copied);
  for (int step = 1; step <= 3; ++step) {
    write(buffer, exec, float(step));
    EXPECT_EQ(seen(buffer), ramp(float(step)));
    EXPECT_EQ(buffer.copied_bytes(), std::uint64_t(step) * count * 4);
  }
  EXPECT_FALSE(buffer.remark().empty());
}

TEST_F(Interop, AnEmptyArrayIsNoTrouble) {
  const auto device = make_cpu_device(1);
  SharedBuffer buffer(*device, 0, GL_R32F);
  EXPECT_EQ(buffer.begin_write(), nullptr);
  buffer.end_write();
  buffer.texture().bind(0);
}

TEST_F(Interop, APathThatTheDeviceCannotGoIsAnError) {
  if (cuda_device_count() > 0) GTEST_SKIP() << "CUDA can";
  const auto device = make_cpu_device(1);
  EXPECT_THROW(SharedBuffer(*device, 64, GL_R32F, SharedBuffer::Path::registered), Error);
}

}  // namespace
}  // namespace nacre
