// Nacre: what streaks know of the surface cells, in few bits: the flow there, and a piece of the streamline through it.
#pragma once

#include "compute/flow/surface_cells.hpp"

namespace nacre {

/// The signed components of a vector in one word, `bits` each, in units of 1 / `scale`.
template <class Int>
NACRE_HD_INLINE auto unpacked_vector(const Int& word, int bits, float scale) {
  using Float = decltype(to_float(word));
  const auto component = [&](int k) { return to_float(signed_bits(word, k * bits, bits)) * (1 / scale); };
  return Vec3<Float>{component(0), component(1), component(2)};
}

template <class Float>
NACRE_HD_INLINE auto packed_vector(const Vec3<Float>& v, int bits, float scale) {
  const auto component = [&](const Float& a) { return floor_to_int(a * scale + 0.5f) & ((1 << bits) - 1); };
  return component(v.x) | component(v.y) << bits | component(v.z) << 2 * bits;
}

/// Barycentric coordinates of a point of a triangle, those of its first two corners in 16 bits each.
struct PackedWeights {
  std::uint32_t word;
  static constexpr float scale = 65535;

  NACRE_HD_INLINE static PackedWeights of(const Vec3f& w) {
    return {std::uint32_t(w.x * scale + 0.5f) | std::uint32_t(w.y * scale + 0.5f) << 16};
  }
  NACRE_HD_INLINE Vec3f unpacked() const {
    const float x = float(word & 65535) * (1 / scale), y = float(word >> 16) * (1 / scale);
    return {x, y, 1 - x - y};
  }
};

/// What a streamline reads of a surface cell: unit vectors whose components have 10 bits (exact to 0.1 degrees) or 8.
struct StreakCell {
  std::uint32_t direction;  ///< of the flow, tangential, 10 bits for each component; 0 where nothing flows
  std::uint32_t surface;    ///< normal, 8 bits for each component, and plane, 8 bits
  float value;

  static constexpr int direction_bits = 10, normal_bits = 8, plane_bits = 8;
  static constexpr float direction_scale = 511, normal_scale = 127, plane_scale = 127 / 0.87f;

  NACRE_HD_INLINE static std::uint32_t packed_direction(const Vec3f& direction) {
    return std::uint32_t(packed_vector(direction, direction_bits, direction_scale));
  }
  /// `plane`: height of the closest point above the cell's centre along the normal, in cells; at most 0.87.
  NACRE_HD_INLINE static StreakCell of(const Vec3f& direction, const Vec3f& normal, float plane) {
    return {packed_direction(direction),
            std::uint32_t(packed_vector(normal, normal_bits, normal_scale)) |
                std::uint32_t(floor_to_int(plane * plane_scale + 0.5f)) << 3 * normal_bits,
            0};
  }
};

/// The surface in one cell or several, unpacked.
template <class Wide>
struct StreakSurface {
  typename Wide::Int word;
  using Float = typename Wide::Float;

  NACRE_HD_INLINE Vec3<Float> normal() const {
    return unpacked_vector(word, StreakCell::normal_bits, StreakCell::normal_scale);
  }
  NACRE_HD_INLINE Float plane() const {
    return to_float(signed_bits(word, 3 * StreakCell::normal_bits, StreakCell::plane_bits)) *
           (1 / StreakCell::plane_scale);
  }
  /// The closest point, from the lower corner of the cell.
  NACRE_HD_INLINE Vec3<Float> foot() const { return multiply_add(normal(), plane(), Vec3<Float>(Wide::all(0.5f))); }
};

/// A StreakCell or several, unpacked.
template <class Wide>
struct StreakCells {
  typename Wide::Int direction_word;
  StreakSurface<Wide> surface;
  typename Wide::Float value;

  NACRE_HD_INLINE Vec3<typename Wide::Float> direction() const {
    return unpacked_vector(direction_word, StreakCell::direction_bits, StreakCell::direction_scale);
  }
};

NACRE_HD_INLINE StreakCells<Single> load_streak_cells(const StreakCell* cells, CellIndex s, bool mask) {
  if (!mask) return {};
  return {std::int32_t(cells[s].direction), {std::int32_t(cells[s].surface)}, cells[s].value};
}

#if defined(NACRE_PACKETS)
/// Reads four bytes behind the last cell.
template <class Index>
NACRE_HD_INLINE StreakCells<Packet> load_streak_cells(const StreakCell* cells, const Index& s, Packet::Mask mask) {
  static_assert(sizeof(StreakCell) == 12);
  Packet::Int word[3];
  gather_triples(reinterpret_cast<const std::uint32_t*>(cells), s, mask, word);
  return {word[0], {word[1]}, Packet::Float(word[2])};
}
#endif

/// Streamlines are followed from the closest point of each surface cell this many cells each way. Long ones are put
/// together of such pieces.
inline constexpr int segment_length = 5, segment_half = segment_length / 2;

/// The streamline through the closest point of a surface cell, from `segment_length` cells behind it to as many ahead,
/// and the values within `segment_half` cells.
struct StreakSegment {
  std::uint32_t ahead;    ///< 24 bits: from the closest point to the end ahead; 0: the streamline ends before
  std::uint32_t behind;   ///< the same behind; the upper 8 bits of both: sum of the values, and how many there are
  std::uint32_t surface;  ///< as in StreakCell

