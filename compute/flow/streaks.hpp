// Nacre: streaks for the eye: the moving texture convolved along the flow of the frame (Cabral & Leedom 1993, Okada &
// Kao 1997). What particles carry is not touched by it, so the texture moves as before; its
// direction is that of the present flow, also where the flow is slow and particles leave no lines.
#pragma once

#include "compute/flow/filter.hpp"
#include "compute/flow/surface_cells.hpp"

namespace nacre {

/// What a streamline reads of a surface cell: unit vectors whose components have 10 bits (exact to 0.1 degrees) or 8.
struct StreakCell {
  std::uint32_t direction;  ///< of the flow, tangential, 10 bits for each component; 0 where nothing flows
  std::uint32_t surface;    ///< normal, 8 bits for each component, and plane, 8 bits
  float value;

  static constexpr int direction_bits = 10, normal_bits = 8, plane_bits = 8;
  static constexpr float direction_scale = 511, normal_scale = 127, plane_scale = 127 / 0.87f;

  /// `plane`: height of the closest point above the cell's centre along the normal, in cells; at most 0.87.
  NACRE_HD_INLINE static StreakCell of(const Vec3f& direction, const Vec3f& normal, float plane) {
    return {packed(direction, direction_bits, direction_scale),
            packed(normal, normal_bits, normal_scale) | bits(plane * plane_scale, plane_bits) << 3 * normal_bits, 0};
  }

  NACRE_HD_INLINE static std::uint32_t bits(float a, int count) {
    return std::uint32_t(int(std::floor(a + 0.5f))) & ((1u << count) - 1);
  }
  NACRE_HD_INLINE static std::uint32_t packed(const Vec3f& v, int count, float scale) {
    return bits(v.x * scale, count) | bits(v.y * scale, count) << count | bits(v.z * scale, count) << 2 * count;
  }
};

/// The same, unpacked, of one cell or several.
template <class Wide>
struct StreakCells {
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  Int direction_word, surface_word;
  Float value;

  NACRE_HD_INLINE Vec3<Float> direction() const {
    return vector(direction_word, StreakCell::direction_bits, 1 / StreakCell::direction_scale);
  }
  NACRE_HD_INLINE Vec3<Float> normal() const {
    return vector(surface_word, StreakCell::normal_bits, 1 / StreakCell::normal_scale);
  }
  NACRE_HD_INLINE Float plane() const {
    return to_float(signed_bits(surface_word, 3 * StreakCell::normal_bits, StreakCell::plane_bits)) *
           (1 / StreakCell::plane_scale);
  }

 private:
  NACRE_HD_INLINE static Vec3<Float> vector(const Int& word, int bits, float scale) {
    return {to_float(signed_bits(word, 0, bits)) * scale, to_float(signed_bits(word, bits, bits)) * scale,
            to_float(signed_bits(word, 2 * bits, bits)) * scale};
  }
};

NACRE_HD_INLINE StreakCells<Single> load_streak_cells(const StreakCell* cells, CellIndex s, bool mask) {
  if (!mask) return {};
  return {std::int32_t(cells[s].direction), std::int32_t(cells[s].surface), cells[s].value};
}

#if defined(NACRE_PACKETS)
NACRE_HD_INLINE StreakCells<Packet> load_streak_cells(const StreakCell* cells, Packet::Int s, Packet::Mask mask) {
  static_assert(sizeof(StreakCell) == 12);
  const auto* words = reinterpret_cast<const std::uint32_t*>(cells);
  return {gather(words, s * 3, mask), gather(words, s * 3 + 1, mask), Packet::Float(gather(words, s * 3 + 2, mask))};
}
#endif

/// Fills in the flow and the surface of each surface cell, from the triangle of its closest point: exact where vectors
/// kept on a coarser grid are blurred, and at creases.
template <class Surface>
struct MarkStreakCells {
  Surface surface;
  MeshView mesh;
  double cell;           ///< edge of a texture cell in units of the mesh's points
  const Vec3f* vectors;  ///< one per point of the mesh, at the time of the frame
  float least;           ///< speed below which nothing flows
  StreakCell* cells;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    const SurfaceFoot foot = surface.foot(s, position);
    const Vec3f w(barycentric(mesh.corners(foot.triangle), (Vec3d(position) + Vec3d(0.5) + Vec3d(foot.offset)) * cell));
    const Triangle corner = mesh.triangles[foot.triangle];
    const Vec3f n = mesh.normal(foot.triangle, w);
    const Vec3f v = vectors[corner.a] * w.x + vectors[corner.b] * w.y + vectors[corner.c] * w.z;
    const Vec3f tangential = v - n * dot(n, v);
    const float speed = length(tangential);
    cells[s] = StreakCell::of(speed > least ? tangential / speed : Vec3f{}, n, dot(n, foot.offset));
  }
};

