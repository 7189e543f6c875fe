// Nacre: four floats that are stored, loaded and computed with together.
#pragma once

#include "compute/device/backend.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

/// How four floats are stored in memory: one 16-byte load on either backend.
struct alignas(16) Float4 {
  float x, y, z, w;
};

#if defined(__CUDACC__)

/// The type to compute with on the device: plain scalars, since one thread has many of them in flight anyway.
struct Lanes {
  float x, y, z, w;
};
NACRE_HD_INLINE Lanes operator+(Lanes a, Lanes b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w}; }
NACRE_HD_INLINE Lanes operator-(Lanes a, Lanes b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
NACRE_HD_INLINE Lanes operator*(Lanes a, Lanes b) { return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w}; }
NACRE_HD_INLINE Lanes operator/(Lanes a, Lanes b) { return {a.x / b.x, a.y / b.y, a.z / b.z, a.w / b.w}; }
NACRE_HD_INLINE Lanes operator*(Lanes a, float s) { return {a.x * s, a.y * s, a.z * s, a.w * s}; }
NACRE_HD_INLINE Lanes operator*(float s, Lanes a) { return a * s; }
NACRE_HD_INLINE Lanes operator+(Lanes a, float s) { return {a.x + s, a.y + s, a.z + s, a.w + s}; }
NACRE_HD_INLINE Lanes load(const Float4& a) { return {a.x, a.y, a.z, a.w}; }
NACRE_HD_INLINE Float4 store(Lanes a) { return {a.x, a.y, a.z, a.w}; }
NACRE_HD_INLINE Lanes lanes(float x, float y, float z, float w = 0) { return {x, y, z, w}; }
NACRE_HD_INLINE Vec3f xyz(Lanes a) { return {a.x, a.y, a.z}; }
NACRE_HD_INLINE float sum(Lanes a) { return a.x + a.y + (a.z + a.w); }
/// Four of the eight floats low[0..3], high[0..3], starting at number `first` (0 to 3). It branches, since few rows
/// cross two bricks, and selecting each float would need more registers than there are.
NACRE_HD_INLINE Lanes four_of(const float* low, const float* high, int first) {
  if (first == 0) return {low[0], low[1], low[2], low[3]};
  const float *lower = low + first, *upper = high + first - 4;
  return {lower[0], (first < 3 ? lower : upper)[1], (first < 2 ? lower : upper)[2], upper[3]};
}

#else

/// The type to compute with on the host: one SIMD register.
typedef float Lanes __attribute__((vector_size(16)));
typedef Lanes MemoryLanes __attribute__((may_alias));
NACRE_HD_INLINE Lanes load(const Float4& a) { return *reinterpret_cast<const MemoryLanes*>(&a); }
NACRE_HD_INLINE Float4 store(Lanes a) { return {a[0], a[1], a[2], a[3]}; }
NACRE_HD_INLINE Lanes lanes(float x, float y, float z, float w = 0) { return Lanes{x, y, z, w}; }
NACRE_HD_INLINE Vec3f xyz(Lanes a) { return {a[0], a[1], a[2]}; }
NACRE_HD_INLINE float sum(Lanes a) { return a[0] + a[1] + (a[2] + a[3]); }
/// Four of the eight floats low[0..3], high[0..3], starting at number `first` (0 to 3).
NACRE_HD_INLINE Lanes four_of(const float* low, const float* high, int first) {
#if __has_builtin(__builtin_shuffle)
  typedef float Unaligned __attribute__((vector_size(16), aligned(4), may_alias));
  typedef int Places __attribute__((vector_size(16)));
  return __builtin_shuffle(Lanes(*reinterpret_cast<const Unaligned*>(low)),
                           Lanes(*reinterpret_cast<const Unaligned*>(high)), Places{0, 1, 2, 3} + first);
#else
  const auto at = [&](int k) { return k < 4 ? low[k] : high[k - 4]; };
  return Lanes{at(first), at(first + 1), at(first + 2), at(first + 3)};
#endif
}

/// Four nodes of a row side by side: the first two axes of a 4^3 stencil are reduced for all four at once.
typedef float Row __attribute__((vector_size(64)));
typedef float HalfRow __attribute__((vector_size(32)));

NACRE_HD_INLINE Row row(const Float4& a, const Float4& b, const Float4& c, const Float4& d) {
  const HalfRow low = __builtin_shufflevector(load(a), load(b), 0, 1, 2, 3, 4, 5, 6, 7);
  const HalfRow high = __builtin_shufflevector(load(c), load(d), 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// The k-th node of a row.
template <int K>
NACRE_HD_INLINE Lanes node(Row r) {
  return __builtin_shufflevector(r, r, 4 * K, 4 * K + 1, 4 * K + 2, 4 * K + 3);
}

#endif

}  // namespace nacre
