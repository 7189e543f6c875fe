// Nacre: keeps a scene in the part of the window that panels and legend leave free.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "app/viewer/scene/free_area.hpp"
#include "app/viewer/scene/scene.hpp"

namespace nacre {

/// A camera that was fitted is fitted again where the free part, the legend or what is drawn has changed, for as long
/// as nobody has moved it.
class Framing {
 public:
  /// The camera that a session begins with, for an area of that size.
  using FirstCamera = std::function<Camera(const Settings& settings, const std::vector<Vec3d>& seen, bool legend)>;

  /// Once a frame, before it is drawn: fits a session without a camera, and what has been fitted. `first`: a camera for
  /// the session's settings, with the area for a size.
  void keep(Session& session, const Scene& scene, const FreeArea& area, const FirstCamera& first);

  /// All of the scene from where the session's camera looks now, or from a named view; it has to have one.
  void fit(Session& session, const Scene& scene, const FreeArea& area);
  void look_from(const std::string& view, Session& session, const Scene& scene, const FreeArea& area);

  /// Is there anything to fit?
  bool ready() const { return ready_; }
  /// The session's camera stays as it is, even if it was fitted.
  void hold() { fitted_.reset(); }
  /// Another scene is opened.
  void forget() { ready_ = false; }

 private:
  /// What a fit depends on, except the side from which the camera looks.
  struct Sight {
    int width = 0, height = 0;
    bool legend = false, orthographic = false;
    std::uint64_t seen = 0;
    bool operator==(const Sight&) const = default;
  };
  static Sight sight(const Session& session, const Scene& scene, const FreeArea& area);
  bool is_fitted(const Camera& camera) const;
  void take(const Session& session, const Sight& sight);

  std::optional<Camera> fitted_;  ///< as it was left
  Sight sight_;
  bool ready_ = false;
};

}  // namespace nacre
