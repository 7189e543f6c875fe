// Nacre: what the mouse does to the slices of the layout.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "app/viewer/scene/layout.hpp"
#include "app/viewer/scene/slice_views.hpp"

namespace nacre {

/// Over each slice lies a part of the user interface that the mouse belongs to.
class SliceMouse {
 public:
  /// With Dear ImGui. A click or a drag moves the crosshair, the wheel goes through the slices, a double click shows
  /// one alone, or all again. What is under the mouse is told.
  void draw(ViewSettings& view, SliceViews& slices, const ViewAreas& areas);
  /// There are no slices.
  void forget() { under_.reset(); }
  /// The position on the slice under the mouse; none: it is elsewhere.
  const std::optional<Vec3d>& under() const { return under_; }

 private:
  void use(int k, ViewSettings& view, SliceViews& slices, const FreeArea& area);

  std::optional<Vec3d> under_;
  std::array<double, 3> turned_{};  ///< of the wheel, less than a voxel
  bool drags_ = false;              ///< the crosshair
  std::string before_;              ///< the crosshair, before a click that may be the first of two
};

}  // namespace nacre
