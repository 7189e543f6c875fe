// Nacre: the planes that cut a scene, from the knobs of the view, and their geometry. No OpenGL here.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/render/view.hpp"
#include "engine/scene/settings/settings.hpp"

namespace nacre {

/// A plane in the world. As a clip plane it cuts away the side that its normal points away from.
struct WorldPlane {
  Vec3d normal{1, 0, 0};  ///< unit
  Vec3d point;

  double offset() const { return dot(normal, point); }
};

inline constexpr std::size_t most_clip_planes = 6;  ///< of the knob `clip_planes`

/// "nx ny nz x y z;...", at most `most_clip_planes`; what is no plane is left out.
std::vector<WorldPlane> parse_clip_planes(const std::string& text);
std::string clip_planes_text(std::span<const WorldPlane> planes);

/// The plane across the axis `view.clip`, at the share `view.clip_at` of the box around `corners` (world), with its
/// point in the middle of the box; none where that says so.
std::optional<WorldPlane> axis_clip_plane(const ViewSettings& view, std::span<const Vec3d> corners);

/// That plane and those of the knob `clip_planes`.
ClipPlanes clip_planes(const ViewSettings& view, std::span<const Vec3d> corners);

/// Corners of a box: corner k is at the far side of axis a where bit a of k is set.
using BoxCorners = std::array<Vec3d, 8>;
/// Of the box around `points`, of which there must be some.
BoxCorners bounding_corners(std::span<const Vec3d> points);

/// Where a plane cuts a box: 3 to 6 corners in their order around it; empty: nowhere.
std::vector<Vec3d> plane_outline(const WorldPlane& plane, const BoxCorners& box);

/// Offsets of planes with this normal between which they meet the box.
std::array<double, 2> offset_range(const Vec3d& normal, const BoxCorners& box);

}  // namespace nacre
