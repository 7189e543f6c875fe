// Nacre: the exact closest points of the cells of a brick, among the clusters of triangles that come near it.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/closest_of_eight.hpp"
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

/// Lowers eight floats >= 0 in memory that the lanes of a team share.
NACRE_HD_INLINE void lower_to(float* shared, const Eight& to) {
#if defined(__CUDA_ARCH__)
  for (int k = 0; k < 8; ++k) atomicMin(reinterpret_cast<int*>(shared) + k, __float_as_int(to[k]));
#else
  store_eight(shared, min(load_eight(shared), to));
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
};

constexpr float cell_diagonal = 0.8660256f;  ///< half of it: a triangle that touches a cell is that near to its centre

/// What may hold the closest points of a cube of cells, and the triangles that touch them.
template <class Item, int Room>
struct ShortList {
  static constexpr int room = Room;
  int count;  // over `Room`: some are not listed
  Item item[Room];

  NACRE_HD_INLINE bool listed() const { return count <= Room; }
  NACRE_HD_INLINE void add(Item what) {
    const int slot = claim_slot(&count);
    if (slot < Room) item[slot] = what;
  }
};

/// The eight cells of an octet (2^3 cells) and their closest points so far.
class OctetSearch {
 public:
  /// `near`: the surface is no farther from the octet's centre.
  NACRE_HD OctetSearch(const ClusterView& clusters, const Vec3d& centre, float near, float radius)
      : clusters_(clusters), centre_(centre), radius_(radius) {
    const float bound = near + (cell_diagonal + 1e-4f);
    nearest_ = eight(bound * bound);
    look();
    for (int k = 0; k < 8; ++k) best_[k] = 1e300, winner_[k] = none;
  }

  /// Looks at the clusters at(0) .. at(count - 1), that with the nearest centre first: it may spare the others.
  template <class At>
  NACRE_HD void search(std::uint64_t count, const At& at) {
    std::uint64_t first = 0;
    float nearest = 1e30f;
    for (std::uint64_t k = 0; k < count; ++k) {
      const Vec3f w = Vec3f(centre_) - clusters_.bound[at(k)].centre;
      const float d = dot(w, w);
      if (d < nearest) nearest = d, first = k;
    }
    look_at(at(first));
    for (std::uint64_t k = 0; k < count; ++k)
      if (k != first) look_at(at(k));
    settle();
  }

  /// Whether the cell is within `radius`.
  NACRE_HD bool in_band(int k, double radius) const { return best_[k] <= radius * radius; }
  NACRE_HD bool touched(int k) const { return touched_ >> k & 1; }
  NACRE_HD Vec3d offset(int k) const { return {x_[k], y_[k], z_[k]}; }
  NACRE_HD std::uint32_t triangle(int k) const { return std::uint32_t(winner_[k]); }

 private:
  static constexpr int room = 32;

