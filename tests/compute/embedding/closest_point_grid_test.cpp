// Nacre: the closest-point grid on the CPU, and how its cells are addressed.
#include <cstring>

#include "compute/device/executor_cpu.hpp"
#include "tests/compute/embedding/closest_point_grid_body.hpp"

namespace nacre::test {
namespace {

TEST(Divider, FloorsWhateverTheDivisor) {
  for (int d = 1; d <= 16; ++d) {
    const Divider divide(d);
    for (int i = -100; i < 1 << 20; i += i < 5000 ? 1 : 7)
      ASSERT_EQ(divide(i), i >= 0 ? i / d : -((-i + d - 1) / d)) << i << " / " << d;
    for (int i = (1 << 20) - 50; i < 1 << 20; ++i) ASSERT_EQ(divide(i), i / d) << i << " / " << d;
  }
}

TEST(ClosestPointGrid, AddressesAndCellsAreInverse) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  for (const int sub : {3, 4, 5, 8}) {
    const HostGrid grid(embed(exec, sphere({20, 20, 20}, 17, 12), 40, sub));
    for (std::uint32_t at = 0; at < grid.offset.size(); ++at) ASSERT_EQ(grid.view.address(grid.view.cell(at)), at);
    EXPECT_EQ(grid.view.address({-1, 0, 0}), none);
    EXPECT_EQ(grid.view.address({0, 0, grid.view.dims().z}), none);
    EXPECT_EQ(grid.view.address({20, 20, 20}), none);  // the middle of the sphere is far from its surface
  }
}

TEST(ClosestPointGrid, OneThreadAndManyGiveTheSameBytes) {
  Mesh mesh = soup(300, 6, 20, 1.5, 31);
  mesh.add(sphere({12.5, 12.5, 12.5}, 5, 16));
  std::vector<Float4> offsets[2];
  std::vector<std::uint32_t> triangles[2], touches[2];
  for (const int k : {0, 1}) {
    const auto device = make_cpu_device(k ? 4 : 1);
    Executor<Cpu> exec(*device);
    const HostGrid grid(embed(exec, mesh, 26));
    offsets[k] = grid.offset;
    triangles[k] = grid.triangle;
    touches[k] = grid.touch_triangle;
  }
  ASSERT_EQ(offsets[0].size(), offsets[1].size());
  EXPECT_EQ(std::memcmp(offsets[0].data(), offsets[1].data(), offsets[0].size() * sizeof(Float4)), 0);
  EXPECT_EQ(triangles[0], triangles[1]);
  EXPECT_EQ(touches[0], touches[1]);
}

TEST(ClosestPointGrid, TwoEqualTrianglesAreTheFirst) {
  const auto device = make_cpu_device();
  Executor<Cpu> exec(*device);
  Mesh mesh = sheet({6.3, 6.2, 8.1}, {6, 0, 0}, {0, 6, 1}, 3);
  const auto n = std::uint32_t(mesh.triangles.size());
  mesh.add(Mesh(mesh));
  const HostGrid grid(embed(exec, mesh, 18));
  for (std::uint32_t at = 0; at < grid.offset.size(); ++at)
    ASSERT_TRUE(grid.offset[at].w > band || grid.triangle[at] < n);
}

}  // namespace
}  // namespace nacre::test
