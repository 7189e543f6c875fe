// Nacre: small vectors for host and device code.
#pragma once

#include <cmath>
#include <cstdint>

#include "compute/device/backend.hpp"

namespace nacre {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3() = default;
  NACRE_HD constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  NACRE_HD constexpr explicit Vec3(T s) : x(s), y(s), z(s) {}
  template <class U>
  NACRE_HD constexpr explicit Vec3(const Vec3<U>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}

  NACRE_HD constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  NACRE_HD constexpr const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

  NACRE_HD constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  NACRE_HD constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  NACRE_HD constexpr Vec3& operator*=(T s) { return *this = *this * s; }

  friend NACRE_HD_INLINE constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend NACRE_HD_INLINE constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend NACRE_HD_INLINE constexpr Vec3 operator*(const Vec3& a, const Vec3& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
  }
  friend NACRE_HD_INLINE constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend NACRE_HD_INLINE constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
  friend NACRE_HD_INLINE constexpr Vec3 operator/(const Vec3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
  friend NACRE_HD_INLINE constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend NACRE_HD_INLINE constexpr bool operator==(const Vec3& a, const Vec3& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z;
  }
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Int3 = Vec3<std::int32_t>;

template <class T>
NACRE_HD_INLINE constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
NACRE_HD_INLINE constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
NACRE_HD_INLINE T length(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}

/// Unit vector, or zero if `a` is zero.
template <class T>
NACRE_HD Vec3<T> normalized(const Vec3<T>& a) {
  const T n = length(a);
  return n > T(0) ? a / n : Vec3<T>{};
}

/// The smaller and the larger of two numbers, in one instruction; std::fmin also handles NaN and is a library call.
NACRE_HD_INLINE constexpr float min(float a, float b) { return b < a ? b : a; }
NACRE_HD_INLINE constexpr float max(float a, float b) { return a < b ? b : a; }

template <class T>
NACRE_HD_INLINE constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}

template <class T>
NACRE_HD_INLINE constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

template <class T>
NACRE_HD bool is_finite(const Vec3<T>& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Whether a cell is within 0 .. dims - 1 along each axis.
NACRE_HD_INLINE constexpr bool is_within(const Vec3<int>& cell, const Vec3<int>& dims) {
  return unsigned(cell.x) < unsigned(dims.x) && unsigned(cell.y) < unsigned(dims.y) &&
         unsigned(cell.z) < unsigned(dims.z);
}

/// Marks a missing index.
inline constexpr std::uint32_t none = 0xffffffffu;

/// Three indices into an array of points.
struct Triangle {
  std::uint32_t a{}, b{}, c{};
  NACRE_HD constexpr std::uint32_t operator[](int k) const { return k == 0 ? a : k == 1 ? b : c; }
  friend NACRE_HD_INLINE constexpr bool operator==(const Triangle& s, const Triangle& t) {
    return s.a == t.a && s.b == t.b && s.c == t.c;
  }
};

}  // namespace nacre
