// Nacre: finds all interfaces of a volume's materials and embeds their closest points (sec. 4.1.1).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/find_junctions.hpp"
#include "compute/embedding/interface_grid.hpp"
#include "compute/embedding/junction_table.hpp"
#include "compute/field/sizing.hpp"

namespace nacre {

/// The interfaces of a volume and their embedding, in permanent memory.
struct InterfaceGrid {
  Int3 coarse{};
  float cells_per_voxel = 2;
  std::vector<Junction> junctions;  ///< by number: surfaces and curves; ascending, surfaces and curves mixed
  Array<Junction> junction;         ///< the same on the device
  std::vector<Float4> points;       ///< junction points: position in voxels, sizing field
  std::vector<Junction> point_junction;
  int crowded_points = 0;  ///< of the points, those where more than four materials meet
  int crowded_cells = 0;   ///< coarse cells with more junctions than could be distinguished
  std::int64_t bricks = 0;
  Array<CoarseWord> word;
  Array<std::uint32_t> brick_start, brick_interface, brick_coarse;
  Array<EmbeddedCell> cell;
  float size_unit = 1;
  bool seeds_only = false;

  InterfaceGridView view() const {
    return {coarse,      cells_per_voxel, word.data(), brick_start.data(), brick_interface.data(),
            cell.data(), size_unit,       seeds_only};
  }
  std::int64_t cells() const { return bricks * 64; }
  std::int64_t bytes() const {
    return std::int64_t(word.bytes() + brick_start.bytes() + brick_interface.bytes() + brick_coarse.bytes() +
                        cell.bytes());
  }
};

namespace detail {

/// Keys (coarse cell << 24 | interface) of the bricks within `reach` cells of a cell that an interface passes through.
struct BricksAround {
  static constexpr int of_seeds = 1;     ///< a seed's closest point is less than a cell away
  static constexpr int of_stencils = 3;  ///< what those of its particles can meet

  const FoundJunction* found;
  const Junction* table;
  std::uint32_t table_size;
  Int3 coarse;
  int reach;

  template <class Visit>
  NACRE_HD void operator()(std::int64_t i, const Visit& visit) const {
    const FoundJunction f = found[i];
    const Int3 low = f.window.low(), high = f.window.high();
    if (f.junction.order() == 0) return;
    const std::uint64_t interface = junction_number(table, table_size, f.junction);
    const Int3 c{int(f.coarse % coarse.x), int(f.coarse / coarse.x % coarse.y), int(f.coarse / coarse.x / coarse.y)};
    for (int z = low.z < reach ? -1 : 0; z <= (high.z > 3 - reach ? 1 : 0); ++z)
      for (int y = low.y < reach ? -1 : 0; y <= (high.y > 3 - reach ? 1 : 0); ++y)
        for (int x = low.x < reach ? -1 : 0; x <= (high.x > 3 - reach ? 1 : 0); ++x) {
          const Int3 d = c + Int3(x, y, z);
          if (is_within(d, coarse))
            visit(std::uint64_t((std::int64_t(d.z) * coarse.y + d.y) * coarse.x + d.x) << 24 | interface);
        }
  }
};

struct CountBricks {
  BricksAround around;
  std::uint64_t* count;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t n = 0;
    around(i, [&](std::uint64_t) { ++n; });
    count[i] = n;
  }
};

struct ListBricks {
  BricksAround around;
  const std::uint64_t* start;
  std::uint64_t* keys;
  NACRE_HD void operator()(std::int64_t i) const {
    std::uint64_t* to = keys + start[i];
    around(i, [&](std::uint64_t key) { *to++ = key; });
  }
};

struct NewKey {
  const std::uint64_t* keys;
  std::uint32_t* head;
  NACRE_HD void operator()(std::int64_t i) const { head[i] = i == 0 || keys[i] != keys[i - 1] ? 1 : 0; }
};

struct UniqueBricks {
  const std::uint64_t* keys;
  const std::uint32_t* number;
  std::uint32_t* interface;
  std::uint32_t* coarse;
  NACRE_HD void operator()(std::int64_t i) const {
    if (i > 0 && keys[i] == keys[i - 1]) return;
    interface[number[i]] = std::uint32_t(keys[i] & 0xffffff);
    coarse[number[i]] = std::uint32_t(keys[i] >> 24);
  }
};

/// Whether a brick is the first of its coarse cell.
struct FirstOfCoarse {
  const std::uint32_t* brick_coarse;
  std::uint32_t* first;
  NACRE_HD void operator()(std::int64_t i) const {
    first[i] = i == 0 || brick_coarse[i] != brick_coarse[i - 1] ? 1 : 0;
  }
};

/// Notes the first brick of each coarse cell that has some.
struct StartCoarse {
  const std::uint32_t* brick_coarse;
  const std::uint32_t* number;  ///< how many coarse cells have bricks before this one
  std::uint32_t* start;
  CoarseWord* word;
  NACRE_HD void operator()(std::int64_t i) const {
    const std::uint32_t c = brick_coarse[i];
    if (i > 0 && c == brick_coarse[i - 1]) return;
    start[number[i]] = std::uint32_t(i);
    atomic_or(&word[c >> 6].mask, std::uint64_t(1) << (c & 63));
    if (i == 0 || brick_coarse[i - 1] >> 6 != c >> 6) word[c >> 6].first = number[i];
  }
};

/// Projects a cell's centre onto its brick's interface.
struct EmbedInterface {
  MaterialBricksView field;
  DistanceFieldView distance;
  SizingFieldView size;
  const Junction* junction;
  Int3 coarse;
  float cells_per_voxel;
  const std::uint32_t* brick_coarse;
  const std::uint32_t* brick_interface;
  EmbeddedCell* cell;
  float size_unit;
  std::uint8_t* found;  ///< per cell: whether the projection arrived
  bool seeds_only;

