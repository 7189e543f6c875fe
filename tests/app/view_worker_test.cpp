// Nacre: the thread that computes beside the frames: which stages run again after a knob was changed.
#if NACRE_HAS_VIEWER

#include <gtest/gtest.h>

#include "app/viewer/flow_worker.hpp"

namespace nacre {
namespace {

/// A small flow, and what its worker has told.
struct WorkerRun {
  std::atomic<bool> stop{false};
  Session session;
  std::unique_ptr<FlowWorker> worker;
  std::vector<float> memory;
  int surfaces = 0, embeddings = 0, starts = 0, steps = 0;
  std::string failure;

  explicit WorkerRun(bool loop = false) {
    session.sample = "sphere";
    session.detail = 24;
    session.settings.flow.resolution = 48;
    session.settings.flow.steps = 4;
    worker = std::make_unique<FlowWorker>(session, make_cpu_device(2), loop);
    settle();
  }

  /// Takes all events until the worker has nothing to do.
  void settle() {
    while (std::optional<FlowEvent> event = worker->wait(stop)) {
      surfaces += std::holds_alternative<SurfaceRead>(*event);
      starts += std::holds_alternative<FlowStarted>(*event);
      steps += std::holds_alternative<FlowStepped>(*event);
      if (const auto* embedded = std::get_if<FlowEmbedded>(&*event)) {
        ++embeddings;
        memory.assign(embedded->info.surface_cells, -1);
      }
      if (const auto* failed = std::get_if<FlowFailed>(&*event)) failure = failed->what;
    }
  }

  long calls(const std::string& name) const {
    const StageTimers timers = worker->timers();
    for (const StageTimers::Stage& stage : timers.stages())
      if (stage.name == name) return stage.calls;
    return 0;
  }

  FlowParameters changed(int resolution, int ttl, double contrast) const {
    FlowParameters p = session.settings.flow;
    p.resolution = resolution;
    p.ttl = ttl;
    p.contrast = contrast;
    return p;
  }
};

TEST(FlowWorker, StepsWriteWhatIsToBeShown) {
  WorkerRun run;
  EXPECT_EQ(run.failure, "");
  EXPECT_EQ(run.surfaces + run.embeddings + run.starts, 3);
  ASSERT_TRUE(run.worker->ready());
  run.worker->step(run.memory.data());
  run.settle();
  EXPECT_EQ(run.steps, 1);
  for (const float value : run.memory) ASSERT_TRUE(value >= 0 && value <= 1) << value;
}

TEST(FlowWorker, OnlyWhatDependsOnAKnobRunsAgain) {
  WorkerRun run;
  EXPECT_EQ(run.calls("embed"), 1);
  run.worker->set_parameters(run.changed(48, 4, 0.1));
  run.settle();
  EXPECT_EQ(run.starts, 1);
  run.worker->set_parameters(run.changed(48, 2, 0.1));
  run.settle();
  EXPECT_EQ(run.starts, 2);
  EXPECT_EQ(run.calls("embed"), 1);
  run.worker->set_parameters(run.changed(32, 2, 0.1));
  run.settle();
  EXPECT_EQ(run.calls("read"), 1);
  EXPECT_EQ(run.calls("embed"), 2);
  EXPECT_EQ(run.embeddings, 2);
  EXPECT_EQ(run.starts, 3);
  ASSERT_TRUE(run.worker->ready());
  run.worker->step(run.memory.data());
  run.settle();
  EXPECT_EQ(run.steps, 1);
}

TEST(FlowWorker, AChangeInterruptsWhatIsUnderWay) {
  WorkerRun run;
  for (int k = 0; k < 6; ++k) {
    run.worker->step(run.memory.data());
    run.worker->set_parameters(run.changed(k % 2 ? 48 : 64, 4, 0.2));  // while it steps, or just before
    run.settle();
    EXPECT_EQ(run.failure, "");
    ASSERT_TRUE(run.worker->ready()) << k;
  }
}

TEST(FlowWorker, AFailureIsToldAndOtherKnobsMendIt) {
  WorkerRun run;
  run.worker->set_parameters(run.changed(1 << 20, 4, 0.2));
  run.settle();
  EXPECT_NE(run.failure, "");
  EXPECT_FALSE(run.worker->ready());
  run.worker->set_parameters(run.changed(48, 4, 0.2));
  run.settle();
  EXPECT_TRUE(run.worker->ready());
}

TEST(FlowWorker, LoopsNeverStandStill) {
  WorkerRun once, loop(true);
  for (int k = 0; k < 10; ++k)
    for (WorkerRun* run : {&once, &loop}) {
      run->worker->step(run->memory.data());
      run->settle();
    }
  EXPECT_EQ(once.steps, 10);
  EXPECT_EQ(loop.steps, 10);
  EXPECT_NE(once.memory, loop.memory);  // one stands at the last time, the other has come round
}

TEST(FlowWorker, EndsAtOnce) {
  Session session;
  session.sample = "torus";
  FlowWorker worker(session, make_cpu_device(1), false);  // and is destroyed at once
}

}  // namespace
}  // namespace nacre

#endif
