// Nacre: which materials meet where: surfaces of two, curves of three, points of four (sec. 3.6).
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compute/device/executor.hpp"
#include "compute/field/interface.hpp"
#include "compute/field/sizing.hpp"
#include "compute/math/bits.hpp"

namespace nacre {

/// A junction that passes through some of the 4^3 cells of a coarse cell.
struct FoundJunction {
  Junction junction;
  std::uint32_t coarse = 0;
  std::uint32_t window = 0;  ///< lowest and highest of the cells, two bits each

  NACRE_HD int low(int axis) const { return int(window >> 2 * axis) & 3; }
  NACRE_HD int high(int axis) const { return int(window >> (6 + 2 * axis)) & 3; }
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

/// The junctions of one coarse cell: at most this many different ones are distinguished.
struct CellJunctions {
  static constexpr int capacity = 64;
  Junction junction[capacity];
  std::uint32_t window[capacity];
  int count = 0;
  bool complete = true;  // nothing was left out, neither a junction nor a material that could have made some

  NACRE_HD void add(const Junction& j, const Int3& cell) {
    int k = 0;
    while (k < count && !(junction[k] == j)) ++k;
    if (k == count) {
      if (count == capacity) {
        complete = false;
        return;
      }
      junction[count++] = j;
      window[k] = pack(cell, cell);
      return;
    }
    Int3 low, high;
    for (int axis = 0; axis < 3; ++axis) {
      const int a = int(window[k] >> 2 * axis) & 3, b = int(window[k] >> (6 + 2 * axis)) & 3;
      low[axis] = a < cell[axis] ? a : cell[axis];
      high[axis] = b > cell[axis] ? b : cell[axis];
    }
    window[k] = pack(low, high);
  }

 private:
  NACRE_HD static std::uint32_t pack(const Int3& low, const Int3& high) {
    return std::uint32_t(low.x | low.y << 2 | low.z << 4 | high.x << 6 | high.y << 8 | high.z << 10);
  }
};

/// Looks into the cells of a coarse cell, at samples no farther apart than the voxels.
struct SearchCoarseCell {
  MaterialBricksView field;
  Int3 coarse;
  float cells_per_voxel;
  int samples;  ///< per coarse cell and axis

  SearchCoarseCell(const MaterialBricksView& f, const Int3& c, float cells)
      : field(f), coarse(c), cells_per_voxel(cells), samples(cells >= 1 ? 4 : int(std::ceil(4 / cells))) {}

  NACRE_HD void operator()(std::int64_t c, CellJunctions& result) const {
    const Int3 b{int(c % coarse.x), int(c / coarse.x % coarse.y), int(c / coarse.x / coarse.y)};
    if (!mixed(b)) return;
    for (int z = 0; z < samples; ++z)
      for (int y = 0; y < samples; ++y)
        for (int x = 0; x < samples; ++x) {
          const Vec3f position = Vec3f(b * Int3(4)) + Vec3f(x + 0.5f, y + 0.5f, z + 0.5f) * (4.0f / float(samples));
          search(position / cells_per_voxel, {4 * x / samples, 4 * y / samples, 4 * z / samples}, result);
        }
  }

 private:
  static constexpr int most = 8;
  NACRE_HD float spacing() const { return 4 / (cells_per_voxel * float(samples)); }

  NACRE_HD Int3 voxel(const Vec3f& p) const {
    const Vec3f u = p * field.cells_per_unit - Vec3f(0.5f);
    return {int(std::floor(u.x)), int(std::floor(u.y)), int(std::floor(u.z))};
  }

  /// Whether the voxels around a coarse cell are of more than one material.
  NACRE_HD bool mixed(const Int3& b) const {
    const Int3 n = field.voxels();
    const Int3 low = max(voxel(Vec3f(b * Int3(4)) / cells_per_voxel), Int3(0));
    const Int3 high = min(voxel(Vec3f((b + Int3(1)) * Int3(4)) / cells_per_voxel) + Int3(1), n - Int3(1));
    if (low.x > high.x || low.y > high.y || low.z > high.z) return false;
    const std::uint16_t own = field.material(low);
    return !field.each_material(low, high + Int3(1), [&](std::uint16_t m) { return m == own; });
  }

