// Nacre: the boxes that an embedding consists of, as Morton codes for a renderer: level after level from the largest.
#pragma once

#include <cstdint>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/build_brick_octree.hpp"
#include "compute/embedding/build_closest_point_grid.hpp"
#include "compute/embedding/build_thesis_octree.hpp"

namespace nacre {

namespace detail {

/// Codes of a node's children from its own.
struct CodesBelow {
  const OctreeNode* node;  // of a level
  const std::uint64_t* code;
  std::uint64_t* below;  // of the next level
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t* out = below + node[i].first;
    for (unsigned child = 0; child < 8; ++child)
      if (node[i].children >> child & 1) *out++ = code[i] << 3 | child;
  }
};

struct ThesisCodesBelow {
  const ThesisNode* node;  // of a height
  std::uint32_t first;     // number of the first node of the height below
  const std::uint64_t* code;
  std::uint64_t* below;
  NACRE_HD void operator()(std::int64_t i) const {
    for (unsigned child = 0; child < 8; ++child)
      if (const std::uint32_t at = node[i].child[child]; at != none) below[at - first] = code[i] << 3 | child;
  }
};

struct CopyCodes {
  const std::uint64_t* from;
  std::uint64_t* to;
  NACRE_HD void operator()(std::int64_t i) const { to[i] = from[i]; }
};

}  // namespace detail

/// Number of the first box of each level, and at the end of all boxes: nodes from the root down, then bricks.
inline std::vector<std::uint64_t> box_levels(const BrickOctree& tree) {
  const std::vector<std::uint32_t> nodes = tree.nodes.level_start.download();
  std::vector<std::uint64_t> start(nodes.begin(), nodes.end());
  start.push_back(start.back() + tree.brick_count);
  return start;
}

/// The same for the thesis octree: nodes down to those of 2^3 cells. Cells are not boxes of their own.
inline std::vector<std::uint64_t> box_levels(const ThesisOctree& tree) {
  std::vector<std::uint64_t> start{0};
  for (std::size_t height = tree.height_start.size() - 1; height > 0; --height)
    start.push_back(start.back() + tree.height_start[height] - tree.height_start[height - 1]);
  return start;
}

/// The bricks of a grid are all of one size.
inline std::vector<std::uint64_t> box_levels(const ClosestPointGrid& grid) { return {0, grid.brick_count}; }

/// Writes the codes of all boxes in the order of `box_levels`, each among cubes of its size, to memory of the device.
template <class Backend>
void write_boxes(Executor<Backend>& exec, const BrickOctree& tree, std::uint64_t* memory) {
  const std::vector<std::uint64_t> start = box_levels(tree);
  exec.device().fill(memory, 0, sizeof(std::uint64_t));  // the root
  for (int l = 0; l < tree.levels; ++l)
    exec.for_each(std::int64_t(start[l + 1] - start[l]),
                  detail::CodesBelow{tree.nodes.node.data() + start[l], memory + start[l], memory + start[l + 1]});
}

template <class Backend>
void write_boxes(Executor<Backend>& exec, const ThesisOctree& tree, std::uint64_t* memory) {
  const std::vector<std::uint64_t> start = box_levels(tree);
  const std::vector<std::uint32_t>& number = tree.height_start;
  exec.device().fill(memory, 0, sizeof(std::uint64_t));
  for (std::size_t l = 0, height = number.size() - 2; height > 0; ++l, --height)
    exec.for_each(std::int64_t(start[l + 1] - start[l]),
                  detail::ThesisCodesBelow{tree.node.data() + number[height], number[height - 1], memory + start[l],
                                           memory + start[l + 1]});
}

template <class Backend>
void write_boxes(Executor<Backend>& exec, const ClosestPointGrid& grid, std::uint64_t* memory) {
  exec.for_each(std::int64_t(grid.brick_count), detail::CopyCodes{grid.brick_code.data(), memory});
}

}  // namespace nacre
