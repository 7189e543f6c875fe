// Nacre: a flow as the viewer shows it.
#include "app/viewer/flow_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compute/device/error.hpp"
#include "engine/picture/colormap.hpp"

namespace nacre {

FlowScene::FlowScene(const Session& session, std::unique_ptr<Device> device, bool loop)
    : worker_(session, std::move(device), loop), settings_(session.settings) {
  colours_.set_map(colormap(settings_.colormap).table);
}

FlowScene::~FlowScene() {
  worker_.finish();  // nobody writes to the memory any more
  shown_.reset();
}

void FlowScene::set_settings(const Settings& settings) {
  if (settings.colormap != settings_.colormap) colours_.set_map(colormap(settings.colormap).table);
  settings_ = settings;
  worker_.set_parameters(settings.flow);
}

void FlowScene::cancel() {}
void FlowScene::resume() {}
Image FlowScene::overlay(int, int) { return {}; }
void FlowScene::result_panel(Session&) {}
std::optional<Probed> FlowScene::probe(const Vec3d&, const Vec3d&) { return {}; }
void FlowScene::write_result(const std::filesystem::path&) {}

std::string FlowScene::title() const { return name_.empty() ? "" : name_ + ": " + array_; }
std::string FlowScene::state() const { return fmt::format("time {:.4g}   step {}", time_, steps_); }

void FlowScene::advance(double now) {
  while (std::optional<FlowEvent> event = worker_.poll()) take(*event);
  if (settings_.look.play && now - last_step_ >= 1.0 / settings_.fps && begin_step(false)) last_step_ = now;
}

void FlowScene::advance_and_wait(const std::atomic<bool>& stop) {
  for (int before = steps_; steps_ <= before && !stop; before = std::min(before, steps_)) {  // 0 after an embedding
    if (!failure_.empty()) throw Error(failure_);
    if (worker_.ready()) begin_step(true);
    std::optional<FlowEvent> event = worker_.wait(stop);
    if (event) take(*event);
  }
}

bool FlowScene::begin_step(bool wait) {
  if (!shown_ || shown_->writing() || !worker_.ready()) return false;
  void* memory = shown_->begin_write(wait);
  if (memory) worker_.step(static_cast<float*>(memory));
  return memory != nullptr;
}

void FlowScene::take(FlowEvent& event) {
  std::visit([this](auto& told) { take(told); }, event);
}

void FlowScene::take(SurfaceRead& told) {
  surface_ = SurfaceBuffers(told.geometry);
  corners_ = std::move(told.corners);
  name_ = std::move(told.name);
  array_ = std::move(told.array);
  warnings_ = std::move(told.warnings);
  low_ = told.low;
  high_ = told.high;
  if (!told.scalar.empty()) colours_.set_scalar(told.scalar, low_, high_);
}

void FlowScene::take(FlowEmbedded& told) {
  if (shown_) copied_ += shown_->copied_bytes();
  shown_.reset();
  steps_ = 0;
  surface_pass_.set_texture(SparseTexture(sparse_lookup(told.lookup), told.rimmed));
  shown_ = std::make_unique<SharedBuffer>(worker_.device(), told.info.surface_cells * sizeof(float), GL_R32F);
  info_ = told.info;
  failure_.clear();
}

void FlowScene::take(FlowStarted&) {
  if (shown_) shown_->cancel_write();  // of a step that was interrupted for this
  failure_.clear();
}

void FlowScene::take(FlowStepped& told) {
  shown_->end_write();
  time_ = told.time;
  ++steps_;
  if (!told.scalar.empty()) colours_.set_scalar(told.scalar, low_, high_);
}

void FlowScene::take(FlowFailed& told) {
  if (shown_) shown_->cancel_write();
  failure_ = std::move(told.what);
}

void FlowScene::draw(const View& view) {
  if (!surface_) return;
  surface_pass_.draw(view, surface_, colours_, complete() ? &shown_->texture() : nullptr);
  if (settings_.look.edges) edge_pass_.draw(view, surface_, Placement(1.0), {0, 0, 0, 0.5f});
  if (shown_) shown_->drawn();
}

std::unique_ptr<Scene> make_flow_scene(const Session& session, const SceneOptions& options) {
  return std::make_unique<FlowScene>(session, options.open_device(), options.loop);
}

}  // namespace nacre
