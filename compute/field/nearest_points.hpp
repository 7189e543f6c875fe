// Nacre: which interface point is the nearest to each cell of a lattice.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "compute/device/executor.hpp"
#include "compute/device/team.hpp"
#include "compute/field/interface_points.hpp"

namespace nacre {
namespace detail {

/// The least of many squared distances, and which one of up to 512 it is: in one word, so that a minimum of integers
/// finds both. Distances that differ by less than 2^-14 of them count as equal.
struct LeastOf {
  static constexpr std::uint32_t most = 512;
  std::uint32_t word = ~std::uint32_t(0);
  NACRE_HD_INLINE LeastOf() {}
  NACRE_HD_INLINE LeastOf(float square, int k) {
    std::uint32_t bits;  // ascend with the number, since it is not negative
    std::memcpy(&bits, &square, sizeof bits);
    word = (bits & ~(most - 1)) | std::uint32_t(k);
  }
  NACRE_HD_INLINE int index() const { return int(word & (most - 1)); }
  NACRE_HD_INLINE friend LeastOf operator+(const LeastOf& a, const LeastOf& b) {
    LeastOf least;
    least.word = a.word < b.word ? a.word : b.word;
    return least;
  }
};

/// Points, each coordinate by itself, as vector instructions want them.
struct Coordinates {
  const float *x, *y, *z;

  NACRE_HD_INLINE Vec3f at(int k) const { return {x[k], y[k], z[k]}; }
  /// Of one of the first 512 points.
  NACRE_HD_INLINE LeastOf square(int k, const Vec3f& from) const {
    const float rx = x[k] - from.x, ry = y[k] - from.y, rz = z[k] - from.z;
    return LeastOf(rx * rx + ry * ry + rz * rz, k);
  }
};

/// Interface points by the stored tiles that their cells are in.
struct PointsInTilesView {
  Coordinates all;             ///< `nowhere` where there is none
  const std::uint32_t* first;  ///< per stored tile and one more: its first point
  const Vec3f *low, *high;     ///< per stored tile: around its points; low > high where it has none

  static constexpr float nowhere = 1e18f;

  NACRE_HD int count(std::uint32_t tile) const { return int(first[tile + 1] - first[tile]); }
  NACRE_HD Coordinates of(std::uint32_t tile) const {
    return {all.x + first[tile], all.y + first[tile], all.z + first[tile]};
  }
};

struct SplitPosition {
  const InterfacePoint* point;
  float *x, *y, *z;
  NACRE_HD void operator()(std::int64_t i) const {
    const Float4 at = point[i].position;
    const bool there = at.w >= 0;
    x[i] = there ? at.x : PointsInTilesView::nowhere;
    y[i] = there ? at.y : PointsInTilesView::nowhere;
    z[i] = there ? at.z : PointsInTilesView::nowhere;
  }
};

struct FirstPointOfTile {
  const std::uint32_t* start;  ///< per slot
  std::int64_t tiles;
  std::uint32_t points;
  std::uint32_t* first;
  NACRE_HD void operator()(std::int64_t s) const { first[s] = s < tiles ? start[s * Lattice::tile_cells] : points; }
};

struct BoxOfTile {
  const InterfacePoint* point;
  const std::uint32_t* first;
  Vec3f *low, *high;
  NACRE_HD void operator()(std::int64_t s) const {
    Vec3f least(PointsInTilesView::nowhere), most(-PointsInTilesView::nowhere);
    for (std::uint32_t i = first[s]; i < first[s + 1]; ++i) {
      const Float4 at = point[i].position;
      if (at.w < 0) continue;
      least = min(least, Vec3f(at.x, at.y, at.z));
      most = max(most, Vec3f(at.x, at.y, at.z));
    }
    low[s] = least, high[s] = most;
  }
};

/// Cell centres from `centre` - `half` to `centre` + `half`, and a point that is near them. Another one can be nearer
/// to one of them only on this side of the plane halfway between the two: the difference of its squared distances,
/// which is linear in the place, is looked at where it is the smallest.
struct CellsBesidePoint {
  Vec3f centre, half;
  Vec3f seen;  ///< the point, as it lies from the centre
  float square;

