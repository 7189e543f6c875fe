// Nacre: the thesis octree on the CPU, its nodes against the thesis's queues, and its look-ups.
#include <optional>
#include <set>

#include "compute/device/executor_cpu.hpp"
#include "compute/embedding/build_brick_octree.hpp"
#include "tests/compute/embedding/thesis_octree_body.hpp"

namespace nacre::test {
namespace {

using namespace thesis_octree_bodies;

/// The streaming construction as the source has it (sec. 6.1.3): keys go into the lowest queue, which is a node once it
/// holds eight, and whose parent then goes into the queue above. A run of empty keys that fills whole queues goes into
/// the queue above at once.
class StreamingOctree {
 public:
  explicit StreamingOctree(int depth) : queue_(depth), node_(depth) {}

  void add(std::uint64_t code, std::uint32_t number) {
    skip_to(code);
    push(0, number);
    ++next_;
  }

  /// The nodes, lowest first, numbered through.
  std::vector<ThesisNode> finish() {
    skip_to(std::uint64_t(1) << 3 * queue_.size());
    std::vector<ThesisNode> all;
    std::uint32_t below = 0;
    for (std::size_t height = 0; height < node_.size(); ++height) {
      const auto first = std::uint32_t(all.size());
      for (ThesisNode n : node_[height]) {
        for (std::uint32_t& c : n.child)
          if (c != none) c += below;
        all.push_back(n);
      }
      below = first;
    }
    return all;
  }

  std::size_t empty_keys = 0;  ///< that were pushed, at whatever height

 private:
  void push(std::size_t height, std::uint32_t what) {
    std::vector<std::uint32_t>& queue = queue_[height];
    queue.push_back(what);
    if (queue.size() < 8) return;
    std::uint32_t parent = none;
    if (std::any_of(queue.begin(), queue.end(), [](std::uint32_t c) { return c != none; })) {
      ThesisNode n;
      std::copy(queue.begin(), queue.end(), n.child);
      parent = std::uint32_t(node_[height].size());
      node_[height].push_back(n);
    }
    queue.clear();
    if (height + 1 < queue_.size()) push(height + 1, parent);
  }

  void skip_to(std::uint64_t code) {
    while (next_ < code) {
      std::size_t height = 0;
      auto fits = [&](std::size_t h) {
        const std::uint64_t width = std::uint64_t(1) << 3 * h;
        return next_ % width == 0 && width <= code - next_;
      };
      while (height + 1 < queue_.size() && fits(height + 1)) ++height;
      push(height, none);
      ++empty_keys;
      next_ += std::uint64_t(1) << 3 * height;
    }
  }

