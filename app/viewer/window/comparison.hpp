// Nacre: a second scene beside the first, with the same camera and time: other data, or the same with other knobs.
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <string>

#include "app/viewer/panel/scene_panel.hpp"
#include "app/viewer/scene/free_area.hpp"
#include "app/viewer/scene/scene_painter.hpp"
#include "engine/scene/session/compared.hpp"

namespace nacre {

/// Two flows of the same time range keep together: the one that is a step ahead waits for the other.
class Comparison {
 public:
  bool on() const { return bool(open_.scene); }
  Scene& scene() const { return *open_.scene; }

  /// Opens, changes or closes the second scene as the first session asks for now, while an OpenGL context is current.
  /// What begins there begins at the time that the first scene shows. Throws Error where it cannot; then the scene
  /// stays as it was.
  void follow(const Session& first, const Scene& first_scene, const SceneOptions& options);
  void close();

  /// Once a frame, before the first scene advances.
  void advance(Scene& first, double now);
  /// For frames that wait, after the first scene has advanced: until both are at the same time.
  void advance_and_wait(Scene& first, const std::atomic<bool>& stop);
  /// Why the second scene has failed, once; empty: it has not.
  std::string take_failure();
  /// What the data of the second scene have decided becomes a knob of it. True where the first session has changed.
  bool settle_knobs(Session& first);

  /// Into that part of a frame, through the camera of the first.
  void draw(const Framebuffer& frame, const Session& first, double turned, const FreeArea& area);
  /// Of the first view; empty without a second one.
  std::string first_heading() const { return on() ? headings_[0] : ""; }

 private:
  OpenScene open_;
  Session session_;  ///< as the scene was told last
  std::optional<ScenePainter> painter_;
  std::array<std::string, 2> headings_;
  std::string failure_;  ///< that was told
};

/// Left and right half, with a gap between them.
std::array<FreeArea, 2> halves(const FreeArea& area);

/// By how many steps is `a` ahead of `b`, where both flows go through the same times? Below 0: it is behind; 0: they
/// are together, or cannot be compared.
int steps_ahead(const Transport& a, const Transport& b);

}  // namespace nacre
