// Nacre: which materials meet where: surfaces of two, curves of three, points of four (sec. 3.6).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/embedding/junctions_in_cell.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/sizing.hpp"
#include "compute/math/bits.hpp"

namespace nacre {

/// A junction that passes through some of the 4^3 cells of a coarse cell.
struct FoundJunction {
  Junction junction;
  std::uint32_t coarse = 0;
  CellWindow window;
};

/// All that were found, in temporary memory of the caller's scope, and the surfaces and curves among them in order.
struct JunctionSearch {
  Array<FoundJunction> found;
  std::int64_t count = 0;
  std::vector<Junction> table;
  int crowded_cells =
      0;  ///< coarse cells with more materials or junctions than can be distinguished: some are left out
};

namespace detail {

/// Launched twice: without `found` it counts a cell's junctions and keeps the first ones, with it lists them, and
/// searches only those cells again that have more. One kernel, so that both decide alike where rounding decides.
struct SearchJunctions {
  static constexpr std::uint32_t kept = 2;  ///< per cell; there are more only where materials meet along curves

  SearchCoarseCell search;
  const std::uint32_t* cell;  ///< those that are searched
  FoundJunction* first;       ///< `kept` per cell
  std::uint32_t* count;       // when it counts
  std::uint32_t* crowded;     // 1 where something was left out
  const std::uint32_t* start = nullptr;
  FoundJunction* found = nullptr;
  std::uint64_t* packed = nullptr;

  NACRE_HD void operator()(std::int64_t i) const {
    FoundJunction* own = first + i * kept;
    if (found && start[i + 1] - start[i] <= kept) {
      for (std::uint32_t k = start[i]; k < start[i + 1]; ++k) list(k, own[k - start[i]]);
      return;
    }
    CellJunctions junctions;
    search(cell[i], junctions);
    for (int k = 0; k < junctions.count; ++k) {
      const FoundJunction junction{junctions.junction[k], cell[i], junctions.window[k]};
      if (found)
        list(start[i] + std::uint32_t(k), junction);
      else if (std::uint32_t(k) < kept)
        own[k] = junction;
    }
    if (found) return;
    count[i] = std::uint32_t(junctions.count);
    crowded[i] = junctions.complete ? 0 : 1;
  }

 private:
  NACRE_HD void list(std::uint32_t position, const FoundJunction& junction) const {
    found[position] = junction;
    packed[position] = junction.junction.packed;
  }
};

/// Marks the coarse cells around which there can be voxels of more than one material: those near blocks with a list.
struct MarkCoarseCells {
  MaterialBricksView field;
  const std::uint32_t* listed;
  Int3 coarse;
  float cells_per_voxel;
  std::uint64_t* marked;  ///< a bit per coarse cell

  NACRE_HD void operator()(std::int64_t i) const {
    const Int3 block = field.block(listed[i]);
    Int3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const float per_voxel = cells_per_voxel / (4 * field.cells_per_unit[axis]);
      low[axis] = int(max(std::floor((float(block[axis] * block_size) - 2) * per_voxel), 0.0f));
      high[axis] = int((float((block[axis] + 1) * block_size) + 2) * per_voxel);
    }
    high = min(high, coarse - Int3(1));
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y) {
        const std::int64_t row = (std::int64_t(z) * coarse.y + y) * coarse.x;
        mark(row + low.x, row + high.x);
      }
  }

 private:
  /// Cells `first` to `last`, both included.
  NACRE_HD void mark(std::int64_t first, std::int64_t last) const {
    constexpr std::uint64_t all = ~std::uint64_t(0);
    for (std::int64_t w = first >> 6; w <= last >> 6; ++w) {
      const std::uint64_t from = w == first >> 6 ? all << (first & 63) : all;
      const std::uint64_t to = w == last >> 6 ? all >> (63 - (last & 63)) : all;
      atomic_or(marked + w, from & to);
    }
  }
};

struct CountMarked {
  const std::uint64_t* marked;
  std::uint32_t* count;
  NACRE_HD void operator()(std::int64_t w) const { count[w] = std::uint32_t(count_bits(marked[w])); }
};