/// What streaks are made of. Along the flow, the mean of the values at a cell and one cell up and down: it takes out
/// what alternates from cell to cell, which would leave chequers. Across, the values beside are taken away a little,
/// which makes streaks as narrow as those of white noise.
template <class Surface>
struct SmoothAlongAndSharpenAcross {
  Surface surface;
  const float* value;  ///< 0..1
  StreakCell* cells;

  static constexpr float across = 1.0f / 16;  ///< share of either neighbour; docs/method/chapter-5.md

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    typename Surface::Cursor cursor(surface);
    const auto at = [&](const Vec3f& p) {
      const NearSurfaceCell found = cursor.find(position + floor_cell(p));
      return value[found.cell == no_cell ? s : found.cell];
    };
    float mean = value[s];
    const StreakCells<Single> own = load_streak_cells(cells, s, true);
    if (own.direction_word != 0) {
      const Vec3f normal = own.normal(), along = own.direction(), side = cross(normal, along);
      const Vec3f p = Vec3f(0.5f) + normal * own.plane();
      mean = 0.5f * mean + 0.25f * (at(p + along) + at(p - along));
      mean = (1 + 2 * across) * mean - across * (at(p + side) + at(p - side));
    }
    cells[s].value = mean - 0.5f;
  }
};

/// How much farther than its own length, in cells on an axis, a streak may come: it is pulled back onto the surface at
/// every cell.
inline constexpr int streak_slack = 8;

/// The mean of the values along the streamline through the closest point of a surface cell, `reach` cells each way or
/// to where the flow or the surface ends or turns back, or it strays; stretched, around 1/2. Streamlines of several
/// cells run side by side where the surface allows.
template <class Surface>
struct ConvolveAlongFlow {
  Surface surface;
  const StreakCell* cells;
  int reach;

  using Wide = typename Surface::Wide;
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  using Mask = typename Wide::Mask;
  static constexpr float gain = 4;  ///< a mean of so many values is small

  NACRE_HD_INLINE Float operator()(const typename Surface::Index& home, const Vec3<Int>& position) const {
    const Float shown = mean(home, position) * gain + 0.5f, black = Wide::all(0.0f), white = Wide::all(1.0f);
    return select(shown < black, black, select(shown > white, white, shown));
  }

  NACRE_HD_INLINE Float mean(const typename Surface::Index& home, const Vec3<Int>& position) const {
    const StreakCells<Wide> own = load_streak_cells(cells, home, Wide::nothing_masked());
    const Vec3<Float> along = own.direction(), middle(Wide::all(0.5f));
    const Vec3<Float> start = middle + own.normal() * own.plane();
    const Float far = Wide::all(float(reach + streak_slack));
    const auto within = [&](const Float& x) { return (x >= Wide::all(0.0f) - far) & (x <= far); };
    Float sum = own.value, count = Wide::all(1.0f);
    for (int side = -1; side <= 1; side += 2) {
      typename Surface::WideCursor cursor(surface);
      const Float sign = Wide::all(float(side));
      Vec3<Float> p = start, d = along * sign, before = d;
      Mask runs = own.direction_word != 0;
      for (int i = 0; i < reach && any(runs); ++i) {
        // A cell by Adams and Bashforth's second order: one direction a step.
        p = p + d * Wide::all(1.5f) - before * Wide::all(0.5f);
        const Vec3<Int> in{floor_to_int(p.x), floor_to_int(p.y), floor_to_int(p.z)};
        runs = runs & within(p.x) & within(p.y) & within(p.z);
        const auto found = cursor.find(position + in, runs);
        const StreakCells<Wide> cell = load_streak_cells(cells, found.cell, found.found);
        const Vec3<Float> next = cell.direction() * sign;
        runs = found.found & (dot(next, d) > 0.0f);
        before = d;
        d = next;
        const Vec3<Float> normal = cell.normal(), low{to_float(in.x), to_float(in.y), to_float(in.z)};
        const Float height = dot(normal, p - low - middle) - cell.plane();
        p = p - normal * select(found.direct, height, Wide::all(0.0f));
        sum = sum + select(runs, cell.value, Wide::all(0.0f));
        count = count + select(runs, Wide::all(1.0f), Wide::all(0.0f));
      }
    }
    return sum / count;
  }
};

}  // namespace nacre
