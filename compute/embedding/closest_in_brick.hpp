// Nacre: the exact closest points of the cells of a brick, among the clusters of triangles that come near it.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/clusters.hpp"
#include "compute/embedding/triangle_frame.hpp"
#include "compute/grid/eight.hpp"

namespace nacre::detail {

/// Adds one to memory that the lanes of a team share; returns what it was.
NACRE_HD_INLINE int claim_slot(int* count) {
#if defined(__CUDA_ARCH__)
  return atomicAdd(count, 1);
#else
  return (*count)++;
#endif
}

NACRE_HD_INLINE int lowest_bit(unsigned bits) {
#if defined(__CUDA_ARCH__)
  return __ffs(bits) - 1;
#else
  return __builtin_ctz(bits);
#endif
}

/// Clusters of triangles with what their distances are computed from.
struct ClusterView {
  MeshView mesh;
  const std::uint32_t* order;
  const std::uint32_t* start;
  const ClusterBound* bound;
  const TriangleFrame* frame;  // in `order`
  float rounding;              // how far a point of the domain may be off in single precision

  NACRE_HD_INLINE bool single(std::uint32_t c) const { return start[c + 1] - start[c] == 1; }

  /// Squares of the distances from the corners of the cube around `centre` with half edge `half`: no point of the cluster
  /// is nearer. Returns how far their roots may be off.
  NACRE_HD_INLINE float lower(std::uint32_t c, const Vec3d& centre, float half, Eight& squared) const {
    if (single(c)) return frame[start[c]].distances(centre, half, squared);
    const ClusterBound& b = bound[c];
    const Vec3f w = Vec3f(centre) - b.centre, s = b.normal * half;
    const Eight zero = eight(0), along = at_corners(dot(w, b.normal), s.x, s.y, s.z);
    const Eight above = max(max(along, zero - along) - b.thickness, zero);
    const Eight across = max(from_point(w, half) - along * along, zero);
    const Eight beside = max(sqrt(across) - b.radius, zero);
    squared = above * above + beside * beside;
    return rounding + 1e-3f;
  }

  /// The same, but some point of the cluster is no farther.
  NACRE_HD_INLINE float upper(std::uint32_t c, const Vec3d& centre, float half, Eight& squared) const {
    if (single(c)) return frame[start[c]].distances(centre, half, squared);
    squared = from_point(Vec3f(centre) - bound[c].centre, half);
    return rounding + 1e-3f;
  }

  /// Squared distances of the corners from a point that lies `-w` from the cube's centre.
  NACRE_HD_INLINE static Eight from_point(const Vec3f& w, float half) {
    const Vec3f s = w * (2 * half);
    return at_corners(dot(w, w) + 3 * half * half, s.x, s.y, s.z);
  }

  /// The point of the cluster closest to `x`.
  NACRE_HD Vec3d closest(std::uint32_t c, const Vec3d& x) const {
    Vec3d closest{};
    double best = 1e300;
    for (std::uint32_t j = start[c]; j < start[c + 1]; ++j) {
      const Vec3d p = closest_point(mesh.corners(order[j]), x);
      const double d = dot(p - x, p - x);
      if (d < best) best = d, closest = p;
    }
    return closest;
  }
};

constexpr float cell_diagonal = 0.8660256f;  ///< half of it: a triangle that touches a cell is that near to its centre

/// What may hold the closest points of a cube of cells, and the triangles that touch them.
template <int Room>
struct ShortList {
  Vec3f pivot;  // a point of the surface, from the cube's centre
  int count;    // over `Room`: some are not listed
  std::uint32_t cluster[Room];
};

/// The nearest of many clusters to each of eight places.
struct Nearest {
  float squared[8];
  std::uint32_t cluster[8];
};
NACRE_HD_INLINE Nearest operator+(const Nearest& a, const Nearest& b) {
  Nearest n;
  for (int k = 0; k < 8; ++k) {
    const bool second = b.squared[k] < a.squared[k] || (b.squared[k] == a.squared[k] && b.cluster[k] < a.cluster[k]);
    n.squared[k] = second ? b.squared[k] : a.squared[k];
    n.cluster[k] = second ? b.cluster[k] : a.cluster[k];
  }
  return n;
}

/// The eight cells of an octet (2^3 cells) and their closest points so far.
class OctetSearch {
 public:
  /// `pivot` is a point of the surface, from the octet's centre.
  NACRE_HD OctetSearch(const ClusterView& clusters, const Vec3d& centre, const Vec3f& pivot, float radius)
      : clusters_(clusters), centre_(centre), radius_(radius) {
    const Eight bound = sqrt(ClusterView::from_point(-pivot, 0.5f)) + 1e-4f;
    nearest_ = bound * bound;
    look();
    for (int k = 0; k < 8; ++k) best_[k] = 1e300, winner_[k] = none;
  }

