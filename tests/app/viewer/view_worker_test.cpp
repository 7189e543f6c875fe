// Nacre: the thread that computes beside the frames: which stages run again after a knob was changed.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "app/viewer/flow/flow_worker.hpp"
#include "compute/device/error.hpp"
#include "engine/io/reader.hpp"
#include "engine/scene/samples/samples.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

/// A small flow, and what its worker has told.
struct WorkerRun {
  std::atomic<bool> stop{false};
  Session session;
  std::unique_ptr<FlowWorker> worker;
  std::vector<float> memory;  ///< shown values, then means, as FlowLookup says
  std::size_t values = 0;
  int surfaces = 0, data = 0, arrows = 0, embeddings = 0, starts = 0, steps = 0, interruptions = 0;
  std::string failure;
  std::optional<std::string> written;  ///< how that went
  FlowData told;
  FlowStepped last;
  std::size_t positions = 0;
  std::shared_ptr<const FlowLines> lines;
  std::shared_ptr<const std::vector<DyeMix>> dyes;

  explicit WorkerRun(
      bool loop = false, const std::function<void(Settings&)>& preset = [](Settings&) {}) {
    session.sample = "sphere";
    session.detail = 24;
    session.settings.flow.resolution = 48;
    session.settings.flow.steps = 4;
    preset(session.settings);
    worker = std::make_unique<FlowWorker>(session, make_cpu_device(2), loop);
    settle();
  }

  /// Takes all events until the worker has nothing to do.
  void settle() {
    while (std::optional<FlowEvent> event = worker->wait(stop)) take(*event);
  }

  void take(FlowEvent& event) {
    surfaces += std::holds_alternative<SurfaceRead>(event);
    starts += std::holds_alternative<FlowStarted>(event);
    interruptions += std::holds_alternative<FlowInterrupted>(event);
    if (auto* read = std::get_if<FlowData>(&event)) ++data, told = *read;
    if (auto* placed = std::get_if<FlowArrows>(&event)) ++arrows, positions = placed->positions.size();
    if (auto* found = std::get_if<FlowLinesFound>(&event)) lines = found->lines;
    if (auto* dyed = std::get_if<FlowDyed>(&event)) dyes = dyed->mixes;
    if (auto* stepped = std::get_if<FlowStepped>(&event)) ++steps, last = *stepped;
    if (const auto* embedded = std::get_if<FlowEmbedded>(&event)) {
      ++embeddings;
      values = embedded->lookup.values;
      memory.assign(embedded->lookup.values + embedded->lookup.means, -1);
    }
    if (const auto* failed = std::get_if<FlowFailed>(&event)) failure = failed->what;
    if (const auto* done = std::get_if<FlowWritten>(&event)) written = done->failure;
  }

  void change(const std::function<void(Settings&)>& how) {
    how(session.settings);
    failure.clear();
    worker->set_settings(session.settings);
    settle();
  }

  void step() {
    ASSERT_TRUE(worker->ready());
    worker->step(memory.data());
    settle();
  }

