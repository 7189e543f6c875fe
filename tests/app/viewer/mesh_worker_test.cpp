// Nacre: the thread that meshes beside the frames: what it tells, and which stages run again after a knob was changed.
#include "app/viewer/mesh/mesh_worker.hpp"

#include <gtest/gtest.h>

#include <map>

#include "engine/io/nrrd_writer.hpp"
#include "engine/scene/settings/knobs.hpp"
#include "tests/engine/io/temporary_folder.hpp"

namespace nacre {
namespace {

/// A small mesh, and what its worker has told.
struct MeshWorkerRun {
  std::atomic<bool> stop{false};
  Session session;
  std::vector<Float4> position, direction;
  /// A letter per event: Volume, Preview, Begun, Iterated (once), Triangulated, Measured, Slice, Written, Failed.
  std::string order;
  int iterations = 0, lease = 0, turns = 0;
  std::int64_t capacity = 0;
  std::vector<std::int64_t> counts;  ///< of particles, where they were shown
  std::vector<Float4> last_places;
  VoxelFrame frame;
  std::vector<Vec3d> corners;
  std::size_t triangles = 0;
  MeshPreview preview;
  bool brought_back = false;
  std::string failure, written;
  SliceFilled slice;
  std::shared_ptr<const ViewedVolume> volume;
  std::unique_ptr<MeshWorker> worker;

  explicit MeshWorkerRun(
      bool lockstep = false, int threads = 2, const std::function<void(Session&)>& preset = [](Session&) {},
      bool live = false) {
    session.sample = "two-spheres";
    session.detail = 20;
    session.settings.mesh.iterations = 30;
    session.settings.mesh.remesh = 1;
    preset(session);
    worker = std::make_unique<MeshWorker>(session, make_cpu_device(threads), lockstep, false, live);
  }

  void note(char letter) {
    if (letter != 'I' || order.empty() || order.back() != 'I') order += letter;
  }

  void lend() {
    position.assign(std::size_t(capacity), {});
    direction.assign(std::size_t(capacity), {});
    LentMemory memory;
    memory.particles = {position.data(), direction.data(), capacity};
    memory.lease = lease;
    worker->lend(memory);
  }

  void take(MeshEvent& event) {
    if (const auto* read = std::get_if<VolumeRead>(&event)) {
      note('V');
      volume = read->volume;
      frame = read->frame;
      corners = read->corners;
    }
    if (auto* made = std::get_if<PreviewMade>(&event)) {
      note('P');
      preview = std::move(made->preview);
    }
    if (const auto* begun = std::get_if<RelaxBegun>(&event)) {
      note('B');
      capacity = begun->capacity;
      lease = begun->lease;
      lend();
    }
    if (const auto* iterated = std::get_if<MeshIterated>(&event)) {
      note('I');
      iterations += iterated->step;
      if (iterated->shown) {
        counts.push_back(iterated->shown->total());
        last_places.assign(position.begin(), position.begin() + iterated->shown->total());
        lend();
      }
    }
    if (const auto* made = std::get_if<MeshTriangulated>(&event)) {
      note('T');
      triangles = made->mesh->triangles.size();
      brought_back = made->brought_back;
    }
    if (std::holds_alternative<MeshMeasured>(event)) note('M');
    if (auto* filled = std::get_if<SliceFilled>(&event)) {
      note('S');
      slice = *filled;
    }
    if (const auto* done = std::get_if<MeshWritten>(&event)) {
      note('W');
      written = done->failure;
    }
    if (const auto* failed = std::get_if<MeshFailed>(&event)) {
      note('F');
      failure = failed->what;
    }
  }

  /// Takes all events until the worker has nothing to do, or `enough` says so. In lockstep gives a turn for each
  /// iteration.
  void settle(const std::function<bool()>& enough = [] { return false; }) {
    while (!enough()) {
      worker->grant_turn();
      std::optional<MeshEvent> event = worker->wait(stop);
      if (!event) break;
      take(*event);
    }
    if (order.ends_with("MI")) order.pop_back();  // the particles of the mesh, shown when memory was lent again
  }

  std::map<std::string, long> calls() const {
    std::map<std::string, long> all;
    const StageTimers timers = worker->timers();
    for (const StageTimers::Stage& stage : timers.stages()) all[stage.name] = stage.calls;
    return all;
  }

