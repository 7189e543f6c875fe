// Nacre: the second scene of a comparison.
#include "app/viewer/window/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/viewer/scene/worker.hpp"
#include "compute/device/error.hpp"
#include "engine/scene/settings/knobs.hpp"

namespace nacre {
namespace {

/// The settings of the second scene, which begins at the time that the first one shows.
Settings begun_beside(const Scene& first, const Settings& of_first, Settings wanted) {
  const Transport at = first.transport();
  if (at.kind == Transport::Kind::time && at.shown >= 0 && wanted.flow.steps == of_first.flow.steps)
    wanted.begin_at = begin_at_of(at.shown, std::max(1, wanted.flow.steps));
  return wanted;
}

}  // namespace

std::array<FreeArea, 2> halves(const FreeArea& area) {
  constexpr int gap = 2;  // pixels
  const int width = std::max(1, (area.width - gap) / 2);
  return {FreeArea{area.x, area.y, width, area.height},
          FreeArea{area.x + area.width - width, area.y, width, area.height}};
}

int steps_ahead(const Transport& a, const Transport& b) {
  const bool alike = a.kind == Transport::Kind::time && b.kind == Transport::Kind::time && a.first == b.first &&
                     a.last == b.last && a.start == b.start && a.per_step == b.per_step;
  if (!alike || a.shown < 0 || b.shown < 0) return 0;
  const int apart = a.shown - b.shown;
  if (a.first > 0) return apart;  // time does not begin again
  const int round = a.last + 1, ahead = ((apart % round) + round) % round;
  return ahead > round / 2 ? ahead - round : ahead;
}

void Comparison::close() {
  open_.reset();
  painter_.reset();
  failure_.clear();
}

void Comparison::follow(const Session& first, const Scene& first_scene, const SceneOptions& options) {
  if (!compares(first)) return close();
  const Session wanted = compared_session(first);
  Session begun = wanted;
  begun.settings = begun_beside(first_scene, first.settings, wanted.settings);
  if (!on() || static_cast<const SessionInput&>(wanted) != session_) {
    OpenScene opened = open_scene(begun, options);
    close();
    open_ = std::move(opened);
    painter_.emplace();
  } else if (const ChangedKnobs changed = changed_knobs(session_, wanted); !changed.empty()) {
    scene().set_settings(begun.settings, changed);
  }
  session_ = wanted;
  headings_ = {nacre::first_heading(first), second_heading(first)};
}

void Comparison::advance(Scene& first, double now) {
  const auto ahead = [this, &first] { return on() ? steps_ahead(first.transport(), scene().transport()) : 0; };
  first.keep_together(ahead);
  scene().keep_together([ahead] { return -ahead(); });
  scene().advance(now);
}

std::string Comparison::take_failure() {
  if (!on() || scene().failure() == failure_) return {};
  failure_ = scene().failure();
  return failure_.empty() ? "" : "the second view: " + failure_;
}

/// A scene that knobs of its own have sent back catches up: at most once through all times.
void Comparison::advance_and_wait(Scene& first, const std::atomic<bool>& stop) {
  scene().advance_and_wait(stop, endless);
  const Transport at = first.transport();
  for (int step = at.first; step <= at.last && !stop && steps_ahead(at, scene().transport()) > 0; ++step)
    scene().advance_and_wait(stop, endless);
}

bool Comparison::settle_knobs(Session& first) {
  Session settled = session_;
  if (!scene().settle_knobs(settled)) return false;
  const std::optional<SessionEvent> change = session_change(session_, settled);
  if (!change) return false;
  std::map<std::string, std::string> differ = parse_compare_knobs(first.settings.view.compare_knobs);
  for (const auto& [name, text] : change->knobs)
    if (can_differ(name)) differ[name] = text;
  std::string text = compare_knobs_text(differ);
  return std::exchange(first.settings.view.compare_knobs, text) != text;
}

void Comparison::draw(const Framebuffer& frame, const Session& first, double turned, const FreeArea& area) {
  session_.camera = first.camera;
  painter_->draw(frame, scene(), session_, turned, area, headings_[1]);
}

}  // namespace nacre