  NACRE_HD CellsBesidePoint(const Vec3f& centre_, const Vec3f& half_, const Vec3f& point)
      : centre(centre_), half(half_), seen(point - centre_), square(dot(seen, seen)) {}

  /// True also of points that are as near, and of some that are not.
  NACRE_HD_INLINE bool may_be_nearer(const Coordinates& points, int k) const {
    const float rx = points.x[k] - centre.x, ry = points.y[k] - centre.y, rz = points.z[k] - centre.z;
    const float other = rx * rx + ry * ry + rz * rz;
    const float gain =
        2 * (std::fabs(rx - seen.x) * half.x + std::fabs(ry - seen.y) * half.y + std::fabs(rz - seen.z) * half.z);
    return other - square <= gain + rounding * (other + square);
  }

  /// No cell is farther from the point.
  NACRE_HD float farthest() const {
    return length(Vec3f(std::fabs(seen.x) + half.x, std::fabs(seen.y) + half.y, std::fabs(seen.z) + half.z));
  }

 private:
  static constexpr float rounding = 1e-5f;
};

/// Finds for all cells of a tile the nearest point. Of the points of the tiles around, those are listed that can be the
/// nearest to one of its cells; of these, for each octant of the tile, those that can be for one of the octant's; and
/// each lane goes through them for a block of 2^3 cells.
struct FindNearestPoints {
  PointsInTilesView points;
  TilesView tiles;
  Int3 rings;  ///< of tiles around one that can have points within reach
  float reach;
  std::uint32_t* nearest;  ///< per slot

  static constexpr std::size_t scratch_bytes() { return sizeof(Found); }

  NACRE_HD void operator()(Team& team, std::int64_t s) const {
    auto& found = *reinterpret_cast<Found*>(team.scratch());
    team.each(Lattice::tile_cells, [&](int k) {
      found.least[k] = reach * reach;
      found.nearest[k] = none;
    });
    const Int3 at = tiles.lattice.tile_at(tiles.tile[s]);
    const Vec3f half = half_of(n), centre = tiles.lattice.centre(at * Int3(n)) + half;
    Vec3f near;
    if (find_near(team, at, centre, near)) list_and_search(team, at, {centre, half, near}, found);
    team.each(Lattice::tile_cells, [&](int k) {
      const bool holds = tiles.lattice.holds(at * Int3(n) + Int3(k % n, k / n % n, k / (n * n)));
      nearest[s * Lattice::tile_cells + k] = holds ? found.nearest[k] : none;
    });
  }

 private:
  static constexpr int n = Lattice::tile;
  static constexpr int capacity = int(LeastOf::most), group = 16;

  /// Points, as they lie from the centre of the tile.
  struct List {
    float x[capacity], y[capacity], z[capacity];
    std::uint32_t number[capacity];
    NACRE_HD_INLINE Coordinates points() const { return {x, y, z}; }
  };
  struct Found {
    List of_tile, of_octant;
    float least[Lattice::tile_cells];  ///< per cell: its squared distance from the nearest one so far
    std::uint32_t nearest[Lattice::tile_cells];
  };

  /// Of so many cells along each axis.
  NACRE_HD Vec3f half_of(int cells) const { return tiles.lattice.spacing * (0.5f * float(cells - 1)); }

  /// visit(stored tile) of those around that have points; the tile itself first.
  template <class Visit>
  NACRE_HD void each_tile_around(const Int3& at, const Visit& visit) const {
    const std::uint32_t own = tiles.beside(at, Int3(0));
    if (points.count(own) > 0) visit(own);
    const Int3 low = max(at - rings, Int3(0)), high = min(at + rings, tiles.lattice.tiles() - Int3(1));
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const std::uint32_t t = tiles.stored[tiles.lattice.tile_number({x, y, z})];
          if (t != none && t != own && points.count(t) > 0) visit(t);
        }
  }

  /// How far a tile's points are at least from the box around `centre`.
  NACRE_HD float distance(std::uint32_t tile, const Vec3f& centre, const Vec3f& half) const {
    const Vec3f below = points.low[tile] - (centre + half), above = (centre - half) - points.high[tile];
    return length(max(max(below, above), Vec3f(0)));
  }