  /// Of these stages, those that ran again when a knob was set.
  std::string rerun(const std::string& knob, const std::string& value) {
    const auto before = calls();
    set_knob(session.settings, knob, value);
    order.clear();
    worker->set_settings(session.settings);
    settle();
    auto after = calls();
    std::string again;
    for (const char* stage :
         {"read", "classify", "materials", "tighten", "distance", "sizing", "embed", "seed", "triangulate", "quality"})
      if (after[stage] > (before.contains(stage) ? before.at(stage) : 0))
        again += (again.empty() ? "" : " ") + std::string(stage);
    return again;
  }
};

TEST(MeshWorker, TellsInOrder) {
  MeshWorkerRun run;
  run.settle();
  EXPECT_EQ(run.failure, "");
  EXPECT_EQ(run.order, "VBITM");
  EXPECT_GT(run.iterations, 20);
  EXPECT_GT(run.triangles, 500u);
  EXPECT_TRUE(run.worker->settled());
  ASSERT_FALSE(run.counts.empty());
  EXPECT_GT(run.counts.back(), 300);
  for (const Float4& p : run.last_places) {
    ASSERT_GT(p.w, 0);
    const Vec3d position = run.frame.to_world(Vec3d(p.x, p.y, p.z));
    for (int a = 0; a < 3; ++a) {
      ASSERT_GT(position[a], run.corners.front()[a] - 1);
      ASSERT_LT(position[a], run.corners.back()[a] + 1);
    }
  }
}

TEST(MeshWorker, OnlyWhatDependsOnAKnobRunsAgain) {
  MeshWorkerRun run;
  run.settle();
  const std::string particles = "seed triangulate quality";
  EXPECT_EQ(run.rerun("theta", "0.6"), particles);
  EXPECT_EQ(run.order, "BITM");
  EXPECT_EQ(run.rerun("delta", "0.3"), "sizing embed " + particles);
  EXPECT_EQ(run.rerun("epsilon", "0.6"), "distance sizing embed " + particles);  // which looks farther
  EXPECT_EQ(run.rerun("tighten", "1"), "tighten distance sizing embed " + particles);
  EXPECT_EQ(run.rerun("remesh", "0"), "triangulate quality");
  EXPECT_EQ(run.rerun("merge", "2:1"), "classify materials tighten distance sizing embed " + particles);
  EXPECT_EQ(run.order, "VBITM");
  EXPECT_EQ(run.rerun("worst", "5"), "");
  EXPECT_EQ(run.rerun("max_cell", "3"), "");
  EXPECT_EQ(run.failure, "");
}

const auto as_it_is = [](Session&) {};

TEST(MeshWorker, APreviewComesBeforeTheFields) {
  MeshWorkerRun run(false, 2, as_it_is, true);
  run.settle([&] { return run.order.ends_with("P"); });
  EXPECT_EQ(run.order, "VP");
  EXPECT_GT(run.preview.geometry.triangles.size(), 200u);
  EXPECT_EQ(run.preview.materials.size(), run.preview.geometry.triangles.size());
  EXPECT_EQ(run.preview.stride, 1);
  run.settle();
  EXPECT_EQ(run.order, "VPBITM");
  set_knob(run.session.settings, "preview", "false");
  EXPECT_EQ(run.rerun("merge", "2:1"), "classify materials tighten distance sizing embed seed triangulate quality");
  EXPECT_EQ(run.order, "VBITM");
}

TEST(MeshWorker, KnobsAsTheyWereBringTheirMeshBack) {
  MeshWorkerRun run(false, 2, as_it_is, true);
  run.settle();
  const std::size_t first = run.triangles;
  run.rerun("max_size", "1.6");
  const std::size_t second = run.triangles;
  EXPECT_LT(second, first);
  EXPECT_EQ(run.rerun("max_size", "1"), "");  // undo
  EXPECT_EQ(run.order, "TM");
  EXPECT_TRUE(run.brought_back);
  EXPECT_EQ(run.triangles, first);
  EXPECT_TRUE(run.worker->settled());
  EXPECT_EQ(run.rerun("max_size", "1.6"), "");  // redo
  EXPECT_EQ(run.triangles, second);
  EXPECT_EQ(run.rerun("merge", "2:1"), "classify materials tighten distance sizing embed seed triangulate quality");
  EXPECT_EQ(run.rerun("merge", ""), "");  // and the volume that it was made of
  EXPECT_EQ(run.order, "VTM");
  EXPECT_EQ(run.triangles, second);
}

TEST(MeshWorker, AfterAMeshWasBroughtBackOthersAreMadeAsEver) {
  MeshWorkerRun run(false, 2, as_it_is, true);
  run.settle();
  run.rerun("max_size", "1.6");
  run.rerun("max_size", "1");  // brought back; the pipeline is at 1.6
  EXPECT_EQ(run.rerun("remesh", "0"), "distance sizing embed seed triangulate quality");
  MeshWorkerRun fresh(false, 2, [](Session& session) { session.settings.mesh.remesh = 0; });
  fresh.settle();
  EXPECT_EQ(run.triangles, fresh.triangles);
  EXPECT_FALSE(run.brought_back);
}

TEST(MeshWorker, AMeshComesBackWhileAnotherIsMade) {
  MeshWorkerRun run(false, 2, as_it_is, true);
  run.settle();
  const std::size_t first = run.triangles;
  const long seeded = run.calls()["seed"];  // curves, then surfaces
  const MeshParameters usual = run.session.settings.mesh;
  run.session.settings.mesh.theta = 0.9;
  run.session.settings.mesh.iterations = 5000;  // so that it is interrupted among those of the surfaces
  run.session.settings.mesh.stagnation = 0;
  run.worker->set_settings(run.session.settings);
  run.settle([&] { return run.calls()["seed"] == 2 * seeded; });
  run.session.settings.mesh = usual;
  EXPECT_EQ(run.rerun("theta", "0.5"), "");
  EXPECT_EQ(run.triangles, first);
  EXPECT_TRUE(run.worker->settled());
  EXPECT_EQ(run.rerun("theta", "0.9"), "seed triangulate quality");  // it had not been finished
  MeshWorkerRun fresh(false, 2, [](Session& session) { session.settings.mesh.theta = 0.9; });
  fresh.settle();
  EXPECT_EQ(run.triangles, fresh.triangles);
}

TEST(MeshWorker, AReplayMakesEverythingAnew) {
  MeshWorkerRun run(true);
  run.settle();
  EXPECT_EQ(run.order, "VBITM");  // no preview
  run.rerun("theta", "0.9");
  EXPECT_EQ(run.rerun("theta", "0.5"), "seed triangulate quality");
}

TEST(MeshWorker, AChangeInterruptsWhatIsUnderWay) {
  MeshWorkerRun run;
  for (int k = 0; k < 8; ++k) {
    const int before = run.iterations;
    run.settle([&] { return run.iterations > before + k; });
    set_knob(run.session.settings, k % 2 ? "theta" : "max_size", k % 4 < 2 ? "0.9" : "1.1");
    run.worker->set_settings(run.session.settings);
  }
  run.settle();
  EXPECT_EQ(run.failure, "");
  EXPECT_TRUE(run.worker->settled());
  MeshWorkerRun fresh;
  for (const char* knob : {"theta", "max_size"}) set_knob(fresh.session.settings, knob, "1.1");
  fresh.worker->set_settings(fresh.session.settings);
  fresh.settle();
  EXPECT_EQ(run.triangles, fresh.triangles);
}

TEST(MeshWorker, CancelKeepsWhatThereIsAndResumeBeginsAgain) {
  MeshWorkerRun run;
  run.settle([&] { return run.iterations >= 5; });
  run.worker->cancel();
  run.settle();
  EXPECT_TRUE(run.worker->halted());
  EXPECT_FALSE(run.worker->settled());
  EXPECT_EQ(run.triangles, 0u);
  EXPECT_FALSE(run.counts.empty());
  run.worker->write("never.vtp", "");
  run.settle();
  EXPECT_NE(run.written, "");
  run.worker->resume();
  run.settle();
  EXPECT_TRUE(run.worker->settled());
  EXPECT_GT(run.triangles, 500u);
  EXPECT_EQ(run.failure, "");
}

TEST(MeshWorker, AFailureIsToldAndOtherKnobsEndIt) {
  MeshWorkerRun run;
  run.settle();
  EXPECT_EQ(run.rerun("materials", "77"), "classify");
  EXPECT_EQ(run.order, "F");
  EXPECT_NE(run.failure.find("77"), std::string::npos) << run.failure;
  EXPECT_TRUE(run.worker->halted());
  EXPECT_EQ(run.rerun("theta", "0.6"), "");  // not what failed
  EXPECT_TRUE(run.worker->halted());
  run.rerun("materials", "1");
  EXPECT_EQ(run.order, "VBITM");
  EXPECT_TRUE(run.worker->settled());
}

TEST(MeshWorker, LockstepShowsEachIterationAlikeOnAnyThreads) {
  MeshWorkerRun one(true, 1), two(true, 2);
  for (MeshWorkerRun* run : {&one, &two}) {
    run->settle();
    EXPECT_EQ(run->failure, "");
    EXPECT_GE(int(run->counts.size()), run->iterations);  // and once more with the triangles
  }
  EXPECT_EQ(one.counts, two.counts);
  EXPECT_EQ(one.order, two.order);
  EXPECT_EQ(one.triangles, two.triangles);
  ASSERT_EQ(one.last_places.size(), two.last_places.size());
  for (std::size_t i = 0; i < one.last_places.size(); ++i) {
    ASSERT_EQ(one.last_places[i].x, two.last_places[i].x) << i;
    ASSERT_EQ(one.last_places[i].w, two.last_places[i].w) << i;
  }
}

TEST(MeshWorker, InLockstepNothingIsToldWithoutATurn) {
  MeshWorkerRun run(true);
  run.settle([&] { return run.iterations == 3; });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(run.worker->poll().has_value());
  EXPECT_TRUE(run.worker->busy());
  set_knob(run.session.settings, "theta", "0.7");
  run.worker->set_settings(run.session.settings);
  run.settle();
  EXPECT_EQ(run.order.substr(run.order.size() - 4), "BITM");
}

TEST(MeshWorker, SlicesAreFilledWhileItWorksAndAfterChanges) {
  MeshWorkerRun run(true);
  run.settle([&] { return run.iterations == 2; });
  run.worker->ask_slice({1, slice_plane(run.volume->input, 2, 0.5), MeshField::material});
  while (run.worker->slice_comes()) {  // without a turn
    std::optional<MeshEvent> event = run.worker->wait(run.stop);
    if (event) run.take(*event);
  }
  EXPECT_EQ(run.iterations, 2);
  while (std::optional<MeshEvent> event = run.worker->poll()) run.take(*event);
  ASSERT_EQ(run.slice.number, 1);
  const std::vector<float>& values = run.slice.values;
  ASSERT_EQ(values.size(), std::size_t(run.slice.columns) * std::size_t(run.slice.rows));
  for (const float material : {0.0f, 1.0f, 2.0f})
    EXPECT_GT(std::count(values.begin(), values.end(), material), 100) << material;
  run.settle();
  EXPECT_EQ(run.order.find('S', run.order.find('S') + 1), std::string::npos);
  run.rerun("tighten", "0.8");
  EXPECT_NE(run.order.find('S'), std::string::npos) << run.order;
  run.worker->ask_slice({2, slice_plane(run.volume->input, 0, 0.5), MeshField::size});
  run.settle();
  EXPECT_EQ(run.slice.number, 2);
}

/// Bricks of three materials, of which three meet along many lines.
Volume brick_wall() {
  Volume volume;
  volume.dims = {30, 30, 30};
  std::vector<std::uint8_t> labels;
  for (int z = 0; z < 30; ++z)
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 30; ++x) {
        const int row = y / 3, column = (x + (row % 2 ? 3 : 0)) / 6;
        labels.push_back(std::uint8_t(1 + (column - (row + 1) / 2 - row + 60) % 3));
      }
  volume.values = std::move(labels);
  return volume;
}

TEST(MeshWorker, ParticlesOfJunctionsAreShownHoweverFewAreAskedForOnSurfaces) {
  const test::TemporaryFolder folder;
  write_nrrd(folder / "wall.nrrd", brick_wall());
  MeshWorkerRun run(false, 2, [&](Session& session) {
    session.sample.clear();
    session.inputs = {folder / "wall.nrrd"};
    session.settings.mesh.particles = 1;
    session.settings.mesh.min_size = session.settings.mesh.max_size = 0.05;
    session.settings.mesh.iterations = 1;
  });
  run.settle([&] { return !run.counts.empty(); });
  ASSERT_EQ(run.failure, "");
  ASSERT_FALSE(run.counts.empty());
  EXPECT_GT(run.counts.front(), 30000) << "there are more than the surfaces alone would have had room for";
  EXPECT_LE(run.counts.front(), run.capacity);
}

TEST(MeshWorker, EndsAtOnce) {
  MeshWorkerRun run;
  run.settle([&] { return run.iterations >= 1; });  // and is destroyed in the middle
}

}  // namespace
}  // namespace nacre