struct ListMarked {
  const std::uint64_t* marked;
  const std::uint32_t* start;
  std::uint32_t* cell;
  NACRE_HD void operator()(std::int64_t w) const {
    std::uint32_t* to = cell + start[w];
    for (int k = 0; k < 64; ++k)
      if (marked[w] >> k & 1) *to++ = std::uint32_t(w * 64 + k);
  }
};

struct FirstOfJunction {
  const std::uint64_t* packed;
  std::uint32_t* first;
  NACRE_HD void operator()(std::int64_t i) const { first[i] = i == 0 || packed[i] != packed[i - 1] ? 1 : 0; }
};

struct ListFirst {
  const std::uint64_t* packed;
  const std::uint32_t* number;
  Junction* table;
  NACRE_HD void operator()(std::int64_t i) const {
    if (i == 0 || packed[i] != packed[i - 1]) table[number[i]].packed = packed[i];
  }
};

/// Junction points near the coarse cells in which one was found: position and size; size 0 where there is none. Looked
/// for from the middle of what was found and, where `starts` is more than one, from each of the cells there and beside
/// them: a coarse cell of several voxels may have two.
struct FindJunctionPoints {
  MaterialBricksView field;
  SizingFieldView size;
  Int3 coarse;
  float cells_per_voxel;
  const FoundJunction* found;
  int starts;  ///< 1 or 65
  Float4* point;
  NACRE_HD void operator()(std::int64_t i) const {
    point[i] = {0, 0, 0, 0};
    const FoundJunction f = found[i / starts];
    const Int3 low = f.window.low(), high = f.window.high();
    const int cell = int(i % starts) - 1;
    const Int3 b{int(f.coarse % coarse.x), int(f.coarse / coarse.x % coarse.y), int(f.coarse / coarse.x / coarse.y)};
    Vec3f middle;
    for (int axis = 0; axis < 3; ++axis) {
      const int k = cell >> 2 * axis & 3;
      if (cell >= 0 && (k + 1 < low[axis] || k - 1 > high[axis])) return;
      middle[axis] = b[axis] * 4 + (cell < 0 ? 0.5f * float(low[axis] + high[axis] + 1) : float(k) + 0.5f);
    }
    JunctionPoint at;
    if (!project(field, f.junction, middle / cells_per_voxel, cells_per_voxel < 1 ? 6 / cells_per_voxel : 6.0f, at))
      return;
    if (junction_margin(field, f.junction, at.p, at.steepness) < -0.1f) return;
    point[i] = {at.p.x, at.p.y, at.p.z, size(at.p)};
  }
};

}  // namespace detail

namespace detail {

/// The coarse cells that are worth searching, ascending. Temporary memory.
template <class Backend>
Array<std::uint32_t> cells_to_search(Executor<Backend>& exec, const MaterialBricks& b, const Int3& coarse,
                                     float cells_per_voxel) {
  Arena& arena = exec.arena();
  const std::int64_t words = (std::int64_t(coarse.x) * coarse.y * coarse.z + 63) / 64;
  Array<std::uint64_t> marked = arena.temporary<std::uint64_t>(words);
  Array<std::uint32_t> start = arena.temporary<std::uint32_t>(words);
  marked.fill_bytes(0);
  exec.for_each(std::int64_t(b.listed.size()),
                MarkCoarseCells{b.view(), b.listed.data(), coarse, cells_per_voxel, marked.data()});
  exec.for_each(words, CountMarked{marked.data(), start.data()});
  const std::uint32_t cells = exec.exclusive_scan(start.data(), start.data(), words);
  Array<std::uint32_t> cell = arena.temporary<std::uint32_t>(cells);
  exec.for_each(words, ListMarked{marked.data(), start.data(), cell.data()});
  return cell;
}

}  // namespace detail