  NACRE_HD void search(const Vec3f& p, const Int3& local, CellJunctions& result) const {
    if (!field.inside(p, 3)) return;
    std::uint32_t material[most];
    int count = materials_around(p, material, result.complete);
    if (count < 2) return;
    const CubicStencil stencil(field, p);
    FieldSample f[most];
    int top = 0;
    for (int m = 0; m < count; ++m) {
      f[m] = stencil.sample(field, material[m]);
      if (f[m].value > f[top].value) top = m;
    }
    const float cell = spacing();
    const FieldSample first = f[top];
    int kept = 0;
    for (int m = 0; m < count; ++m) {  // only those within reach of the one that is here
      const float behind = first.value - f[m].value;
      if (behind > 1.6f * cell * max(length(first.gradient - f[m].gradient), 1e-6f)) continue;
      f[kept] = f[m];
      material[kept++] = material[m];
    }
    for (int a = 0; a < kept; ++a)
      for (int b = a + 1; b < kept; ++b) {
        const FieldSample two[2] = {f[a], f[b]};
        if (!passes(two, 2, first.value, 0.87f * cell) && !steps_down(p, two, material[a], material[b], first.value))
          continue;
        result.add(Junction(material[a], material[b]), local);
        for (int c = b + 1; c < kept; ++c) add_curve(p, f, material, a, b, c, kept, first.value, local, result);
      }
  }

  NACRE_HD void add_curve(const Vec3f& p, const FieldSample* f, const std::uint32_t* material, int a, int b, int c,
                          int kept, float highest, const Int3& local, CellJunctions& result) const {
    const float cell = spacing();
    const FieldSample three[3] = {f[a], f[b], f[c]};
    const Junction curve(material[a], material[b], material[c]);
    const float more = is_coarse() ? 1.4f : 1;  // see steps_down
    if (!passes(three, 3, highest, 1.2f * more * cell) || !exists(curve, p, 2 * cell)) return;
    result.add(curve, local);
    for (int d = c + 1; d < kept; ++d) {
      const FieldSample four[4] = {f[a], f[b], f[c], f[d]};
      const Junction point(material[a], material[b], material[c], material[d]);
      if (passes(four, 4, highest, 1.5f * more * cell) && exists(point, p, 3 * cell)) result.add(point, local);
    }
  }

  /// One Newton step reaches the junction, and its materials are nearly the highest.
  NACRE_HD bool passes(const FieldSample* f, int count, float highest, float reach) const {
    Vec3f step;
    JunctionPoint at;
    if (!junction_step(f, count, step, at) || !(dot(step, step) <= reach * reach)) return false;
    for (int m = 0; m < count; ++m)
      if (highest - f[m].value > 2 * reach * at.steepness) return false;
    return true;
  }

  /// Samples are as far apart as voxels, and may be at their centres.
  NACRE_HD bool is_coarse() const {
    const Vec3f& n = field.cells_per_unit;
    return spacing() * max(n.x, max(n.y, n.z)) > 0.99f;
  }

  /// Where a function falls from one plateau to another between two voxels, as at the faces of the volume, its slope at
  /// their centres is half of what it is between them, and one step leads a whole voxel on. Closer samples find such
  /// an interface from beside it; these look where it is once the voxels around are of both materials.
  NACRE_HD bool steps_down(const Vec3f& p, const FieldSample* two, std::uint32_t a, std::uint32_t b,
                           float highest) const {
    if (!is_coarse() || !passes(two, 2, highest, 1.3f * spacing())) return false;
    bool has_a = false, has_b = false;
    const Int3 low = voxel(p);
    field.each_material(low, low + Int3(2), [&](std::uint32_t m) {
      has_a = has_a || m == a, has_b = has_b || m == b;
      return !has_a || !has_b;
    });
    return has_a && has_b && exists(Junction(a, b), p, 0.87f * spacing());
  }

