// Nacre: the bar under the picture: time of a flow, iterations of a mesh; play, pause, step, scrub.
#pragma once

#include <optional>

#include "app/viewer/scene/free_area.hpp"
#include "app/viewer/scene/transport.hpp"
#include "engine/scene/session/session.hpp"

namespace nacre {

/// All that it does, it does through the session: knobs `play`, `loop`, `play_speed`, and `begin_at` of a flow or
/// `iteration` of a mesh. Each position is a value of the latter; it is written when time is paused, so that a session
/// holds what is seen.
class TransportBar {
 public:
  /// Pixels that it is high, with the lettering of now.
  static int height();

  /// With Dear ImGui, in `area` of the window.
  void draw(Session& session, const Transport& transport, const FreeArea& area);

  // Also for keys.

  void toggle_play(Session& session, const Transport& transport);
  /// Pauses, and goes so many positions on or back.
  void step(Session& session, const Transport& transport, int by);

  /// The user pulls it.
  bool scrubs() const { return scrubs_; }

 private:
  static void pause(Session& session, const Transport& transport);
  static void go_to(Session& session, const Transport& transport, int position);
  void rewind(Session& session, const Transport& transport);
  void buttons(Session& session, const Transport& transport);
  void track(Session& session, const Transport& transport);
  static void labels(const Session& session, const Transport& transport, bool narrow);
  static void speed(Session& session);

  bool scrubs_ = false, played_ = false;  ///< pulled now; it played when that began
  std::optional<int> next_;               ///< position to go to in the next frame, and play: after a pause of one frame
};

}  // namespace nacre
