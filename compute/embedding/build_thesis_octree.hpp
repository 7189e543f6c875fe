// Nacre: the thesis's closest-point sparse octree, bottom-up (sec. 6.1.3): the yardstick for the brick octree.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/thesis_cells.hpp"
#include "compute/embedding/thesis_octree.hpp"

namespace nacre {

/// The thesis octree and who owns its arrays. Per cell it takes 20 bytes, about 7 of nodes, 1/8 of flags, and with the
/// neighbour index 24 more.
struct ThesisOctree {
  int levels = 0;
  double radius = 0;
  std::uint64_t cells = 0, touched_cells = 0;  ///< in the band; those that a triangle touches
  Array<std::uint64_t> code;
  Array<CellPoint> point;
  Array<std::uint32_t> touched;
  Array<ThesisNode> node;
  std::vector<std::uint32_t> height_start;  ///< on the host: first node of each height, and how many there are
  Array<std::uint32_t> neighbour;

  ThesisOctreeView view() const {
    ThesisOctreeView view;
    view.levels = levels;
    view.radius = float(radius);
    view.quantum = CellPoint::quantum(radius);
    view.root = node.size() ? std::uint32_t(node.size() - 1) : none;
    view.cells = view.surface_cells = cells;
    view.code = code.data();
    view.point = point.data();
    view.node = node.data();
    view.neighbour = neighbour.data();
    view.touched = touched.data();
    return view;
  }

  std::uint64_t bytes() const {
    return code.bytes() + point.bytes() + touched.bytes() + node.bytes() + neighbour.bytes();
  }
};

namespace detail {

/// Whether something begins another node than the one before it did.
struct NodeHead {
  const std::uint64_t* code;
  std::uint32_t* head;
  NACRE_HD void operator()(std::int64_t i) const { head[i] = i == 0 || code[i] >> 3 != code[i - 1] >> 3 ? 1 : 0; }
};

/// Enters something in the node above it.
struct AddToNode {
  std::int64_t count;
  std::uint32_t nodes;  // at this height
  std::uint32_t first;  // number of the thing with index 0
  const std::uint64_t* code;
  const std::uint32_t* number;  // exclusive scan of the heads
  ThesisNode* node;             // of this height
  std::uint64_t* node_code;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t at = (i + 1 < count ? number[i + 1] : nodes) - 1;
    node[at].child[code[i] & 7] = first + std::uint32_t(i);
    if (number[i] == at) node_code[at] = code[i] >> 3;
  }
};

struct FindCellNeighbours {
  ThesisOctreeView tree;
  std::uint32_t* neighbour;
  NACRE_HD void operator()(std::int64_t i) const {
    const Int3 position = morton_cell(tree.code[i]);
    for (int k = 0; k < 6; ++k) {
      Int3 beside = position;
      beside[k / 2] += k % 2 ? 1 : -1;
      neighbour[6 * i + k] = tree.locate(beside);
    }
  }
};

/// Puts nodes over the cells, height by height. The thesis streams the keys through one queue of eight per level
/// on the CPU; a queue that fills up is a node. All queues of a level at once are what a flag and a scan over the keys
/// give, and the same nodes come out in the same order. What is empty does not appear, whatever its size.
template <class Backend>
void build_thesis_nodes(Executor<Backend>& exec, ThesisOctree& tree) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  tree.node = arena.permanent<ThesisNode>(0);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(tree.cells);
  Array<std::uint64_t> code = tree.code;
  std::uint64_t total = 0;
  std::uint32_t first = 0;  // number of the lower height's first thing
  for (int height = 0; height < tree.levels + 3; ++height) {
    const auto count = std::int64_t(code.size());
    exec.for_each(count, NodeHead{code.data(), number.data()});
    const std::uint32_t nodes = exec.exclusive_scan(number.data(), number.data(), count);
    if (total + nodes >= none)
      throw Error("the grid is too fine for `octree` source", "over 2^32 nodes",
                  "lower `resolution`, or use `octree` brick");
    arena.resize_last(tree.node, total + nodes);
    arena.device().fill(tree.node.data() + total, 0xff, nodes * sizeof(ThesisNode));
    Array<std::uint64_t> node_code = arena.temporary<std::uint64_t>(nodes);
    exec.for_each(
        count, AddToNode{count, nodes, first, code.data(), number.data(), tree.node.data() + total, node_code.data()});
    code = node_code;
    first = std::uint32_t(total);
    tree.height_start.push_back(first);
    total += nodes;
  }
  tree.height_start.push_back(std::uint32_t(total));
}

}  // namespace detail

/// Builds the thesis octree around `triangles` triangles (points in cells) in a domain of 8 << levels cells per axis,
/// 0 <= levels <= 17: every cell whose centre lies within `radius` cells of a triangle, as in `find_source_cells`,
/// under nodes built from the bottom. With `neighbour_index`, each cell gets the numbers of its six neighbours, by a
/// walk each (sec. 6.1.4); all 26 would take 104 bytes per cell instead of 24, to save a step or two of those across
/// edges and corners. Arrays are permanent in the executor's arena. Throws Error when they do not fit, no cell is in
/// the band, or cells pass 2^32.
template <class Backend>
ThesisOctree build_thesis_octree(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                                 double radius, bool neighbour_index, const ThesisSubgrids& subgrids = {}) {
  if (levels < 0 || levels > 17)
    throw Error("the octree cannot have this resolution", "2^" + std::to_string(levels + 3) + " cells per axis",
                "use 8 to 1048576");
  if (!(radius > 0 && radius <= 1000))
    throw Error("the band cannot have this radius", std::to_string(radius) + " cells", "use one above 0, up to 1000");
  const ThesisCells cells = find_thesis_cells(exec, mesh, triangles, levels, radius, subgrids);
  ThesisOctree tree;
  tree.levels = levels;
  tree.radius = radius;
  tree.cells = cells.count;
  tree.touched_cells = cells.touched_count;
  tree.code = cells.code;
  tree.point = cells.point;
  tree.touched = cells.touched;
  detail::build_thesis_nodes(exec, tree);
  if (neighbour_index) {
    Array<std::uint32_t> neighbour = exec.arena().template permanent<std::uint32_t>(6 * tree.cells);
    exec.for_each(std::int64_t(tree.cells), detail::FindCellNeighbours{tree.view(), neighbour.data()});
    tree.neighbour = neighbour;
  }
  return tree;
}

}  // namespace nacre
