// Nacre: which materials meet in the 4^3 cells of a coarse cell of the embedding.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/field/interface.hpp"

namespace nacre {

/// A box of some of the 4^3 cells of a coarse cell: the lowest and highest, two bits for each number.
class CellWindow {
 public:
  CellWindow() = default;
  NACRE_HD CellWindow(const Int3& low, const Int3& high)
      : bits_(std::uint32_t(low.x | low.y << 2 | low.z << 4 | high.x << 6 | high.y << 8 | high.z << 10)) {}

  NACRE_HD Int3 low() const { return at(0); }
  NACRE_HD Int3 high() const { return at(6); }
  NACRE_HD CellWindow with(const Int3& cell) const { return {min(low(), cell), max(high(), cell)}; }

 private:
  NACRE_HD Int3 at(int shift) const {
    return {int(bits_ >> shift) & 3, int(bits_ >> (shift + 2)) & 3, int(bits_ >> (shift + 4)) & 3};
  }

  std::uint32_t bits_ = 0;
};

namespace detail {

/// The junctions of one coarse cell: at most this many different ones are distinguished.
struct CellJunctions {
  static constexpr int capacity = 64;
  Junction junction[capacity];
  CellWindow window[capacity];
  int count = 0;
  bool complete = true;  // nothing was left out, neither a junction nor a material that could have made some

  NACRE_HD void add(const Junction& j, const Int3& cell) {
    const int k = find(j);
    if (k < count) {
      window[k] = window[k].with(cell);
    } else if (count < capacity) {
      junction[k] = j, window[k] = {cell, cell};
      ++count;
    } else {
      complete = false;
    }
  }

 private:
  NACRE_HD int find(const Junction& j) const {
    int k = 0;
    while (k < count && !(junction[k] == j)) ++k;
    return k;
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
    const Vec3f low = Vec3f(b * Int3(4)) / cells_per_voxel, high = Vec3f((b + Int3(1)) * Int3(4)) / cells_per_voxel;
    if (!mixed(low, high)) return;
    for (int z = 0; z < samples; ++z)
      for (int y = 0; y < samples; ++y) {
        if (!mixed(sample(b, 0, y, z), sample(b, samples - 1, y, z))) continue;
        for (int x = 0; x < samples; ++x)
          search(sample(b, x, y, z), {4 * x / samples, 4 * y / samples, 4 * z / samples}, result);
      }
  }

 private:
  static constexpr int most = 8;
  NACRE_HD float spacing() const { return 4 / (cells_per_voxel * float(samples)); }

  NACRE_HD Int3 voxel(const Vec3f& p) const {
    const Vec3f u = p * field.cells_per_unit - Vec3f(0.5f);
    return {int(std::floor(u.x)), int(std::floor(u.y)), int(std::floor(u.z))};
  }

  /// Of a coarse cell.
  NACRE_HD Vec3f sample(const Int3& b, int x, int y, int z) const {
    return (Vec3f(b * Int3(4)) + Vec3f(x + 0.5f, y + 0.5f, z + 0.5f) * (4.0f / float(samples))) / cells_per_voxel;
  }

  /// Whether the voxels around the points of a box are of more than one material.
  NACRE_HD bool mixed(const Vec3f& from, const Vec3f& to) const {
    const Int3 n = field.voxels();
    const Int3 low = max(voxel(from), Int3(0)), high = min(voxel(to) + Int3(1), n - Int3(1));
    if (low.x > high.x || low.y > high.y || low.z > high.z) return false;
    const std::uint16_t own = field.material(low);
    return !field.each_material(low, high + Int3(1), [&](std::uint16_t m) { return m == own; });
  }

  NACRE_HD void search(const Vec3f& p, const Int3& local, CellJunctions& result) const {
    if (!field.inside(p, 3)) return;
    std::uint32_t material[most];
    int count = materials_around(p, material, result.complete);
    if (count < 2) return;
    if (count == 2) {  // most often: they meet between the voxels around, and nobody else is near
      result.add(Junction(material[0], material[1]), local);
      return;
    }
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
        if (!meet(p, two, material[a], material[b], first.value)) continue;
        result.add(Junction(material[a], material[b]), local);
        for (int c = b + 1; c < kept; ++c) add_curve(p, f, material, a, b, c, kept, first.value, local, result);
      }
  }

  NACRE_HD bool meet(const Vec3f& p, const FieldSample* two, std::uint32_t a, std::uint32_t b, float highest) const {
    return passes(two, 2, highest, 0.87f * spacing()) || steps_down(p, two, a, b, highest);
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

}  // namespace detail
}  // namespace nacre
