// Nacre: the linear octree above sorted bricks, and the neighbours of each brick.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/code_lists.hpp"

namespace nacre {

namespace detail {

/// Makes a node from the run of its children's codes.
struct WriteNode {
  const std::uint64_t* child;  // codes
  const std::uint64_t* start;
  OctreeNode* node;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint32_t children = 0;
    for (std::uint64_t k = start[i]; k < start[i + 1]; ++k) children |= 1u << (child[k] & 7);
    node[i] = {std::uint32_t(start[i]), children};
  }
};

/// Finds the 13 neighbours that come first among a brick's 26, and enters the brick in theirs, too. A neighbour is
/// mostly near in Morton order, so the search starts at the brick and doubles its steps.
struct FindBrickNeighbours {
  int levels;
  std::uint32_t count;
  const std::uint64_t* code;
  std::uint32_t* neighbour;

  NACRE_HD void operator()(std::int64_t i) const {
    const auto self = std::uint32_t(i);
    const Int3 position = morton_cell(code[self]);
    const unsigned bricks = 1u << levels;
    neighbour[27 * std::size_t(self) + 13] = self;
    for (int k = 0; k < 13; ++k) {
      const Int3 p = position + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (unsigned(p.x) >= bricks || unsigned(p.y) >= bricks || unsigned(p.z) >= bricks) continue;
      const std::uint32_t other = find(morton(p), self);
      if (other == none) continue;
      neighbour[27 * std::size_t(self) + k] = other;
      neighbour[27 * std::size_t(other) + 26 - k] = self;
    }
  }

  NACRE_HD std::uint32_t find(std::uint64_t wanted, std::uint32_t from) const {
    std::uint64_t low = from, high = from, step = 1;  // code[low] <= wanted < code[high], if inside
    if (wanted >= code[from]) {
      while (high < count && code[high] <= wanted) low = high, high += step, step *= 2;
    } else {
      while (low > 0 && code[low] > wanted) high = low, low = low > step ? low - step : 0, step *= 2;
      if (code[low] > wanted) return none;
    }
    high = high < count ? high : count;
    while (high - low > 1) {
      const std::uint64_t middle = (low + high) / 2;
      if (code[middle] <= wanted)
        low = middle;
      else
        high = middle;
    }
    return code[low] == wanted ? std::uint32_t(low) : none;
  }
};

}  // namespace detail

/// Nodes over bricks, level after level from the root; permanent arrays.
struct OctreeNodes {
  Array<OctreeNode> node;
  Array<std::uint32_t> level_start;  ///< levels + 1 entries
};

/// Builds the levels from the lowest to the root: one node for each run of codes that differ only in their last three
/// bits.
template <class Backend>
OctreeNodes build_octree_nodes(Executor<Backend>& exec, const Array<std::uint64_t>& brick_code, int levels) {
  Arena& arena = exec.arena();
  OctreeNodes nodes;
  Arena::Scope scope(arena);
  std::vector<CodeRuns> level(levels);
  const Array<std::uint64_t>* child = &brick_code;
  for (int l = levels - 1; l >= 0; --l) {
    level[l] = runs_of(exec, child->data(), child->size(), 3);
    child = &level[l].code;
  }
  std::vector<std::uint32_t> start(levels + 1, 0);
  std::uint64_t total = 0;
  for (int l = 0; l < levels; ++l) {
    total += level[l].count;
    if (total >= none) throw Error("the grid is too fine", "over 2^32 nodes", "lower the resolution");
    start[l + 1] = std::uint32_t(total);
  }
  nodes.node = arena.permanent<OctreeNode>(total);
  nodes.level_start = arena.permanent_copy<std::uint32_t>(start);
  for (int l = 0; l < levels; ++l)
    exec.for_each(level[l].count, detail::WriteNode{(l + 1 < levels ? level[l + 1].code : brick_code).data(),
                                                    level[l].start.data(), nodes.node.data() + start[l]});
  return nodes;
}

/// 27 per brick: see BrickOctreeView::neighbour. Permanent.
template <class Backend>
Array<std::uint32_t> find_brick_neighbours(Executor<Backend>& exec, const Array<std::uint64_t>& brick_code,
                                           int levels) {
  Array<std::uint32_t> neighbour = exec.arena().template permanent<std::uint32_t>(27 * brick_code.size());
  neighbour.fill_bytes(0xff);
  exec.for_each(std::int64_t(brick_code.size()), detail::FindBrickNeighbours{levels, std::uint32_t(brick_code.size()),
                                                                             brick_code.data(), neighbour.data()});
  return neighbour;
}

}  // namespace nacre
