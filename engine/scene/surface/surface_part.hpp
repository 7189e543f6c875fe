// Nacre: a part of a surface, cut along planes; what is known at points of the whole is known at its points, too.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/scene/surface/prepare.hpp"

namespace nacre {

/// The points p with dot(normal, p) <= offset.
struct HalfSpace {
  Vec3d normal;  ///< unit
  double offset;
};

struct SurfacePart {
  /// Where a point lies in the whole: its weights at three of the whole's points.
  struct Origin {
    Triangle points;
    Vec3f weights;
  };

  PreparedSurface surface;
  std::vector<Origin> origin;                          ///< one per point of the part
  std::size_t whole_triangles = 0, cut_triangles = 0;  ///< of the part: taken as they are; made by cutting

  /// Interpolates what belongs to the whole's points, into one for each of the part's.
  void take(std::span<const Vec3f> whole, std::span<Vec3f> part) const;
  std::vector<float> take(std::span<const float> whole) const;
  std::vector<std::array<float, 4>> take(std::span<const std::array<float, 4>> whole) const;
};

/// The part of `whole` inside of all half spaces. Triangles that cross a border are cut there (Sutherland and Hodgman
/// 1974), which leaves the surface as it was.
SurfacePart cut_surface(const PreparedSurface& whole, std::span<const HalfSpace> inside);

}  // namespace nacre
