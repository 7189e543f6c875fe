// Nacre: what is drawn over a frame: timings, what goes on, knobs. Dear ImGui is used in this folder only.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "app/viewer/scene.hpp"
#include "engine/gl/window.hpp"

namespace nacre {

/// The last frames' times.
class FrameClock {
 public:
  void add(double seconds);
  double mean_seconds() const;                  ///< of those kept; 0: none
  std::array<float, 120> milliseconds() const;  ///< oldest first

 private:
  std::array<float, 120> kept_{};
  std::size_t next_ = 0, count_ = 0;
};

/// What the panels remember and no session does.
struct PanelState {
  bool help = false;
};

/// Dear ImGui, in a window or without one.
class Interface {
 public:
  explicit Interface(Window* window);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// Between these two, panels are made and the mouse can be asked for. `seconds`: since the last frame.
  void begin(int width, int height, double seconds);
  void end();

 private:
  Window* window_;
};

/// Timings, the state of the scene and the knobs of the session, which it changes; `renderer`: who draws.
void draw_panel(PanelState& state, Session& session, Scene& scene, const FrameClock& clock,
                const std::string& renderer);

}  // namespace nacre
