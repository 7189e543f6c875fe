// Nacre: what limits sizes in materials, in regions and by an image, beside the rule for all of them.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "compute/field/interface.hpp"

namespace nacre {

/// The largest size in a material or in a region, in place of SizingRule::max_size; lengths in voxels.
struct SizeBound {
  enum class Kind : std::uint32_t { material, box, ball };
  Kind kind = Kind::material;
  float size = 1;
  std::uint32_t material = 0;
  Vec3f centre, row[3];  ///< of a region: row * (p - centre) maps it to the cube or ball of half width 1 around zero

  /// Whether it holds at a point of this interface.
  NACRE_HD bool holds(const Vec3f& p, const Junction& surface) const {
    if (kind == Kind::material) return surface.has(material);
    const Vec3f r = p - centre, u{dot(row[0], r), dot(row[1], r), dot(row[2], r)};
    if (kind == Kind::ball) return dot(u, u) <= 1;
    return std::fabs(u.x) <= 1 && std::fabs(u.y) <= 1 && std::fabs(u.z) <= 1;
  }
  bool operator==(const SizeBound& b) const {
    return kind == b.kind && size == b.size && material == b.material && centre == b.centre && row[0] == b.row[0] &&
           row[1] == b.row[1] && row[2] == b.row[2];
  }
};

/// An image of largest sizes, in place of SizingRule::max_size; voxels.
struct SizeWishes {
  Int3 dims{};
  Vec3f origin, row[3];       ///< row[k] * (p - origin) is the index of p along axis k of the image
  std::vector<float> size;    ///< per voxel of the image, x fastest; 0: no wish
  float least = 0, most = 0;  ///< of the wishes in and around the volume
};

/// The same on the device.
struct SizeWishesView {
  Int3 dims{};
  Vec3f origin, row[3];
  const float* size = nullptr;

  /// Linear between the centres of voxels, of which those without a wish are left out; 0 where the nearest one has
  /// none, and beside the image.
  NACRE_HD float operator()(const Vec3f& p) const {
    if (!size) return 0;
    const Vec3f r = p - origin;
    int first[3];
    float f[3];
    for (int k = 0; k < 3; ++k) {
      const float u = dot(row[k], r), last = float(dims[k] - 1);
      if (!(u >= -0.5f && u <= last + 0.5f)) return 0;
      const float limited = max(min(u, last), 0);
      first[k] = int(min(limited, max(last - 1, 0)));
      f[k] = limited - float(first[k]);
    }
    float sum = 0, weights = 0, nearest = 0, largest = -1;
    for (int corner = 0; corner < 8; ++corner) {
      std::int64_t at = 0, stride = 1;
      float weight = 1;
      for (int k = 0; k < 3; ++k) {
        const int second = corner >> k & 1;
        weight *= second ? f[k] : 1 - f[k];
        at += stride * (first[k] + (first[k] + second < dims[k] ? second : 0));
        stride *= dims[k];
      }
      if (weight > largest) largest = weight, nearest = size[at];
      if (!(size[at] > 0)) continue;
      sum += weight * size[at];
      weights += weight;
    }
    return nearest > 0 ? sum / weights : 0;
  }
};

}  // namespace nacre
