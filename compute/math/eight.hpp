// Nacre: eight floats, one per corner of a cube, that are computed with together.
#pragma once

#include <cmath>
#include <cstring>

#include "compute/device/backend.hpp"
#include "compute/math/vec.hpp"

#if !defined(__CUDACC__) && defined(__AVX__)
#include <immintrin.h>
#endif

namespace nacre {

#if defined(__CUDACC__)

/// On the device one thread computes all eight, in registers.
struct Eight {
  float v[8];
  NACRE_HD_INLINE float operator[](int k) const { return v[k]; }
};

namespace detail {
template <class F>
NACRE_HD_INLINE Eight each_of_eight(const F& f) {
  Eight r;
  for (int k = 0; k < 8; ++k) r.v[k] = f(k);
  return r;
}
}  // namespace detail

NACRE_HD_INLINE Eight eight(float a) {
  return detail::each_of_eight([&](int) { return a; });
}
NACRE_HD_INLINE Eight operator+(const Eight& a, const Eight& b) {
  return detail::each_of_eight([&](int k) { return a.v[k] + b.v[k]; });
}
NACRE_HD_INLINE Eight operator-(const Eight& a, const Eight& b) {
  return detail::each_of_eight([&](int k) { return a.v[k] - b.v[k]; });
}
NACRE_HD_INLINE Eight operator*(const Eight& a, const Eight& b) {
  return detail::each_of_eight([&](int k) { return a.v[k] * b.v[k]; });
}
NACRE_HD_INLINE Eight operator+(const Eight& a, float b) { return a + eight(b); }
NACRE_HD_INLINE Eight operator-(const Eight& a, float b) { return a - eight(b); }
NACRE_HD_INLINE Eight operator*(const Eight& a, float b) { return a * eight(b); }
NACRE_HD_INLINE Eight min(const Eight& a, const Eight& b) {
  return detail::each_of_eight([&](int k) { return a.v[k] < b.v[k] ? a.v[k] : b.v[k]; });
}
NACRE_HD_INLINE Eight max(const Eight& a, const Eight& b) {
  return detail::each_of_eight([&](int k) { return a.v[k] > b.v[k] ? a.v[k] : b.v[k]; });
}
NACRE_HD_INLINE Eight sqrt(const Eight& a) {
  return detail::each_of_eight([&](int k) { return std::sqrt(a.v[k]); });
}
/// `a` where `sign` > 0, otherwise `b`.
NACRE_HD_INLINE Eight where_positive(const Eight& sign, const Eight& a, const Eight& b) {
  return detail::each_of_eight([&](int k) { return sign.v[k] > 0 ? a.v[k] : b.v[k]; });
}
/// One bit per corner: set where `a` <= `b`.
NACRE_HD_INLINE unsigned at_most(const Eight& a, const Eight& b) {
  unsigned bits = 0;
  for (int k = 0; k < 8; ++k) bits |= unsigned(a.v[k] <= b.v[k]) << k;
  return bits;
}
/// `a` with `x`, `y`, `z` added or subtracted: the corners of a cube, x fastest, lower ones first.
NACRE_HD_INLINE Eight at_corners(float a, float x, float y, float z) {
  return detail::each_of_eight([&](int k) { return a + (k & 1 ? x : -x) + ((k & 2 ? y : -y) + (k & 4 ? z : -z)); });
}

/// The displacements from a point to the corners of a cube.
struct EightDisplacements {
  Vec3f middle;
  float half;
};
NACRE_HD_INLINE EightDisplacements displacements_to_corners(const Vec3f& middle, float half) { return {middle, half}; }
NACRE_HD_INLINE Eight dot(const EightDisplacements& w, const Vec3f& n) {
  return at_corners(dot(w.middle, n), n.x * w.half, n.y * w.half, n.z * w.half);
}
NACRE_HD_INLINE Eight squared(const EightDisplacements& w) {
  const Vec3f s = w.middle * (2 * w.half);
  return at_corners(dot(w.middle, w.middle) + 3 * w.half * w.half, s.x, s.y, s.z);
}

#else

/// On the host the eight floats are one SIMD register.
typedef float Eight __attribute__((vector_size(32)));
typedef double EightDoubles __attribute__((vector_size(64)));

NACRE_HD_INLINE Eight eight(float a) { return Eight{a, a, a, a, a, a, a, a}; }
NACRE_HD_INLINE Eight min(Eight a, Eight b) { return a < b ? a : b; }
NACRE_HD_INLINE Eight max(Eight a, Eight b) { return a > b ? a : b; }
NACRE_HD_INLINE Eight sqrt(Eight a) {
#if defined(__AVX__)
  return _mm256_sqrt_ps(a);
#else
  for (int k = 0; k < 8; ++k) a[k] = std::sqrt(a[k]);
  return a;
#endif
}
/// `a` where `sign` > 0, otherwise `b`.
NACRE_HD_INLINE Eight where_positive(Eight sign, Eight a, Eight b) { return sign > 0 ? a : b; }
/// One bit per corner: set where `a` <= `b`.
NACRE_HD_INLINE unsigned at_most(Eight a, Eight b) {
#if defined(__AVX__)
  return unsigned(_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LE_OQ)));
#else
  unsigned bits = 0;
  for (int k = 0; k < 8; ++k) bits |= unsigned(a[k] <= b[k]) << k;
  return bits;
#endif
}
/// `a` with `x`, `y`, `z` added or subtracted: the corners of a cube, x fastest, lower ones first.
NACRE_HD_INLINE EightDoubles at_corners(double a, double x, double y, double z) {
  return EightDoubles{-1, 1, -1, 1, -1, 1, -1, 1} * x + a +
         (EightDoubles{-1, -1, 1, 1, -1, -1, 1, 1} * y + EightDoubles{-1, -1, -1, -1, 1, 1, 1, 1} * z);
}

/// The displacements from a point to the corners of a cube.
struct EightDisplacements {
  Eight x, y, z;
};
NACRE_HD_INLINE EightDisplacements displacements_to_corners(const Vec3f& middle, float half) {
  return {Eight{-1, 1, -1, 1, -1, 1, -1, 1} * half + middle.x, Eight{-1, -1, 1, 1, -1, -1, 1, 1} * half + middle.y,
          Eight{-1, -1, -1, -1, 1, 1, 1, 1} * half + middle.z};
}
NACRE_HD_INLINE Eight dot(const EightDisplacements& w, const Vec3f& n) { return w.x * n.x + w.y * n.y + w.z * n.z; }
NACRE_HD_INLINE Eight squared(const EightDisplacements& w) { return w.x * w.x + w.y * w.y + w.z * w.z; }

#endif

/// Eight floats as they are stored in memory, which need not be aligned.
NACRE_HD_INLINE Eight load_eight(const float* from) {
  Eight a;
  std::memcpy(&a, from, sizeof a);
  return a;
}
NACRE_HD_INLINE void store_eight(float* to, const Eight& a) { std::memcpy(to, &a, sizeof a); }

}  // namespace nacre
