// Nacre: three orthogonal slices of a volume that can be drawn beside the view.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "app/viewer/scene/scene.hpp"
#include "engine/render/view.hpp"

namespace nacre {

/// What is written on a slice.
struct SliceCaption {
  std::string position;                  ///< of the slice
  std::string left, right, bottom, top;  ///< what lies that way
  std::array<float, 3> colour{};         ///< of its border, and of its line in the others
};

/// Slice k lies across the axis of the volume that runs most along the axis k of the world. All go through one point,
/// the crosshair, which the knob `crosshair` says.
class SliceViews {
 public:
  virtual ~SliceViews() = default;

  /// That sees all of slice k from the front.
  virtual Camera camera(int k, double aspect) const = 0;
  /// Slice, outline of the mesh, crosshair.
  virtual void draw(int k, const View& view) = 0;
  virtual SliceCaption caption(int k) const = 0;

  /// The knob with the crosshair at a point of slice k, or so many voxels farther across it.
  virtual std::string crosshair_at(int k, const Vec3d& point) const = 0;
  virtual std::string crosshair_after(int k, int steps) const = 0;
  /// What a ray meets on slice k.
  virtual std::optional<ProbeResult> probe(int k, const Vec3d& from, const Vec3d& along) const = 0;
};

}  // namespace nacre
