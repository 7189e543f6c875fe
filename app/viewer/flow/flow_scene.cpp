// Nacre: a flow as the viewer shows it.
#include "app/viewer/flow/flow_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/parameter_names.hpp"
#include "app/viewer/scene/captions.hpp"
#include "compute/device/error.hpp"
#include "engine/picture/colormap.hpp"

namespace nacre {
namespace {

constexpr double least_box = 14;  ///< pixels: boxes that are smaller on the screen would cover it
constexpr std::array<float, 4> box_colour{0.1f, 0.25f, 0.5f, 0.25f};

}  // namespace

SurfaceTexture FlowScene::surface_texture(const FlowLookup& l, const std::vector<std::uint32_t>& rimmed) {
  if (l.kind == FlowLookup::Kind::grid) return SparseTexture(sparse_lookup(l), rimmed);
  return OctreeTexture({l.levels, l.origin, l.cell_size, l.node, l.level_start, l.layer, l.child});
}

TextureLayout FlowScene::texture_layout(const FlowLookup& l) {
  return {l.means > 0 ? std::int64_t(l.values) : -1, l.sheet_shift};
}

FlowScene::Texture::Texture(const FlowEmbedded& told, Device& device)
    : info(told.info),
      boxes(told.boxes),
      number(told.number),
      values(device, (told.lookup.values + told.lookup.means) * sizeof(float), GL_R32F) {
  pass.set_texture(surface_texture(told.lookup, told.rimmed), texture_layout(told.lookup));
}

FlowScene::FlowScene(const Session& session, std::unique_ptr<Device> device, bool loop, bool low_priority)
    : worker_(session, std::move(device), loop, low_priority),
      settings_(session.settings),
      frames_of_(session.settings),
      loops_(loop),
      begun_at_(session.settings.begin_at) {
  colours_.set_map(colormap(settings_.colormap).table);
  arrow_pass_.set_map(colormap(settings_.colormap).table);
}

FlowScene::~FlowScene() {
  worker_.finish();  // nobody writes to the memory any more
  focus_.reset();
  next_focus_.reset();
  former_focus_.reset();
  leaving_focuses_.clear();
  kept_flows_.clear();
  lent_.reset();
  shown_.reset();
  next_.reset();
}

void FlowScene::set_settings(const Settings& settings, const ChangedKnobs& changed) {
  ++version_;
  const std::string colours_before = settings_.colormap;
  settings_ = settings;
  if (changed.has("colormap")) {
    try {
      const Colormap& map = colormap(settings.colormap);
      colours_.set_map(map.table);
      arrow_pass_.set_map(map.table);
    } catch (const Error& error) {
      warnings_.push_back(error.what());
      settings_.colormap = colours_before;
    }
  }
  if (changed.has_any(
          {"color_range", "color_symmetric", "color_scale", "color_below", "color_above", "color_nan", "colormap"})) {
    find_range();
    show_colours(std::vector<float>(scalar_));
  }
  const FlowRerun rerun = pass_on(settings, changed.has("begin_at"));
  if (!(rerun == FlowRerun())) failure_.clear();
  stale_ = !looks_back_ && (stale_ || rerun.has(FlowStage::step));
  if (rerun.has(FlowStage::start) || changed.has("focus")) drop_focus();
  colour_focus();
  ++overlay_version_;
}

SceneTotals FlowScene::totals() const {
  return {results_.steps, copied_bytes(), worker_.timers(), worker_.peak_bytes()};
}

void FlowScene::write_result(const std::filesystem::path& file, const std::string& origin) {
  begin_write(file, origin);
  static const std::atomic<bool> never{false};
  while (!written_)
    if (std::optional<FlowEvent> event = worker_.wait(never)) take(*event);
  if (const std::string why = *take_written(); !why.empty()) throw Error(why);
}

void FlowScene::begin_write(const std::filesystem::path& file, const std::string& origin) {
  written_.reset();
  worker_.write(file, origin);
}

bool FlowScene::settled() const { return complete() && !wants_step() && !worker_.busy() && !focus_changes(); }
std::string FlowScene::title() const { return name_.empty() ? "" : name_ + ": " + results_.data.array; }

std::string FlowScene::state() const {
  if (results_.data.array.empty()) return "";
  return fmt::format("time {}   step {}{}", time_text(results_.time), results_.steps,
                     worker_.cancelled() ? "   cancelled" : "");
}

/// Before the data are known, what was asked for counts.
bool FlowScene::has_legend() const {
  return settings_.legend && (results_.data.array.empty() ? settings_.color : results_.data.color) != "none";
}

std::optional<LegendRange> FlowScene::legend_range() const {
  if (!has_legend() || results_.data.array.empty()) return {};
  return LegendRange{results_.colours.range.low, results_.colours.range.high, results_.colours.scale.log};
}

FlowCaption FlowScene::caption() const {
  FlowCaption caption;
  if (has_legend() && !results_.data.array.empty()) caption.map = &colormap(settings_.colormap);
  caption.low = results_.colours.range.low;
  caption.high = results_.colours.range.high;
  caption.scale = results_.colours.scale;
  caption.title = results_.data.color == "speed" ? results_.data.array : results_.data.color;
  if (settings_.time_stamp && complete() && results_.data.time.high > results_.data.time.low)
    caption.time = results_.time;
  caption.frame_time = results_.span.frame_time;
  return caption;
}

/// The legend is kept, so that a step draws no more than the time.
Image FlowScene::overlay(int width, int height) {
  FlowCaption wanted = caption();
  if (!wanted.map && !wanted.time) return {};
  const std::optional<double> time = std::exchange(wanted.time, {});
  if (legend_.width != width || legend_.height != height || legend_version_ != overlay_version_) {
    legend_ = clear_sheet(width, height, paper_of(settings_.background));
    draw_caption(legend_, wanted);
    legend_version_ = overlay_version_;
  }
  Image sheet = legend_;
  wanted.map = nullptr;
  wanted.time = time;
  draw_caption(sheet, wanted);
  return sheet;
}

void FlowScene::advance(double now) {
  while (std::optional<FlowEvent> event = worker_.poll()) take(*event);
  ask_boxes();
  watch_view(now);
  if (!wants_step() || now - last_step_ < 1 / (settings_.fps * settings_.view.play_speed)) return;
  if (play_kept() || begin_step(false)) last_step_ = now;
}

bool FlowScene::advance_and_wait(const std::atomic<bool>& stop, double patience) {
  const std::uint64_t before = taken_;
  while (taken_ == before && !stop) {
    if (!failure_.empty()) throw Error(failure_);
    const bool boxes_come = ask_boxes();
    if (wants_step() && play_kept()) return true;
    if (worker_.ready() && !(wants_step() && begin_step(true)) && !boxes_come) return true;
    std::optional<FlowEvent> event = worker_.wait(stop, patience);
    if (event)
      take(*event);
    else if (!worker_.busy() && !worker_.ready())
      return true;  // cancelled
    else if (patience < endless)
      return false;
  }
  return true;
}

/// Where boxes are wanted, they are written once for an embedding. True while they are being computed.
bool FlowScene::ask_boxes() {
  Texture* const texture = written();
  if (!texture || !settings_.view.boxes || texture->boxes.count() == 0) return false;
  if (!texture->codes) {
    const std::size_t bytes = texture->boxes.count() * sizeof(std::uint64_t);
    texture->codes = std::make_unique<SharedBuffer>(worker_.device(), bytes, GL_RG32UI);
    worker_.show_boxes(static_cast<std::uint64_t*>(texture->codes->begin_write(true)), texture->number);
  }
  return texture->codes->writing();
}

bool FlowScene::begin_step(bool wait) {
  if (!no_texture_.empty()) return failure_ = no_texture_, false;  // what is shown has no room for the newest values
  Texture* const texture = written();
  if (!texture || texture->values.writing() || !worker_.ready()) return false;
  float* focus_memory = nullptr;
  int focus = 0;
  if (!lend_focus(wait, focus_memory, focus)) return false;
  void* memory = texture->values.begin_write(wait);
  if (!memory) {
    if (focus_memory) focus_->values.cancel_write(), focus_->in_step = false;
    return false;
  }
  lent_ = next_ ? next_ : shown_;
  worker_.step(static_cast<float*>(memory), focus_memory, focus);
  stale_ = false;
  return true;
}

void FlowScene::take(FlowEvent& event) {
  ++version_;
  std::visit([this](auto& told) { take(told); }, event);
}

void FlowScene::take(SurfaceRead& told) {
  surface_ = SurfaceBuffers(told.geometry);
  results_.corners = std::move(told.corners);
  ++surfaces_;
  name_ = std::move(told.name);
  results_.tree = std::move(told.tree);
  area_ = told.area;
  box_ = {Vec3d(1e300), Vec3d(-1e300)};
  for (const Vec3d& p : results_.corners) box_ = {min(box_[0], p), max(box_[1], p)};
  failure_.clear();
}

void FlowScene::take(FlowData& told) {
  if (told.reason.empty()) told.reason = results_.data.reason;
  results_.data = std::move(told);
  if (!complete() && results_.steps == 0) results_.time = results_.data.time.low;
  for (std::string& warning : results_.data.warnings) warnings_.push_back(std::move(warning));
  results_.data.warnings.clear();
  find_range();
  show_colours(results_.data.scalar);
  vectors_ = results_.data.vectors;
  move_arrows();
  if (const KeptFrame* kept = looked_back_at()) show_moment(kept->moment);  // which is of another time
  failure_.clear();
  ++overlay_version_;
}

/// By the knobs where these mean something, else the data's.
void FlowScene::find_range() {
  const Colormap& map = colormap(settings_.colormap);
  try {
    results_.colours = shown_colours(settings_, map, results_.data.colours);
  } catch (const Error& error) {
    Settings plain;
    plain.color_nan = settings_.color_nan;
    results_.colours = shown_colours(plain, map, results_.data.colours);
    warnings_.push_back(error.what());
  }
  const ShownColours& c = results_.colours;
  colours_.set_range(c.range.bottom(), c.range.top());
  colours_.set_beyond(c.below, c.above, c.no_number);
}

void FlowScene::show_colours(const std::vector<float>& scalar) {
  if (scalar.empty())
    colours_.clear_scalar();
  else
    colours_.set_scalar(results_.colours.range.on_axis(scalar), results_.colours.range.bottom(),
                        results_.colours.range.top());
  scalar_ = scalar;
  colour_focus();
}

void FlowScene::take(FlowArrows& told) {
  arrows_ = std::move(told);
  move_arrows();
}

void FlowScene::take(FlowLinesFound& told) {
  if (looks_back_) return;  // of another time; the frame has its own
  set_lines(std::move(told.lines));
  ++version_;
}

void FlowScene::set_lines(std::shared_ptr<const FlowLines> lines) {
  lines_pass_.set_lines(std::move(lines), surface_);
  results_.lines = lines_pass_.lines();
}

void FlowScene::take(FlowEmbedded& told) {
  drop_focus();
  failure_.clear();
  no_texture_.clear();
  next_.reset();
  try {
    next_ = std::make_shared<Texture>(told, worker_.device());
  } catch (const std::exception& error) {
    no_texture_ = with_knobs(error.what());
  }
}

void FlowScene::take(FlowBoxed& told) {
  for (Texture* texture : {shown_.get(), next_.get()})
    if (texture && texture->number == told.embedding) texture->codes->end_write(), texture->boxed = true;
}

void FlowScene::take(FlowStarted& told) {
  drop_focus();
  results_.span = told.span;
  skipped_ = told.skipped;
  newest_ = -1;
  if (!complete()) results_.time = told.span.start;
  results_.steps = 0;
  stale_ = !looks_back_;
  failure_.clear();
}

void FlowScene::take(FlowDyed& told) {
  if (!looks_back_) show_dyes(std::move(told.mixes));  // else the frame has its own
}

void FlowScene::show_dyes(std::shared_ptr<const std::vector<DyeMix>> mixes) {
  dyes_ = std::move(mixes);
  colours_.set_dyes(dyes_ ? std::span<const DyeMix>(*dyes_) : std::span<const DyeMix>());
  colour_focus();
}

void FlowScene::take(FlowStepped& told) {
  lent_->values.end_write();
  lent_.reset();
  return_focus(told.focus);
  if (next_) {
    if (shown_) copied_ += shown_->copied_bytes();
    const bool alike = shown_ && shown_->values.bytes() == next_->values.bytes();
    if (!looks_back_ || !alike) forget_frames();  // else they are of the same knobs, and so of the same cells
    shown_ = std::move(next_);
    results_.embedding = shown_->info;
  }
  results_.steps = told.number;
  ++taken_;
  results_.step_seconds.push_back(float(told.seconds));
  if (results_.step_seconds.size() > 240) results_.step_seconds.erase(results_.step_seconds.begin());
  newest_ = position_after(told.number);
  kept_.keep(newest_, shown_->values.shown(), told.moment);
  shown_->values.drawn();
  if (looks_back_) return;  // at another time; this one is at hand from now on
  position_ = newest_;
  warming_ = false;
  show_moment(told.moment);
}

/// Colours, arrows, lines and the stamp of a time, and the shape of a surface that moves.
void FlowScene::show_moment(const FlowMoment& moment) {
  if (moment.shape) {
    surface_ = SurfaceBuffers(moment.shape->geometry);
    results_.tree = std::shared_ptr<const TriangleTree>(moment.shape, &moment.shape->tree);
  }
  results_.time = moment.time;
  show_dyes(moment.dyes);
  show_colours(moment.scalar);
  vectors_ = moment.vectors;
  move_arrows();
  if (moment.lines != results_.lines || moment.shape) set_lines(moment.lines);
  if (settings_.time_stamp) ++time_version_;
}

void FlowScene::take(FlowInterrupted&) {
  if (lent_) lent_->values.cancel_write();
  lent_.reset();
  return_focus(false);
  stale_ = true;
}

void FlowScene::draw(const View& view) {
  view_ = view;
  if (!surface_) return;
  if (lockstep_) await_focus(view);
  const KeptFrame* const kept = looked_back_at();
  colours_.set_isolines(settings_.view.isolines);
  const BufferTexture* const values = kept ? &kept->texture : shown_ ? &shown_->values.texture() : nullptr;
  (shown_ ? shown_->pass : plain_pass_).draw(view, surface_, colours_, values, settings_.back_faces);
  if (!kept) draw_focus(view);
  if (settings_.view.edges) edge_pass_.draw(view, surface_, Placement(1.0), {0, 0, 0, 0.5f});
  if (settings_.view.arrows) draw_arrows(view);
  lines_pass_.draw(view, surface_.placement());
  if (settings_.view.boxes && shown_ && shown_->boxed) draw_boxes(view);
  if (shown_) shown_->values.drawn();
}

/// Those of the finest level whose boxes are large enough to be seen.
void FlowScene::draw_boxes(const View& view) const {
  const FlowBoxes& boxes = shown_->boxes;
  std::size_t level = boxes.level_start.size() - 2;
  double width = boxes.width;
  for (; level > 0 && width * view.height / view.camera.height < least_box; --level) width *= 2;
  const std::uint64_t first = boxes.level_start[level], last = boxes.level_start[level + 1];
  box_pass_.draw_codes(view, place_grid(boxes.origin, width), shown_->codes->shown(), first, last - first, 1,
                       box_colour);
  shown_->codes->drawn();
}

/// As far as the reference speed goes at length 1.
double FlowScene::arrow_spacing() const {
  return arrows_.positions.empty() ? 0 : std::sqrt(area_ / double(arrows_.positions.size()));
}

/// The vectors of the time that is shown, where arrows stand.
void FlowScene::move_arrows() {
  std::vector<Arrow> arrows;
  const double speed = std::max(results_.data.statistics.percentile_98, 1e-300), spacing = arrow_spacing();
  for (std::size_t k = 0; k < arrows_.positions.size() && vectors_ && results_.tree; ++k) {
    const SurfacePoint& position = arrows_.positions[k];
    // Places on other triangles: new ones are on their way.
    if (position.triangle >= results_.tree->triangles().size()) continue;
    const Triangle& t = results_.tree->triangles()[position.triangle];
    Vec3d point{};
    Vec3f vector{};
    if (std::max({t.a, t.b, t.c}) >= vectors_->size()) continue;
    for (int c = 0; c < 3; ++c) {
      point += results_.tree->points()[t[c]] * double(position.weights[c]);
      vector += (*vectors_)[t[c]] * position.weights[c];
    }
    const Vec3f normal = arrows_.normals[k], along = vector - normal * dot(vector, normal);
    const float share = float(length(along) / speed);
    arrows.push_back(
        {Vec3f((point - surface_.origin()) / surface_.size()), along * float(spacing / speed), normal, share});
  }
  arrow_pass_.set_arrows(arrows);
}

void FlowScene::draw_arrows(const View& view) {
  ArrowStyle style;
  style.scale = float(settings_.view.arrow_length);
  style.width = float(0.3 * arrow_spacing());
  style.mapped = results_.data.color == "none";  // dark where they would vanish in the surface's colours
  arrow_pass_.draw(view, surface_.placement(), style);
}

}  // namespace nacre
