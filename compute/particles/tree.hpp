// Nacre: the Barnes-Hut octree of the particles, one root per interface (sec. 4.1), and the walk through it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "compute/device/executor.hpp"
#include "compute/math/bisection.hpp"
#include "compute/math/morton.hpp"
#include "compute/particles/particle_set.hpp"

namespace nacre {

/// A node: particles [first, last) of the sorted arrays, and what stands for them from afar: the mean of their
/// positions, sizes and normals, and their number as mass.
struct TreeNode {
  std::uint32_t first = 0, last = 0;
  std::uint32_t child = 0;     ///< number of the first child; children are consecutive
  std::uint32_t children = 0;  ///< 0: a leaf
  Vec3f low, high;             ///< bounds of the particles
  float largest = 0;           ///< h among them
  Float4 centre{};             ///< of mass; mean h
  Float4 normal{};             ///< mean of the normals (not unit)

  NACRE_HD float mass() const { return float(last - first); }
  NACRE_HD float size() const { return max(high.x - low.x, max(high.y - low.y, high.z - low.z)); }
};

/// Squared distance between two boxes.
NACRE_HD_INLINE float box_distance2(const Vec3f& low_a, const Vec3f& high_a, const Vec3f& low_b, const Vec3f& high_b) {
  const Vec3f gap = max(max(low_a - high_b, low_b - high_a), Vec3f(0.0f));
  return dot(gap, gap);
}

/// The tree of one ParticleSet in Morton order within each interface. Nodes 0 .. interfaces - 1 are the roots.
struct TreeView {
  static constexpr int leaf_size = 24;
  static constexpr int bits = 16;  ///< Morton levels

  const TreeNode* node = nullptr;
  const Float4* position = nullptr;   ///< sorted
  const Float4* direction = nullptr;  ///< sorted
  float theta = 0;

  /// Walks from `root` to all that may be felt in the box by particles that reach `reach` in their own size (how far
  /// two of them feel each other is the mean of their reaches): calls particles(first, last) for leaves, and far(node)
  /// for nodes that count as one particle: smaller than theta times their distance from the box (their own, not that of
  /// the particle's node as sec. 4.1 has it). Nodes that the box may lie in are always opened.
  template <class Particles, class Far>
  NACRE_HD void walk(std::uint32_t root, const Vec3f& low, const Vec3f& high, float reach, const Particles& particles,
                     const Far& far) const {
    std::uint32_t stack[8 * bits];
    int depth = 0;
    stack[depth++] = root;
    while (depth > 0) {
      const TreeNode& n = node[stack[--depth]];
      if (n.first == n.last) continue;
      const float limit = 0.5f * (reach + support * n.largest);
      const float gap2 = box_distance2(n.low, n.high, low, high);
      if (gap2 > limit * limit) continue;
      if (n.children == 0) {
        particles(n.first, n.last);
        continue;
      }
      const Vec3f c(n.centre.x, n.centre.y, n.centre.z);
      const float away2 = box_distance2(c, c, low, high), size = n.size();
      if (size * size < theta * theta * away2 && gap2 > 0) {
        far(n);
        continue;
      }
      for (std::uint32_t k = n.children; k-- > 0;) stack[depth++] = n.child + k;
    }
  }
};

namespace detail {

/// Sorting key: interface, then Morton code of the position on a grid of 2^16 per axis over the volume.
struct TreeKey {
  const Float4* position;
  const std::uint32_t* interface;
  float scale;
  std::uint64_t* key;
  std::uint32_t* number;
  NACRE_HD void operator()(std::int64_t i) const {
    const Float4 p = position[i];
    const auto digit = [&](float x) {
      const float d = x * scale;
      return d <= 0 ? 0 : d >= 65535 ? 65535 : int(d);
    };
    key[i] = std::uint64_t(interface[i]) << 48 | morton({digit(p.x), digit(p.y), digit(p.z)});
    number[i] = std::uint32_t(i);
  }
};

/// What the device knows of a tree while it is built; the host asks once, at the end.
struct TreeSizes {
  std::uint32_t
      begin[TreeView::bits + 2];  ///< of each level's nodes; the next one's is its end, behind the last one too
  std::uint32_t leaves;
  std::uint32_t full;  ///< nodes were wanted for which there was no room
};

struct MakeRoots {
  const std::uint64_t* key;
  std::uint32_t count, interfaces;
  TreeNode* node;
  TreeSizes* sizes;
  NACRE_HD void operator()(std::int64_t i) const {
    if (i == 0) *sizes = {{0, interfaces}, 0, 0};
    TreeNode root;
    root.first = first_not_below(key, 0u, count, std::uint64_t(i) << 48);
    root.last = first_not_below(key, root.first, count, std::uint64_t(i + 1) << 48);
    node[i] = root;
  }
};

/// Splits the nodes of a level by the next three bits of the Morton code.
struct SplitNodes {
  const std::uint64_t* key;
  TreeNode* node;
  TreeSizes* sizes;
  int level, shift;

