// Nacre: the exact closest points of the cells of a brick, among the clusters of triangles near it.
#pragma once

#include <cstdint>

#include "compute/device/executor.hpp"
#include "compute/embedding/brick_octree.hpp"
#include "compute/embedding/octet_search.hpp"
#include "compute/math/eight.hpp"

namespace nacre::detail {

/// Takes the minimum with eight floats >= 0 in memory that the lanes of a team share.
NACRE_HD_INLINE void lower_to(float* shared, const Eight& to) {
#if defined(__CUDA_ARCH__)
  for (int k = 0; k < 8; ++k) atomicMin(reinterpret_cast<int*>(shared) + k, __float_as_int(to[k]));
#else
  store_eight(shared, min(load_eight(shared), to));
#endif
}

/// Candidates for the closest points of a cube of cells, and for the triangles that touch them.
template <class Item, int Room>
struct ShortList {
  static constexpr int room = Room;
  int count;            // if over `Room`, some are not listed
  Item item[Room + 1];  // the last entry takes what is not listed

  NACRE_HD_INLINE bool listed() const { return count <= Room; }

  /// Lists `what` if `yes`; on the host without a branch that a processor would mispredict.
  NACRE_HD_INLINE void add_if(bool yes, Item what) {
#if defined(__CUDA_ARCH__)
    if (!yes) return;
    const int slot = atomicAdd(&count, 1);
    if (slot < Room) item[slot] = what;
#else
    item[count < Room ? count : Room] = what;
    count += yes;
#endif
  }
};

/// Masks and closest points of a brick's cells, with a team per brick. Candidates are sifted twice, for the brick's
/// eight blocks (4^3 cells) and for their octets; then every octet is searched.
///
/// A part (a block, an octet) drops a cluster that is farther from its centre than the surface, plus the distance
/// between the centre and the part's outermost cells and back: some other triangle is nearer to all of its cells. It
/// also drops what is beyond the band's radius, and with it the parts that have no cell in the band.
struct ClosestInBrick {
  static constexpr int cells = 512;  // room for points per brick

  ClusterView clusters;
  double radius;
  float quantum;
  const std::uint64_t* code;        // per brick
  const std::uint64_t* list_start;  // its clusters
  const std::uint32_t* list;
  OctreeBrick* brick;  // receives the words of the masks
  CellPoint* point;    // cell (x, y, z) of brick i: 512 i + 64 z + 8 y + x

#if defined(__CUDACC__)
  static constexpr int room = 96, octet_room = 44;  // clusters; more take memory that few thread blocks could share
#else
  static constexpr int room = 256, octet_room = 96;
#endif
  struct Scratch {
    float near[8];  // upper bounds of the distance of the surface from the centres of a cube's parts
    float octet_near[64];
    float slack[room];  // of the clusters being sifted, and their distances from the parts
    float squared[8 * room];
    ShortList<std::uint32_t, room> block[8];
    ShortList<std::uint8_t, octet_room> octet[64];  // of the items of the block's list
    std::uint8_t band[64], surface[64];             // per octet
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

  /// Stores the result of an octet.
  NACRE_HD void store(std::int64_t i, int o, const Int3& low, const OctetSearch& found, Scratch& s) const {
    const unsigned band = found.in_band(radius);
    if (!band) return;
    CellPoint* first = point + i * cells + 64 * low.z + 8 * low.y + low.x;
    found.pack(band, quantum, [&](int k) -> CellPoint& { return first[64 * (k >> 2) + 8 * (k >> 1 & 1) + (k & 1)]; });
    s.band[o] = std::uint8_t(band);
    s.surface[o] = std::uint8_t(found.touched() & band);
  }

  /// How far from the centres of parts a cluster matters; `spread` is the distance from there to the outermost cells.
  NACRE_HD_INLINE Eight reach(const float* near, float spread) const {
    return max(min(load_eight(near) + spread, eight(float(radius))), eight(cell_diagonal)) + (spread + 1e-4f);
  }

  /// Fills the lists of the blocks.
  NACRE_HD void sift_brick(Team& team, const Vec3d& centre, const std::uint32_t* all, int count, Scratch& s) const {
    team.each(8, [&](int b) { s.block[b].count = 0; });
    sift(
        team, s, centre, 2, count, [&](int k) { return all[k]; },
        [&](int b, int k, bool yes) { s.block[b].add_if(yes, all[k]); });
  }

  /// Fills the lists of a block's octets; if the block has no list, they overflow.
  NACRE_HD void sift_block(Team& team, const Vec3d& centre, int b, Scratch& s) const {
    const auto& block = s.block[b];
    team.each(8, [&](int o) {
      s.octet[8 * b + o].count = block.listed() ? 0 : 1 << 20;
      s.octet_near[8 * b + o] = 1e15f;
    });
    if (!block.listed() || block.count == 0) return;
    sift(
        team, s, centre, 1, block.count, [&](int k) { return block.item[k]; },
        [&](int o, int k, bool yes) { s.octet[8 * b + o].add_if(yes, std::uint8_t(k)); });
    team.each(8, [&](int o) { s.octet_near[8 * b + o] = s.near[o]; });
  }

  /// Calls add(part, k, yes) for the clusters at(0) .. at(count - 1); `yes`: it may matter for that part of the cube
  /// around `centre`, whose parts are cubes with half edge `half`; `near` receives upper bounds of the distance of the
  /// surface from their centres.
  template <class At, class Add>
  NACRE_HD void sift(Team& team, Scratch& s, const Vec3d& centre, float half, int count, const At& at,
                     const Add& add) const {
    team.each(8, [&](int p) { s.near[p] = 1e15f; });
    team.each(count, [&](int k) {
      Eight squared;
      const auto slack = clusters.distances(at(k), centre, half, squared);
      if (k < room) s.slack[k] = slack.lower, store_eight(s.squared + 8 * k, squared);
      lower_to(s.near, sqrt(squared) + slack.upper);
    });
    const Eight limit = reach(s.near, (2 * half - 1) * cell_diagonal);
    team.each(count, [&](int k) {
      Eight squared;
      float slack;
      if (k < room)
        slack = s.slack[k], squared = load_eight(s.squared + 8 * k);
      else
        slack = clusters.distances(at(k), centre, half, squared).lower;
      const Eight farthest = limit + slack;
      const unsigned bits = at_most(squared, farthest * farthest);
      for (int p = 0; p < 8; ++p) add(p, k, bits >> p & 1);
    });
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
