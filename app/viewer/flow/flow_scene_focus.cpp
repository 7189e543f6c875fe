// Nacre: focus in the viewer: when it is asked for, and how it is laid over the texture of the whole surface.
#include <algorithm>
#include <cmath>
#include <utility>

#include "app/parameter_names.hpp"
#include "app/viewer/flow/flow_scene.hpp"
#include "engine/picture/colormap.hpp"

namespace nacre {
namespace {

constexpr double rest_seconds = 0.1;  ///< that a camera stands still before a focus is asked for
constexpr double fade_seconds = 0.25;
constexpr double most_pixels =
    1.3;  ///< times the pixel that a focus was made for: then it covers too little of the view
constexpr double moving_width = 1.4;  ///< of a focus for a camera that moves, times its view: it serves some frames
constexpr float former_steps = 4, focus_steps = 8;  ///< of the depth, that they are drawn nearer than the whole

}  // namespace

FlowScene::FocusTexture::FocusTexture(FlowFocused& told, Device& device)
    : part(std::move(told.part)),
      surface(told.geometry),
      values(device, (told.lookup.values + told.lookup.means) * sizeof(float), GL_R32F),
      number(told.number) {
  pass.set_texture(surface_texture(told.lookup, told.rimmed), texture_layout(told.lookup));
}

double FlowScene::FocusTexture::opacity(double now) const {
  return std::clamp((now - shown_at) / fade_seconds, 0.0, 1.0);
}

bool FlowScene::focused() const { return focus_ && focus_->opacity(now_) >= 1; }

bool FlowScene::focus_changes() const { return awaits_focus_ || next_focus_ || (focus_ && !focused()); }

/// In a window: asks for a focus once the camera rests. One that is there stays while the camera moves, for it belongs
/// to the surface.
void FlowScene::watch_view(double now) {
  now_ = now;
  if (focus_ && (former_focus_ || !focused())) ++version_;
  if (focused()) release(former_focus_);
  if (!sees(view_)) rests_since_ = now;
  if (now - rests_since_ >= rest_seconds) ask_focus(1);
  fill_focus();
}

/// In a replay each frame waits for a focus that serves it; for a camera that moves it is made wider than the view. It
/// is faded in where the camera has moved before.
void FlowScene::await_focus(const View& view) {
  static const std::atomic<bool> never{false};
  const std::atomic<bool>& stop = stop_ ? *stop_ : never;
  const bool first = !begun_looking_ && complete();
  now_ += 1.0 / settings_.fps;
  if (focused()) release(former_focus_);
  const bool rests = sees(view);
  begun_looking_ = begun_looking_ || complete();
  ask_focus(rests || first ? 1 : moving_width);
  while (!stop && failure_.empty()) {
    fill_focus();
    if (!awaits_focus_ && !next_focus_) break;
    if (std::optional<FlowEvent> event = worker_.wait(stop))
      take(*event);
    else if (!worker_.busy())
      break;
  }
  if (first && focus_) focus_->shown_at = now_ - fade_seconds;
}

/// The view of this frame: true if the camera has not moved since the one before. Where it goes back out, a focus goes
/// at once.
bool FlowScene::sees(const View& view) {
  const FlowView seen{view.camera, view.width, view.height};
  if (seen == seen_) return true;
  moved_since_ = looks_back_ && seen_.height > 0;
  seen_ = seen;
  looked_ = false;
  if (awaits_focus_) worker_.stop_focus();
  const FocusTexture* newest = next_focus_ ? next_focus_.get() : focus_.get();
  if (cells_are_fine() || (!lockstep_ && newest && pixel() > most_pixels * newest->pixel)) drop_focus();
  return false;
}

/// Edge of a pixel of the view, world units: with parallel rays exactly, else at the nearest corner of the box around
/// the surface, which is too small where nothing of that is in view.
double FlowScene::pixel() const {
  const Camera& camera = seen_.camera;
  double pixel = camera.height / std::max(1, seen_.height);
  if (!camera.orthographic) {
    const double distance = length(camera.target - camera.eye);
    double nearest = 1e300;
    for (int k = 0; k < 8; ++k) {
      const Vec3d corner(box_[k & 1].x, box_[k >> 1 & 1].y, box_[k >> 2].z);
      nearest = std::min(nearest, dot(corner - camera.eye, camera.forward()));
    }
    if (distance > 0) pixel *= std::max(nearest, 0.0) / distance;
  }
  return pixel;
}

bool FlowScene::cells_are_fine() const { return !shown_ || shown_->info.cell_size <= coarsest_cell * pixel(); }

/// Not while a step is being made, so that no step comes between the focus and its first values.
void FlowScene::ask_focus(double width) {
  if (looked_ || !settings_.focus || !complete() || seen_.height <= 0 || cells_are_fine()) return;
  if (moved_since_ && !settings_.view.play && !worker_.busy()) warm_up_behind();
  if (focus_changes() || looks_back_ || warming_ || newest_ < 0 || next_ || shown_->values.writing()) return;
  looked_ = awaits_focus_ = true;
  const FlowView wide = widened(seen_, width);
  worker_.focus(seen_, lockstep_ ? picture_budget(wide) : window_budget(seen_), width, ++focus_request_);
}

/// All of it goes, at once. What is on its way will not be shown.
void FlowScene::drop_focus() {
  looked_ = false;
  if (!awaits_focus_ && !next_focus_ && !focus_) return;
  awaits_focus_ = false;
  ++focus_request_;
  worker_.drop_focus();
  for (auto* texture : {&former_focus_, &focus_, &next_focus_}) release(*texture);
}

/// Memory that the worker still writes to is kept until it has.
void FlowScene::release(std::unique_ptr<FocusTexture>& texture) {
  if (!texture) return;
  ++version_;
  copied_ += texture->values.copied_bytes();
  if (texture->values.writing())
    leaving_focuses_.push_back(std::move(texture));
  else
    texture.reset();
}

void FlowScene::take(FlowFocused& told) {
  if (told.request != focus_request_ || !awaits_focus_) return;  // dropped since
  awaits_focus_ = false;
  warn_once(told.remark);
  if (!told.part) {
    if (told.ends_former) release(focus_);
    return;
  }
  try {
    told.geometry.closed = surface_.closed();  // then no back of the part is seen either
    next_focus_ = std::make_unique<FocusTexture>(told, worker_.device());
    next_focus_->pixel = pixel();
  } catch (const std::exception& error) {  // the graphics device cannot hold it
    warn_once("no close-up: " + with_knobs(error.what()));
    drop_focus();
    looked_ = true;
    return;
  }
  colour_focus();
}

void FlowScene::warn_once(const std::string& sentence) {
  if (sentence.empty() || std::find(warnings_.begin(), warnings_.end(), sentence) != warnings_.end()) return;
  warnings_.push_back(sentence);
}

void FlowScene::fill_focus() {
  if (!next_focus_ || next_focus_->values.writing()) return;
  if (void* memory = next_focus_->values.begin_write())
    worker_.fill_focus(static_cast<float*>(memory), next_focus_->number);
}

void FlowScene::take(FlowFocusFilled& told) {
  std::erase_if(leaving_focuses_,
                [&](const auto& texture) { return texture->number == told.number && !texture->in_step; });
  if (!next_focus_ || next_focus_->number != told.number) return;
  if (!told.written) {
    next_focus_->values.cancel_write();
    release(next_focus_);
    release(focus_);
    return;
  }
  next_focus_->values.end_write();
  next_focus_->shown_at = now_;
  release(former_focus_);
  former_focus_ = std::move(focus_);
  focus_ = std::move(next_focus_);
}

/// Memory for the next step of the focus; false: not yet.
bool FlowScene::lend_focus(bool wait, float*& memory, int& number) {
  if (awaits_focus_ || next_focus_) return false;
  if (!focus_) return true;
  memory = static_cast<float*>(focus_->values.begin_write(wait));
  number = focus_->number;
  focus_->in_step = memory != nullptr;
  return memory != nullptr;
}

/// The step that it was lent for is made, or will not be.
void FlowScene::return_focus(bool written) {
  std::erase_if(leaving_focuses_, [](const auto& texture) { return texture->in_step; });
  if (!lockstep_ || focused()) release(former_focus_);  // it is a step behind
  if (!focus_ || !focus_->in_step) return;
  focus_->in_step = false;
  if (written) return focus_->values.end_write();
  focus_->values.cancel_write();
  release(focus_);
}

/// As the whole is coloured.
void FlowScene::colour_focus() {
  const ShownColours& c = results_.colours;
  for (FocusTexture* texture : {former_focus_.get(), focus_.get(), next_focus_.get()}) {
    if (!texture) continue;
    texture->colours.set_map(colormap(settings_.colormap).table);
    if (scalar_.empty())
      texture->colours.clear_scalar();
    else
      texture->colours.set_scalar(texture->part->take(c.range.on_axis(scalar_)), c.range.bottom(), c.range.top());
    texture->colours.set_dyes(dyes_ ? texture->part->take(std::span<const DyeMix>(*dyes_)) : std::vector<DyeMix>());
    texture->colours.set_beyond(c.below, c.above, c.no_number);
  }
}

void FlowScene::draw_focus(const View& view) {
  for (FocusTexture* texture : {former_focus_.get(), focus_.get()}) {
    if (!texture) continue;
    const bool newest = texture == focus_.get();
    texture->colours.set_isolines(settings_.view.isolines);
    texture->pass.draw(view, texture->surface, texture->colours, &texture->values.texture(), settings_.back_faces,
                       {float(texture->opacity(now_)), newest ? focus_steps : former_steps});
    texture->values.drawn();
  }
}

}  // namespace nacre