  NACRE_HD Vec3d cell(int k) const {
    return centre_ + Vec3d(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
  }

  NACRE_HD_INLINE void look_at(std::uint32_t c) {
    const std::uint32_t first = clusters_.start[c], last = clusters_.start[c + 1];
    const bool many = last - first > 1;
    if (many) {
      Eight lower;
      const float error = clusters_.lower(c, centre_, 0.5f, lower);
      const Eight limit = reach_ + error;
      if (!at_most(lower, limit * limit)) return;
    }
    for (std::uint32_t j = first; j < last; ++j) {
      const TriangleFrame& frame = clusters_.frame[j];
      if (!in_reach(frame)) continue;
      Eight squared;
      const float error = frame.distances(centre_, 0.5f, squared);
      const Eight limit = reach_ + error;
      if (at_most(squared, limit * limit)) keep(clusters_.order[j], squared, error);
    }
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
      if (const unsigned bits = at_most(squared_[i], limit2)) offer(bits, triangle_[i]);
    const Eight touching = eight((cell_diagonal + error) * (cell_diagonal + error));
    if (const unsigned near = at_most(nearest_, touching) & ~touched_) touch(near, touching);
    pending_ = 0;
  }

  /// Finds out which cells of `near` a pending triangle touches; mostly it is the one that holds the closest point.
  NACRE_HD_INLINE void touch(unsigned near, const Eight& touching) {
    constexpr double half = 0.5 + 1e-7;
    for (unsigned bits = near; bits; bits &= bits - 1) {
      const int k = lowest_bit(bits);
      if (best_[k] < 1 && std::fabs(x_[k]) <= half && std::fabs(y_[k]) <= half && std::fabs(z_[k]) <= half)
        touched_ |= 1u << k;
    }
    if (!(near & ~touched_)) return;
    for (int i = 0; i < pending_; ++i)
      for (unsigned bits = at_most(squared_[i], touching) & ~touched_; bits; bits &= bits - 1) {
        const int k = lowest_bit(bits);
        if (touches_cube(clusters_.mesh.corners(triangle_[i]), cell(k), half)) touched_ |= 1u << k;
      }
  }

  /// Takes a triangle for those of the cells in `bits` that it is the nearest to so far.
  NACRE_HD_INLINE void offer(unsigned bits, std::uint32_t t) {
    const Corners corners = clusters_.mesh.corners(t);
#if !defined(__CUDACC__)
    ClosestOfEight found;
    if (closest_of_eight(corners, centre_, 0.5, found)) {
      const auto wins = (found.squared < best_) | ((found.squared == best_) & (std::int64_t(t) < winner_));
      x_ = wins ? found.x : x_, y_ = wins ? found.y : y_, z_ = wins ? found.z : z_;
      best_ = wins ? found.squared : best_;
      winner_ = wins ? winner_ - winner_ + std::int64_t(t) : winner_;
      return;
    }
#endif
    for (; bits; bits &= bits - 1) offer_one(lowest_bit(bits), t, corners);
  }

  NACRE_HD void offer_one(int k, std::uint32_t t, const Corners& corners) {
    const Vec3d x = cell(k), d = closest_point(corners, x) - x;
    const double square = dot(d, d);
    if (square > best_[k] || (square == best_[k] && t > winner_[k])) return;
    best_[k] = square;
    x_[k] = d.x, y_[k] = d.y, z_[k] = d.z;
    winner_[k] = t;
  }

#if defined(__CUDACC__)
  typedef double Doubles[8];
  typedef std::int64_t Numbers[8];
#else
  typedef EightDoubles Doubles;
  typedef std::int64_t Numbers __attribute__((vector_size(64)));
#endif

  const ClusterView& clusters_;
  Vec3d centre_;
  float radius_;
  float error_ = 0;
  int pending_ = 0;
  unsigned touched_ = 0;
  Eight nearest_;  // squared, of the triangles looked at
  Eight reach_;
  Doubles best_;  // squared
  Doubles x_, y_, z_;
  Numbers winner_;
  std::uint32_t triangle_[room];
  Eight squared_[room];
};

/// Masks and closest points of a brick's cells: a team per brick. What may be near is sifted twice, for the brick's eight
/// blocks (4^3 cells) and for their octets, then every octet is searched.
///
/// A part (a block, an octet) leaves a cluster out that is farther from its centre than the surface, a way there and back
/// between the centre and the part's outermost cells included: some other triangle is nearer to all of its cells. It
/// leaves out as well what is beyond the band's radius, and with it the parts that have no cell in the band.
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
    float near[8];  // how far the surface is from the centres of a cube's parts, at most
    float octet_near[64];
    float error[room];  // of a block's clusters, and their distances from its octets
    float squared[8 * room];
    ShortList<std::uint32_t, room> block[8];
    ShortList<std::uint8_t, 44> octet[64];  // of the items of the block's list
    std::uint8_t band[64], surface[64];     // per octet
  };
  std::size_t scratch_bytes() const { return sizeof(Scratch); }

  NACRE_HD void operator()(Team& team, std::int64_t i) const {
    Scratch& s = *reinterpret_cast<Scratch*>(team.scratch());
    const Vec3d corner(morton_cell(code[i]) * Int3(BrickOctreeView::width));
    const std::uint32_t* all = list + list_start[i];
    const auto count = int(list_start[i + 1] - list_start[i]);
    sift_brick(team, corner + Vec3d(4.0), all, count, s);
    for (int b = 0; b < 8; ++b) sift_block(team, corner + Vec3d(part(b)) * 4.0 + Vec3d(2.0), b, s);
    team.each(64, [&](int o) {
      const auto& block = s.block[o >> 3];
      const auto& octet = s.octet[o];
      s.band[o] = s.surface[o] = 0;
      if (octet.count == 0) return;
      const Int3 low = part(o >> 3) * Int3(4) + part(o & 7) * Int3(2);
      OctetSearch search(clusters, corner + Vec3d(low) + Vec3d(1.0), s.octet_near[o], float(radius));
      if (octet.listed())
        search.search(octet.count, [&](std::uint64_t k) { return block.item[octet.item[k]]; });
      else if (block.listed())
        search.search(block.count, [&](std::uint64_t k) { return block.item[k]; });
      else
        search.search(count, [&](std::uint64_t k) { return all[k]; });
      store(i, o, low, search, s);
    });
    team.each(8, [&](int z) {
      brick[i].band.word[z] = word(s.band, z);
      brick[i].surface.word[z] = word(s.surface, z);
    });
  }

  /// Takes over what was found for an octet.
  NACRE_HD void store(std::int64_t i, int o, const Int3& low, const OctetSearch& found, Scratch& s) const {
    unsigned band = 0, surface = 0;
    for (int k = 0; k < 8; ++k) {
      if (!found.in_band(k, radius)) continue;
      band |= 1u << k;
      surface |= unsigned(found.touched(k)) << k;
      const Int3 c = low + part(k);
      point[i * cells + 64 * c.z + 8 * c.y + c.x] = CellPoint::pack(found.offset(k), quantum, found.triangle(k));
    }
    s.band[o] = std::uint8_t(band);
    s.surface[o] = std::uint8_t(surface);
  }

  /// How far from the centres of parts a cluster is of interest; `spread` is from there to the outermost cells.
  NACRE_HD_INLINE Eight reach(const float* near, float spread) const {
    return max(min(load_eight(near) + spread, eight(float(radius))), eight(cell_diagonal)) + (spread + 1e-4f);
  }

  /// Fills the lists of the blocks.
  NACRE_HD void sift_brick(Team& team, const Vec3d& centre, const std::uint32_t* all, int count, Scratch& s) const {
    team.each(8, [&](int b) { s.near[b] = 1e15f, s.block[b].count = 0; });
    team.each(count, [&](int k) {
      Eight squared;
      const float error = clusters.upper(all[k], centre, 2, squared);
      lower_to(s.near, sqrt(squared) + error);
    });
    const Eight limit = reach(s.near, 3 * cell_diagonal);
    team.each(count, [&](int k) {
      Eight squared;
      const Eight farthest = limit + clusters.lower(all[k], centre, 2, squared);
      for (unsigned bits = at_most(squared, farthest * farthest); bits; bits &= bits - 1)
        s.block[lowest_bit(bits)].add(all[k]);
    });
  }

  /// Fills the lists of a block's octets; those of a block without a list overflow.
  NACRE_HD void sift_block(Team& team, const Vec3d& centre, int b, Scratch& s) const {
    const auto& block = s.block[b];
    const int count = block.listed() ? block.count : 0;
    team.each(8, [&](int o) { s.near[o] = 1e15f, s.octet[8 * b + o].count = block.listed() ? 0 : 1 << 20; });
    team.each(count, [&](int k) {
      const std::uint32_t c = block.item[k];
      Eight squared;
      s.error[k] = clusters.lower(c, centre, 1, squared);
      store_eight(s.squared + 8 * k, squared);
      const float error = clusters.single(c) ? s.error[k] : clusters.upper(c, centre, 1, squared);
      lower_to(s.near, sqrt(squared) + error);
    });
    const Eight limit = reach(s.near, cell_diagonal);
    team.each(count, [&](int k) {
      const Eight farthest = limit + s.error[k];
      for (unsigned bits = at_most(load_eight(s.squared + 8 * k), farthest * farthest); bits; bits &= bits - 1)
        s.octet[8 * b + lowest_bit(bits)].add(std::uint8_t(k));
    });
    team.each(8, [&](int o) { s.octet_near[8 * b + o] = s.near[o]; });
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
