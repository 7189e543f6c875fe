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
/// Reads four bytes behind the last cell.
template <class Index>
NACRE_HD_INLINE StreakCells<Packet> load_streak_cells(const StreakCell* cells, const Index& s, Packet::Mask mask) {
  static_assert(sizeof(StreakCell) == 12);
  Packet::Int word[3];
  gather_triples(reinterpret_cast<const std::uint32_t*>(cells), s, mask, word);
  return {word[0], word[1], Packet::Float(word[2])};
}
#endif

/// Vectors of one or several cells, fused in one way.
template <class Float>
NACRE_HD_INLINE Vec3<Float> multiply_add(const Vec3<Float>& a, const Float& b, const Vec3<Float>& c) {
  return {multiply_add(a.x, b, c.x), multiply_add(a.y, b, c.y), multiply_add(a.z, b, c.z)};
}
template <class Float>
NACRE_HD_INLINE Float fused_dot(const Vec3<Float>& a, const Vec3<Float>& b) {
  return multiply_add(a.z, b.z, multiply_add(a.y, b.y, a.x * b.x));
}
template <class Float>
NACRE_HD_INLINE Vec3<Float> fused_cross(const Vec3<Float>& a, const Vec3<Float>& b) {
  return {multiply_add(a.y, b.z, -(a.z * b.y)), multiply_add(a.z, b.x, -(a.x * b.z)),
          multiply_add(a.x, b.y, -(a.y * b.x))};
}

/// The cells that positions lie in.
template <class Float>
NACRE_HD_INLINE auto cells_of(const Vec3<Float>& p) {
  return Vec3<decltype(floor_to_int(p.x))>{floor_to_int(p.x), floor_to_int(p.y), floor_to_int(p.z)};
}

/// `values` of surface cells, 0 where they are masked out.
NACRE_HD_INLINE float load_values(const float* values, CellIndex s, bool mask) { return mask ? values[s] : 0; }

#if defined(NACRE_PACKETS)
template <class Index>
NACRE_HD_INLINE Packet::Float load_values(const float* values, const Index& s, Packet::Mask mask) {
  Packet::Float result;
  for (int lane = 0; lane < Packet::lanes; ++lane) result[lane] = values[std::uint64_t(s[lane])];
  return Packet::Float(Packet::Int(result) & mask);
}
#endif

/// Where a value of a surface cell is stored.
struct ToStreakCell {
  StreakCell* cells;
  NACRE_HD_INLINE void operator()(CellIndex s, float value) const { cells[s].value = value; }
};

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
    const Vec3f n = mesh.normal(foot.triangle, w), v = mesh.tangential(vectors, foot.triangle, w);
    const float speed = length(v);
    cells[s] = StreakCell::of(speed > least ? v * (1 / speed) : Vec3f{}, n, dot(n, foot.offset));
  }
};

/// What streaks are made of, one value for each surface cell. Along the flow, a mean over five cells that weighs even
/// and odd ones alike: it takes out what alternates from cell to cell, which would leave chequers. Across, the values
/// beside are taken away a little, which makes streaks as narrow as those of white noise.
template <class Surface>
struct SmoothAlongAndSharpenAcross {
  Surface surface;
  const float* value;  ///< 0..1
  const StreakCell* cells;

  using Wide = typename Surface::Wide;
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  static constexpr float across = 1.0f / 12;  ///< share of either neighbour; docs/method/chapter-5.md

  NACRE_HD_INLINE Float operator()(const typename Surface::Index& home, const Vec3<Int>& position) const {
    const StreakCells<Wide> own = load_streak_cells(cells, home, Wide::nothing_masked());
    const Float here = load_values(value, home, Wide::nothing_masked());
    const auto flows = own.direction_word != 0;
    const Vec3<Float> normal = own.normal(), along = own.direction(), side = fused_cross(normal, along);
    const Vec3<Float> start = multiply_add(normal, own.plane(), Vec3<Float>(Wide::all(0.5f)));
    typename Surface::WideCursor cursor(surface);
    const auto at = [&](const Vec3<Float>& p) {
      const auto found = cursor.find(position + cells_of(p), flows);
      return select(found.found, load_values(value, found.cell, found.found), here);
    };
    const auto pair = [&](const Vec3<Float>& way) { return at(start + way) + at(start - way); };
    const Float mean = (here + pair(along)) * 0.25f + pair(along * Wide::all(2.0f)) * 0.125f;  // exact products
    const Float sharp = multiply_add(mean + mean - pair(side), Wide::all(across), mean);
    return select(flows, sharp, here) - 0.5f;
  }
};

/// How much farther than its own length, in cells on an axis, a streak may come: it is pulled back onto the surface at
/// every cell.
inline constexpr int streak_slack = 6;

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
    const Vec3<Float> start = multiply_add(own.normal(), own.plane(), Vec3<Float>(Wide::all(0.5f)));
    const Mask flows = own.direction_word != 0;
    Half up(surface, 1, start, own.direction(), flows), down(surface, -1, start, own.direction(), flows);
    // Both ways at a time: while one waits for memory, the other goes on.
    for (int i = 0; i < reach && any(up.runs | down.runs); ++i) {
      advance(up, position);
      advance(down, position);
    }
    return (own.value + up.sum + down.sum) / (Wide::all(1.0f) + up.count + down.count);
  }

 private:
  /// A streamline one way.
  struct Half {
    typename Surface::WideCursor cursor;
    Float sign;
    Vec3<Float> p, d, before;  ///< from the lower corner of the home cell; direction of this step and of the last one
    Mask runs;
    Float sum = Wide::all(0.0f), count = Wide::all(0.0f);

    NACRE_HD_INLINE Half(const Surface& surface, int side, const Vec3<Float>& start, const Vec3<Float>& along,
                         Mask flows)
        : cursor(surface), sign(Wide::all(float(side))), p(start), d(along * sign), before(d), runs(flows) {}
  };

  /// A cell by Adams and Bashforth's second order: one direction a step.
  NACRE_HD_INLINE void advance(Half& line, const Vec3<Int>& home) const {
    const Float far = Wide::all(float(reach + streak_slack)), zero = Wide::all(0.0f);
    const auto within = [&](const Float& x) { return (x >= zero - far) & (x <= far); };
    const Vec3<Float> p = multiply_add(line.before, Wide::all(-0.5f), multiply_add(line.d, Wide::all(1.5f), line.p));
    const Vec3<Int> in = cells_of(p);
    const auto found = line.cursor.find(home + in, line.runs & within(p.x) & within(p.y) & within(p.z));
    const StreakCells<Wide> cell = load_streak_cells(cells, found.cell, found.found);
    const Vec3<Float> next = cell.direction() * line.sign, normal = cell.normal();
    line.runs = found.found & (fused_dot(next, line.d) > 0.0f);
    line.before = line.d;
    line.d = next;
    const Vec3<Float> middle{to_float(in.x) + 0.5f, to_float(in.y) + 0.5f, to_float(in.z) + 0.5f};
    line.p = multiply_add(normal, select(found.direct, cell.plane() - fused_dot(normal, p - middle), zero), p);
    line.sum = line.sum + select(line.runs, cell.value, zero);
    line.count = line.count + select(line.runs, Wide::all(1.0f), zero);
  }
};

}  // namespace nacre
