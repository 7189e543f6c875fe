// Nacre: the parts of the mesh pipeline that run on a device, each by itself: fields, seeds, relaxation, looks.
#include <gtest/gtest.h>

#include <numeric>

#include "compute/device/executor_cpu.hpp"
#include "compute/pipeline/mesh_probe.hpp"
#include "compute/pipeline/relaxation.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

const TellStage silent = [](std::string_view, double, int, double) {};

/// Fields of a volume and the particles on them.
struct Parts {
  std::unique_ptr<Device> device = make_cpu_device();
  Executor<Cpu> exec{*device};
  MeshParameters parameters;
  MeshInfo info;
  MeshFields<Cpu> fields{exec};
  ParticleStore<Cpu> particles{exec, fields};
  nacre::Relaxation<Cpu> relaxation{exec, fields, particles};

  explicit Parts(const MeshVolume& volume) {
    parameters.iterations = 20;
    fields.load(volume, parameters, info);
    build();
  }
  void build() {
    fields.drop_outdated(parameters);
    fields.build(parameters, silent, info);
  }
  void make_room() { particles.make(std::int64_t(particle_capacity(info.expected_particles))); }
};

TEST(MeshFields, StagesThatAreOutdatedAreDropped) {
  Parts parts(three_balls());
  EXPECT_TRUE(parts.fields.built());
  EXPECT_FALSE(parts.fields.drop_outdated(parts.parameters));
  parts.parameters.theta = 0.1;
  EXPECT_FALSE(parts.fields.drop_outdated(parts.parameters));
  const std::size_t end = parts.fields.end();
  parts.parameters.delta = 0.3;
  EXPECT_TRUE(parts.fields.drop_outdated(parts.parameters));
  EXPECT_FALSE(parts.fields.built());
  EXPECT_LT(parts.exec.arena().mark(), end) << "what was behind them is free";
  std::vector<std::string> stages;
  parts.fields.build(
      parts.parameters, [&](std::string_view stage, double, int, double) { stages.emplace_back(stage); }, parts.info);
  EXPECT_EQ(stages, (std::vector<std::string>{"sizing", "embed"}));
  EXPECT_TRUE(parts.fields.built());
}

TEST(MeshFields, KnowTheJunctionsAndWhatIsExpectedOnThem) {
  const Parts parts(three_balls());
  EXPECT_EQ(parts.info.surfaces, 6);
  EXPECT_EQ(parts.info.curves, 4);
  EXPECT_EQ(parts.info.points, 2);
  EXPECT_EQ(parts.fields.expected(0), 2);
  EXPECT_GT(parts.fields.expected(1), 20);
  EXPECT_EQ(parts.info.expected_particles,
            parts.fields.expected(0) + parts.fields.expected(1) + parts.fields.expected(2));
  EXPECT_EQ(parts.fields.junctions().download().size(), parts.fields.table().junctions.size());
}

TEST(MeshFields, AnswerAtPointsOfTheWorld) {
  Parts parts(scalar_volume({24, 24, 24}, ball({11, 12, 11.5}, 6)));
  const std::vector<Vec3d> points{{11, 12, 11.5}, {11, 12, 2}, {1e30, 0, 0}};
  EXPECT_EQ(material_at(parts.exec, parts.fields, points), (std::vector<std::uint16_t>{1, 0, 0}));
  const std::vector<float> distance = field_at(parts.exec, parts.fields, MeshField::distance, points);
  EXPECT_NEAR(distance[1], 3.5, 0.2);
  EXPECT_TRUE(std::isnan(distance[2]));
}

TEST(Seeding, PutsPointsThenCurvesThenSurfaces) {
  Parts parts(three_balls());
  parts.make_room();
  ParticleSet& set = parts.particles.set();
  Array<Float4>& velocity = parts.particles.solver().velocity();
  put_points(parts.fields, set, velocity);
  EXPECT_EQ(set.count, 2);
  const std::int64_t curves = seed_order(parts.exec, parts.fields, parts.parameters, 1, set, velocity);
  EXPECT_NEAR(double(curves), parts.fields.expected(1), 2);
  parts.parameters.particles = 300;
  const std::int64_t surfaces = seed_order(parts.exec, parts.fields, parts.parameters, 2, set, velocity);
  EXPECT_NEAR(double(surfaces), 300, 2);
  EXPECT_EQ(count_by_order(parts.particles.download().interface, parts.fields.table()),
            (std::array<std::int64_t, 3>{2, curves, surfaces}));
}