  NACRE_HD Vec3f centre(std::int64_t i) const {
    const std::uint32_t c = brick_coarse[i / 64];
    const int k = int(i % 64);
    const Int3 b{int(c % coarse.x), int(c / coarse.x % coarse.y), int(c / coarse.x / coarse.y)};
    return cell_centre(b * Int3(4) + Int3(k % 4, k / 4 % 4, k / 16));
  }

  NACRE_HD void operator()(std::int64_t i) const {
    const Vec3f middle = centre(i), p = middle / cells_per_voxel;
    const Junction j = junction[brick_interface[i / 64]];
    cell[i] = EmbeddedCell({0, 0, 0, -4}, {0, 0, 0, 0}, size_unit);
    found[i] = 0;
    if (!field.inside(p, 3)) return;
    float away = 0;
    const std::uint32_t nearest = distance.closest(p, away);
    if ((nearest == none ? distance.reach : away) > farthest()) return;
    const bool own = nearest != none && j.order() == 2 && distance.point[nearest].surface == j;
    const std::uint32_t known = own ? nearest : none;
    if (own && is_too_far(known, away)) return;
    JunctionPoint at;
    const bool is_foot = own && seeds_only && find_foot(j, known, p, at);
    if (!is_foot && !find_closest(j, known, p, at)) return;
    const Vec3f o = at.p * cells_per_voxel - middle;
    if (seeds_only && dot(o, o) >= 1) return;  // no seed comes from here
    const float margin = is_foot ? only_margin : max(junction_margin(field, j, at.p, at.steepness), -4.0f);
    cell[i] =
        EmbeddedCell({o.x, o.y, o.z, margin}, {at.direction.x, at.direction.y, at.direction.z, size(at.p)}, size_unit);
    found[i] = 1;
  }

 private:
  static constexpr float close = 0.04f;  ///< as near to a surface as seeds need to be, voxels

  /// Steps end here: what is left then is less than WENO makes of such cells.
  NACRE_HD float last_step() const { return close / min(cells_per_voxel, 1.0f); }

  /// How far Newton's steps may lead.
  NACRE_HD float reach() const { return (seeds_only ? 2 : 5) / cells_per_voxel; }

  /// How far an interface may be: as far as its seeds' cells, or as the steps can lead, and the distance of known
  /// points from each other.
  NACRE_HD float farthest() const {
    return (seeds_only ? 1 / cells_per_voxel : min(reach(), newton_steps * newton_stride)) + 0.35f;
  }

  NACRE_HD Vec3f normal_at(std::uint32_t known) const {
    const Float4 n = distance.point[known].normal;
    return {n.x, n.y, n.z};
  }

  /// Whether a surface is farther away than the stencils around its points reach, two cells along each axis.
  NACRE_HD bool is_too_far(std::uint32_t known, float away) const {
    const Vec3f n = normal_at(known);
    return away > 2.3f / cells_per_voxel * (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z)) + 0.35f;
  }

