// Nacre: points of a body-centred lattice that grows coarser with the distance from given points.
#include "compute/meshing/lattice.hpp"

#include <oneapi/tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "compute/device/error.hpp"
#include "compute/math/morton.hpp"

namespace nacre {
namespace {

using Code = std::uint64_t;

constexpr int deepest = 19;  // levels; two more bits are kept for corners and centres
constexpr std::size_t most_leaves = 200'000'000;

void sort_unique(std::vector<Code>& codes) {
  tbb::parallel_sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
}

/// Nodes of the octree that are split, by level (0: the root), as sorted Morton codes.
class Octree {
 public:
  Octree(std::span<const Vec3d> points, std::span<const double> size) {
    Vec3d lower = points[0], upper = points[0];
    for (const Vec3d& p : points) lower = min(lower, p), upper = max(upper, p);
    std::vector<double> sizes(size.begin(), size.end());
    std::nth_element(sizes.begin(), sizes.begin() + std::ptrdiff_t(sizes.size() / 2), sizes.end());
    edge_ = sizes[sizes.size() / 2];  // becomes that of the root: a power of two times the usual size
    const Vec3d extent = upper - lower;
    const double wanted = std::max({extent.x, extent.y, extent.z}) + 4 * *std::max_element(size.begin(), size.end());
    while (edge_ < wanted) edge_ *= 2;
    corner_ = 0.5 * (lower + upper) - Vec3d(0.5 * edge_);
    split_.resize(deepest + 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int level = std::clamp(int(std::lround(std::log2(edge_ / std::max(size[i], edge(deepest))))), 1, deepest);
      finest_ = std::max(finest_, level);
      split_[std::size_t(level - 1)].push_back(code_of(points[i], level - 1));
    }
    grade();
  }

  /// Splits leaves larger than is wanted, until none is.
  void refine(const EdgeLength& edge_length) {
    for (int level = 0; level < finest_; ++level) {
      std::vector<Code> large;
      std::vector<Vec3d> centres;
      for_leaves(level, [&](Code code) {
        large.push_back(code);
        centres.push_back(centre(code, level));
      });
      if (large.empty()) continue;
      const std::vector<float> wanted = edge_length(centres);
      bool any = false;
      for (std::size_t i = 0; i < large.size(); ++i)
        if (edge(level) > 1.5 * double(wanted[i]) && wanted[i] > 0) {
          split_[std::size_t(level)].push_back(large[i]);
          any = true;
        }
      if (any) grade();
    }
  }

  /// Corners and centres of all leaves.
  std::vector<Vec3d> points() const {
    std::vector<Code> found;
    for (int level = 1; level <= finest_; ++level) {
      const int shift = deepest + 1 - level;
      for_leaves(level, [&](Code code) {
        const Int3 c = morton_cell(code);
        for (int corner = 0; corner < 8; ++corner)
          found.push_back(row_order(
              {(c.x + (corner & 1)) << shift, (c.y + (corner >> 1 & 1)) << shift, (c.z + (corner >> 2)) << shift}));
        const auto middle = [&](int k) { return (c[k] << shift) + (1 << (shift - 1)); };
        found.push_back(row_order({middle(0), middle(1), middle(2)}));
      });
    }
    sort_unique(found);
    std::vector<Vec3d> points;
    points.reserve(found.size());
    const double unit = edge_ / double(1 << (deepest + 1));
    const double jitter = 1e-3 * edge(finest_) / unit;
    for (const Code key : found) {
      const Vec3d position(double(key & mask), double(key >> 21 & mask), double(key >> 42));
      points.push_back(corner_ + unit * (position + jitter * random_direction(key)));
    }
    return points;
  }

 private:
  static constexpr Code mask = (Code(1) << 21) - 1;

  /// Ascends with z, then y, then x.
  static Code row_order(const Int3& c) { return Code(c.z) << 42 | Code(c.y) << 21 | Code(c.x); }

  /// Within the cube -0.5 .. 0.5.
  static Vec3d random_direction(Code key) {
    Vec3d direction;
    for (int axis = 0; axis < 3; ++axis) {
      key = (key ^ key >> 31) * 0x9e3779b97f4a7c15u + 0x632be59bd9b4e019u;  // any good mixing will do
      direction[axis] = double(key >> 11) * 0x1p-53 - 0.5;
    }
    return direction;
  }

  double edge(int level) const { return edge_ / double(1 << level); }

  Code code_of(const Vec3d& p, int level) const {
    Int3 c;
    for (int axis = 0; axis < 3; ++axis)
      c[axis] = std::clamp(int((p[axis] - corner_[axis]) / edge(level)), 0, (1 << level) - 1);
    return morton(c);
  }

  Vec3d centre(Code code, int level) const { return corner_ + edge(level) * (Vec3d(morton_cell(code)) + Vec3d(0.5)); }

  /// Where a node is split, its 26 neighbours are there too: their parents are split.
  void grade() {
    for (int level = finest_ - 1; level > 0; --level) {
      std::vector<Code>& split = split_[std::size_t(level)];
      std::vector<Code>& parents = split_[std::size_t(level - 1)];
      sort_unique(split);
      for (const Code code : split) {
        const Int3 c = morton_cell(code);
        for (int k = 0; k < 8;
             ++k) {  // of a child's neighbours, only those across its three outer sides have other parents
          Int3 p;
          for (int axis = 0; axis < 3; ++axis)
            p[axis] = (c[axis] + ((k >> axis & 1) ? (c[axis] & 1 ? 1 : -1) : 0)) >> 1;
          const int last = (1 << (level - 1)) - 1;
          if (std::min({p.x, p.y, p.z}) < 0 || std::max({p.x, p.y, p.z}) > last) continue;
          parents.push_back(morton(p));
        }
      }
      if (parents.size() > most_leaves / 8)
        throw Error("the volume cannot be filled with tetrahedra", "there would be too many",
                    "choose a larger `min_size`");
      sort_unique(parents);
    }
    sort_unique(split_[0]);
  }

  /// Calls visit(code) for the leaves of a level, ascending.
  template <class Visit>
  void for_leaves(int level, const Visit& visit) const {
    if (level == 0) {
      if (split_[0].empty()) visit(Code(0));
      return;
    }
    const std::vector<Code>& split = split_[std::size_t(level)];
    auto next = split.begin();
    for (const Code parent : split_[std::size_t(level - 1)])
      for (Code child = 8 * parent; child < 8 * parent + 8; ++child) {
        while (next != split.end() && *next < child) ++next;
        if (next == split.end() || *next != child) visit(child);
      }
  }

  double edge_ = 0;
  Vec3d corner_;
  int finest_ = 1;
  std::vector<std::vector<Code>> split_;
};

}  // namespace

std::vector<Vec3d> graded_lattice(std::span<const Vec3d> points, std::span<const double> size,
                                  const EdgeLength& edge_length) {
  if (points.empty()) return {};
  Octree octree(points, size);
  if (edge_length) octree.refine(edge_length);
  return octree.points();
}

}  // namespace nacre