  /// How many nodes the level has, and which one of all is the i-th.
  NACRE_HD std::uint32_t count() const { return sizes->begin[level + 1] - sizes->begin[level]; }
  NACRE_HD TreeNode& at(std::int64_t i) const { return node[sizes->begin[level] + i]; }

  template <class Visit>
  NACRE_HD void children(std::int64_t i, const Visit& visit) const {
    const TreeNode& n = at(i);
    if (n.last - n.first <= TreeView::leaf_size) return;
    const std::uint64_t prefix = key[n.first] >> (shift + 3) << (shift + 3);
    std::uint32_t from = n.first;
    for (std::uint64_t octant = 0; octant < 8 && from < n.last; ++octant) {
      const std::uint32_t to =
          octant == 7 ? n.last : first_not_below(key, from, n.last, prefix + ((octant + 1) << shift));
      if (to > from) visit(from, to);
      from = to;
    }
  }
};

/// For i up to the most nodes that the level can have, and one more: none behind those that it has.
struct CountChildren {
  SplitNodes split;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint32_t n = 0;
    if (i < split.count()) split.children(i, [&](std::uint32_t, std::uint32_t) { ++n; });
    count[i] = n;
  }
};

struct MakeChildren {
  SplitNodes split;
  const std::uint32_t* start;
  std::int64_t most;       ///< nodes that the level can have: start[most] is the number of all children
  std::uint32_t capacity;  ///< nodes that there is room for
  NACRE_HD void operator()(std::int64_t i) const {
    TreeSizes& sizes = *split.sizes;
    const std::uint32_t end = sizes.begin[split.level + 1];  // of the level: where children begin
    const bool full = start[most] > capacity - end;
    if (i == 0) {
      sizes.begin[split.level + 2] = full ? end : end + start[most];
      if (full) sizes.full = 1;
    }
    if (full || i >= split.count()) return;
    TreeNode& parent = split.at(i);
    std::uint32_t at = end + start[i];
    parent.child = at;
    split.children(i, [&](std::uint32_t from, std::uint32_t to) {
      TreeNode child;
      child.first = from;
      child.last = to;
      split.node[at++] = child;
    });
    parent.children = at - parent.child;
  }
};

/// Bounds and means of a level's nodes from their particles or children.
struct SummariseNodes {
  TreeNode* node;
  const Float4* position;
  const Float4* direction;
  std::uint32_t begin;
  NACRE_HD void operator()(std::int64_t i) const {
    TreeNode& n = node[begin + i];
    if (n.first == n.last) return;
    Vec3f low(3e38f), high(-3e38f), centre(0.0f), normal(0.0f);
    float h = 0, largest = 0;
    if (n.children == 0) {
      for (std::uint32_t k = n.first; k < n.last; ++k) {
        const Vec3f p(position[k].x, position[k].y, position[k].z);
        low = min(low, p), high = max(high, p);
        centre += p;
        normal += Vec3f(direction[k].x, direction[k].y, direction[k].z);
        h += position[k].w;
        largest = max(largest, position[k].w);
      }
    } else {
      for (std::uint32_t k = n.child; k < n.child + n.children; ++k) {
        const TreeNode& c = node[k];
        const float m = c.mass();
        low = min(low, c.low), high = max(high, c.high);
        centre += Vec3f(c.centre.x, c.centre.y, c.centre.z) * m;
        normal += Vec3f(c.normal.x, c.normal.y, c.normal.z) * m;
        h += c.centre.w * m;
        largest = max(largest, c.largest);
      }
    }
    const float inverse = 1 / n.mass();
    n.low = low, n.high = high, n.largest = largest;
    n.centre = {centre.x * inverse, centre.y * inverse, centre.z * inverse, h * inverse};
    n.normal = {normal.x * inverse, normal.y * inverse, normal.z * inverse, 0};
  }
};

struct GatherParticles {
  const std::uint32_t* number;
  const Float4* position;
  const Float4* direction;
  const std::uint32_t* interface;
  const Float4* velocity;
  Float4* to_position;
  Float4* to_direction;
  std::uint32_t* to_interface;
  Float4* to_velocity;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t k = number[i];
    to_position[i] = position[k];
    to_direction[i] = direction[k];
    to_interface[i] = interface[k];
    to_velocity[i] = velocity[k];
  }
};

