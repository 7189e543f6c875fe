// Nacre: a copy of the brick octree in host memory, for tests to look into.
#pragma once

#include <vector>

#include "compute/embedding/build_brick_octree.hpp"
#include "tests/compute/meshes.hpp"

namespace nacre::test {

/// A brick octree on the host; `view` points into the copies.
struct HostBrickOctree {
  std::vector<std::uint64_t> brick_code, list_start;
  std::vector<OctreeBrick> brick;
  std::vector<std::uint32_t> neighbour, level_start, list;
  std::vector<OctreeNode> node;
  std::vector<CellPoint> point;
  BrickOctreeView view;

  explicit HostBrickOctree(const BrickOctree& tree)
      : brick_code(tree.brick_code.download()),
        list_start(tree.list_start.download()),
        brick(tree.brick.download()),
        neighbour(tree.neighbour.download()),
        level_start(tree.nodes.level_start.download()),
        list(tree.list.download()),
        node(tree.nodes.node.download()),
        point(tree.point.download()),
        view(tree.view()) {
    view.brick_code = brick_code.data();
    view.list_start = list_start.data();
    view.brick = brick.data();
    view.neighbour = neighbour.data();
    view.level_start = level_start.data();
    view.list = list.data();
    view.node = node.data();
    view.point = point.data();
  }
  HostBrickOctree(const HostBrickOctree&) = delete;

  Vec3d closest(const Int3& cell, CellIndex at) const {
    return Vec3d(cell) + Vec3d(0.5) + Vec3d(point[at].offset(view.quantum));
  }
};

/// The octree of `mesh`; drops what it put into the arena.
template <class Backend>
HostBrickOctree brick_octree(Executor<Backend>& exec, const Mesh& mesh, int levels, double radius) {
  struct Rewind {
    Arena& arena;
    std::size_t mark;
    ~Rewind() { arena.rewind(mark); }
  } rewind{exec.arena(), exec.arena().mark()};
  const MeshView view = upload(exec, mesh);
  return HostBrickOctree(build_brick_octree(exec, view, std::uint32_t(mesh.triangles.size()), levels, radius));
}

}  // namespace nacre::test
