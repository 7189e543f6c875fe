// Nacre: several numbers side by side in SIMD registers, for kernels that do the same with many elements.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/backend.hpp"
#include "compute/math/vec.hpp"

#if !defined(__CUDACC__) && defined(__AVX2__) && defined(__FMA__)
#include <immintrin.h>
#endif

namespace nacre {

/// One element: what a GPU's thread computes with. A kernel written in Wide::Float, Wide::Int and Wide::Mask runs with
/// Single and with Packet, and gives the same numbers.
struct Single {
  static constexpr int lanes = 1;
  using Float = float;
  using Int = std::int32_t;
  using Mask = bool;

  NACRE_HD_INLINE static Float all(float a) { return a; }
  NACRE_HD_INLINE static Int all(std::int32_t a) { return a; }
  NACRE_HD_INLINE static Mask nothing_masked() { return true; }
};

NACRE_HD_INLINE float select(bool which, float a, float b) { return which ? a : b; }
NACRE_HD_INLINE std::int32_t select(bool which, std::int32_t a, std::int32_t b) { return which ? a : b; }
NACRE_HD_INLINE bool any(bool mask) { return mask; }
NACRE_HD_INLINE float square_root(float a) { return std::sqrt(a); }
/// One of several numbers side by side.
NACRE_HD_INLINE float element(float a, int) { return a; }
NACRE_HD_INLINE std::int32_t element(std::int32_t a, int) { return a; }
NACRE_HD_INLINE bool is_set(bool mask, int) { return mask; }
NACRE_HD_INLINE void set_element(float& a, int, float value) { a = value; }
NACRE_HD_INLINE float to_float(std::int32_t a) { return float(a); }
NACRE_HD_INLINE std::int32_t floor_to_int(float a) { return std::int32_t(std::floor(a)); }
/// a * b + c, rounded once where the processor can. If the compiler chooses what to fuse, the last bits of one element
/// and of several may differ.
NACRE_HD_INLINE float multiply_add(float a, float b, float c) {
#if defined(__CUDA_ARCH__) || defined(__FMA__)
  return std::fma(a, b, c);
#else
  return a * b + c;
#endif
}
/// `from[index]`, or 0 where it is masked out. The index is read as an unsigned number.
NACRE_HD_INLINE std::int32_t gather(const std::uint32_t* from, std::int32_t index, bool mask) {
  return mask ? std::int32_t(from[std::uint32_t(index)]) : 0;
}
NACRE_HD_INLINE float gather(const float* from, std::int32_t index) { return from[index]; }
/// Of a table of at most 32 numbers, all of which can be read.
NACRE_HD_INLINE float gather_of_32(const float* table, std::int32_t index) { return table[index]; }
/// first, first + 1, ... but at most `last`.
template <class Wide>
NACRE_HD_INLINE typename Wide::Int counted(std::int32_t first, std::int32_t last) {
  if constexpr (Wide::lanes == 1) {
    return first < last ? first : last;
  } else {
    typename Wide::Int result;
    for (int lane = 0; lane < Wide::lanes; ++lane) result[lane] = first + lane < last ? first + lane : last;
    return result;
  }
}

#if !defined(__CUDACC__) && defined(__AVX2__) && defined(__FMA__)
#define NACRE_PACKETS 1

/// As many elements as a SIMD register holds.
struct Packet {
#if defined(__AVX512F__)
  static constexpr int lanes = 16;
#else
  static constexpr int lanes = 8;
#endif
  typedef float Float __attribute__((vector_size(4 * lanes)));
  typedef std::int32_t Int __attribute__((vector_size(4 * lanes)));
  using Mask = Int;  ///< all bits set, or none