/// Of the nodes before *end.
struct IsLeaf {
  const TreeNode* node;
  const std::uint32_t* end;
  std::uint32_t* count;
  NACRE_HD bool is_leaf(std::int64_t i) const {
    return i < *end && node[i].children == 0 && node[i].last > node[i].first;
  }
  NACRE_HD void operator()(std::int64_t i) const { count[i] = is_leaf(i) ? 1 : 0; }
};

struct ListLeaves {
  IsLeaf is;
  const std::uint32_t* start;
  std::int64_t most;  ///< start[most] is the number of all leaves
  std::uint32_t* leaf;
  TreeSizes* sizes;
  NACRE_HD void operator()(std::int64_t i) const {
    if (i == 0) sizes->leaves = start[most];
    if (is.is_leaf(i)) leaf[start[i]] = std::uint32_t(i);
  }
};

}  // namespace detail

/// Memory for trees of up to `capacity` particles on `interfaces` interfaces.
class Tree {
 public:
  template <class Backend>
  Tree(Executor<Backend>& exec, std::int64_t capacity, std::int64_t interfaces)
      : Tree(exec.arena(), capacity, interfaces) {}

  /// `Memory` is an Arena, or an AllocationPlan.
  template <class Memory>
  Tree(Memory& memory, std::int64_t capacity, std::int64_t interfaces)
      : interfaces_(interfaces),
        node_(memory.template permanent<TreeNode>(most_nodes(capacity, interfaces))),
        leaf_(memory.template permanent<std::uint32_t>(most_nodes(capacity, interfaces))),
        sizes_(memory.template permanent<detail::TreeSizes>(1)) {}

  /// Builds the tree over particles that are sorted by `key`.
  template <class Backend>
  void build(Executor<Backend>& exec, const Array<std::uint64_t>& key, std::int64_t particles) {
    launch_build(exec, key, particles);
    read_sizes();
  }

