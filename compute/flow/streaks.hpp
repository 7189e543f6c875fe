// Nacre: streaks for the eye: the moving texture convolved along the flow of the frame (Cabral & Leedom 1993, Okada &
// Kao 1997). What particles carry is not touched by it, so the texture moves as before; its direction is that of the
// present flow, also where the flow is slow and particles leave no lines. Cells share pieces of streamlines, as in a
// fast line integral convolution (Stalling & Hege 1995).
#pragma once

#include "compute/flow/streak_cells.hpp"

namespace nacre {

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

/// Fills in the surface of each surface cell, and where on its triangle its closest point is: exact at creases.
template <class Surface>
struct DescribeStreakCells {
  Surface surface;
  MeshView mesh;
  double cell;  ///< edge of a texture cell in units of the mesh's points
  StreakCell* cells;
  PackedWeights* weights;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    const SurfaceFoot foot = surface.foot(s, position);
    const Vec3f w =
        barycentric_in_float(mesh.corners(foot.triangle), (Vec3d(position) + Vec3d(0.5) + Vec3d(foot.offset)) * cell);
    const Vec3f n = mesh.normal(foot.triangle, w);
    cells[s] = StreakCell::of({}, n, dot(n, foot.offset));
    weights[s] = PackedWeights::of(w);
  }
};

/// Fills in the flow of each surface cell, from the triangle of its closest point: exact where vectors kept on a
/// coarser grid are blurred.
template <class Surface>
struct MarkStreakCells {
  Surface surface;
  const Triangle* triangles;
  const Vec3f* vectors;  ///< one per point of the mesh, at the time of the frame
  float least;           ///< speed below which nothing flows
  const PackedWeights* weights;
  StreakCell* cells;

  NACRE_HD void operator()(CellIndex s, const Int3& position) const {
    const Triangle corner = triangles[surface.foot(s, position).triangle];
    const Vec3f w = weights[s].unpacked(), n = StreakSurface<Single>{std::int32_t(cells[s].surface)}.normal();
    const Vec3f flow = vectors[corner.a] * w.x + vectors[corner.b] * w.y + vectors[corner.c] * w.z;
    const float squared = dot(n, n);
    const Vec3f v = squared > 0 ? flow - n * (dot(n, flow) / squared) : flow;
    const float speed = length(v);
    cells[s].direction = StreakCell::packed_direction(speed > least ? v * (1 / speed) : Vec3f{});
  }
};

/// Gives the cells the values of the moving texture.
struct GiveStreakValues {
  const float* value;  ///< 0..1
  StreakCell* cells;
  NACRE_HD void operator()(std::int64_t s) const { cells[s].value = value[s] - 0.5f; }
};

/// How much farther than it is long, in cells on an axis, a streak may come: it is pulled back onto the surface again
/// and again.
inline constexpr int streak_slack = 3;

/// Segments either side of a cell's own that a streak of `cells` cells each way has. So streaks are 2, 7, 12, ... long.
NACRE_HD_INLINE constexpr int streak_segments(int cells) { return cells / segment_length; }

/// A streamline of one cell or several, one way.
template <class Surface>
struct Streamline {
  using Wide = typename Surface::Wide;
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  using Mask = typename Wide::Mask;

  typename Surface::WideCursor cursor;
  Vec3<Float> position;                                  ///< from the lower corner of the home cell
  Vec3<Float> step;                                      ///< from here on
  Mask runs;                                             ///< it has not ended
  Float sum = Wide::all(0.0f), count = Wide::all(0.0f);  ///< of the values on it

  NACRE_HD_INLINE Streamline(const Surface& surface, const Vec3<Float>& start, const Vec3<Float>& first, Mask runs)
      : cursor(surface), position(start), step(first), runs(runs) {}

