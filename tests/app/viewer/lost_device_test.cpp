// Nacre: a worker notices that its computing device stopped working.
#include <gtest/gtest.h>

#include <string>

#include "app/viewer/scene/worker.hpp"

namespace nacre {
namespace {

/// Times that can be asked for until the device fails.
struct FailingPipeline {
  bool fails = false;
  StageTimers timers() const {
    if (fails) throw Error("CUDA: waiting for a stream failed", "an illegal memory access was encountered");
    StageTimers timers;
    timers.add("embed", 1);
    return timers;
  }
  std::size_t peak_bytes() const { return 7; }
};

class IdleWorker : public Worker<int> {
 public:
  using Worker<int>::take_timers;
  using Worker<int>::check_device;
};

TEST(LostDevice, TimersThatCannotBeTakenSayThatItIsLost) {
  IdleWorker worker;
  FailingPipeline pipeline;
  worker.take_timers(pipeline);
  EXPECT_EQ(worker.lost_device(), "");
  EXPECT_NO_THROW(worker.check_device());
  pipeline.fails = true;
  worker.take_timers(pipeline);  // neither throws nor keeps the mutex
  EXPECT_TRUE(worker.lost_device().find("illegal memory access") != std::string::npos) << worker.lost_device();
  EXPECT_THROW(worker.check_device(), Error);
  EXPECT_EQ(worker.timers().seconds("embed"), 1) << "what was known stays";
  EXPECT_EQ(worker.peak_bytes(), 7u);
}

}  // namespace
}  // namespace nacre
