// Nacre: where curves of four materials end without a point, one is put.
#include "compute/pipeline/missing_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compute/pipeline/mesh_volumes.hpp"

namespace nacre::test {
namespace {

/// The curves of four materials whose functions are linear: rays from a point, in the world's origin. Particles are one
/// apart on each, the first ones right beside the point; on `rays` of them.
class FourRays : public MovableParticles {
 public:
  FourRays(int rays, double first) {
    for (std::uint32_t left_out = 0; int(left_out) < rays; ++left_out)
      for (int k = 0; k < 12; ++k) {
        std::vector<std::uint32_t> m;
        for (std::uint32_t i = 0; i < 4; ++i)
          if (i != left_out) m.push_back(i);
        add(direction(left_out) * -(first + k), *table.find(Junction(m[0], m[1], m[2])));
      }
  }

  /// Of the slope of a material's function: the corners of a tetrahedron.
  static Vec3d direction(std::uint32_t material) {
    const Vec3d corners[] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    return normalized(corners[material]);
  }

  std::int64_t count() const override { return std::int64_t(particles.count()); }
  HostParticles download() const override { return particles; }
  void upload(const HostParticles& now) override { particles = now; }
  std::size_t replace(std::span<const std::uint8_t>, std::span<const MeshDefects::NewPoint>) override { return 0; }
  void smooth(const TriangleRings&, const SmoothingRule&, const std::function<void(int)>&) override {}
  std::vector<std::uint16_t> material_at(std::span<const Vec3d> points) override {
    return std::vector<std::uint16_t>(points.size(), 0);
  }
  std::vector<JunctionGradients> junction_gradients(std::span<const Vec3f>, std::span<const Junction> of) override {
    std::vector<JunctionGradients> gradients(of.size());
    for (std::size_t i = 0; i < of.size(); ++i)
      for (int k = 1; k < of[i].materials(); ++k)
        gradients[i].from_first[k - 1] = Vec3f(direction(of[i].material(0)) - direction(of[i].material(k)));
    return gradients;
  }
  std::vector<Vec3d> onto_junctions(std::span<const Vec3d> points, std::span<const Junction>, bool) override {
    return std::vector<Vec3d>(points.size(), found ? Vec3d() : Vec3d(NAN));
  }
  void in_stage(std::string_view, const std::function<void()>& work) override { work(); }

  void add(const Vec3d& world, std::uint32_t interface) {
    const Vec3d p = frame.to_voxels(world);
    particles.position.push_back({float(p.x), float(p.y), float(p.z), 1});
    particles.direction.push_back({});
    particles.interface.push_back(interface);
  }
  std::size_t broken() {
    const StarInput input = star_input(*this, particles, table);
    const std::vector<CurveNode> nodes = link_curves(input.of(particles));
    return std::size_t(std::count_if(nodes.begin(), nodes.end(), [](const CurveNode& n) { return n.is_broken(); }));
  }

  const JunctionTable table = make_junction_table(
      std::vector<Junction>{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}, {0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}},
      std::vector<Junction>{{0, 1, 2, 3}});
  const VolumeFrame frame{[] {
    MeshVolume volume;
    volume.dims = {20, 20, 20};
    return volume;
  }()};
  HostParticles particles;
  bool found = true;
};

TEST(MissingPoints, FourCurvesThatEndBesideEachOtherGetTheirPoint) {
  FourRays rays(4, 0.05);
  EXPECT_EQ(rays.broken(), 8u) << "all ends of all curves";
  EXPECT_EQ(put_missing_points(rays, rays.table, rays.frame), 1u);
  EXPECT_EQ(rays.count(), 4 * 12 - 3);
  const std::uint32_t point = *rays.table.find(Junction(0, 1, 2, 3));
  ASSERT_EQ(std::count(rays.particles.interface.begin(), rays.particles.interface.end(), point), 1);
  const auto at = std::find(rays.particles.interface.begin(), rays.particles.interface.end(), point);
  const Float4 p = rays.particles.position[std::size_t(at - rays.particles.interface.begin())];
  EXPECT_LT(length(rays.frame.to_world({p.x, p.y, p.z})), 1e-5);
  EXPECT_EQ(p.w, 1);
  EXPECT_EQ(rays.broken(), 4u) << "the far ends";
  EXPECT_EQ(put_missing_points(rays, rays.table, rays.frame), 0u);
}

TEST(MissingPoints, ThreeAreEnoughAndTwoAreNot) {
  FourRays three(3, 0.3), two(2, 0.05);
  EXPECT_EQ(put_missing_points(three, three.table, three.frame), 1u);
  EXPECT_EQ(put_missing_points(two, two.table, two.frame), 0u);
  EXPECT_EQ(two.count(), 24);
}

TEST(MissingPoints, WhereThereIsOneOrNoneCanBeFoundNothingChanges) {
  FourRays known(4, 0.6), none(4, 0.05);
  known.add(Vec3d(), *known.table.find(Junction(0, 1, 2, 3)));
  EXPECT_EQ(put_missing_points(known, known.table, known.frame), 0u);
  EXPECT_EQ(known.count(), 49);
  none.found = false;
  EXPECT_EQ(put_missing_points(none, none.table, none.frame), 0u);
  EXPECT_EQ(none.count(), 48);
}

}  // namespace
}  // namespace nacre::test