TEST(Relaxation, BringsTheParticlesToRestByEachSolver) {
  for (const char* solver : {"tree", "redblack", "serial"}) {
    SCOPED_TRACE(solver);
    Parts parts(scalar_volume({24, 24, 24}, ball({11, 12, 11.5}, 6)));
    parts.parameters.solver = solver;
    parts.parameters.coarse_iterations = 0;
    parts.make_room();
    int told = 0;
    const TellStage tell = [&](std::string_view stage, double fraction, int iteration, double) {
      EXPECT_EQ(stage, "relax");
      EXPECT_EQ(iteration, ++told);
      EXPECT_NEAR(fraction, 0.22 + 0.63 * iteration / 20, 1e-9);
    };
    parts.relaxation.run(parts.parameters, tell, parts.info);
    EXPECT_EQ(parts.info.iterations, told);
    EXPECT_LT(parts.info.energy.back(), parts.info.energy.front());
    const HostParticles particles = parts.particles.download();
    EXPECT_NEAR(double(particles.count()), 4 * M_PI * 36 / 0.866, 100);
    for (const Float4& p : particles.position)
      EXPECT_NEAR(length(parts.fields.frame().to_world({p.x, p.y, p.z}) - Vec3d(11, 12, 11.5)), 6, 0.05);
  }
}

/// A quarter of the particles settle first; those that are made from them begin with less energy than seeds end with
/// after as many iterations.
TEST(Relaxation, BeginsWithAQuarterOfTheParticles) {
  const MeshVolume volume = scalar_volume({32, 32, 32}, ball({15, 16, 15.5}, 13));
  Parts at_once(volume), coarse_first(volume);
  at_once.parameters.coarse_iterations = 0;
  coarse_first.parameters.coarse_iterations = 30;
  for (Parts* parts : {&at_once, &coarse_first}) {
    parts->make_room();
    parts->relaxation.run(parts->parameters, silent, parts->info);
  }
  EXPECT_EQ(at_once.info.coarse_iterations, 0);
  const MeshInfo& info = coarse_first.info;
  ASSERT_GT(info.coarse_iterations, 20);
  ASSERT_LT(info.coarse_iterations, info.iterations);
  const double seeds = double(info.seeded_on_surfaces);
  EXPECT_NEAR(double(info.count.front()), seeds / 4, 1);
  EXPECT_NEAR(double(info.count[std::size_t(info.coarse_iterations)]), seeds, 0.03 * seeds);
  EXPECT_LT(info.energy[std::size_t(info.coarse_iterations)], at_once.info.energy.back());
  const HostParticles particles = coarse_first.particles.download();
  EXPECT_NEAR(double(particles.count()), double(at_once.particles.count()), 0.03 * seeds);
  for (const Float4& p : particles.position) {
    EXPECT_NEAR(length(coarse_first.fields.frame().to_world({p.x, p.y, p.z}) - Vec3d(15, 16, 15.5)), 13, 0.05);
    EXPECT_NEAR(p.w, 1, 1e-3) << "the size of the field, not that of a quarter";
  }
}

/// A ball in slices, so that many of the surfaces' particles stand at rims.
MeshVolume sliced_ball() {
  return label_volume({38, 38, 38}, 8, [](const Vec3d& p) {
    return length(p - Vec3d(18.3, 18.6, 18.4)) > 16.4 ? 0 : 1 + int(p.z / 5.5);
  });
}

/// Rims crowd out particles beside them, twice as wide a strip among a quarter of them: in the end there are as many as
/// without that; so in a draft, for all its few iterations.
TEST(Relaxation, AsManyStandAtRimsAfterAQuarter) {
  const MeshVolume volume = sliced_ball();
  double count[3] = {};
  for (const int coarse : {0, 1, 2}) {
    Parts parts(volume);
    parts.parameters = {};
    parts.parameters.max_size = parts.parameters.min_size = 0.6;
    if (coarse == 2) parts.parameters.quality = "draft", parts.parameters = at_quality(parts.parameters);
    if (coarse == 0) parts.parameters.coarse_iterations = 0;
    parts.build();
    parts.make_room();
    parts.relaxation.run(parts.parameters, silent, parts.info);
    EXPECT_EQ(parts.info.coarse_iterations > 0, coarse > 0);
    count[coarse] = double(parts.particles.count());
  }
  EXPECT_NEAR(count[1], count[0], 0.03 * count[0]);
  EXPECT_NEAR(count[2], count[0], 0.03 * count[0]);
}

