// Nacre: the improvement of a mesh alone, on particles of a sphere that stand in for those of the pipeline.
#include "compute/pipeline/mesh_improvement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "compute/device/error.hpp"
#include "compute/device/executor_cpu.hpp"
#include "compute/device/random.hpp"
#include "compute/meshing/device_stars.hpp"
#include "compute/meshing/quality.hpp"
#include "compute/meshing/topology.hpp"
#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

/// Particles on a sphere, in voxels that are the world's, with material 1 in it.
class SphereParticles : public MovableParticles {
 public:
  static constexpr double radius = 6;

  explicit SphereParticles(const std::vector<Vec3d>& directions) {
    for (const Vec3d& d : directions) add(d);
  }

  std::int64_t count() const override { return std::int64_t(particles_.count()); }
  HostParticles download() const override { return particles_; }
  void upload(const HostParticles& particles) override { particles_ = particles; }
  std::vector<std::uint32_t> replace(std::span<const std::uint8_t> gone,
                                     std::span<const MeshDefects::NewPoint> born) override {
    std::vector<std::uint32_t> taken = replace_particles(particles_, gone, born, table, frame, 100000);
    const std::size_t kept = particles_.count() - taken.size();
    removed += gone.size() - kept;
    for (std::size_t i = kept; i < particles_.count(); ++i) put(i, world(i));
    return taken;
  }
  /// Towards the middle of the corners around; enough for a sphere.
  void smooth(const TriangleRings& rings, const SmoothingRule& rule, const std::function<void(int)>& turned) override {
    ++smoothings;
    for (int k = 0; k < rule.turns; k += 2) {
      for (std::size_t i = 0; i + 1 < rings.first.size(); ++i) {
        Vec3d sum;
        for (std::uint32_t e = rings.first[i]; e < rings.first[i + 1]; ++e)
          sum += world(rings.edge[e].a) + world(rings.edge[e].b);
        if (rings.first[i] < rings.first[i + 1])
          put(i, world(i) * 0.5 + sum / (4.0 * (rings.first[i + 1] - rings.first[i])));
      }
      turned(k + 2);
    }
  }
  std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) override {
    std::vector<std::uint16_t> material;
    for (const Vec3d& p : points) material.push_back(length(p) < radius ? 1 : 0);
    return material;
  }
  std::vector<JunctionGradients> junction_gradients(std::span<const Vec3f> points, std::span<const Junction>) override {
    return std::vector<JunctionGradients>(points.size());
  }
  std::vector<Vec3d> onto_junctions(std::span<const Vec3d> points, std::span<const Junction>, bool) override {
    std::vector<Vec3d> on;
    for (const Vec3d& p : points) on.push_back(p * (radius / length(p)));
    return on;
  }
  std::unique_ptr<StarDevice> star_device() override { return std::make_unique<DeviceStars<Cpu>>(exec_); }
  void in_stage(std::string_view name, const std::function<void()>& work) override {
    stages.insert(std::string(name));
    work();
  }

  void add(const Vec3d& direction) {
    particles_.position.push_back({});
    particles_.direction.push_back({});
    particles_.interface.push_back(0);
    put(particles_.count() - 1, direction);
  }

  const JunctionTable table = make_junction_table(std::vector<Junction>{{0, 1}}, {});
  const VolumeFrame frame{[] {
    MeshVolume volume;
    volume.origin = Vec3d(volume_padding + 0.5);  // so that voxels are the world's
    volume.dims = {20, 20, 20};
    return volume;
  }()};
  std::size_t removed = 0;
  int smoothings = 0;
  std::set<std::string> stages;

 private:
  Vec3d world(std::size_t i) const {
    const Float4& p = particles_.position[i];
    return frame.to_world({p.x, p.y, p.z});
  }
  void put(std::size_t i, const Vec3d& near) {
    const Vec3d n = near / length(near), p = frame.to_voxels(n * radius);
    particles_.position[i] = {float(p.x), float(p.y), float(p.z), 1};
    particles_.direction[i] = {float(n.x), float(n.y), float(n.z), 0};
  }

  HostParticles particles_;
  std::unique_ptr<Device> device_ = make_cpu_device();
  Executor<Cpu> exec_{*device_};
};