  static constexpr int end_bits = 8, count_bits = 3;
  static constexpr float farthest = 6.35f, end_scale = 127 / farthest;  ///< of an end, on each axis, in cells
  static constexpr float sum_scale = 1024;                              ///< sums of up to 4
};

/// The same, unpacked, of one cell or several.
template <class Wide>
struct StreakSegments {
  using Float = typename Wide::Float;
  using Int = typename Wide::Int;
  Int ahead_word, behind_word;
  StreakSurface<Wide> surface;

  /// `ahead`, `behind`: 0 where the streamline ends before.
  NACRE_HD_INLINE static StreakSegments of(const Vec3<Float>& ahead, const Vec3<Float>& behind, const Float& sum,
                                           const Float& count, const StreakSurface<Wide>& surface) {
    const Int values =
        floor_to_int(sum * StreakSegment::sum_scale + 0.5f) << StreakSegment::count_bits | floor_to_int(count);
    const auto end = [](const Vec3<Float>& v) {
      return packed_vector(v, StreakSegment::end_bits, StreakSegment::end_scale);
    };
    return {end(ahead) | values << value_bits, end(behind) | values >> 8 << value_bits, surface};
  }

  NACRE_HD_INLINE auto goes_ahead() const { return (ahead_word & end_mask) != 0; }
  NACRE_HD_INLINE auto goes_behind() const { return (behind_word & end_mask) != 0; }
  NACRE_HD_INLINE Vec3<Float> ahead() const { return end(ahead_word); }
  NACRE_HD_INLINE Vec3<Float> behind() const { return end(behind_word); }
  NACRE_HD_INLINE Float sum() const {
    return to_float(values() >> StreakSegment::count_bits) * (1 / StreakSegment::sum_scale);
  }
  NACRE_HD_INLINE Float count() const { return to_float(values() & ((1 << StreakSegment::count_bits) - 1)); }

 private:
  static constexpr int value_bits = 3 * StreakSegment::end_bits;  // where a half of the sum and number begins
  static constexpr int end_mask = (1 << value_bits) - 1;
  NACRE_HD_INLINE Int values() const {
    return (ahead_word >> value_bits & 255) | signed_bits(behind_word, value_bits, 8) << 8;
  }
  NACRE_HD_INLINE static Vec3<Float> end(const Int& word) {
    return unpacked_vector(word, StreakSegment::end_bits, StreakSegment::end_scale);
  }
};

NACRE_HD_INLINE StreakSegments<Single> load_streak_segments(const StreakSegment* segments, CellIndex s, bool mask) {
  if (!mask) return {};
  return {std::int32_t(segments[s].ahead), std::int32_t(segments[s].behind), {std::int32_t(segments[s].surface)}};
}
NACRE_HD_INLINE StreakSegment element(const StreakSegments<Single>& segment, int) {
  return {std::uint32_t(segment.ahead_word), std::uint32_t(segment.behind_word), std::uint32_t(segment.surface.word)};
}

#if defined(NACRE_PACKETS)
/// Reads four bytes behind the last segment.
template <class Index>
NACRE_HD_INLINE StreakSegments<Packet> load_streak_segments(const StreakSegment* segments, const Index& s,
                                                            Packet::Mask mask) {
  static_assert(sizeof(StreakSegment) == 12);
  Packet::Int word[3];
  gather_triples(reinterpret_cast<const std::uint32_t*>(segments), s, mask, word);
  return {word[0], word[1], {word[2]}};
}
NACRE_HD_INLINE StreakSegment element(const StreakSegments<Packet>& segments, int lane) {
  return {std::uint32_t(segments.ahead_word[lane]), std::uint32_t(segments.behind_word[lane]),
          std::uint32_t(segments.surface.word[lane])};
}
#endif

}  // namespace nacre