  /// A point near `centre`; false where none is within reach of the tile.
  NACRE_HD bool find_near(Team& team, const Int3& at, const Vec3f& centre, Vec3f& near) const {
    float least = reach + length(tiles.lattice.spacing) * (0.5f * n);
    bool any = false;
    each_tile_around(at, [&](std::uint32_t t) {
      if (distance(t, centre, Vec3f(0)) >= least) return;
      const Coordinates of_tile = points.of(t);
      const LeastOf nearest_of_tile =
          team.sum(points.count(t), LeastOf(), [&](int k) { return of_tile.square(k, centre); });
      const Vec3f p = of_tile.at(nearest_of_tile.index());
      if (!(length(p - centre) < least)) return;
      least = length(p - centre);
      near = p;
      any = true;
    });
    return any;
  }

  /// Lists the points that can be the nearest to one of the tile's cells, and looks at them whenever the list is full.
  NACRE_HD void list_and_search(Team& team, const Int3& at, const CellsBesidePoint& cells, Found& found) const {
    const float farthest = min(cells.farthest(), reach);
    int count = 0;
    each_tile_around(at, [&](std::uint32_t t) {
      if (distance(t, cells.centre, cells.half) > farthest) return;
      const Coordinates of_tile = points.of(t);
      const int end = points.count(t);
      for (int i = 0; i < end; i += Team::lanes) {
        count = keep(team, cells, of_tile, i, end, cells.centre, found.of_tile, count,
                     [&](int k) { return points.first[t] + std::uint32_t(k); });
        if (count > capacity - Team::lanes) {
          search(team, count, found);
          count = 0;
        }
      }
    });
    if (count > 0) search(team, count, found);
  }

  /// Adds those of a team's points from number `i` on, before `end`, that can be the nearest to one of the cells, to
  /// the `count` in the list, as they lie from `origin`. Returns how many it has then.
  template <class Number>
  NACRE_HD static int keep(Team& team, const CellsBesidePoint& cells, const Coordinates& from, int i, int end,
                           const Vec3f& origin, List& list, int count, const Number& number) {
    return count + team.compact(
                       end - i < Team::lanes ? end - i : Team::lanes,
                       [&](int k) { return cells.may_be_nearer(from, i + k); },
                       [&](int k, int place) {
                         const Vec3f p = from.at(i + k) - origin;
                         list.x[count + place] = p.x, list.y[count + place] = p.y, list.z[count + place] = p.z;
                         list.number[count + place] = number(i + k);
                       });
  }

  /// Looks at the `count` points listed for the tile, octant by octant.
  NACRE_HD void search(Team& team, int count, Found& found) const {
    const List& all = found.of_tile;
    List& some = found.of_octant;
    for (int octant = 0; octant < 8; ++octant) {
      const Int3 first = Int3(octant & 1, octant >> 1 & 1, octant >> 2) * Int3(n / 2);
      const Vec3f half = half_of(n / 2), centre = centre_of(first) + half;
      const LeastOf least = team.sum(count, LeastOf(), [&](int k) { return all.points().square(k, centre); });
      const CellsBesidePoint cells(centre, half, all.points().at(least.index()));
      int kept = 0;
      for (int i = 0; i < count; i += Team::lanes)
        kept = keep(team, cells, all.points(), i, count, Vec3f(0), some, kept, [&](int k) { return all.number[k]; });
      const int filled = (kept + group - 1) / group * group;
      team.each(filled - kept,
                [&](int k) { some.x[kept + k] = some.y[kept + k] = some.z[kept + k] = PointsInTilesView::nowhere; });
      team.each(8, [&](int block) {
        search_block(first + Int3(block & 1, block >> 1 & 1, block >> 2) * Int3(2), filled, found);
      });
    }
  }

  /// Centre of a cell in the tile, from the centre of the tile.
  NACRE_HD Vec3f centre_of(const Int3& cell) const { return Vec3f(cell) * tiles.lattice.spacing - half_of(n); }

  /// The 2^3 cells from `first` on, in the tile.
  struct Cells {
    static constexpr int count = 8;
    float x[count], y[count], z[count], least[count];
    std::uint32_t nearest[count];