  /// The first half of `build`: level by level on the device. How many nodes a level has is known there alone; launches
  /// are for the most that it can have, where that would have to be waited for.
  template <class Backend>
  void launch_build(Executor<Backend>& exec, const Array<std::uint64_t>& key, std::int64_t particles) {
    bounded_ = 0;
    detail::TreeSizes* sizes = sizes_.data();
    exec.for_each(
        std::max<std::int64_t>(interfaces_, 1),
        detail::MakeRoots{key.data(), std::uint32_t(particles), std::uint32_t(interfaces_), node_.data(), sizes});
    std::int64_t most = interfaces_, all = most;
    int level = 0;
    for (; level < TreeView::bits; ++level) {
      const detail::SplitNodes split{key.data(), node_.data(), sizes, level, 3 * (TreeView::bits - 1 - level)};
      const std::int64_t n = exec.known([&] { return split.count(); }, most);
      if (n == 0) break;
      Arena::Scope scope(exec.arena());
      Array<std::uint32_t> start = exec.arena().template temporary<std::uint32_t>(n + 1);
      exec.for_each(n + 1, detail::CountChildren{split, start.data()});
      exec.scan(start.data(), start.data(), n + 1);
      exec.for_each(n, detail::MakeChildren{split, start.data(), n, std::uint32_t(node_.size())});
      most = std::min(8 * std::min(most, particles / (TreeView::leaf_size + 1)), std::int64_t(node_.size()));
      all = std::min(all + most, std::int64_t(node_.size()));
    }
    list_leaves(exec, level, all);
  }

  /// The second half, which waits for the first. Throws Error where there was not enough room.
  void read_sizes() {
    const detail::TreeSizes sizes = sizes_.download()[0];
    if (sizes.full)
      throw Error("the tree of particles is full", std::to_string(node_.size()) + " nodes",
                  "use another `seed` or raise `min_size`");
    level_.assign(1, 0);
    for (int l = 0; l <= TreeView::bits && sizes.begin[l + 1] > sizes.begin[l]; ++l)
      level_.push_back(sizes.begin[l + 1]);
    leaf_count_ = sizes.leaves;
  }

  /// Bounds and means for where the particles are now; their order stays.
  template <class Backend>
  void summarise(Executor<Backend>& exec, const ParticleSet& particles) {
    for (std::size_t l = level_.size() - 1; l-- > 0;)
      exec.for_each(level_[l + 1] - level_[l], detail::SummariseNodes{node_.data(), particles.position.data(),
                                                                      particles.direction.data(), level_[l]});
    bounded_ = nodes();
  }

  TreeView view(const ParticleSet& particles, float theta) const {
    return {node_.data(), particles.position.data(), particles.direction.data(), theta};
  }
  std::int64_t interfaces() const { return interfaces_; }
  const std::uint32_t* leaves() const { return leaf_.data(); }
  std::int64_t leaf_count() const { return leaf_count_; }
  std::int64_t nodes() const { return level_.back(); }
  /// The nodes of a tree that was built and summarised to its end; 0 where there is none.
  std::int64_t bounded_nodes() const { return bounded_; }

 private:
  static std::size_t most_nodes(std::int64_t capacity, std::int64_t interfaces) {
    return std::size_t(capacity / 3 + 9 * interfaces + 4096);
  }

  /// Of a tree of `levels` levels, perhaps fewer, which has at most `most` nodes.
  template <class Backend>
  void list_leaves(Executor<Backend>& exec, int levels, std::int64_t most) {
    const std::uint32_t* end = sizes_.data()->begin + levels + 1;
    const std::int64_t n = exec.known([&] { return *end; }, most);
    Arena::Scope scope(exec.arena());
    Array<std::uint32_t> start = exec.arena().template temporary<std::uint32_t>(n + 1);
    const detail::IsLeaf is_leaf{node_.data(), end, start.data()};
    exec.for_each(n + 1, is_leaf);
    exec.scan(start.data(), start.data(), n + 1);
    exec.for_each(n, detail::ListLeaves{is_leaf, start.data(), n, leaf_.data(), sizes_.data()});
  }

  std::int64_t interfaces_;
  Array<TreeNode> node_;
  Array<std::uint32_t> leaf_;
  Array<detail::TreeSizes> sizes_;
  std::int64_t leaf_count_ = 0, bounded_ = 0;
  std::vector<std::uint32_t> level_;  ///< where each level's nodes begin, and where the last one's end
};

}  // namespace nacre
