// Nacre: what stands over a frame and belongs to the picture.
#include "app/viewer/scene/captions.hpp"

#include <fmt/format.h>

#include "app/viewer/scene/marks.hpp"
#include "engine/picture/legend.hpp"
#include "engine/picture/lettering.hpp"
#include "engine/picture/text.hpp"

namespace nacre {
namespace {

/// One line in the left upper corner, as far as it fits.
Image heading_sheet(int width, int height, const std::string& line, const Rgba& paper) {
  Image sheet = clear_sheet(width, height, paper);
  const float pixels = lettering_size(sheet);
  if (pixels <= 0) return {};
  const int margin = int(pixels);
  draw_lettering(sheet, margin, margin, text_to_fit(line, pixels, width - 2 * margin), pixels,
                 ink_for(sheet, 0, 0, width, 3 * margin));
  return sheet;
}

}  // namespace

Rgba paper_of(const std::string& background) {
  const bool colour = background.size() == 7 && background[0] == '#' &&
                      background.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!colour) return {255, 255, 255, 0};
  const int rgb = std::stoi(background.substr(1), nullptr, 16);
  return {std::uint8_t(rgb >> 16), std::uint8_t(rgb >> 8), std::uint8_t(rgb), 255};
}

void Captions::draw(Scene& scene, const View& view, const Settings& settings, const std::string& heading) {
  draw_scene(scene, view);
  if (settings.legend) draw_triad(view, settings.background);
  if (settings.legend && !heading.empty()) draw_heading(view, settings.background, heading);
  draw_marks(view, settings, scene.unit());
}

void Captions::draw_heading(const View& view, const std::string& background, const std::string& line) {
  const Headed wanted{view.width, view.height, line, background};
  if (headed_ != wanted) heading_.set_image(heading_sheet(view.width, view.height, line, paper_of(background)));
  headed_ = wanted;
  heading_.draw(view);
}

void Captions::draw_marks(const View& view, const Settings& settings, const std::string& unit) {
  const ViewSettings& knobs = settings.view;
  if (knobs.ruler.empty() && knobs.notes.empty()) return;
  const Marked wanted{view.width, view.height, view.camera, knobs.ruler, knobs.notes, unit, settings.background};
  if (marked_ != wanted)
    marks_.set_image(marks_sheet(view, knobs.ruler, knobs.notes, unit, paper_of(settings.background)));
  marked_ = wanted;
  marks_.draw(view);
}

void Captions::draw_scene(Scene& scene, const View& view) {
  const Made wanted{view.width, view.height, scene.overlay_version()};
  if (drawn_ != wanted) scene_.set_image(scene.overlay(view.width, view.height));
  drawn_ = wanted;
  scene_.draw(view);
}

void Captions::draw_triad(const View& view, const std::string& background) {
  const Vec3f forward(view.camera.forward()), right(view.camera.right()), up = cross(right, forward);
  Seen wanted{view.width, view.height, {}, background};
  for (int k = 0; k < 3; ++k) {
    const auto at = std::size_t(k);
    wanted.axes[at] = right[k], wanted.axes[3 + at] = up[k], wanted.axes[6 + at] = forward[k];
  }
  if (seen_ != wanted)
    triad_.set_image(orientation_sheet(view.width, view.height, paper_of(background), right, up, forward));
  seen_ = wanted;
  triad_.draw(view);
}

std::string window_title(const Scene& scene, bool filming) {
  const SceneProgress progress = scene.progress();
  std::string title = filming ? "film - " : "";
  if (!progress.stage.empty()) {
    title += progress.stage;
    if (progress.fraction >= 0) title += fmt::format(" {:.0f}%", 100 * progress.fraction);
    title += " - ";
  }
  if (!scene.title().empty()) title += scene.title() + " - ";
  return title + "Nacre";
}

}  // namespace nacre
