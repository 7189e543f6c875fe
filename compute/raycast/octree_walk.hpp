// Nacre: the parametric traversal of a sparse octree by a ray (Revelles, Urena, Lastra 2000).
#pragma once

#include <cstdint>

#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/thesis_octree.hpp"
#include "compute/raycast/ray.hpp"

namespace nacre {

/// A ray as the traversal sees it: mirrored in the middle of the domain along the axes on which it descends, so that it
/// ascends on all. Positions are given by parameters of planes alone. A plane has the same parameter for the nodes on
/// either side, so that neighbours leave no gap and the traversal cannot turn back.
struct AscendingRay {
  Vec3d origin, inverse;  ///< inverse: of the direction, finite, > 0
  int size = 0;           ///< cells per axis
  int flip = 0;           ///< bit per axis: mirrored

  NACRE_HD AscendingRay(const Ray& ray, int cells) : origin(ray.origin), size(cells) {
    for (int axis = 0; axis < 3; ++axis) {
      double d = ray.direction[axis];
      if (d < 0) {
        d = -d;
        origin[axis] = size - origin[axis];
        flip |= 1 << axis;
      }
      // Along an axis on which the ray does not move, planes are far ahead or far behind, never at NaN.
      inverse[axis] = d > 1e-280 ? 1 / d : 1e280;
    }
  }

  /// Parameter at which the ray crosses this plane.
  NACRE_HD_INLINE double at(int axis, int plane) const { return (plane - origin[axis]) * inverse[axis]; }

  /// Where the ray leaves the cube [low, low + width)^3, and through which face.
  NACRE_HD_INLINE double leave(const Int3& low, int width, int& axis) const {
    const double x = at(0, low.x + width), y = at(1, low.y + width), z = at(2, low.z + width);
    axis = x <= y && x <= z ? 0 : y <= z ? 1 : 2;
    return axis == 0 ? x : axis == 1 ? y : z;
  }

  /// Moves `low` to the octant, of cubes `half` wide, that contains the ray at `t`; returns the bits of the octant.
  NACRE_HD_INLINE int enter(Int3& low, int half, double t) const {
    int octant = 0;
    for (int axis = 0; axis < 3; ++axis)
      if (at(axis, low[axis] + half) <= t) {
        low[axis] += half;
        octant |= 1 << axis;
      }
    return octant;
  }

  /// Lower corner of a cube in the octree's own coordinates.
  NACRE_HD_INLINE Int3 unmirrored(const Int3& low, int width) const {
    return {flip & 1 ? size - width - low.x : low.x, flip & 2 ? size - width - low.y : low.y,
            flip & 4 ? size - width - low.z : low.z};
  }
};

// What the traversal requires of an octree: its root, and child `octant` (bits x, y, z) of node `at` of a level; false
// if there is none. Children of the nodes of the lowest level are leaves.

NACRE_HD_INLINE std::uint32_t octree_root(const BrickOctreeView&) { return 0; }
NACRE_HD_INLINE bool octree_child(const BrickOctreeView& tree, int level, std::uint32_t at, int octant,
                                  std::uint32_t& child) {
  const OctreeNode n = tree.node[tree.level_start[level] + at];
  if (!(n.children >> octant & 1)) return false;
  child = n.first + std::uint32_t(count_bits(n.children & ((1u << octant) - 1)));
  return true;
}

NACRE_HD_INLINE std::uint32_t octree_root(const ThesisOctreeView& tree) { return tree.root; }
NACRE_HD_INLINE bool octree_child(const ThesisOctreeView& tree, int, std::uint32_t at, int octant,
                                  std::uint32_t& child) {
  child = tree.node[at].child[octant];
  return child != none;
}

/// Calls leaf(number, low, enter, leave) for the leaves that the ray passes, in order, until one returns true; returns
/// whether one did. `number` is the number within the lowest level, `low` the leaf's lower corner in the coordinates of
/// `ray`; the ray is inside between the two parameters. The domain is `ray.size` cells wide, the leaves `ray.size` >>
/// levels. The ray begins at parameter 0, inside or outside of the domain. The tree must have a root.
template <class Tree, class Leaf>
NACRE_HD bool walk_octree(const Tree& tree, int levels, const AscendingRay& ray, Leaf&& leaf) {
  constexpr int most_levels = 21;
  double enter = 0, end = 1e300;
  for (int axis = 0; axis < 3; ++axis) {
    const double in = ray.at(axis, 0), out = ray.at(axis, ray.size);
    enter = in > enter ? in : enter;
    end = out < end ? out : end;
  }
  if (!(enter < end) || levels > most_levels) return false;

  std::uint32_t above[most_levels];  // the nodes that contain the current cube
  std::uint32_t here = octree_root(tree);
  Int3 low{};
  int level = 0, width = ray.size;
  for (;;) {
    bool there = false;
    if (level < levels) {
      above[level] = here;
      width /= 2;
      const int octant = ray.enter(low, width, enter);
      there = octree_child(tree, level, here, octant ^ ray.flip, here);
      ++level;
    } else {
      int axis;
      if (leaf(here, low, enter, ray.leave(low, width, axis))) return true;
    }
    while (!there) {
      int axis;
      const double out = ray.leave(low, width, axis);
      enter = out > enter ? out : enter;
      while (level > 0 && low[axis] & width) {  // the last child along this axis: leave its parent, too
        low = {low.x & ~width, low.y & ~width, low.z & ~width};
        width *= 2;
        --level;
      }
      if (level == 0) return false;
      low[axis] += width;
      const int octant = (low.x & width ? 1 : 0) | (low.y & width ? 2 : 0) | (low.z & width ? 4 : 0);
      there = octree_child(tree, level - 1, above[level - 1], octant ^ ray.flip, here);
    }
  }
}

}  // namespace nacre