  /// The foot of a point on the plane through the nearest known point of its surface: as good as the closest point for
  /// a seed to begin at. False where the surface bends away from the plane by more than `close`, where the known point
  /// is farther from there than a voxel, and where a third material is near.
  NACRE_HD bool find_foot(const Junction& j, std::uint32_t known, const Vec3f& p, JunctionPoint& at) const {
    const Float4& n = distance.point[known].normal;  // w: the larger curvature
    const Vec3f normal = normal_at(known), r = p - distance.position(known);
    const float height = dot(r, normal), aside = dot(r, r) - height * height;
    at.p = p - normal * height;
    at.direction = normal;
    return aside <= 1 && 0.5f * std::fabs(n.w) * aside <= close && field.inside(at.p, 3) && !has_others(field, j, at.p);
  }

  /// Newton's method onto the junction, from beside a known point if there is one (not `none`), and from there to the
  /// closest point.
  NACRE_HD bool find_closest(const Junction& j, std::uint32_t known, const Vec3f& p, JunctionPoint& at) const {
    if (!(known != none && project(field, j, beside(known, p), 3, at, last_step())) &&
        !project(field, j, p, reach(), at, last_step()))
      return false;
    for (int k = 0; k < 2; ++k) {  // along the tangent towards p and back onto the interface
      const Vec3f r = p - at.p;
      const Vec3f along =
          j.order() == 2 ? r - at.direction * dot(r, at.direction) : at.direction * dot(r, at.direction);
      if (dot(along, along) < 2.5f * last_step() * last_step()) break;
      JunctionPoint better;
      if (!project(field, j, at.p + along, 4, better, last_step()) || dot(better.p - p, better.p - p) >= dot(r, r))
        break;
      at = better;
    }
    return true;
  }

  /// Beside a known point of a surface, on its plane and towards p.
  NACRE_HD Vec3f beside(std::uint32_t known, const Vec3f& p) const {
    const Vec3f normal = normal_at(known), on = distance.position(known), r = p - on;
    Vec3f along = r - normal * dot(r, normal);
    const float most = 2, size = length(along);
    if (size > most) along *= most / size;
    return on + along;
  }
};

/// A cell without a closest point takes that of the neighbour whose point is the nearest to it.
struct BorrowClosestPoint {
  InterfaceGridView grid;
  EmbedInterface embed;

  NACRE_HD void operator()(std::int64_t i) const {
    if (embed.found[i]) return;
    const InterfaceBricks bricks{grid, embed.brick_interface[i / 64]};
    const Vec3f centre = embed.centre(i);
    const Int3 cell = floor_cell(centre);
    float least = 3e38f;
    std::uint32_t best = none;
    Vec3f best_offset;
    for (int k = 0; k < 27; ++k) {
      const Int3 c = cell + Int3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (!bricks.inside(c)) continue;
      const std::uint32_t b = bricks.brick(c.x >> 2, c.y >> 2, c.z >> 2);
      if (b == none) continue;
      const std::uint32_t at = b * 64 + ((c.z & 3) * 4 + (c.y & 3)) * 4 + (c.x & 3);
      if (!embed.found[at]) continue;
      const Float4 o = store(load(embed.cell[at]));
      const Vec3f from_here = cell_centre(c) + Vec3f(o.x, o.y, o.z) - centre;
      if (dot(from_here, from_here) < least) least = dot(from_here, from_here), best = at, best_offset = from_here;
    }
    if (best == none) return;
    const float margin = store(load(embed.cell[best])).w;
    embed.cell[i] =
        EmbeddedCell({best_offset.x, best_offset.y, best_offset.z, margin}, grid.direction(best), embed.size_unit);
  }
};

/// How the bricks of a coarse cell are found.
template <class Backend>
void index_coarse_cells(Executor<Backend>& exec, InterfaceGrid& grid) {
  Arena& arena = exec.arena();
  const std::int64_t coarse = std::int64_t(grid.coarse.x) * grid.coarse.y * grid.coarse.z;
  grid.word = arena.permanent<CoarseWord>((coarse + 63) / 64);
  grid.word.fill_bytes(0);
  Arena::Scope scope(arena);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(grid.bricks);
  exec.for_each(grid.bricks, FirstOfCoarse{grid.brick_coarse.data(), number.data()});
  const std::uint32_t used = exec.exclusive_scan(number.data(), number.data(), grid.bricks);
  grid.brick_start = arena.permanent<std::uint32_t>(used + 1);
  exec.for_each(grid.bricks,
                StartCoarse{grid.brick_coarse.data(), number.data(), grid.brick_start.data(), grid.word.data()});
  const std::uint32_t end[] = {std::uint32_t(grid.bricks)};
  part_of(arena, grid.brick_start, used, 1).upload(end);
}

}  // namespace detail