/// Both ways back onto the interfaces lead to the same particles, as far as numbers and energies tell: of one run these
/// vary by two percent, so it is means that are compared.
TEST(Relaxation, ByTheFieldsAndByTheEmbeddingEndAlike) {
  const MeshVolume volume = sliced_ball();
  double fields_energy = 0, embedding_energy = 0;
  for (const std::uint32_t seed : {1, 2, 3, 4}) {
    Parts fields(volume), embedding(volume);
    for (Parts* parts : {&fields, &embedding}) {
      parts->parameters = {};
      parts->parameters.coarse_iterations = 0;
      parts->parameters.projection = parts == &fields ? "fields" : "embedding";
      parts->parameters.seed = seed;
      parts->build();
      parts->make_room();
      parts->relaxation.run(parts->parameters, silent, parts->info);
    }
    const double count = double(fields.particles.count());
    EXPECT_NEAR(double(fields.info.seeded), double(embedding.info.seeded), 0.005 * count);
    EXPECT_NEAR(double(embedding.particles.count()), count, 0.01 * count);
    fields_energy += fields.info.final_energy / 4, embedding_energy += embedding.info.final_energy / 4;
  }
  EXPECT_NEAR(embedding_energy, fields_energy, 0.015 * fields_energy);
}

/// Stopped among a quarter of the particles: the others are made all the same.
TEST(Relaxation, IsRefinedAfterAnInterruption) {
  Parts parts(scalar_volume({32, 32, 32}, ball({15, 16, 15.5}, 13)));
  parts.make_room();
  const TellStage stop = [](std::string_view, double, int iteration, double) {
    if (iteration == 10) throw Interrupted();
  };
  EXPECT_THROW(parts.relaxation.run(parts.parameters, stop, parts.info), Interrupted);
  const double quarter = double(parts.particles.count());
  parts.relaxation.finish(parts.parameters, parts.info);
  EXPECT_NEAR(double(parts.particles.count()), 4 * quarter, 0.05 * 4 * quarter);
  for (const Float4& p : parts.particles.download().position) EXPECT_NEAR(p.w, 1, 1e-3);
}

/// Stopped while curves move: surfaces have particles all the same when it is finished.
TEST(Relaxation, IsFinishedAfterAnInterruption) {
  Parts parts(three_balls());
  parts.make_room();
  const TellStage stop = [](std::string_view, double, int iteration, double) {
    if (iteration == 3) throw Interrupted();
  };
  EXPECT_THROW(parts.relaxation.run(parts.parameters, stop, parts.info), Interrupted);
  EXPECT_EQ(parts.info.seeded_on_surfaces, 0);
  parts.relaxation.finish(parts.parameters, parts.info);
  EXPECT_GT(parts.info.seeded_on_surfaces, 100);
  const std::int64_t count = parts.particles.count();
  parts.relaxation.finish(parts.parameters, parts.info);
  EXPECT_EQ(parts.particles.count(), count) << "once is enough";
}

/// The plan of the memory is what is taken, to the byte.
TEST(SolverBytes, AreWhatTheSolversTake) {
  for (const char* solver : {"tree", "serial"}) {
    Parts parts(scalar_volume({20, 20, 20}, ball({9, 10, 9.5}, 5)));
    parts.parameters.solver = solver;
    Arena& arena = parts.exec.arena();
    const std::size_t before = arena.mark();
    parts.particles.make(30001);
    if (solver == std::string("serial")) make_solver_state(parts.exec, parts.particles.set());
    const std::size_t permanent = arena.mark() - before, free = arena.free_bytes();
    Arena::Scope scope(arena);
    detail::SmoothingScratch(arena, 30001, 6 * 30001);
    EXPECT_EQ(solver_bytes(30001, 1, parts.parameters), double(permanent + free - arena.free_bytes())) << solver;
  }
}

TEST(SolverBytes, RoomIsRefusedWhereMemoryIsTooSmall) {
  MeshParameters parameters;
  const std::size_t enough = std::size_t(solver_bytes(36000, 5, parameters));
  const auto device = make_cpu_device();
  EXPECT_EQ(require_room_for(10000, 5, enough, *device, parameters, "asked for "), 36000);
  EXPECT_THROW(require_room_for(10000, 5, enough - 1, *device, parameters, "asked for "), Error);
  EXPECT_THROW(require_room_for(1e12, 5, ~std::size_t(0), *device, parameters, "asked for "), Error);
}

}  // namespace
}  // namespace nacre::test
