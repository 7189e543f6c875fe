// Nacre: particles, and boxes around them, for a renderer.
#pragma once

#include <cstdint>

#include "compute/particles/bins.hpp"
#include "compute/particles/solver_state.hpp"
#include "compute/particles/tree_solver.hpp"
#include "compute/pipeline/mesh_pipeline.hpp"

namespace nacre {

namespace detail {

/// One in the upper half for a point, in the lower half for a curve's particle, so that one scan numbers both.
struct CountLowerOrders {
  const std::uint8_t* order;  ///< per interface
  const std::uint32_t* interface;
  std::uint64_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    const int mine = order[interface[i]];
    count[i] = mine == 0 ? std::uint64_t(1) << 32 : mine == 1 ? 1 : 0;
  }
};

/// Copies a particle to where a renderer wants it: points, curves, surfaces, each in their present order.
struct ShowParticle {
  const std::uint8_t* order;
  const std::uint32_t* interface;
  const Float4* position;
  const Float4* direction;
  const std::uint64_t* before;  ///< scanned
  std::int64_t points, curves;  ///< of all
  Float4* to_position;
  Float4* to_direction;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::int64_t p = std::int64_t(before[i] >> 32), c = std::int64_t(before[i] & 0xffffffff);
    const int mine = order[interface[i]];
    const std::int64_t at = mine == 0 ? p : mine == 1 ? points + c : points + curves + (i - p - c);
    to_position[at] = position[i];
    to_direction[at] = direction[i];
  }
};

/// An interface without particles has a root without bounds.
struct CountFullNodes {
  const TreeNode* node;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const { count[i] = node[i].first < node[i].last ? 1 : 0; }
};

struct NodeBox {
  const TreeNode* node;
  const std::uint32_t* number;  ///< scanned
  ShownBox* box;
  NACRE_HD void operator()(std::int64_t i) const {
    if (node[i].first < node[i].last) box[number[i]] = {node[i].low, node[i].high};
  }
};

struct BinBox {
  BinGrid grid;
  const std::uint32_t* bin;
  ShownBox* box;
  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f low = grid.low + Vec3f(grid.bin_of(bin[i])) * grid.edge;
    box[i] = {low, low + Vec3f(grid.edge)};
  }
};

}  // namespace detail

/// Writes the particles of a set into `memory`: points, curves, surfaces; nothing where there is no room for them.
/// `order` is that of each interface, on the device.
template <class Backend>
ShownCounts show_particles(Executor<Backend>& exec, const ParticleSet& set, const std::uint8_t* order,
                           const ShownParticles& memory) {
  Arena::Scope scope(exec.arena());
  Array<std::uint64_t> before = exec.arena().template temporary<std::uint64_t>(std::size_t(set.count));
  exec.for_each(set.count, detail::CountLowerOrders{order, set.interface.data(), before.data()});
  const std::uint64_t lower = exec.exclusive_scan(before.data(), before.data(), set.count);
  ShownCounts counts;
  counts.points = std::int64_t(lower >> 32);
  counts.curves = std::int64_t(lower & 0xffffffff);
  counts.surfaces = set.count - counts.points - counts.curves;
  if (set.count <= memory.capacity)
    exec.for_each(set.count,
                  detail::ShowParticle{order, set.interface.data(), set.position.data(), set.direction.data(),
                                       before.data(), counts.points, counts.curves, memory.position, memory.direction});
  return counts;
}

/// Writes the boxes of the nodes that hold particles, from the roots down, and returns how many there are; writes
/// nothing where they are more than `capacity`. None while there is no tree.
template <class Backend>
std::int64_t show_tree(Executor<Backend>& exec, const TreeSolver& solver, ShownBox* memory, std::int64_t capacity) {
  const std::int64_t nodes = solver.tree().bounded_nodes();
  if (nodes == 0) return 0;
  Arena::Scope scope(exec.arena());
  Array<std::uint32_t> number = exec.arena().template temporary<std::uint32_t>(std::size_t(nodes));
  const TreeNode* node = solver.view(0).node;
  exec.for_each(nodes, detail::CountFullNodes{node, number.data()});
  const std::int64_t full = exec.exclusive_scan(number.data(), number.data(), nodes);
  if (full <= capacity) exec.for_each(nodes, detail::NodeBox{node, number.data(), memory});
  return full;
}

/// The same for the bins that hold moving particles, as the serial and the red-black solver sort them.
template <class Backend>
std::int64_t show_bins(Executor<Backend>& exec, const ParticleSet& set, ShownBox* memory, std::int64_t capacity) {
  Arena::Scope scope(exec.arena());
  const Bins bins = build_bins(exec, set, SolverParameters().step);
  const std::int64_t occupied = bins.colour.back();
  if (occupied <= capacity) exec.for_each(occupied, detail::BinBox{bins.grid, bins.occupied.data(), memory});
  return occupied;
}

}  // namespace nacre
