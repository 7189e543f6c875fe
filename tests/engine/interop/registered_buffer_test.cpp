// Nacre: buffers of OpenGL that CUDA writes into, on a machine whose GPU does both.
#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>
#include <vector>

#include "compute/device/device.hpp"
#include "compute/device/error.hpp"
#include "engine/gl/context.hpp"
#include "engine/interop/shared_buffer.hpp"

namespace nacre {
namespace {

constexpr std::size_t ramp_count = 1 << 20;
using Path = SharedBuffer::Path;

/// Has a CUDA device and a context on the GPU that it is; the test is skipped, aloud, where there is none.
class InteropOnCuda : public testing::Test {
 protected:
  void SetUp() override {
    if (cuda_device_count() == 0) GTEST_SKIP() << "no CUDA device on this machine";
    device_ = make_cuda_device(std::size_t(64) << 20);
    try {
      context_ = make_offscreen_context(true);
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
    std::printf("drawn by %s\n", context_->renderer().c_str());
  }

  void TearDown() override {
    if (!context_) return;
    for (const std::string& message : context_->messages()) ADD_FAILURE() << "the driver says: " << message;
  }

  void write(SharedBuffer& buffer, float first) {
    void* memory = buffer.begin_write(true);
    ASSERT_NE(memory, nullptr);
    device_->copy_to_device(memory, ramp(first).data(), ramp_count * sizeof(float));
    buffer.end_write();
  }

  static std::vector<float> ramp(float first) {
    std::vector<float> values(ramp_count);
    std::iota(values.begin(), values.end(), first);
    return values;
  }

  /// What a draw would read.
  static std::vector<float> seen(const SharedBuffer& buffer) {
    std::vector<float> values(ramp_count);
    glGetNamedBufferSubData(buffer.shown().id(), 0, GLsizeiptr(ramp_count * sizeof(float)), values.data());
    return values;
  }

  std::unique_ptr<Device> device_;
  std::unique_ptr<Context> context_;  ///< goes first
};

TEST_F(InteropOnCuda, WritesStraightIntoOpenGl) {
  if (!cuda_draws_here(*device_)) GTEST_SKIP() << context_->renderer() << " draws, CUDA computes elsewhere";
  SharedBuffer buffer(*device_, ramp_count * sizeof(float), GL_R32F);
  ASSERT_EQ(buffer.path(), Path::registered);
  EXPECT_EQ(seen(buffer), std::vector<float>(ramp_count, 0.0f));
  for (int step = 0; step < 10; ++step) {
    write(buffer, float(100 * step));
    EXPECT_EQ(seen(buffer), ramp(float(100 * step))) << step;
    buffer.drawn();
  }
  EXPECT_EQ(buffer.copied_bytes(), 0u);
  EXPECT_TRUE(buffer.remark().empty());
}

TEST_F(InteropOnCuda, AnInterruptedWriteIsNotShown) {
  if (!cuda_draws_here(*device_)) GTEST_SKIP() << context_->renderer() << " draws, CUDA computes elsewhere";
  SharedBuffer buffer(*device_, ramp_count * sizeof(float), GL_R32F, Path::registered);
  write(buffer, 3);
  device_->fill(buffer.begin_write(true), 0x55, ramp_count * sizeof(float));
  buffer.cancel_write();
  EXPECT_EQ(seen(buffer), ramp(3));
  write(buffer, 6);
  EXPECT_EQ(seen(buffer), ramp(6));
}

TEST_F(InteropOnCuda, ABufferMayDieWhileItIsWritten) {
  if (!cuda_draws_here(*device_)) GTEST_SKIP() << context_->renderer() << " draws, CUDA computes elsewhere";
  {
    SharedBuffer buffer(*device_, ramp_count * sizeof(float), GL_R32F, Path::registered);
    device_->fill(buffer.begin_write(true), 0x55, ramp_count * sizeof(float));
  }
  device_->synchronize();
  SharedBuffer next(*device_, ramp_count * sizeof(float), GL_R32F, Path::registered);
  write(next, 1);
  EXPECT_EQ(seen(next), ramp(1));
}

TEST_F(InteropOnCuda, CopiesWhereAnotherDeviceDraws) {
  SharedBuffer buffer(*device_, ramp_count * sizeof(float), GL_R32F, Path::copied);
  for (int step = 1; step <= 3; ++step) {
    write(buffer, float(step));
    EXPECT_EQ(seen(buffer), ramp(float(step)));
    EXPECT_EQ(buffer.copied_bytes(), std::uint64_t(step) * ramp_count * sizeof(float));
  }
  EXPECT_FALSE(buffer.remark().empty());
}

}  // namespace
}  // namespace nacre
