// Nacre: the tree of particles on the CPU.
#include "compute/device/executor_cpu.hpp"
#include "tests/compute/particles/tree_body.hpp"

namespace nacre::test {
namespace {

/// A device that keeps the sizes of levels to itself builds the tree by launches for the most that they can be; the
/// other one by their sizes.
TEST(Tree, IsTheSameWhetherSizesAreKnownOrNot) {
  const auto near = make_cpu_device(), remote = make_cpu_device(0, true);
  Executor<Cpu> known(*near), unknown(*remote);
  EXPECT_EQ(known.known([] { return 3; }, 7), 3);
  EXPECT_EQ(unknown.known([] { return 3; }, 7), 7);
  for (const int count : {0, 20, 300, 20000}) {
    const TreeCase c = graded_case(count);
    TreeRun<Cpu> a(known, c), b(unknown, c);
    const std::vector<TreeNode> nodes = nodes_of(a), others = nodes_of(b);
    ASSERT_EQ(nodes.size(), others.size()) << count;
    EXPECT_GT(nodes.size(), count > 1000 ? 1000u : 2u);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const TreeNode &m = nodes[k], &n = others[k];
      ASSERT_EQ(m.first, n.first) << k;
      ASSERT_EQ(m.last, n.last) << k;
      ASSERT_EQ(m.child, n.child) << k;
      ASSERT_EQ(m.children, n.children) << k;
    }
    EXPECT_EQ(leaves_of(a), leaves_of(b)) << count;
  }
}

}  // namespace
}  // namespace nacre::test
