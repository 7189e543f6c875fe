// Nacre: clip planes in the panel, and the handle by which one is dragged in the view.
#pragma once

#include <optional>
#include <span>

#include "app/viewer/scene/clip_drag.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// The section "clip" of the tab "look". While it is open, the chosen plane has its outline and a handle in the view.
class ClipPanel {
 public:
  /// The section, with Dear ImGui. `corners`: of the scene; `camera`: of what is seen.
  void draw(Settings& settings, std::span<const Vec3d> corners, const Camera& camera);
  /// Outline and handle of the chosen plane over the picture, and what dragging them does; after `draw`. Nothing where
  /// the section has not been drawn since the last call.
  void draw_handle(ViewSettings& view, std::span<const Vec3d> corners, const PictureArea& picture);
  /// One more plane, through the middle of the scene and facing the camera; the section opens.
  void add_facing(Settings& settings, std::span<const Vec3d> corners, const Camera& camera);

 private:
  static constexpr int axis_plane = -1;

  struct Held {
    WorldPlane plane;  ///< when it was taken
    bool turns = false;
    std::array<double, 2> offset{};  ///< of the mouse from what it has taken, pixels
  };
  void choose_one_of(const ViewSettings& view, int planes);
  void add(ViewSettings& view, std::span<const Vec3d> corners, const Vec3d& normal);
  void rows(ViewSettings& view, std::span<const Vec3d> corners, const Camera& camera);
  std::optional<WorldPlane> dragged(const WorldPlane& plane, const BoxCorners& box, const PictureArea& picture);

  int chosen_ = 0;  ///< number in the list, or axis_plane
  bool drawn_ = false, opens_ = false;
  std::optional<Held> held_;
};

}  // namespace nacre