  NACRE_HD void search(const std::uint32_t* cluster, std::uint64_t count) {
    for (std::uint64_t k = 0; k < count; ++k) {
      const std::uint32_t first = clusters_.start[cluster[k]], last = clusters_.start[cluster[k] + 1];
      if (last - first > 1) {
        Eight lower;
        const float error = clusters_.lower(cluster[k], centre_, 0.5f, lower);
        const Eight limit = reach_ + error;
        if (!at_most(lower, limit * limit)) continue;
      }
      for (std::uint32_t j = first; j < last; ++j) {
        const TriangleFrame& frame = clusters_.frame[j];
        if (last - first > 1 && !in_reach(frame)) continue;
        Eight squared;
        const float error = frame.distances(centre_, 0.5f, squared);
        const Eight limit = reach_ + error;
        if (at_most(squared, limit * limit)) keep(clusters_.order[j], squared, error);
      }
    }
    settle();
  }

  /// Whether the cell is within `radius`.
  NACRE_HD bool in_band(int k, double radius) const { return best_[k] <= radius * radius; }
  NACRE_HD bool touched(int k) const { return touched_ >> k & 1; }
  NACRE_HD const Vec3d& offset(int k) const { return offset_[k]; }
  NACRE_HD std::uint32_t triangle(int k) const { return winner_[k]; }

 private:
  static constexpr int room = 32;

  NACRE_HD Vec3d cell(int k) const {
    return centre_ + Vec3d(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
  }

  /// Whether a ball around the triangle, centred on the middle of its longest edge, comes near enough to a cell.
  NACRE_HD_INLINE bool in_reach(const TriangleFrame& frame) const {
    const Vec3f w = Vec3f(centre_ - frame.origin) - frame.u * (0.5f * frame.length);
    const Eight limit = reach_ + (0.8661f * frame.length + 1e-4f);
    return at_most(ClusterView::from_point(w, 0.5f), limit * limit) != 0;
  }

  /// Puts a triangle aside for `settle`.
  NACRE_HD_INLINE void keep(std::uint32_t t, const Eight& squared, float error) {
    nearest_ = min(nearest_, squared);
    error_ = error > error_ ? error : error_;
    look();
    squared_[pending_] = squared;
    triangle_[pending_] = t;
    if (++pending_ == room) settle();
  }

  /// How far from each cell a triangle may be to be of interest.
  NACRE_HD_INLINE void look() {
    reach_ = max(min(sqrt(nearest_), eight(radius_)), eight(cell_diagonal)) + (error_ + 1e-6f);
  }

  /// Looks at the pending triangles in double precision where single precision leaves them a chance.
  NACRE_HD void settle() {
    const float error = 2 * error_ + 1e-6f;
    const Eight limit = min(sqrt(nearest_), eight(radius_)) + error;
    const Eight limit2 = limit * limit;
    for (int i = 0; i < pending_; ++i)
      for (unsigned bits = at_most(squared_[i], limit2); bits; bits &= bits - 1) offer(lowest_bit(bits), triangle_[i]);
    const Eight touching = eight((cell_diagonal + error) * (cell_diagonal + error));
    if (at_most(nearest_, touching) & ~touched_)
      for (int i = 0; i < pending_; ++i)
        for (unsigned bits = at_most(squared_[i], touching) & ~touched_; bits; bits &= bits - 1) {
          const int k = lowest_bit(bits);
          if (touches_cube(clusters_.mesh.corners(triangle_[i]), cell(k), 0.5 + 1e-7)) touched_ |= 1u << k;
        }
    pending_ = 0;
  }

  NACRE_HD void offer(int k, std::uint32_t t) {
    const Vec3d x = cell(k);
    const Vec3d d = closest_point(clusters_.mesh.corners(t), x) - x;
    const double square = dot(d, d);
    if (square > best_[k] || (square == best_[k] && t > winner_[k])) return;
    best_[k] = square;
    offset_[k] = d;
    winner_[k] = t;
    constexpr double half = 0.5 + 1e-7;
    if (std::fabs(d.x) <= half && std::fabs(d.y) <= half && std::fabs(d.z) <= half) touched_ |= 1u << k;
  }

  const ClusterView& clusters_;
  Vec3d centre_;
  float radius_;
  float error_ = 0;
  int pending_ = 0;
  unsigned touched_ = 0;
  Eight nearest_;  // squared, of the triangles looked at
  Eight reach_;
  double best_[8];
  Vec3d offset_[8];
  std::uint32_t winner_[8];
  std::uint32_t triangle_[room];
  Eight squared_[room];
};

/// Masks and closest points of a brick's cells: a team per brick. What may be near is sifted for each of its eight blocks
/// (4^3 cells), in which every octet is searched.
///
/// A block leaves out a cluster if some point p of the surface is nearer than the cluster to all corners of the block:
/// then it is nearer everywhere in the block. For the square of the distance from a convex set is |x|^2 plus a minimum of
/// linear functions of x; minus |x - p|^2 that is concave, and is nowhere below its least value at a corner.
struct ClosestInBrick {
  static constexpr int cells = 512;  // room for points per brick

