// Nacre: what stands over a frame and belongs to the picture: the scene's legend and stamp, the triad of axes.
#pragma once

#include <array>
#include <cstdint>

#include "app/viewer/scene/scene.hpp"
#include "engine/picture/compose.hpp"
#include "engine/render/overlay_pass.hpp"

namespace nacre {

class Captions {
 public:
  /// Draws into what is bound. Images are made and go up only where they differ from the last ones. `heading`: a line
  /// at the top, with the legend.
  void draw(Scene& scene, const View& view, const Settings& settings, const std::string& heading = {});
  /// Of another scene.
  void forget() { drawn_ = {}; }

 private:
  void draw_scene(Scene& scene, const View& view);
  void draw_marks(const View& view, const Settings& settings, const std::string& unit);
  void draw_triad(const View& view, const std::string& background);
  void draw_heading(const View& view, const std::string& background, const std::string& line);

  /// What an image was made for.
  struct Made {
    int width = 0, height = 0;
    std::uint64_t version = 0;
    bool operator==(const Made&) const = default;
  };
  struct Seen {
    int width = 0, height = 0;
    std::array<float, 9> axes{};
    std::string background;
    bool operator==(const Seen&) const = default;
  };
  struct Marked {
    int width = 0, height = 0;
    Camera camera;
    std::string ruler, notes, unit, background;
    bool operator==(const Marked&) const = default;
  };
  struct Headed {
    int width = 0, height = 0;
    std::string line, background;
    bool operator==(const Headed&) const = default;
  };
  OverlayPass scene_, triad_, marks_, heading_;
  Headed headed_;
  Marked marked_;
  Made drawn_;
  Seen seen_;
};

/// Progress and what is open, for the window's title, which is seen beside other windows: "relax 40% - head.nrrd -
/// Nacre", or with "film" before all that.
std::string window_title(const Scene& scene, bool filming);

/// The background behind a frame: `#rrggbb`; white without opacity for any other word, such as transparent.
Rgba paper_of(const std::string& background);

}  // namespace nacre