  long calls(const std::string& name) const {
    const StageTimers timers = worker->timers();
    for (const StageTimers::Stage& stage : timers.stages())
      if (stage.name == name) return stage.calls;
    return 0;
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
  for (std::size_t i = 0; i < run.memory.size(); ++i)
    ASSERT_TRUE((run.memory[i] >= 0 && run.memory[i] <= 1) || (i >= run.values && run.memory[i] == -1)) << i;
}

TEST(FlowWorker, MayEndWhileItAnswers) {
  const Vec3d position = make_sample("sphere", 24).load(0).points[5];
  for (int k = 0; k < 40; ++k) {
    WorkerRun run;
    run.step();
    run.worker->sample(position);
    std::this_thread::sleep_for(std::chrono::microseconds(5 * k / 2));
    run.worker->finish();  // an interruption that left the thread would end the program
  }
}

TEST(FlowWorker, OnlyWhatDependsOnAKnobRunsAgain) {
  WorkerRun run;
  EXPECT_EQ(run.calls("embed"), 1);
  run.change([](Settings& s) { s.flow.contrast = 0.1; });
  EXPECT_EQ(run.starts, 1);
  run.change([](Settings& s) { s.flow.ttl = 2; });
  EXPECT_EQ(run.starts, 2);
  EXPECT_EQ(run.calls("embed"), 1);
  run.change([](Settings& s) { s.flow.resolution = 32; });
  EXPECT_EQ(run.calls("read"), 1);
  EXPECT_EQ(run.calls("embed"), 2);
  EXPECT_EQ(run.embeddings, 2);
  EXPECT_EQ(run.starts, 3);
  run.step();
  EXPECT_EQ(run.steps, 1);
}

TEST(FlowWorker, ColoursChangeWhileTheTextureGoesOn) {
  WorkerRun run;
  run.step();
  run.change([](Settings& s) { s.color = "velocity"; });
  EXPECT_EQ(run.starts, 1);
  EXPECT_EQ(run.data, 3);  // of the first step, of all, with other colours
  EXPECT_EQ(run.told.color, "velocity");
  EXPECT_FALSE(run.told.scalar.empty());
  EXPECT_GT(run.told.colours.high, run.told.colours.low);
  run.change([](Settings& s) { s.color = "none"; });
  EXPECT_TRUE(run.told.scalar.empty());
  run.step();
  EXPECT_EQ(run.last.number, 2);
  EXPECT_EQ(run.calls("embed"), 1);
}

TEST(FlowWorker, VectorsAreChosenAgainOnTheSameEmbedding) {
  WorkerRun run;
  run.change([](Settings& s) { s.vectors = "@rotation"; });
  EXPECT_EQ(run.told.array, "@rotation");
  EXPECT_EQ(run.surfaces, 1);
  EXPECT_EQ(run.calls("embed"), 1);
  EXPECT_EQ(run.starts, 2);
  const WorkerRun fresh(false, [](Settings& s) { s.vectors = "@rotation"; });
  EXPECT_EQ(run.told.statistics.percentile_98, fresh.told.statistics.percentile_98);
  EXPECT_EQ(run.told.scalar, fresh.told.scalar);
}

TEST(FlowWorker, CreasesMakeTheSurfaceAnew) {
  WorkerRun run;
  run.change([](Settings& s) { s.crease_angle = 1; });
  EXPECT_EQ(run.surfaces, 2);
  EXPECT_EQ(run.calls("embed"), 2);
  EXPECT_EQ(run.starts, 2);
  run.step();
  WorkerRun fresh(false, [](Settings& s) { s.crease_angle = 1; });
  fresh.step();
  EXPECT_EQ(run.memory, fresh.memory);
}

TEST(FlowWorker, AChoiceThatFailsLeavesWhatThereWas) {
  WorkerRun run;
  run.step();
  run.change([](Settings& s) { s.color = "nosuch"; });
  EXPECT_NE(run.failure.find("nosuch"), std::string::npos) << run.failure;
  run.step();
  EXPECT_EQ(run.last.number, 2);
  EXPECT_FALSE(run.last.moment.scalar.empty());
  run.change([](Settings& s) { s.vectors = "nosuch"; });
  EXPECT_NE(run.failure.find("nosuch"), std::string::npos) << run.failure;
  run.step();
  EXPECT_EQ(run.last.number, 1);  // from the noise, with the vectors there were
  run.change([](Settings& s) { s.vectors = "", s.color = "speed"; });
  EXPECT_EQ(run.failure, "");
  EXPECT_EQ(run.told.array + run.told.color, "velocityspeed");
}

TEST(FlowWorker, ArrowsArePlacedWhereTheyAreOn) {
  WorkerRun run;
  EXPECT_EQ(run.arrows, 0);
  run.change([](Settings& s) { s.view.arrows = true, s.view.arrow_count = 50; });
  EXPECT_EQ(run.positions, 50u);
  run.change([](Settings& s) { s.view.arrows = false; });
  EXPECT_EQ(run.positions, 0u);
  EXPECT_EQ(run.starts, 1);
}

TEST(FlowWorker, LinesAreFoundWhereTheyAreOnAndComeWithEachStep) {
  WorkerRun run;
  run.step();
  EXPECT_EQ(run.last.moment.lines, nullptr);
  run.change([](Settings& s) { s.topology = true; });
  ASSERT_NE(run.lines, nullptr);
  EXPECT_GT(run.lines->skeleton.topology.points.size(), 1u);
  EXPECT_TRUE(run.lines->streamlines.lines.empty());
  EXPECT_EQ(run.starts, 1);
  const auto found = run.lines;
  run.change([](Settings& s) { s.streamlines = true; });
  EXPECT_NE(run.lines, found);
  EXPECT_GT(run.lines->streamlines.lines.size(), 10u);
  run.step();
  ASSERT_NE(run.last.moment.lines, nullptr);
  EXPECT_EQ(run.last.moment.lines->skeleton.time, run.last.moment.time);
  run.change([](Settings& s) { s.topology = s.streamlines = false; });
  EXPECT_EQ(run.lines, nullptr);
  run.step();
  EXPECT_EQ(run.last.moment.lines, nullptr);
}

double whole(const std::shared_ptr<const std::vector<DyeMix>>& mixes, std::size_t dye) {
  double sum = 0;
  if (mixes)
    for (const DyeMix& mix : *mixes) sum += double(mix[dye]);
  return sum;
}

TEST(FlowWorker, DyesStayWhileOthersAreReleasedAndGoWhenTheyAreRemoved) {
  WorkerRun run;
  run.step();
  EXPECT_EQ(run.last.moment.dyes, nullptr);
  run.change([](Settings& s) { s.dye = "1,0,0,0.4"; });
  EXPECT_EQ(run.failure, "");
  ASSERT_NE(run.dyes, nullptr) << "it is seen at once";
  const double first = whole(run.dyes, 0);
  EXPECT_GT(first, 1);
  EXPECT_EQ(run.starts, 1) << "the texture goes on";
  run.step();
  const auto carried = run.last.moment.dyes;
  ASSERT_NE(carried, nullptr);
  EXPECT_NE(*carried, *run.dyes) << "a step carries it";
  run.change([](Settings& s) { s.dye += ";-1,0,0,0.4|0,0,1,0.4"; });
  EXPECT_GT(whole(run.dyes, 0), whole(carried, 0) + 0.5 * first);
  EXPECT_GT(whole(run.dyes, 1), 1);
  for (std::size_t p = 0; p < carried->size(); ++p)
    ASSERT_GE((*run.dyes)[p][0], (*carried)[p][0]) << "what is there stays";
  run.change([](Settings& s) { s.dye = "9,9,9,0.1"; });
  EXPECT_NE(run.failure.find("dye: no point of the surface"), std::string::npos) << run.failure;
  run.change([](Settings& s) { s.dye.clear(); });
  EXPECT_EQ(run.dyes, nullptr);
  run.step();
  EXPECT_EQ(run.last.moment.dyes, nullptr);
}

TEST(FlowWorker, DyesBeginAgainWithTheFlowAndGoOnWhereItComesRound) {
  WorkerRun run(true, [](Settings& s) { s.dye = "1,0,0,0.4"; });
  const auto begun = run.dyes;
  ASSERT_NE(begun, nullptr);
  const double mass = whole(begun, 0);
  for (int k = 0; k < 6; ++k) run.step();  // of four in a round
  EXPECT_EQ(run.failure, "");
  EXPECT_GT(whole(run.last.moment.dyes, 0), 0.2 * mass);
  run.change([](Settings& s) { s.flow.ttl = 3; });
  EXPECT_EQ(run.starts, 2);
  EXPECT_EQ(*run.dyes, *begun);
}

TEST(FlowWorker, ExponentsAreColoursAndFollowTheirTime) {
  WorkerRun run(false, [](Settings& s) { s.color = "FTLE"; });
  EXPECT_EQ(run.failure, "");
  EXPECT_EQ(run.told.color, "FTLE");
  const std::vector<float> all = run.told.scalar;
  ASSERT_FALSE(all.empty());
  EXPECT_GT(*std::max_element(all.begin(), all.end()), *std::min_element(all.begin(), all.end()));
  run.change([&](Settings& s) { s.ftle_time = 1e9; });
  EXPECT_NE(run.failure.find("ftle_time"), std::string::npos);
  run.step();
  EXPECT_EQ(run.last.moment.scalar, all) << "what does not work leaves the colours as they were";
  run.change([&](Settings& s) { s.ftle_time = -0.5 * (run.told.time.high - run.told.time.low); });
  EXPECT_EQ(run.failure, "");
  EXPECT_NE(run.told.scalar, all);
  EXPECT_EQ(run.starts, 1);
  run.step();
  EXPECT_EQ(run.last.moment.scalar, run.told.scalar);
}

TEST(FlowWorker, AChangeInterruptsWhatIsUnderWay) {
  WorkerRun run;
  for (int k = 0; k < 6; ++k) {
    run.worker->step(run.memory.data());
    // While it steps, or just before: the step is dropped, and that is told, or it is done.
    const int before = run.steps + run.interruptions;
    run.change([&](Settings& s) { s.flow.resolution = k % 2 ? 48 : 64; });
    EXPECT_EQ(run.failure, "");
    EXPECT_EQ(run.steps + run.interruptions, before + 1);
    ASSERT_TRUE(run.worker->ready()) << k;
  }
}

TEST(FlowWorker, AFailureIsToldAndOtherKnobsEndIt) {
  WorkerRun run;
  run.change([](Settings& s) { s.flow.resolution = 1 << 20; });
  EXPECT_NE(run.failure, "");
  EXPECT_FALSE(run.worker->ready());
  EXPECT_FALSE(run.worker->busy());
  run.change([](Settings& s) { s.flow.resolution = 48; });
  EXPECT_TRUE(run.worker->ready());
}

TEST(FlowWorker, CancelEndsALongStageAndResumeBeginsItAgain) {
  WorkerRun run;
  run.step();
  const std::vector<float> shown = run.memory;
  run.session.settings.flow.resolution = 768;
  run.worker->set_settings(run.session.settings);
  while (run.worker->stage() != "embedding") std::this_thread::sleep_for(std::chrono::milliseconds(1));
  run.worker->cancel();
  const auto begin = std::chrono::steady_clock::now();
  run.settle();
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 2);
  EXPECT_TRUE(run.worker->cancelled());
  EXPECT_FALSE(run.worker->ready());
  EXPECT_EQ(run.failure, "");
  EXPECT_EQ(run.embeddings, 1);
  EXPECT_EQ(run.memory, shown);
  run.change([](Settings& s) { s.view.edges = true; });  // concerns nothing that was cancelled
  EXPECT_TRUE(run.worker->cancelled());
  run.change([](Settings& s) { s.flow.resolution = 64; });
  EXPECT_FALSE(run.worker->cancelled());
  run.step();
  EXPECT_EQ(run.embeddings, 2);
}

