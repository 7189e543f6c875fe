// Nacre: the brick octree on the CPU, what it refuses, and that threads do not change it.
#include <cstring>
#include <limits>

#include "compute/device/executor_cpu.hpp"
#include "tests/compute/embedding/brick_octree_body.hpp"
#include "tests/compute/embedding/brick_octree_tree_body.hpp"

namespace nacre::test {
namespace {

using namespace brick_octree_bodies;

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(BrickOctree, OneThreadAndManyGiveTheSameBytes) {
  const auto one = make_cpu_device(1), many = make_cpu_device(4);
  Executor<Cpu> first(*one), second(*many);
  const HostBrickOctree a = brick_octree(first, tree_mesh(), 3, 4.47), b = brick_octree(second, tree_mesh(), 3, 4.47);
  EXPECT_TRUE(same_bytes(a.point, b.point));
  EXPECT_TRUE(same_bytes(a.brick, b.brick));
  EXPECT_TRUE(same_bytes(a.node, b.node));
  EXPECT_EQ(a.neighbour, b.neighbour);
  EXPECT_EQ(a.list, b.list);
}

TEST(BrickOctree, BadInputIsAnError) {
  const auto device = make_cpu_device(1);
  Executor<Cpu> exec(*device);
  const Mesh good = sphere({15.3, 15.1, 14.8}, 8, 6);
  EXPECT_THROW(brick_octree(exec, good, 18, 3), Error);
  EXPECT_THROW(brick_octree(exec, good, -1, 3), Error);
  EXPECT_THROW(brick_octree(exec, good, 2, 0.9), Error);
  EXPECT_THROW(brick_octree(exec, good, 2, std::nan("")), Error);
  EXPECT_THROW(brick_octree(exec, Mesh{}, 2, 3), Error);
  EXPECT_THROW(brick_octree(exec, sphere({150, 15, 15}, 8, 6), 2, 3), Error);
  EXPECT_NO_THROW(brick_octree(exec, good, 2, 3));
}

TEST(BrickOctree, TrianglesThatAreNoNumbersAreNotThere) {
  const auto device = make_cpu_device(1);
  Executor<Cpu> exec(*device);
  Mesh mesh = sphere({15.3, 15.1, 14.8}, 8, 6);
  const HostBrickOctree good = brick_octree(exec, mesh, 2, 3);
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  mesh.add(Corners{{nan, 4, 4}, {5, 5, 5}, {4, 6, 4}});
  mesh.add(Corners{{inf, 14, 14}, {15, 15, 15}, {14, 16, 14}});
  mesh.add(Corners{{-inf, nan, inf}, {0.5, 0.5, 0.5}, {0.6, 0.5, nan}});
  const HostBrickOctree same = brick_octree(exec, mesh, 2, 3);
  EXPECT_TRUE(same_bytes(good.point, same.point));
  EXPECT_EQ(good.list, same.list);
}

TEST(BrickOctree, AMeshThatDoesNotFitIsAnError) {
  const auto device = make_cpu_device(1);
  Executor<Cpu> exec(*device);
  Mesh mesh;  // some 2^33 bricks
  mesh.add(Corners{{10, 10, 9}, {1e6, 20, 11}, {10, 1e6, 12}});
  EXPECT_THROW(brick_octree(exec, mesh, 17, 3), Error);
}

TEST(BrickOctree, StopsWhenAsked) {
  const auto device = make_cpu_device(1);
  Executor<Cpu> exec(*device);
  std::atomic<bool> stop = true;
  exec.watch(&stop);
  EXPECT_THROW(brick_octree(exec, sphere({15.3, 15.1, 14.8}, 8, 6), 2, 3), Interrupted);
}

}  // namespace
}  // namespace nacre::test