ImprovedMesh improve(SphereParticles& particles, int smooth, int remesh, double deviation = 0, bool stars = false,
                     const DefectRule& aim = worst_defects) {
  const ImprovementRule rule{
      .smooth = smooth, .remesh = remesh, .stars = stars, .aim = aim, .threads = 1, .deviation = deviation};
  const TellStage tell = [](std::string_view, double fraction, int, double) {
    EXPECT_GE(fraction, 0.85);
    EXPECT_LE(fraction, 0.94);
  };
  return MeshImprovement(particles, particles.table, particles.frame, rule, tell).run();
}

/// About a particle to the area of a hexagonal lattice with spacing 1.
const int even = int(4 * M_PI * 36 / 0.866);

std::vector<Vec3d> shaken(double by, std::uint32_t seed) {
  std::vector<Vec3d> directions = even_directions(even);
  for (std::uint32_t i = 0; i < directions.size(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      directions[i][axis] += by * (uniform_random(seed, i, std::uint32_t(axis)) - 0.5);
  return directions;
}

TEST(MeshImprovement, MakesAClosedMeshOfTheParticles) {
  SphereParticles particles(even_directions(even));
  const ImprovedMesh made = improve(particles, 0, 0);
  EXPECT_TRUE(check_topology(made.mesh, 2).sound());
  EXPECT_EQ(made.mesh.points.size(), std::size_t(even));
  EXPECT_EQ(made.mesh.triangles.size(), std::size_t(2 * even - 4));  // Euler
  EXPECT_EQ(made.particles, (std::array<std::int64_t, 3>{0, 0, even}));
  EXPECT_EQ(particles.smoothings, 0);
  EXPECT_EQ(particles.removed, 0u);
  EXPECT_EQ(particles.stages, (std::set<std::string>{"triangulate"}));
}

TEST(MeshImprovement, SmoothingMakesTheWorstTriangleBetter) {
  SphereParticles as_they_are(even_directions(even)), smoothed(even_directions(even));
  const double before = surface_quality(improve(as_they_are, 0, 0).mesh).all.radius_ratio_min;
  const double after = surface_quality(improve(smoothed, 2, 0).mesh).all.radius_ratio_min;
  EXPECT_EQ(smoothed.smoothings, 2);
  EXPECT_GT(after, before + 0.05);
}

/// Pairs of particles that stand together: one of each goes, whatever smoothing does.
TEST(MeshImprovement, MendingTakesOutWhatSpoilsTriangles) {
  std::vector<Vec3d> directions = even_directions(even);
  for (int k = 0; k < 5; ++k) directions.push_back(directions[std::size_t(40 + 70 * k)] + Vec3d(0.01, 0.01, 0));
  SphereParticles particles(directions);
  const ImprovedMesh made = improve(particles, 2, 12);
  EXPECT_GE(particles.removed, 5u);
  EXPECT_TRUE(check_topology(made.mesh, 2).sound());
  EXPECT_GT(surface_quality(made.mesh).all.radius_ratio_min, worst_defects.ratio);
  EXPECT_EQ(std::size_t(particles.count()), made.mesh.points.size()) << "the particles are those of the mesh";
  EXPECT_TRUE(particles.stages.contains("remesh"));
}

/// The same particles, neither smoothed nor remeshed: their triangles go by edits alone.
TEST(MeshImprovement, PolishingEditsEdgesInPlaceOfParticles) {
  std::vector<Vec3d> directions = even_directions(even);
  for (int k = 0; k < 5; ++k) directions.push_back(directions[std::size_t(40 + 70 * k)] + Vec3d(0.01, 0.01, 0));
  SphereParticles particles(directions), cells(directions);
  const ImprovedMesh made = improve(particles, 0, 0, 0, true);
  EXPECT_EQ(made.stars.meshes, 1);
  EXPECT_EQ(made.stars.fallbacks, 0);
  EXPECT_EQ(made.stars.contractions, 5);
  EXPECT_TRUE(check_topology(made.mesh, 2).sound());
  EXPECT_GT(surface_quality(made.mesh).all.radius_ratio_min, wanted_ratio);
  EXPECT_LT(surface_quality(improve(cells, 0, 0).mesh).all.radius_ratio_min, 0.1);
  EXPECT_EQ(std::size_t(particles.count()), made.mesh.points.size()) << "the particles are those of the mesh";
}

/// Particles that are shaken, and barely smoothed: attempts make bad triangles better, and leave all else as it is.
TEST(MeshImprovement, AttemptsLeaveAllElseAsItIs) {
  for (const bool stars : {false, true}) {
    const double asked = stars ? 0.75 : 0.65;  // without attempts, polishing reaches more than smoothing
    const DefectRule aim{0, asked, asked, false};
    const auto bad = [&](const ImprovedMesh& made) { return triangles_under(asked, made.mesh).size(); };
    std::size_t bad_before = 0, bad_after = 0, all = 0, same = 0;
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
      const std::vector<Vec3d> directions = shaken(0.2, seed);
      SphereParticles before(directions), after(directions);
      const ImprovedMesh without = improve(before, 1, 1, 0, stars, aim), with = improve(after, 1, 12, 0, stars, aim);
      EXPECT_TRUE(check_topology(with.mesh, 2).sound());
      EXPECT_EQ(std::size_t(after.count()), with.mesh.points.size()) << "the particles are those of the mesh";
      EXPECT_EQ(with.stars.meshes, without.stars.meshes) << "nothing else is triangulated again";
      bad_before += bad(without), bad_after += bad(with);
      all += without.mesh.points.size();
      for (const Vec3d& p : without.mesh.points)
        same += std::find(with.mesh.points.begin(), with.mesh.points.end(), p) != with.mesh.points.end();
    }
    EXPECT_GT(bad_before, 4u);
    EXPECT_LT(2 * bad_after, bad_before);
    EXPECT_GT(3 * same, 2 * all);
    EXPECT_LT(same, all);
  }
}

/// Particles nearly at random, and one round of remeshing, which is made before triangles are judged: attempts that are
/// left are those at triangles for which all would be made of cells.
TEST(MeshImprovement, ThereAreAttemptsAtUnacceptableTrianglesBeforeAllIsMadeOfCells) {
  std::int64_t attempts = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    SphereParticles particles(shaken(3, seed));
    const ImprovedMesh made = improve(particles, 0, 1, 0, true);
    attempts += made.stars.attempts;
    EXPECT_LE(made.stars.attempts, 1) << seed;
    EXPECT_EQ(made.stars.fallbacks, 0) << seed;
    EXPECT_GE(surface_quality(made.mesh).all.radius_ratio_min, 0.2) << seed;
  }
  EXPECT_GT(attempts, 1);
}

