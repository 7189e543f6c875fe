// Nacre: a displacement in four bytes, and eight of them interpolated at once.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "compute/math/lanes.hpp"
#include "compute/math/vec.hpp"

namespace nacre {

/// Three signed 9-bit mantissas (x lowest) and one 5-bit exponent: component = mantissa * 2^(exponent - 29), up to
/// 1020. The direction is off by at most 0.4 degrees however short the vector is, down to 2^-29 cells.
struct PackedVector {
  static constexpr int bias = 29, largest = 255;

  NACRE_HD static std::uint32_t pack(const Vec3f& v) {
    const float x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z);
    const float most = x > y ? (x > z ? x : z) : (y > z ? y : z);
    if (!(most > 0)) return 0;
    const float share = most * (1.0f / largest);
    std::uint32_t bits;
    memcpy(&bits, &share, sizeof bits);
    int exponent = int(bits >> 23) - 126 + bias;  // most <= largest * 2^(exponent - bias), but for rounding
    exponent = exponent < 0 ? 0 : exponent > 31 ? 31 : exponent;
    bits = std::uint32_t(127 + bias - exponent) << 23;
    float scale;
    memcpy(&scale, &bits, sizeof scale);
    std::uint32_t all = std::uint32_t(exponent) << 27;
    for (int axis = 0; axis < 3; ++axis) {
      const float q = max(min(std::floor(v[axis] * scale + 0.5f), float(largest)), -float(largest));
      all |= (std::uint32_t(int(q)) & 0x1ff) << (9 * axis);
    }
    return all;
  }

  NACRE_HD_INLINE static Vec3f unpack(std::uint32_t p) {
    const float s = scale(p);
    return {float(std::int32_t(p << 23) >> 23) * s, float(std::int32_t(p << 14) >> 23) * s,
            float(std::int32_t(p << 5) >> 23) * s};
  }

  NACRE_HD_INLINE static float scale(std::uint32_t p) {
    const std::uint32_t bits = ((p >> 27) + (127 - bias)) << 23;
    float s;
    memcpy(&s, &bits, sizeof s);
    return s;
  }

  /// Sum of weight[k] times vector p[k] over eight.
  NACRE_HD_INLINE static Vec3f sum(const std::uint32_t* p, const float* weight) {
#if defined(__CUDACC__)
    Vec3f total{};
    for (int k = 0; k < 8; ++k) total += unpack(p[k]) * weight[k];
    return total;
#else
    typedef std::uint32_t Words __attribute__((vector_size(32)));
    typedef std::int32_t Integers __attribute__((vector_size(32)));
    typedef float Floats __attribute__((vector_size(32)));
    Words all;
    Floats w;
    memcpy(&all, p, sizeof all);
    memcpy(&w, weight, sizeof w);
    const Words exponent = ((all >> 27) + (127 - bias)) << 23;
    Floats s;
    memcpy(&s, &exponent, sizeof s);
    w *= s;
    const Floats x = __builtin_convertvector(Integers(all << 23) >> 23, Floats) * w;
    const Floats y = __builtin_convertvector(Integers(all << 14) >> 23, Floats) * w;
    const Floats z = __builtin_convertvector(Integers(all << 5) >> 23, Floats) * w;
    const auto add = [](const Floats& v) { return ((v[0] + v[4]) + (v[1] + v[5])) + ((v[2] + v[6]) + (v[3] + v[7])); };
    return {add(x), add(y), add(z)};
#endif
  }
};

}  // namespace nacre