  NACRE_HD bool exists(const Junction& j, const Vec3f& p, float reach) const {
    JunctionPoint at;
    return project(field, j, p, reach, at) && junction_margin(field, j, at.p, at.steepness) > -0.3f * spacing();
  }

  /// Materials around a point, ascending: of its eight voxels, and where those are of two or more and there are more in
  /// the block, of its 64, since smoothing can move a junction out of the cube that joined its voxels. `complete`
  /// becomes false where there are more than `most`.
  NACRE_HD int materials_around(const Vec3f& p, std::uint32_t* material, bool& complete) const {
    const Int3 low = voxel(p);
    int count = 0;
    collect(low, 2, material, count, complete);
    if (count < 2) return count;
    const std::int64_t block = field.block_at(p);
    if (field.block_start[block + 1] - field.block_start[block] > std::uint32_t(count))
      collect(low - Int3(1), 4, material, count, complete);
    return count;
  }

  NACRE_HD void collect(const Int3& low, int width, std::uint32_t* material, int& count, bool& complete) const {
    field.each_material(low, low + Int3(width), [&](std::uint32_t m) {
      int position = 0;
      while (position < count && material[position] < m) ++position;
      if (position < count && material[position] == m) return true;
      if (count == most) {
        complete = false;
        return true;
      }
      for (int j = count; j > position; --j) material[j] = material[j - 1];
      material[position] = m;
      ++count;
      return true;
    });
  }
};

/// Launched twice: without `found` it counts a cell's junctions, with it lists them. One kernel, so that both decide
/// alike where rounding decides.
struct SearchJunctions {
  SearchCoarseCell search;
  const std::uint32_t* cell;  ///< those that are searched
  std::uint32_t* count;       // when it counts
  std::uint32_t* crowded;     // 1 where something was left out
  const std::uint32_t* start = nullptr;
  FoundJunction* found = nullptr;
  std::uint64_t* packed = nullptr;

  NACRE_HD void operator()(std::int64_t i) const {
    CellJunctions junctions;
    if (found && start[i] == start[i + 1]) return;
    search(cell[i], junctions);
    if (!found) {
      count[i] = std::uint32_t(junctions.count);
      crowded[i] = junctions.complete ? 0 : 1;
      return;
    }
    for (int k = 0; k < junctions.count; ++k) {
      found[start[i] + k] = {junctions.junction[k], cell[i], junctions.window[k]};
      packed[start[i] + k] = junctions.junction[k].packed;
    }
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
    const int cell = int(i % starts) - 1;
    const Int3 b{int(f.coarse % coarse.x), int(f.coarse / coarse.x % coarse.y), int(f.coarse / coarse.x / coarse.y)};
    Vec3f middle;
    for (int axis = 0; axis < 3; ++axis) {
      const int k = cell >> 2 * axis & 3;
      if (cell >= 0 && (k + 1 < f.low(axis) || k - 1 > f.high(axis))) return;
      middle[axis] = b[axis] * 4 + (cell < 0 ? 0.5f * float(f.low(axis) + f.high(axis) + 1) : float(k) + 0.5f);
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
  {
    Arena::Scope scope(arena);
    Array<std::uint32_t> crowded = arena.temporary<std::uint32_t>(cells);
    exec.for_each(cells, detail::SearchJunctions{search, cell.data(), start.data(), crowded.data()});
    result.crowded_cells = int(exec.exclusive_scan(crowded.data(), crowded.data(), cells));
  }
  result.count = exec.exclusive_scan(start.data(), start.data(), cells + 1);
  result.found = arena.temporary<FoundJunction>(result.count);
  Array<std::uint64_t> packed = arena.temporary<std::uint64_t>(result.count);
  exec.for_each(cells, detail::SearchJunctions{search, cell.data(), nullptr, nullptr, start.data(), result.found.data(),
                                               packed.data()});
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
