// Nacre: particles taken out, put in and taken back on the host; frames between voxels and the world.
#include "compute/pipeline/host_particles.hpp"

#include <gtest/gtest.h>

namespace nacre {
namespace {

VolumeFrame tilted_frame() {
  MeshVolume volume;
  volume.dims = {10, 12, 8};
  volume.spacing = {0.5, 0.8, 2};
  volume.origin = {3, -4, 5};
  volume.axes = {Vec3d(0, 1, 0), Vec3d(-1, 0, 0), Vec3d(0, 0, -1)};
  return VolumeFrame(volume);
}

/// Particles 0, 1, 2, ... of interface 0 at (k, 0, 0).
HostParticles in_a_row(int count) {
  HostParticles particles;
  for (int k = 0; k < count; ++k) {
    particles.position.push_back({float(k), 0, 0, 1});
    particles.direction.push_back({0, 0, 1, float(k)});
    particles.interface.push_back(0);
  }
  return particles;
}

std::vector<float> xs(const HostParticles& particles) {
  std::vector<float> x;
  for (const Float4& p : particles.position) x.push_back(p.x);
  return x;
}

TEST(HostParticles, SomeGoAndOthersCome) {
  const VolumeFrame frame = tilted_frame();
  const std::vector<Junction> interfaces{{0, 1}, {1, 2}};
  const JunctionTable table = make_junction_table(interfaces, {});
  HostParticles particles = in_a_row(4);
  const std::vector<std::uint8_t> gone{0, 1, 0, 1};
  const std::vector<MeshDefects::NewPoint> born{{frame.to_world({7, 8, 9}), {1, 2}, 0},
                                                {frame.to_world({1, 1, 1}), {0, 2}, 0},
                                                {frame.to_world({5, 5, 5}), {0, 1}, 0}};
  EXPECT_EQ(replace_particles(particles, gone, born, table, frame, 3), std::vector<std::uint32_t>{0});
  ASSERT_EQ(particles.count(), 3u) << "none on an interface that is not there, and no more than there is room for";
  EXPECT_EQ(particles.position[1].x, 2);
  EXPECT_EQ(particles.direction[1].w, 2);
  EXPECT_NEAR(particles.position[2].x, 7, 1e-5);
  EXPECT_NEAR(particles.position[2].z, 9, 1e-5);
  EXPECT_EQ(particles.position[2].w, 0);
  EXPECT_EQ(particles.interface, (std::vector<std::uint32_t>{0, 0, 1}));
  EXPECT_EQ(count_by_order(particles.interface, table), (std::array<std::int64_t, 3>{0, 0, 3}));
}

TEST(HostParticles, SomeAreSelected) {
  const HostParticles some = select(in_a_row(5), std::vector<std::uint32_t>{3, 0});
  EXPECT_EQ(xs(some), (std::vector<float>{3, 0}));
  EXPECT_EQ(some.direction[0].w, 3);
  EXPECT_EQ(some.interface.size(), 2u);
}

TEST(HostParticles, AreTheSameInOnePositionOnOneInterface) {
  const HostParticles before = in_a_row(5);
  HostParticles now = select(before, std::vector<std::uint32_t>{4, 0, 1, 2});
  now.position[1].x += 0.25f;  // moved
  now.interface[2] += 1;       // on another interface
  EXPECT_EQ(same_particles(before, now), (std::vector<std::uint32_t>{4, none, none, 2}));
  now.position[0] = now.position[3], now.interface[0] = now.interface[3];
  EXPECT_EQ(same_particles(before, now), std::vector<std::uint32_t>(4, none)) << "two in one position are neither";
  EXPECT_TRUE(same_particles(before, {}).empty());
}

TEST(HostParticles, AreDescribedInTheWorld) {
  const VolumeFrame frame = tilted_frame();
  const std::vector<Junction> interfaces{{2, 5}};
  const MeshParticles told = describe_particles(in_a_row(2), make_junction_table(interfaces, {}), frame);
  EXPECT_EQ(told.points[1], frame.to_world({1, 0, 0}));
  EXPECT_EQ(told.size[1], 0.5f) << "the smallest spacing is the unit";
  EXPECT_EQ(told.energy[1], 1);
  EXPECT_EQ(told.normal[1], Vec3f(0, 0, -1));
  EXPECT_EQ(told.order[1], 2);
  EXPECT_EQ(told.materials[1], (std::array<std::uint16_t, 4>{2, 5, 0xffff, 0xffff}));
}

TEST(VolumeFrame, IndicesVoxelsAndTheWorldAgree) {
  const VolumeFrame frame = tilted_frame();
  EXPECT_EQ(index_to_world({0, 0, 0}, frame.origin, frame.spacing, frame.axes), frame.origin);
  EXPECT_EQ(index_to_world({2, 1, 3}, frame.origin, frame.spacing, frame.axes), Vec3d(3 - 0.8, -4 + 1, 5 - 6));
  const Vec3d index = world_to_index({3 - 0.8, -4 + 1, 5 - 6}, frame.origin, frame.spacing, frame.axes);
  EXPECT_LT(length(index - Vec3d(2, 1, 3)), 1e-14);
  // Voxels are cubes with the edge of the smallest spacing: an index along z is four of them.
  const Vec3d padding(volume_padding + 0.5);
  const Vec3d world = frame.to_world((Vec3d(2, 1, 3) + padding) * Vec3d(1, 1.6, 4));
  EXPECT_LT(length(world - Vec3d(3 - 0.8, -4 + 1, 5 - 6)), 1e-14);
  const Vec3d p(3.25, 17.5, 40);
  EXPECT_LT(length(frame.to_voxels(frame.to_world(p)) - p), 1e-12);
  EXPECT_LT(length(frame.voxel_frame().to_world(p) - frame.to_world(p)), 1e-12);
}

}  // namespace
}  // namespace nacre