  ClusterView clusters;
  double radius;
  float quantum;
  const std::uint64_t* code;        // per brick
  const std::uint64_t* list_start;  // its clusters
  const std::uint32_t* list;
  OctreeBrick* brick;  // takes the words of the masks
  CellPoint* point;    // cell (x, y, z) of brick i: 512 i + 64 z + 8 y + x

  static constexpr int room = 96;
  struct Scratch {
    ShortList<room> block[8];
    std::uint8_t band[64], surface[64];  // per octet
  };
  std::size_t scratch_bytes() const { return sizeof(Scratch); }

  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    Scratch& s = *reinterpret_cast<Scratch*>(team.scratch());
    const Vec3d corner(morton_cell(code[i]) * Int3(BrickOctreeView::width));
    const std::uint32_t* all = list + list_start[i];
    const auto count = int(list_start[i + 1] - list_start[i]);
    sift(team, corner, all, count, s.block);
    team.each(64, [&](int o) {
      const ShortList<room>& block = s.block[o >> 3];
      const Int3 low = part(o >> 3) * Int3(4) + part(o & 7) * Int3(2);
      s.band[o] = s.surface[o] = 0;
      if (block.count == 0) return;
      const Vec3f from_block = Vec3f(part(o & 7) * Int3(2)) - Vec3f(1.0f);
      OctetSearch search(clusters, corner + Vec3d(low) + Vec3d(1.0), block.pivot - from_block, float(radius));
      const bool listed = block.count <= room;
      search.search(listed ? block.cluster : all, std::uint64_t(listed ? block.count : count));
      unsigned band = 0, surface = 0;
      for (int k = 0; k < 8; ++k) {
        if (!search.in_band(k, radius)) continue;
        band |= 1u << k;
        surface |= unsigned(search.touched(k)) << k;
        const Int3 c = low + part(k);
        point[i * cells + 64 * c.z + 8 * c.y + c.x] = CellPoint::pack(search.offset(k), quantum, search.triangle(k));
      }
      s.band[o] = std::uint8_t(band);
      s.surface[o] = std::uint8_t(surface);
    });
    team.each(8, [&](int z) {
      brick[i].band.word[z] = word(s.band, z);
      brick[i].surface.word[z] = word(s.surface, z);
    });
  }

  /// Fills the lists of the blocks.
  NACRE_HD void sift(Team& team, const Vec3d& corner, const std::uint32_t* all, int count,
                     ShortList<room>* blocks) const {
    const Vec3d centre = corner + Vec3d(4.0);
    Nearest nothing;
    for (int b = 0; b < 8; ++b) nothing.squared[b] = 1e30f, nothing.cluster[b] = none;
    const Nearest nearest = team.sum(count, nothing, [&](int k) {
      Nearest n;
      Eight squared;
      clusters.upper(all[k], centre, 2, squared);
      for (int b = 0; b < 8; ++b) n.squared[b] = squared[b], n.cluster[b] = all[k];
      return n;
    });
    team.each(8, [&](int b) {
      const Vec3d middle = corner + Vec3d(part(b)) * 4.0 + Vec3d(2.0);
      blocks[b].count = 0;
      const std::uint32_t c = nearest.cluster[b] == none ? all[0] : nearest.cluster[b];  // none: beyond 1e15 cells
      blocks[b].pivot = Vec3f(clusters.closest(c, middle) - middle);
    });
    for (int b = 0; b < 8; ++b) {
      const Vec3d middle = corner + Vec3d(part(b)) * 4.0 + Vec3d(2.0);
      const Vec3f pivot = blocks[b].pivot;
      constexpr float spread = 2.5981f;  // from the block's centre to the farthest cell's
      const Eight reach = sqrt(ClusterView::from_point(-pivot, 1.5f)) + 1e-4f;
      team.each(count, [&](int k) {
        const std::uint32_t c = all[k];
        const ClusterBound& bound = clusters.bound[c];
        const float away = length(Vec3f(middle) - bound.centre) - bound.radius - clusters.rounding - 1e-3f;
        if (away > float(radius) + spread) return;
        Eight lower;
        const float error = clusters.lower(c, middle, 1.5f, lower);
        const Eight limit = reach + error;
        if (away > cell_diagonal + spread && !at_most(lower, limit * limit)) return;
        const int slot = claim_slot(&blocks[b].count);
        if (slot < room) blocks[b].cluster[slot] = c;
      });
    }
  }

  NACRE_HD_INLINE static Int3 part(int k) { return {k & 1, k >> 1 & 1, k >> 2}; }

  /// Layer z of a mask from the masks of the octets.
  NACRE_HD static std::uint64_t word(const std::uint8_t* octets, int z) {
    std::uint64_t word = 0;
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        const int o = (z >> 2) << 5 | (y >> 1) << 4 | (x >> 1) << 3 | (z >> 1 & 1) << 2 | (y & 1) << 1 | (x & 1);
        const std::uint64_t four = octets[o] >> (z & 1 ? 4 : 0) & 15;
        word |= ((four & 3) | (four >> 2) << 8) << (16 * y + 2 * x);
      }
    return word;
  }
};

}  // namespace nacre::detail