    NACRE_HD_INLINE void look_at(float px, float py, float pz, std::uint32_t number) {
#if !defined(__CUDACC__)
#pragma omp simd
#endif
      for (int k = 0; k < count; ++k) {
        const float rx = px - x[k], ry = py - y[k], rz = pz - z[k], d = rx * rx + ry * ry + rz * rz;
        const bool nearer = (d < least[k]) | ((d == least[k]) & (number < nearest[k]));
        least[k] = nearer ? d : least[k];
        nearest[k] = nearer ? number : nearest[k];
      }
    }
  };

  /// Looks at `count` points of the octant, a multiple of `group`.
  NACRE_HD void search_block(const Int3& first, int count, Found& found) const {
    const List& list = found.of_octant;
    const Vec3f spacing = tiles.lattice.spacing, begin = centre_of(first), half = half_of(2), centre = begin + half;
    LeastOf least;
    for (int k = 0; k < count; ++k) least = least + list.points().square(k, centre);
    const CellsBesidePoint block(centre, half, list.points().at(least.index()));
    const auto place = [&](int k) {
      return Lattice::place(first.x + (k & 1), first.y + (k >> 1 & 1), first.z + (k >> 2));
    };
    Cells cells;
    for (int k = 0; k < Cells::count; ++k) {
      cells.x[k] = begin.x + float(k & 1) * spacing.x;
      cells.y[k] = begin.y + float(k >> 1 & 1) * spacing.y;
      cells.z[k] = begin.z + float(k >> 2) * spacing.z;
      cells.least[k] = found.least[place(k)];
      cells.nearest[k] = found.nearest[place(k)];
    }
    for (int i = 0; i < count; i += group) {
      std::uint32_t near[group], any = 0;
#if !defined(__CUDACC__)
#pragma omp simd reduction(| : any)
#endif
      for (int k = 0; k < group; ++k) {
        near[k] = block.may_be_nearer(list.points(), i + k) ? 1 : 0;
        any |= near[k];
      }
      if (!any) continue;
      for (int k = 0; k < group; ++k)
        if (near[k]) cells.look_at(list.x[i + k], list.y[i + k], list.z[i + k], list.number[i + k]);
    }
    for (int k = 0; k < Cells::count; ++k) {
      found.least[place(k)] = cells.least[k];
      found.nearest[place(k)] = cells.nearest[k];
    }
  }
};

}  // namespace detail

/// For each cell of `tiles` the nearest of the points within `reach` voxels, of several the first; `none` where there
/// is none. Points are in the order of their cells' slots, and `nearest`, per slot, holds how many come before each.
///
/// Exact: a point is passed over only where another one is nearer to all cells of a block.
template <class Backend>
void find_nearest_points(Executor<Backend>& exec, const LatticeTiles& tiles, const Array<InterfacePoint>& point,
                         float reach, const Array<std::uint32_t>& nearest) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  const std::int64_t count = tiles.count(), points = std::int64_t(point.size());
  const auto first = arena.temporary<std::uint32_t>(std::size_t(count + 1));
  const auto low = arena.temporary<Vec3f>(std::size_t(count)), high = arena.temporary<Vec3f>(std::size_t(count));
  Array<float> at[3];
  for (Array<float>& along : at) along = arena.temporary<float>(std::size_t(points));
  exec.for_each(count + 1, detail::FirstPointOfTile{nearest.data(), count, std::uint32_t(points), first.data()});
  exec.for_each(points, detail::SplitPosition{point.data(), at[0].data(), at[1].data(), at[2].data()});
  exec.for_each(count, detail::BoxOfTile{point.data(), first.data(), low.data(), high.data()});
  Int3 rings;
  for (int axis = 0; axis < 3; ++axis)
    rings[axis] =
        int(std::ceil((reach + InterfacePoint::farthest + 1) / (Lattice::tile * tiles.lattice.spacing[axis])));
  exec.for_each_team(count, detail::FindNearestPoints{
                                {{at[0].data(), at[1].data(), at[2].data()}, first.data(), low.data(), high.data()},
                                tiles.view(),
                                rings,
                                reach,
                                nearest.data()});
}

}  // namespace nacre