  /// Goes to `next`, at most `far` cells away on each axis, or ends. `take(cell)` is called with the number of the
  /// surface cell there and returns its surface; then the position is moved onto that.
  template <class Take>
  NACRE_HD_INLINE void go(const Vec3<Int>& home, const Vec3<Float>& next, int far, const Take& take) {
    const Float most = Wide::all(float(far)), zero = Wide::all(0.0f);
    const auto near = [&](const Float& x) { return (x >= zero - most) & (x <= most); };
    const Vec3<Int> in = cells_of(next);
    const auto there = cursor.find(home + in, runs & near(next.x) & near(next.y) & near(next.z));
    runs = there.found;
    const StreakSurface<Wide> surface = take(there.cell);
    const Vec3<Float> middle{to_float(in.x) + 0.5f, to_float(in.y) + 0.5f, to_float(in.z) + 0.5f};
    const Vec3<Float> normal = surface.normal();
    const Float off = select(there.direct, surface.plane() - fused_dot(normal, next - middle), zero);
    position = multiply_add(normal, off, next);
  }

  /// Goes on by `next`, if that does not turn back.
  NACRE_HD_INLINE void turn(const Vec3<Float>& next) {
    runs = runs & (fused_dot(next, step) > 0.0f);
    step = next;
  }

  NACRE_HD_INLINE void add(const Float& values, const Float& number, Mask where) {
    sum = sum + select(where, values, Wide::all(0.0f));
    count = count + select(where, number, Wide::all(0.0f));
  }
};

/// The segment of a surface cell: one cell a step, by Adams and Bashforth's second order, which asks for one direction
/// a step.
template <class Surface>
struct FollowSegments {
  Surface surface;
  const StreakCell* cells;

  using Wide = typename Surface::Wide;
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  using Line = Streamline<Surface>;

  NACRE_HD_INLINE StreakSegments<Wide> operator()(const typename Surface::Index& home,
                                                  const Vec3<Int>& position) const {
    const StreakCells<Wide> own = load_streak_cells(cells, home, Wide::nothing_masked());
    const Vec3<Float> start = own.surface.foot(), along = own.direction(), against = along * Wide::all(-1.0f);
    const auto flows = own.direction_word != 0;
    Line up(surface, start, along, flows), down(surface, start, against, flows);
    Vec3<Float> before_up = along, before_down = against;
    // Both ways at a time: while one waits for memory, the other goes on.
    for (int i = 0; i < segment_length && any(up.runs | down.runs); ++i) {
      advance(up, before_up, position, 1, i < segment_half);
      advance(down, before_down, position, -1, i < segment_half);
    }
    const Float zero = Wide::all(0.0f), most = Wide::all(StreakSegment::farthest);
    const auto fits = [&](const Float& x) { return (x >= zero - most) & (x <= most); };
    const auto end = [&](const Line& line) {
      const Vec3<Float> way = line.position - start;
      const auto goes = line.runs & fits(way.x) & fits(way.y) & fits(way.z);
      return Vec3<Float>{select(goes, way.x, zero), select(goes, way.y, zero), select(goes, way.z, zero)};
    };
    return StreakSegments<Wide>::of(end(up), end(down), own.value + up.sum + down.sum,
                                    Wide::all(1.0f) + up.count + down.count, own.surface);
  }

 private:
  NACRE_HD_INLINE void advance(Line& line, Vec3<Float>& before, const Vec3<Int>& home, int way, bool counts) const {
    const Vec3<Float> next =
        multiply_add(before, Wide::all(-0.5f), multiply_add(line.step, Wide::all(1.5f), line.position));
    before = line.step;
    line.go(home, next, segment_length + streak_slack, [&](const auto& at) {
      const StreakCells<Wide> cell = load_streak_cells(cells, at, line.runs);
      line.turn(cell.direction() * Wide::all(float(way)));
      if (counts) line.add(cell.value, Wide::all(1.0f), line.runs);
      return cell.surface;
    });
  }
};