  std::vector<std::vector<std::uint32_t>> queue_;
  std::vector<std::vector<ThesisNode>> node_;
  std::uint64_t next_ = 0;
};

std::vector<ThesisNode> streamed(const std::vector<std::uint64_t>& codes, int levels) {
  StreamingOctree stream(levels + 3);
  for (std::size_t i = 0; i < codes.size(); ++i) stream.add(codes[i], std::uint32_t(i));
  const std::vector<ThesisNode> nodes = stream.finish();
  EXPECT_LE(stream.empty_keys, 14 * (codes.size() + 1) * std::size_t(levels + 3));  // 7 per level up, and down again
  return nodes;
}

class ThesisOctreeTest : public ::testing::Test {
 protected:
  ThesisOctreeTest() : device(make_cpu_device(2)), exec(*device) {}
  std::unique_ptr<Device> device;
  Executor<Cpu> exec;
};

/// The nodes that the device makes of these cells.
ThesisOctree nodes_over(Executor<Cpu>& exec, const std::vector<std::uint64_t>& codes, int levels) {
  ThesisOctree tree;
  tree.levels = levels;
  tree.cells = codes.size();
  tree.code = exec.arena().permanent_copy<std::uint64_t>(codes);
  detail::build_thesis_nodes(exec, tree);
  return tree;
}

TEST_F(ThesisOctreeTest, NodesByHand) {
  const ThesisOctree tree = nodes_over(exec, {0, 1, 9}, 0);
  const std::vector<std::uint32_t> expected{0,    1,    none, none, none, none, none, none,   // cells 0x0, 0x1
                                            none, 2,    none, none, none, none, none, none,   // cell 0x9
                                            0,    1,    none, none, none, none, none, none,   //
                                            2,    none, none, none, none, none, none, none};  // root
  EXPECT_EQ(children(tree.node.download()), expected);
  EXPECT_EQ(tree.view().root, 3u);
}

TEST_F(ThesisOctreeTest, NodesAreThoseOfTheQueues) {
  Random random(51);
  for (const int levels : {0, 1, 3, 9, 17}) {
    const std::uint64_t last = (std::uint64_t(1) << 3 * (levels + 3)) - 1;
    std::set<std::uint64_t> codes{0, last};
    for (int k = 0; k < 300; ++k) {
      const auto c = std::uint64_t(random() * double(last));
      for (std::uint64_t j = 0; j < 12 && c + j <= last; j += 1 + k % 3) codes.insert(c + j);
    }
    const std::vector<std::uint64_t> sorted(codes.begin(), codes.end());
    const ThesisOctree tree = nodes_over(exec, sorted, levels);
    EXPECT_EQ(children(tree.node.download()), children(streamed(sorted, levels))) << levels;
    exec.arena().rewind(0);
  }
  const HostThesisOctree tree(thesis_octree_of(exec, torus({63, 65, 62}, 40, 12, 20), 4));
  EXPECT_EQ(children(tree.node), children(streamed(tree.code, 4)));
}

TEST_F(ThesisOctreeTest, FindsItsCellsAndNoOthers) {
  const HostThesisOctree tree(thesis_octree_of(exec, torus({31, 33, 30}, 17, 6, 16), 3));
  ASSERT_TRUE(std::adjacent_find(tree.code.begin(), tree.code.end(), std::greater_equal<>()) == tree.code.end());
  const std::set<std::uint64_t> stored(tree.code.begin(), tree.code.end());
  ThesisOctreeView::Cursor cursor(tree.view);
  std::size_t found = 0;
  for (int z = -2; z < 66; ++z)
    for (int y = -2; y < 66; ++y)
      for (int x = -2; x < 66; ++x) {
        const bool inside = x >= 0 && y >= 0 && z >= 0 && x < 64 && y < 64 && z < 64;
        const CellIndex c = cursor.find({x, y, z});
        ASSERT_EQ(c != no_cell, inside && stored.count(morton({x, y, z})) == 1) << x << " " << y << " " << z;
        if (c == no_cell) continue;
        ASSERT_EQ(tree.code[c], morton({x, y, z}));
        ++found;
      }
  EXPECT_EQ(found, tree.code.size());
  for (const Int3 far : {Int3(1 << 20, 0, 0), Int3(-(1 << 30), 5, 5), Int3(5, 5, 1 << 30)})
    EXPECT_EQ(cursor.find(far), no_cell);
}

TEST_F(ThesisOctreeTest, NeighbourIndexAgreesWithWalks) {
  Mesh mesh = soup(60, 2, 62, 14, 61);
  mesh.add(sheet({-3, -3, 1.2}, {70, 0, 0}, {0, 70, 3}, 1));  // along the edge of the domain
  const HostThesisOctree tree(thesis_octree_of(exec, mesh, 3, true, 1.7));
  ThesisOctreeView plain = tree.view;
  plain.neighbour = nullptr;
  ASSERT_EQ(tree.neighbour.size(), 6 * tree.code.size());
  for (std::size_t c = 0; c < tree.code.size(); ++c)
    for (int k = 0; k < 6; ++k) {
      Int3 beside = morton_cell(tree.code[c]);
      beside[k / 2] += k % 2 ? 1 : -1;
      ASSERT_EQ(tree.neighbour[6 * c + k], plain.locate(beside));
    }
  Random random(62);
  ThesisOctreeView::Cursor walking(plain), stepping(tree.view);
  Int3 at(32, 32, 2);
  std::size_t found = 0, partly = 0;
  for (int k = 0; k < 200'000; ++k) {
    const int reach = k % 50 == 0 ? 20 : 1;
    for (int axis = 0; axis < 3; ++axis)
      at[axis] = std::clamp(at[axis] + int(std::floor(random.between(-reach, reach + 1))), -2, 65);
    const CellIndex expected = walking.find(at);
    ASSERT_EQ(stepping.find(at), expected);
    found += expected != no_cell;
    CellIndex eight[2][8];
    const unsigned there = walking.eight(at, eight[0]);
    ASSERT_EQ(stepping.eight_surface(at, eight[1]), there);
    partly += there != 0 && there != 255;
    for (int j = 0; j < 8; ++j) {
      ASSERT_EQ(eight[0][j], eight[1][j]);
      ASSERT_EQ(eight[0][j] != no_cell, (there >> j & 1) == 1);
    }
  }
  EXPECT_GT(found, 10'000u);
  EXPECT_GT(partly, 10'000u);
}

TEST_F(ThesisOctreeTest, InTheFarCornerOfTheLargestDomain) {
  const double far = (1 << 20) - 12;
  Mesh mesh;
  for (const Vec3d& corner : {Vec3d(4.3, 5.1, 6.2), Vec3d(far + 0.3, far + 0.2, far + 1.1)})
    mesh.add(Corners{corner, corner + Vec3d(3, 0.5, 0), corner + Vec3d(0, 2, 2.5)});
  const HostThesisOctree tree(thesis_octree_of(exec, mesh, 17, true));
  const BruteForce brute(mesh.points, mesh.triangles);
  ThesisFaults faults;
  const int high = 1 << 20;
  for (const int low : {0, high - 24})
    for (int z = low; z < low + 24; ++z)
      for (int y = low; y < low + 24; ++y)
        for (int x = low; x < low + 24; ++x) check_cell(tree, brute, {x, y, z}, faults);
  EXPECT_EQ(faults.stored, tree.code.size());
  EXPECT_GT(faults.stored, 1500u);
  EXPECT_EQ(faults.missing + faults.extra + faults.wrong_point + faults.wrong_triangle + faults.wrong_touch, 0u);
}

TEST_F(ThesisOctreeTest, OneThreadAndManyGiveTheSame) {
  Mesh mesh = soup(300, 6, 58, 3, 31);
  mesh.add(sphere({32.5, 31.5, 30.5}, 14, 16));
  mesh.add(Mesh(mesh));  // ties everywhere: the lower triangle
  const auto n = std::uint32_t(mesh.triangles.size() / 2);
  std::optional<HostThesisOctree> trees[2];
  for (const int k : {0, 1}) {
    const auto other = make_cpu_device(k ? 4 : 1);
    Executor<Cpu> on(*other);
    trees[k].emplace(thesis_octree_of(on, mesh, 3, true));
  }
  expect_same(*trees[0], *trees[1], "threads");
  for (const CellPoint& p : trees[0]->point) ASSERT_LT(p.triangle, n);
}

TEST_F(ThesisOctreeTest, BytesPerCell) {
  const ThesisOctree tree = thesis_octree_of(exec, torus({63, 65, 62}, 40, 15, 60), 4, true);
  const HostThesisOctree host(tree);
  std::size_t touched = 0;
  for (CellIndex c = 0; c < tree.cells; ++c) touched += host.view.touches(c);
  EXPECT_EQ(touched, tree.touched_cells);
  const double nodes = double(tree.node.bytes()) / double(tree.cells);
  const double all = double(tree.bytes()) / double(tree.cells);
  RecordProperty("nodes_bytes_per_cell", std::to_string(nodes));
  RecordProperty("bytes_per_cell", std::to_string(all));
  EXPECT_NEAR(all, 8 + 12 + 24 + 1.0 / 8 + nodes, 0.01);
  EXPECT_LT(nodes, 7);
  // A band this thick around 40 x 15 cells of torus: 4 pi^2 R r times twice the radius, but for its facets.
  EXPECT_NEAR(double(tree.cells), 4 * pi * pi * 40 * 15 * 2 * source_radius, 0.01 * double(tree.cells));
}

TEST_F(ThesisOctreeTest, BadWishesAreErrors) {
  const Mesh mesh = sphere({15, 15, 15}, 8, 6);
  EXPECT_THROW(thesis_octree_of(exec, mesh, 18), Error);
  EXPECT_THROW(thesis_octree_of(exec, mesh, -1), Error);
  for (const double radius : {0.0, -1.0, 1001.0, std::nan("")})
    EXPECT_THROW(thesis_octree_of(exec, mesh, 2, false, radius), Error);
  EXPECT_THROW(thesis_octree_of(exec, sphere({500, 500, 500}, 8, 6), 2), Error);        // nothing in the domain
  EXPECT_THROW(thesis_octree_of(exec, mesh, 2, false, source_radius, {64, 1}), Error);  // not even one cell's list fits
}

TEST_F(ThesisOctreeTest, LittleMemoryMeansSmallerSubgridsThenAnError) {
  const Mesh mesh = torus({63, 65, 62}, 40, 12, 20);
  Arena& arena = exec.arena();
  const HostThesisOctree whole(thesis_octree_of(exec, mesh, 4));
  arena.rewind(0);
  std::size_t errors = 0, trees = 0;
  for (const std::size_t mib : {1, 2, 4, 8, 12, 16, 24}) {
    Arena::Scope scope(arena);
    arena.temporary<std::uint8_t>(arena.free_bytes() - (mib << 20) - 4096);
    try {
      expect_same(whole, HostThesisOctree(thesis_octree_of(exec, mesh, 4)), std::to_string(mib) + " MiB");
      ++trees;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("memory"), std::string::npos) << e.what();
      EXPECT_FALSE(e.advice().empty());
      EXPECT_EQ(trees, 0u) << mib;
      ++errors;
    }
    arena.rewind(0);
  }
  EXPECT_GT(errors, 0u);
  EXPECT_GT(trees, 1u);
}

/// Adds up what the brick octree says about each cell that the other one knows.
struct CompareCells {
  ThesisOctreeView source;
  float slack;
  std::uint32_t* count;  // compared, not found, of another point, of another touch
  NACRE_HD void operator()(CellIndex cell, const Int3& position, BrickOctreeView::Cursor& cursor,
                           const BrickOctreeView& bricks) const {
    ThesisOctreeView::Cursor walk(source);
    const CellIndex other = walk.find(position);
    atomic_add(count, 1u);
    if (other == no_cell) {
      atomic_add(count + 1, 1u);
      return;
    }
    const Vec3f a = bricks.point[cell].offset(bricks.quantum), b = source.point[other].offset(source.quantum);
    // Of a cell on the medial axis the two may name different points, just as far.
    if (std::fabs(length(a) - length(b)) > slack ||
        (length(a - b) > slack && bricks.point[cell].triangle == source.point[other].triangle))
      atomic_add(count + 2, 1u);
    if ((cursor.find_surface(position) != no_cell) != source.touches(other)) atomic_add(count + 3, 1u);
  }
};

struct CompareWithBricks {
  BrickOctreeView bricks;
  CompareCells compare;
  NACRE_HD void operator()(CellIndex cell, const Int3& position, BrickOctreeView::Cursor& cursor) const {
    compare(cell, position, cursor, bricks);
  }
};

TEST_F(ThesisOctreeTest, SameCellsAsBricks) {
  Mesh folded = sheet({20, 20, 60.1}, {80, 0, 0}, {0, 80, 0}, 8);
  folded.add(sheet({100, 20, 60.1}, {-80, 0, 1.4}, {0, 80, 0}, 8));
  const std::vector<Mesh> meshes{torus({63, 65, 62}, 40, 12, 20), folded, box({21, 21, 21}, {90, 80, 70}, 2),
                                 soup(10'000, 6, 122, 1.5, 71), soup(40, -20, 150, 60, 72)};
  for (std::size_t m = 0; m < meshes.size(); ++m)
    for (const double radius : {2.5, 5.0}) {
      const MeshView mesh = upload(exec, meshes[m]);
      const auto triangles = std::uint32_t(meshes[m].triangles.size());
      const ThesisOctree source = build_thesis_octree(exec, mesh, triangles, 4, radius, false);
      const BrickOctree bricks = build_brick_octree(exec, mesh, triangles, 4, radius);
      EXPECT_EQ(source.cells, bricks.cells) << m;
      EXPECT_EQ(source.touched_cells, bricks.surface_cells) << m;
      Array<std::uint32_t> count = exec.arena().permanent<std::uint32_t>(4);
      count.fill_bytes(0);
      for_each_cell(exec, bricks.view(), CompareWithBricks{bricks.view(), {source.view(), 1e-5f, count.data()}});
      const std::vector<std::uint32_t> expected{std::uint32_t(source.cells), 0, 0, 0};
      EXPECT_EQ(count.download(), expected) << m << ", radius " << radius;
      exec.arena().rewind(0);
    }
}

}  // namespace
}  // namespace nacre::test