/// A part of the sphere where particles are half as dense: there are more in the end, and nowhere else.
TEST(MeshImprovement, ParticlesAreAddedWhereTrianglesAreTooFarAway) {
  std::vector<Vec3d> directions;
  int number = 0;
  for (const Vec3d& d : even_directions(even))
    if (d.z < 0.5 || ++number % 2 == 0) directions.push_back(d);
  SphereParticles loose(directions), bounded(directions);
  const double before = improve(loose, 2, 12).deviation.max;
  EXPECT_EQ(before, 0) << "nothing is measured without a bound";
  const ImprovedMesh made = improve(bounded, 2, 12, 0.045);
  EXPECT_GT(made.deviation.first_max, 0.045);
  EXPECT_GT(made.deviation.first_above, 0);
  EXPECT_GT(made.deviation.inserted, 0);
  EXPECT_LE(made.deviation.max, 0.045);
  EXPECT_EQ(made.deviation.above(), 0);
  EXPECT_TRUE(made.deviation.places.empty());
  EXPECT_TRUE(check_topology(made.mesh, 2).sound());
  EXPECT_GT(surface_quality(made.mesh).all.radius_ratio_min, worst_defects.ratio);
  EXPECT_EQ(std::size_t(bounded.count()), made.mesh.points.size()) << "the particles are those of the mesh";
  EXPECT_TRUE(bounded.stages.contains("refine"));
}

TEST(MeshImprovement, StopsWhenAsked) {
  SphereParticles particles(even_directions(even));
  const std::atomic<bool> stop = true;
  const TellStage tell = [](std::string_view, double, int, double) {};
  const ImprovementRule rule{.threads = 1, .stop = &stop};
  EXPECT_THROW(MeshImprovement(particles, particles.table, particles.frame, rule, tell).run(), Interrupted);
}

}  // namespace
}  // namespace nacre::test