TEST(FlowWorker, ResumeGoesOnWithoutOtherKnobs) {
  WorkerRun run;
  run.worker->cancel();  // nothing goes on: nothing is lost
  run.settle();
  EXPECT_FALSE(run.worker->ready());
  run.worker->resume();
  run.step();
  EXPECT_EQ(run.last.number, 1);
  EXPECT_EQ(run.starts, 1);
}

TEST(FlowWorker, AJumpIsAFlowThatBeginsThere) {
  WorkerRun run(true);
  const Range data = run.told.time;
  run.change([](Settings& s) { s.begin_at = 0.5; });
  EXPECT_EQ(run.calls("embed"), 1);
  for (const double share : {0.75, 0.0, 0.25}) {  // of four steps, and round
    run.step();
    EXPECT_NEAR(run.last.moment.time, data.low + share * (data.high - data.low), 1e-12);
  }
  run.change([](Settings& s) { s.begin_at = 0, s.time = "0.2:0.6"; });
  for (const double time : {0.3, 0.4, 0.5, 0.2}) {
    run.step();
    EXPECT_NEAR(run.last.moment.time, time, 1e-12);
  }
  WorkerRun once(false, [](Settings& s) { s.begin_at = 0.5; });
  for (int k = 0; k < 3; ++k) once.step();
  EXPECT_DOUBLE_EQ(once.last.moment.time, data.high);
}