/// Finds the interfaces and embeds them, `cells_per_voxel` closest-point cells to a voxel and axis. Throws Error where
/// there are none, or more than `most_interfaces`. With `seeds_only`, closest points are found for the cells that seeds
/// come from alone, a third of what the stencils of particles need.
template <class Backend>
InterfaceGrid embed_interfaces(Executor<Backend>& exec, const MaterialBricks& b, const DistanceField& distance,
                               const SizingField& size, double cells_per_voxel, bool seeds_only = false) {
  Arena& arena = exec.arena();
  InterfaceGrid grid;
  grid.cells_per_voxel = float(cells_per_voxel);
  grid.seeds_only = seeds_only;
  const Int3 n = b.blocks * Int3(block_size);
  for (int axis = 0; axis < 3; ++axis)
    grid.coarse[axis] =
        int(std::ceil(double(n[axis]) / b.cells_per_unit[axis] * cells_per_voxel / InterfaceGridView::sub));
  std::uint64_t total = 0;
  Array<std::uint64_t> keys;
  Arena::Scope scope(arena);
  const JunctionSearch search = find_junctions(exec, b, grid.coarse, grid.cells_per_voxel);
  grid.crowded_cells = search.crowded_cells;
  if (search.table.empty()) throw Error("no interface in the volume", "it holds one material only");
  if (search.table.size() > most_interfaces)
    throw Error("too many interfaces", std::to_string(search.table.size()) + " pairs and triples of materials meet",
                "merge materials with `merge` or keep fewer with `materials`");
  grid.junctions = search.table;
  grid.junction = arena.permanent_copy<Junction>(search.table);
  const detail::BricksAround around{search.found.data(), grid.junction.data(), std::uint32_t(search.table.size()),
                                    grid.coarse,
                                    seeds_only ? detail::BricksAround::of_seeds : detail::BricksAround::of_stencils};
  {
    Array<std::uint64_t> start = arena.temporary<std::uint64_t>(search.found.size());
    exec.for_each(search.count, detail::CountBricks{around, start.data()});
    total = exec.exclusive_scan(start.data(), start.data(), search.count);
    keys = arena.temporary<std::uint64_t>(total);
    exec.for_each(search.count, detail::ListBricks{around, start.data(), keys.data()});
  }
  exec.sort(keys.data(), total);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(total);
  exec.for_each(total, detail::NewKey{keys.data(), number.data()});
  grid.bricks = exec.exclusive_scan(number.data(), number.data(), total);
  if (grid.bricks >= std::int64_t(1) << 26)
    throw Error("embedding too large", "more than 2^26 bricks", "lower `mesh_subcells`");
  grid.brick_interface = arena.permanent<std::uint32_t>(grid.bricks);
  grid.brick_coarse = arena.permanent<std::uint32_t>(grid.bricks);
  exec.for_each(
      total, detail::UniqueBricks{keys.data(), number.data(), grid.brick_interface.data(), grid.brick_coarse.data()});
  detail::index_coarse_cells(exec, grid);
  grid.cell = arena.permanent<EmbeddedCell>(grid.cells());
  grid.size_unit = 1.1f * size.largest / 65535;  // beside the interface it may be larger
  Array<std::uint8_t> found = arena.temporary<std::uint8_t>(grid.cells());
  const detail::EmbedInterface embed{b.view(),
                                     distance.view(),
                                     size.view(),
                                     grid.junction.data(),
                                     grid.coarse,
                                     grid.cells_per_voxel,
                                     grid.brick_coarse.data(),
                                     grid.brick_interface.data(),
                                     grid.cell.data(),
                                     grid.size_unit,
                                     found.data(),
                                     seeds_only};
  exec.for_each(grid.cells(), embed);
  if (!seeds_only) exec.for_each(grid.cells(), detail::BorrowClosestPoint{grid.view(), embed});
  grid.crowded_points =
      junction_points(exec, b, size, search, grid.coarse, grid.cells_per_voxel, grid.points, grid.point_junction);
  return grid;
}

}  // namespace nacre