/// The mean of the values along the streamline through the closest point of a surface cell, `reach` segments each way
/// or to where the flow or the surface ends or turns back, or it strays; stretched, around 1/2. Each segment is that of
/// the cell in which the one before ends, moved to that end. Streamlines of several cells run side by side where
/// the surface allows.
template <class Surface>
struct ConvolveAlongFlow {
  Surface surface;
  const StreakSegment* segments;
  int reach;

  using Wide = typename Surface::Wide;
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  using Line = Streamline<Surface>;
  using Segments = StreakSegments<Wide>;
  static constexpr float gain = 4;  ///< a mean of so many values is small

  NACRE_HD_INLINE Float operator()(const typename Surface::Index& home, const Vec3<Int>& position) const {
    const Segments own = load_streak_segments(segments, home, Wide::nothing_masked());
    const Vec3<Float> start = own.surface.foot();
    Line up(surface, start, own.ahead(), own.goes_ahead()), down(surface, start, own.behind(), own.goes_behind());
    for (int i = 1; i <= reach && any(up.runs | down.runs); ++i) {
      advance(
          up, position, i, [](const Segments& s) { return s.ahead(); }, [](const Segments& s) { return s.behind(); });
      advance(
          down, position, i, [](const Segments& s) { return s.behind(); }, [](const Segments& s) { return s.ahead(); });
    }
    return (own.sum() + up.sum + down.sum) / (own.count() + up.count + down.count) * gain + 0.5f;
  }

 private:
  /// `onward`, `back`: where segments end that way, and the other way.
  template <class Onward, class Back>
  NACRE_HD_INLINE void advance(Line& line, const Vec3<Int>& home, int i, const Onward& onward, const Back& back) const {
    line.go(home, line.position + line.step, segment_length * i + streak_slack, [&](const auto& at) {
      const Segments there = load_streak_segments(segments, at, line.runs);
      const Vec3<Float> next = onward(there);
      // The last one counts, though nothing goes on from it, but not where the flow turns back.
      const auto along = (fused_dot(next, line.step) >= 0.0f) & (fused_dot(back(there), line.step) <= 0.0f);
      line.add(there.sum(), there.count(), line.runs & along);
      line.runs = line.runs & along;
      line.turn(next);
      return there.surface;
    });
  }
};

/// What is shown of values that are convolved. Along the flow, a mean over five cells that weighs even and odd ones
/// alike: streamlines of cells beside each other meet other cells, and this takes out what then alternates from cell to
/// cell. Across, the values beside are taken away a little, which makes streaks as narrow as those of white noise.
template <class Surface>
struct SmoothAlongAndSharpenAcross {
  Surface surface;
  const float* value;
  const StreakCell* cells;

  using Wide = typename Surface::Wide;
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  static constexpr float across = 1.0f / 10;  ///< share of either neighbour; docs/method/chapter-5.md

  NACRE_HD_INLINE Float operator()(const typename Surface::Index& home, const Vec3<Int>& position) const {
    const StreakCells<Wide> own = load_streak_cells(cells, home, Wide::nothing_masked());
    const Float here = load_values(value, home, Wide::nothing_masked());
    const auto flows = own.direction_word != 0;
    const Vec3<Float> along = own.direction(), side = fused_cross(own.surface.normal(), along);
    const Vec3<Float> start = own.surface.foot();
    typename Surface::WideCursor cursor(surface);
    const auto at = [&](const Vec3<Float>& p) {
      const auto found = cursor.find(position + cells_of(p), flows);
      return select(found.found, load_values(value, found.cell, found.found), here);
    };
    const auto pair = [&](const Vec3<Float>& way) { return at(start + way) + at(start - way); };
    const Float mean = (here + pair(along)) * 0.25f + pair(along * Wide::all(2.0f)) * 0.125f;  // exact products
    const Float sharp = select(flows, multiply_add(mean + mean - pair(side), Wide::all(across), mean), here);
    const Float black = Wide::all(0.0f), white = Wide::all(1.0f);
    return select(sharp < black, black, select(sharp > white, white, sharp));
  }
};

}  // namespace nacre