TEST(FlowWorker, WritesWhatIsShown) {
  const test::TemporaryFolder folder;
  WorkerRun run;
  run.step();
  run.worker->write(folder / "values.vtp", "");
  run.settle();
  EXPECT_EQ(run.written, "");
  const FileInfo written = describe(folder / "values.vtp");
  EXPECT_EQ(written.points, run.values);
  EXPECT_TRUE(
      std::any_of(written.arrays.begin(), written.arrays.end(), [&](const ArrayInfo& a) { return a.name == "value"; }));
  run.worker->write(folder / "no" / "such" / "folder.vtp", "");
  run.settle();
  EXPECT_NE(run.written.value_or("").find("folder.vtp"), std::string::npos);
  EXPECT_EQ(run.failure, "") << "the flow goes on";
}

TEST(FlowWorker, SamplesTheTextureWhereItIsAsked) {
  WorkerRun run;
  run.step();
  const Surface sphere = make_sample("sphere", 24).load(0);
  run.worker->sample(sphere.points[5]);
  std::optional<float> value;
  while (std::optional<FlowEvent> event = run.worker->wait(run.stop))
    if (const auto* sampled = std::get_if<FlowSampled>(&*event)) value = sampled->value;
  ASSERT_TRUE(value.has_value());
  EXPECT_TRUE(*value >= 0 && *value <= 1) << *value;
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
