// Nacre: two numbers in a tangent plane, also as a complex number.
#pragma once

#include <cmath>

namespace nacre {

/// Two numbers in a tangent plane.
struct Vec2d {
  double x = 0, y = 0;
};

inline Vec2d operator+(const Vec2d& a, const Vec2d& b) { return {a.x + b.x, a.y + b.y}; }
inline Vec2d operator-(const Vec2d& a, const Vec2d& b) { return {a.x - b.x, a.y - b.y}; }
inline Vec2d operator*(const Vec2d& a, double s) { return {a.x * s, a.y * s}; }
inline double dot(const Vec2d& a, const Vec2d& b) { return a.x * b.x + a.y * b.y; }
inline double cross(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }
inline double length(const Vec2d& a) { return std::hypot(a.x, a.y); }

/// Unit vector, or zero if `a` is zero.
inline Vec2d normalized(const Vec2d& a) {
  const double n = length(a);
  return n > 0 ? a * (1 / n) : Vec2d{};
}

/// Both as complex numbers: `a` turned by the angle of `b`, if that is a unit vector.
inline Vec2d turned_by(const Vec2d& a, const Vec2d& b) { return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x}; }
/// The other way round.
inline Vec2d turned_back_by(const Vec2d& a, const Vec2d& b) { return {a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y}; }

}  // namespace nacre
