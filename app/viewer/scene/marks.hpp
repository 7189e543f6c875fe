// Nacre: what the user has marked in a scene: a ruler, notes, cameras to come back to. All are values of knobs, so that
// sessions, recordings and undo have them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/picture/compose.hpp"
#include "engine/picture/image.hpp"
#include "engine/render/view.hpp"

namespace nacre {

/// Points of a ruler: "x y z;x y z;...", world coordinates; what is no point is left out.
std::vector<Vec3d> parse_ruler(const std::string& text);
std::string ruler_text(std::span<const Vec3d> points);

/// What a ruler says: the length of each of its parts; with three points, the angle at the second as well.
std::vector<std::string> ruler_lines(std::span<const Vec3d> points, const std::string& unit);

struct PlacedNote {
  Vec3d position;  ///< world
  std::string text;
};
/// "x y z text;x y z text;..."
std::vector<PlacedNote> parse_notes(const std::string& text);
std::string notes_text(std::span<const PlacedNote> notes);

struct SavedCamera {
  std::string name;
  Camera camera;
};
/// "name:" and ten numbers: eye, target, up, height; followed by o for an orthographic camera; separated by ";".
std::vector<SavedCamera> parse_cameras(const std::string& text);
std::string cameras_text(std::span<const SavedCamera> cameras);

/// Where a point of the world is in a picture: pixels from the upper left corner; none behind the eye.
std::optional<std::array<double, 2>> pixel_of(const View& view, const Vec3d& point);

/// Ruler and notes as a transparent sheet over the picture, with `paper` behind it.
Image marks_sheet(const View& view, const std::string& ruler, const std::string& notes, const std::string& unit,
                  const Rgba& paper);

}  // namespace nacre
