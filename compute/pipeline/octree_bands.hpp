// Nacre: the two octrees that flow runs on, and what is asked of either.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/device/error.hpp"
#include "compute/embedding/build_brick_octree.hpp"
#include "compute/embedding/build_thesis_octree.hpp"
#include "compute/flow/sample_band.hpp"
#include "compute/flow/surface_cells.hpp"
#include "compute/pipeline/carry.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "compute/pipeline/flow_pipeline.hpp"

namespace nacre {

/// The two-level octree and how flow runs on it: as on the grid, contrast judged in each brick's surroundings.
struct BrickBand {
  using Octree = BrickOctree;
  using Surface = BrickSurface;
  static constexpr const char* name = "brick octree";
  static constexpr bool as_thesis = false;
  static constexpr int smallest_box = 8;  ///< texture cells
  static std::uint64_t touched(const Octree& tree) { return tree.surface_cells; }
  /// Triangles of a brick that lists some.
  static double mean_list(const Octree& tree) { return double(tree.list.size()) / std::max(1u, tree.brick_count); }

  template <class Backend>
  static Octree build(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                      const FlowDomain& domain, const FlowParameters&, const OctreePart* part) {
    return build_brick_octree(exec, mesh, triangles, levels, domain.radius, part);
  }
};

/// The thesis octree of cells and its flow, as the thesis has it: every cell of the band releases a particle from its
/// centre, whose whole life is computed at once; the texture is shown without streaks.
struct ThesisBand {
  using Octree = ThesisOctree;
  using Surface = ThesisSurface;
  static constexpr const char* name = "source octree";
  static constexpr bool as_thesis = true;
  static constexpr int smallest_box = 2;
  static std::uint64_t touched(const Octree& tree) { return tree.touched_cells; }
  static double mean_list(const Octree&) { return 0; }  // it lists none

  template <class Backend>
  static Octree build(Executor<Backend>& exec, const MeshView& mesh, std::uint32_t triangles, int levels,
                      const FlowDomain& domain, const FlowParameters& parameters, const OctreePart*) {
    return build_thesis_octree(exec, mesh, triangles, levels, domain.radius, parameters.neighbour_index);
  }
};

namespace detail {

/// Values at points of the band, for probes.
template <class View>
struct SampleBandAt {
  View view;
  const float* values;
  const BandPoint* points;
  float* result;
  NACRE_HD void operator()(std::int64_t i) const { result[i] = sample_band(view, values, points[i], 0.5f); }
};

/// Whether a triangle touches a cell that has a value of its own: all do among bricks.
NACRE_HD inline bool is_touched(const BrickOctreeView&, CellIndex) { return true; }
NACRE_HD inline bool is_touched(const ThesisOctreeView& view, CellIndex cell) { return view.touches(cell); }

/// What a renderer needs of the tree.
inline void fill_lookup(const BrickOctree& tree, FlowLookup& lookup) {
  lookup.kind = FlowLookup::Kind::octree;
  for (const OctreeNode& node : tree.nodes.node.download()) {
    lookup.node.push_back(node.first);
    lookup.node.push_back(node.children);
  }
  lookup.level_start = tree.nodes.level_start.download();
  if (tree.surface_cells > 0xffffffffu) throw Error("the octree is too large to be drawn", "", "lower `resolution`");
  lookup.layer.reserve(24 * std::size_t(tree.brick_count));
  for (const OctreeBrick& brick : tree.brick.download())
    for (int z = 0; z < BrickOctreeView::width; ++z) {
      const CellMask& mask = brick.surface;
      lookup.layer.push_back(std::uint32_t(mask.word[z]));
      lookup.layer.push_back(std::uint32_t(mask.word[z] >> 32));
      lookup.layer.push_back(std::uint32_t(mask.first + mask.before[z]));
    }
}

inline void fill_lookup(const ThesisOctree& tree, FlowLookup& lookup) {
  lookup.kind = FlowLookup::Kind::thesis;
  const std::vector<ThesisNode> nodes = tree.node.download();
  if (8 * nodes.size() > 0xffffffffu) throw Error("the octree is too large to be drawn", "", "lower `resolution`");
  lookup.child.reserve(8 * nodes.size());
  for (const ThesisNode& node : nodes) lookup.child.insert(lookup.child.end(), node.child, node.child + 8);
}

/// What an output needs of each cell that has a value.
template <class View>
struct GatherSurface {
  View view;
  std::uint64_t* code;  ///< Morton code of its position; all ones where no triangle touches it
  CellPoint* point;
  NACRE_HD void operator()(CellIndex s, CellIndex cell, const Int3& position, typename View::Cursor&) const {
    code[s] = is_touched(view, cell) ? morton(position) : ~std::uint64_t(0);
    point[s] = view.point[cell];
  }
};

}  // namespace detail

}  // namespace nacre