  static Float all(float a) { return Float{} + a; }
  static Int all(std::int32_t a) { return Int{} + a; }
  static Mask nothing_masked() { return ~Int{}; }
};

NACRE_HD_INLINE Packet::Float select(Packet::Mask which, Packet::Float a, Packet::Float b) { return which ? a : b; }
NACRE_HD_INLINE Packet::Int select(Packet::Mask which, Packet::Int a, Packet::Int b) { return which ? a : b; }
NACRE_HD_INLINE float element(Packet::Float a, int lane) { return a[lane]; }
NACRE_HD_INLINE std::int32_t element(Packet::Int a, int lane) { return a[lane]; }
NACRE_HD_INLINE bool is_set(Packet::Mask mask, int lane) { return mask[lane] != 0; }
NACRE_HD_INLINE void set_element(Packet::Float& a, int lane, float value) { a[lane] = value; }
NACRE_HD_INLINE Packet::Float to_float(Packet::Int a) { return __builtin_convertvector(a, Packet::Float); }
NACRE_HD_INLINE Packet::Int floor_to_int(Packet::Float a) {
  const Packet::Int towards_zero = __builtin_convertvector(a, Packet::Int);
  return towards_zero + (to_float(towards_zero) > a);
}

#if defined(__AVX512F__)
NACRE_HD_INLINE Packet::Float square_root(Packet::Float a) {
  return Packet::Float(_mm512_maskz_sqrt_ps(0xFFFF, __m512(a)));
}
NACRE_HD_INLINE Packet::Float gather(const float* from, Packet::Int index) {
  return Packet::Float(_mm512_mask_i32gather_ps(_mm512_setzero_ps(), 0xFFFF, __m512i(index), from, 4));
}
NACRE_HD_INLINE Packet::Float gather_of_32(const float* table, Packet::Int index) {
  return Packet::Float(_mm512_permutex2var_ps(_mm512_loadu_ps(table), __m512i(index), _mm512_loadu_ps(table + 16)));
}
NACRE_HD_INLINE Packet::Float multiply_add(Packet::Float a, Packet::Float b, Packet::Float c) {
  return Packet::Float(_mm512_fmadd_ps(__m512(a), __m512(b), __m512(c)));
}
NACRE_HD_INLINE __mmask16 bits_of(Packet::Mask mask) { return _mm512_test_epi32_mask(__m512i(mask), __m512i(mask)); }
NACRE_HD_INLINE bool any(Packet::Mask mask) { return bits_of(mask) != 0; }
NACRE_HD_INLINE Packet::Int gather(const std::uint32_t* from, Packet::Int index, Packet::Mask mask) {
  constexpr std::int32_t half = INT32_MIN;  // the instruction's indices are signed
  return Packet::Int(
      _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), bits_of(mask), __m512i(index ^ half), from + 0x80000000u, 4));
}
#else
NACRE_HD_INLINE Packet::Float square_root(Packet::Float a) { return Packet::Float(_mm256_sqrt_ps(__m256(a))); }
NACRE_HD_INLINE Packet::Float gather(const float* from, Packet::Int index) {
  return Packet::Float(_mm256_i32gather_ps(from, __m256i(index), 4));
}
NACRE_HD_INLINE Packet::Float gather_of_32(const float* table, Packet::Int index) { return gather(table, index); }
NACRE_HD_INLINE Packet::Float multiply_add(Packet::Float a, Packet::Float b, Packet::Float c) {
  return Packet::Float(_mm256_fmadd_ps(__m256(a), __m256(b), __m256(c)));
}
NACRE_HD_INLINE bool any(Packet::Mask mask) { return !_mm256_testz_si256(__m256i(mask), __m256i(mask)); }
NACRE_HD_INLINE Packet::Int gather(const std::uint32_t* from, Packet::Int index, Packet::Mask mask) {
  constexpr std::int32_t half = INT32_MIN;  // the instruction's indices are signed
  return Packet::Int(_mm256_mask_i32gather_epi32(_mm256_setzero_si256(),
                                                 reinterpret_cast<const int*>(from + 0x80000000u),
                                                 __m256i(index ^ half), __m256i(mask), 4));
}
#endif

/// `from[3 * index[i] + k]` of each element i in `result[k]`, k < 3; 0 where it is masked out, though it is read. One
/// load for the three words of an element, and for one more that must exist: several times as fast as three gathers.
template <class Index>
NACRE_HD_INLINE void gather_triples(const std::uint32_t* from, const Index& index, Packet::Mask mask,
                                    Packet::Int result[3]) {
  typedef std::int32_t Row __attribute__((vector_size(16)));
  typedef std::int32_t UnalignedRow __attribute__((vector_size(16), aligned(4), may_alias));
  typedef std::int32_t Rows __attribute__((vector_size(32)));
  constexpr int groups = Packet::lanes / 8;
  Rows word[3][groups];
  for (int g = 0; g < groups; ++g) {
    Rows rows[4];  // element k beside element k + 4
    for (int k = 0; k < 4; ++k) {
      const auto row = [&](int element) {
        return Row(*reinterpret_cast<const UnalignedRow*>(from + 3 * std::uint64_t(index[8 * g + element])));
      };
      rows[k] = __builtin_shufflevector(row(k), row(k + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    }
    const Rows low01 = __builtin_shufflevector(rows[0], rows[1], 0, 8, 1, 9, 4, 12, 5, 13);
    const Rows low23 = __builtin_shufflevector(rows[2], rows[3], 0, 8, 1, 9, 4, 12, 5, 13);
    const Rows high01 = __builtin_shufflevector(rows[0], rows[1], 2, 10, 3, 11, 6, 14, 7, 15);
    const Rows high23 = __builtin_shufflevector(rows[2], rows[3], 2, 10, 3, 11, 6, 14, 7, 15);
    word[0][g] = __builtin_shufflevector(low01, low23, 0, 1, 8, 9, 4, 5, 12, 13);
    word[1][g] = __builtin_shufflevector(low01, low23, 2, 3, 10, 11, 6, 7, 14, 15);
    word[2][g] = __builtin_shufflevector(high01, high23, 0, 1, 8, 9, 4, 5, 12, 13);
  }
  for (int k = 0; k < 3; ++k) {
#if defined(__AVX512F__)
    result[k] =
        mask & __builtin_shufflevector(word[k][0], word[k][1], 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    result[k] = mask & word[k][0];
#endif
  }
}

using Widest = Packet;
#else
using Widest = Single;
#endif

/// The cells that positions lie in, and the lower corners of cells.
template <class Float>
NACRE_HD_INLINE auto cells_of(const Vec3<Float>& p) {
  return Vec3<decltype(floor_to_int(p.x))>{floor_to_int(p.x), floor_to_int(p.y), floor_to_int(p.z)};
}
template <class Int>
NACRE_HD_INLINE auto corners_of(const Vec3<Int>& cell) {
  return Vec3<decltype(to_float(cell.x))>{to_float(cell.x), to_float(cell.y), to_float(cell.z)};
}

/// Vectors of one element or several, fused in one way.
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

/// Bits first .. first + count - 1 of a word, as a signed number.
template <class Int>
NACRE_HD_INLINE Int signed_bits(Int word, int first, int count) {
  return (word << (32 - first - count)) >> (32 - count);
}

}  // namespace nacre