/// Searches the cells along the interfaces. Temporary memory.
template <class Backend>
JunctionSearch find_junctions(Executor<Backend>& exec, const MaterialBricks& b, const Int3& coarse,
                              float cells_per_voxel) {
  Arena& arena = exec.arena();
  if (std::int64_t(coarse.x) * coarse.y * coarse.z >= std::int64_t(1) << 32)
    throw Error("embedding too large", "more than 2^32 coarse cells", "lower `mesh_subcells`");
  const detail::SearchCoarseCell search{b.view(), coarse, cells_per_voxel};
  const Array<std::uint32_t> cell = detail::cells_to_search(exec, b, coarse, cells_per_voxel);
  const auto cells = std::int64_t(cell.size());
  JunctionSearch result;
  Array<std::uint32_t> start = arena.temporary<std::uint32_t>(cells + 1);
  start.fill_bytes(0);
  Array<FoundJunction> first = arena.temporary<FoundJunction>(cells * detail::SearchJunctions::kept);
  {
    Arena::Scope scope(arena);
    Array<std::uint32_t> crowded = arena.temporary<std::uint32_t>(cells);
    exec.for_each(cells, detail::SearchJunctions{search, cell.data(), first.data(), start.data(), crowded.data()});
    result.crowded_cells = int(exec.exclusive_scan(crowded.data(), crowded.data(), cells));
  }
  result.count = exec.exclusive_scan(start.data(), start.data(), cells + 1);
  result.found = arena.temporary<FoundJunction>(result.count);
  Array<std::uint64_t> packed = arena.temporary<std::uint64_t>(result.count);
  exec.for_each(cells, detail::SearchJunctions{search, cell.data(), first.data(), nullptr, nullptr, start.data(),
                                               result.found.data(), packed.data()});
  exec.sort(packed.data(), result.count);
  Array<std::uint32_t> number = arena.temporary<std::uint32_t>(result.count);
  exec.for_each(result.count, detail::FirstOfJunction{packed.data(), number.data()});
  const std::uint32_t different = exec.exclusive_scan(number.data(), number.data(), result.count);
  Array<Junction> table = arena.temporary<Junction>(different);
  exec.for_each(result.count, detail::ListFirst{packed.data(), number.data(), table.data()});
  for (const Junction& j : table.download())
    if (j.order() > 0) result.table.push_back(j);
  return result;
}

/// The junction points. Where several lie within a third of h of each other, as where more than four materials meet,
/// the first stands for all. Returns how many stand for junctions of other materials, too.
template <class Backend>
int junction_points(Executor<Backend>& exec, const MaterialBricks& b, const SizingField& size,
                    const JunctionSearch& search, const Int3& coarse, float cells_per_voxel,
                    std::vector<Float4>& points, std::vector<Junction>& junctions) {
  Arena& arena = exec.arena();
  Arena::Scope scope(arena);
  std::vector<FoundJunction> found = search.found.download(0, search.count);
  std::erase_if(found, [](const FoundJunction& f) { return f.junction.order() != 0; });
  if (found.empty()) return 0;
  const int starts = cells_per_voxel > 1 ? 1 : 65;
  Array<FoundJunction> sought = arena.temporary<FoundJunction>(found.size());
  sought.upload(found);
  Array<Float4> position = arena.temporary<Float4>(found.size() * std::size_t(starts));
  exec.for_each(std::int64_t(position.size()),
                detail::FindJunctionPoints{b.view(), size.view(), coarse, cells_per_voxel, sought.data(), starts,
                                           position.data()});
  const std::vector<Float4> all = position.download();
  std::vector<bool> crowded;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].w <= 0) continue;
    const Junction junction = found[i / std::size_t(starts)].junction;
    std::size_t known = points.size();
    for (std::size_t k = points.size(); k-- > 0 && known == points.size();) {
      const Vec3f r(points[k].x - all[i].x, points[k].y - all[i].y, points[k].z - all[i].z);
      if (dot(r, r) < 0.1f * all[i].w * all[i].w) known = k;
    }
    if (known < points.size()) {
      if (!(junctions[known] == junction)) crowded[known] = true;
      continue;
    }
    points.push_back(all[i]);
    junctions.push_back(junction);
    crowded.push_back(false);
  }
  return int(std::count(crowded.begin(), crowded.end(), true));
}

}  // namespace nacre
