// Nacre: the stages of the flow's worker, each on its thread.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "app/parameter_names.hpp"
#include "app/viewer/flow/flow_worker.hpp"
#include "compute/device/error.hpp"
#include "engine/io/flow_values.hpp"
#include "engine/io/reader.hpp"
#include "engine/run/flow_maps.hpp"
#include "engine/run/focus.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/surface/flow_input.hpp"

namespace nacre {
namespace {

/// A flow that loops is one that is this many times as long: a power of two, so that the times of its steps are the
/// very numbers of a flow that ends.
int rounds(int steps, bool loop) {
  int n = 1;
  while (loop && n < 1 << 16 && steps > 0 && steps < (1 << 29) / n) n *= 2;
  return n;
}

SurfaceRead describe(const VectorsInTime& vectors) {
  const PreparedSurface& surface = vectors.surface();
  SurfaceRead told;
  told.name = vectors.series().name;
  told.geometry =
      make_surface_geometry(surface.points, surface.triangles, surface.corner_normals, surface.second_sheet);
  if (vectors.moves())
    told.corners = corners_of_all_steps(vectors);
  else
    for (const SurfaceVertex& v : told.geometry.vertices) told.corners.push_back(surface.points[v.point]);
  told.tree = std::make_shared<TriangleTree>(surface.points, surface.triangles);
  told.area = surface_area(surface.points, surface.triangles);
  return told;
}

FlowOffer offer_of(const Surface& surface) {
  FlowOffer offer;
  for (const PointArray& array : surface.arrays) {
    offer.arrays.push_back(array.name);
    if (array.components == 3) offer.vectors.push_back(array.name);
  }
  return offer;
}

}  // namespace

void FlowWorker::read() {
  lines_.reset();
  tracks_.reset();
  std::string reason;
  std::vector<std::string> warnings;
  bool told_surface = false;
  {
    StageTimers::Scope scope(pipeline_->timers(), "read");
    if (read_patch_ != settings_.patch) vectors_.reset();  // another surface
    read_patch_ = settings_.patch;
    if (vectors_) {
      MotionChoice motion = vectors_->motion();
      motion.crease_degrees = settings_.crease_angle;
      if (vectors_->moves()) vectors_->set_motion(motion);
      vectors_->set_surface(prepare(vectors_->series().load(0), settings_.crease_angle));
    } else {
      SurfaceSeries series = input_.sample.empty() ? open_surface(input_.inputs, settings_.patch)
                                                   : make_sample(input_.sample, input_.detail);
      FlowLog log;
      log.warn = [&](const std::string& sentence) { warnings.push_back(sentence); };
      log.chosen = [&](const VectorChoice& choice) { reason = choice.reason; };
      log.read = [&](const Surface& first) { tell(offer_of(first)); };
      const Range all{series.times.front(), series.times.back()};
      log.first_step = [&](VectorsInTime& first) {  // something to see, before all steps are read
        tell(describe(first));
        told_surface = true;
        shown_time_ = first.start();
        tell_data(first, all, reason, {});
      };
      vectors_ = std::make_unique<VectorsInTime>(make_flow_input(std::move(series), settings_, log, &interrupt_));
      shown_time_ = vectors_->start();
    }
    if (!told_surface || vectors_->moves()) tell(describe(*vectors_));
  }
  tell_data(reason, std::move(warnings));
}

/// Vectors and colours, whichever have changed.
void FlowWorker::choose() {
  if (doing_ == FlowStage::vectors) lines_.reset(), tracks_.reset();
  std::string reason;
  std::vector<std::string> warnings;
  {
    StageTimers::Scope scope(pipeline_->timers(), "read");
    if (doing_ == FlowStage::vectors) {
      const Surface first = vectors_->series().load(0);
      const VectorChoice choice = choose_vectors(first, settings_.vectors);
      FlowLog log;
      log.warn = [&](const std::string& sentence) { warnings.push_back(sentence); };
      const MotionChoice motion = choose_motion(vectors_->series(), first, choice.name, settings_, log);
      vectors_->set_vectors(choice.name);
      if (!(motion == vectors_->motion())) vectors_->set_motion(motion);
      reason = choice.reason;
      warn_of_vectors(*vectors_, settings_, log);
    } else {
      choose_colours();
    }
  }
  tell_data(reason, std::move(warnings));
}

void FlowWorker::tell_data(std::string reason, std::vector<std::string> warnings) {
  tell_data(*vectors_, {vectors_->start(), vectors_->end()}, std::move(reason), std::move(warnings));
}

void FlowWorker::tell_data(VectorsInTime& vectors, const Range& time, std::string reason,
                           std::vector<std::string> warnings) {
  FlowData told;
  told.array = vectors.array();
  told.color = vectors.color();
  told.reason = std::move(reason);
  told.statistics = vectors.statistics();
  told.time = time;
  told.times = vectors.series().times;
  told.colours = vectors.color_spread();
  told.scalar = scalar(vectors, shown_time_);
  told.vectors = vectors_at(vectors, shown_time_);
  told.warnings = std::move(warnings);
  tell(std::move(told));
}

/// Those of the knob `color`. What does not work leaves all as it was.
void FlowWorker::choose_colours() {
  if (!is_ftle(settings_.color) || vectors_->series().load(0).find(settings_.color))  // an array may have that name
    return vectors_->set_color(settings_.color);
  StageTimers::Scope scope(pipeline_->timers(), "flow_map");
  const FlowSpan span = flow_span(settings_, {vectors_->start(), vectors_->end()});
  SurfaceFlowMap map = surface_flow_map(*vectors_, span, settings_.ftle_time, &interrupt_);
  vectors_->set_color("none");
  vectors_->show_scalar(settings_.color, std::move(map.ftle));
}

/// What the knobs want of them. Those of a steady flow are kept.
std::shared_ptr<const FlowLines> FlowWorker::lines_at(double time) {
  if (!has_lines(settings_)) return nullptr;
  const bool steady = vectors_->series().times.size() == 1;
  if (lines_ && steady) return lines_;
  StageTimers::Scope scope(pipeline_->timers(), "topology");
  auto found = std::make_shared<FlowLines>();
  found->time = time;
  if (settings_.tracks && !steady) {
    const FlowSpan span = flow_span(settings_, {vectors_->start(), vectors_->end()});
    if (!tracks_)
      tracks_ = std::make_shared<const FlowTracks>(
          flow_tracks(*vectors_, {span.first, span.end}, settings_.persistence, &interrupt_));
    found->tracks = tracks_;
  }
  if (settings_.topology) found->skeleton = flow_skeleton(*vectors_, time, settings_.persistence);
  if (settings_.streamlines)
    found->streamlines = flow_streamlines(*vectors_, time, settings_.line_spacing, &interrupt_);
  found->skeleton.shape = found->streamlines.shape = {};
  lines_ = found;
  return found;
}

void FlowWorker::find_lines() {
  lines_.reset();
  tracks_.reset();
  tell(FlowLinesFound{lines_at(shown_time_)});
}

void FlowWorker::find_probes() {
  StageTimers::Scope scope(pipeline_->timers(), "probes");
  tell(FlowProbed{flow_probes(*vectors_, settings_.probe, &interrupt_)});
}

FlowMoment FlowWorker::moment_at(double time) {
  return {time, scalar(*vectors_, time), vectors_at(*vectors_, time), moved_surface(time), lines_at(time), dye_mixes()};
}

void FlowWorker::place_arrows() {
  FlowArrows told;
  const PreparedSurface& surface = vectors_->surface();
  if (settings_.view.arrows)
    told.positions = spread_points(surface.points, surface.triangles, settings_.view.arrow_count, settings_.flow.seed);
  for (const SurfacePoint& position : told.positions) {
    Vec3f normal{};
    for (int k = 0; k < 3; ++k)
      normal += surface.corner_normals[3 * position.triangle + std::size_t(k)] * position.weights[k];
    told.normals.push_back(normalized(normal));
  }
  tell(std::move(told));
}

/// As the knobs say, with the resolution that there is.
FlowParameters FlowWorker::parameters() const {
  FlowParameters parameters = settings_.flow;
  parameters.resolution = resolution_;
  return parameters;
}

void FlowWorker::embed() {
  has_values_ = false;
  focus_.reset();
  ++embeddings_;
  const PreparedSurface& surface = vectors_->surface();
  const FlowView view{fit_camera("iso", triangle_corners(surface), settings_.width, settings_.height), settings_.width,
                      settings_.height};
  resolution_ = picture_resolution(view, surface, settings_.flow, device_->available_bytes());
  pipeline_->parameters = parameters();
  const auto warn = [this](const std::string& sentence) { tell_data("", {sentence}); };
  motion_ = std::make_unique<FlowMotion>(*pipeline_, *vectors_, warn, [this](double t) { return wrapped(t); });
  span_ = {};
  motion_->embed(vectors_->moves() ? flow_span(settings_, {vectors_->start(), vectors_->end()}).start : 0);
  take_timers(*pipeline_);
  check_device();
  tell_embedded();
}

void FlowWorker::tell_embedded() {
  const FlowMethod& flow = pipeline_->flow();
  FlowEmbedded told{flow.lookup(), {}, flow.embedding(), flow.boxes(), embeddings_};
  means_ = told.lookup.means > 0 ? told.lookup.values : 0;
  if (told.lookup.kind == FlowLookup::Kind::grid) told.rimmed = with_rims(sparse_lookup(told.lookup));
  tell(std::move(told));
}

/// Of a flow that comes round, when it has done so as often as it can.
double FlowWorker::flow_end() const {
  return loop_ ? span_.start + (span_.end - span_.first) * rounds(settings_.flow.steps, loop_) : span_.end;
}

void FlowWorker::start() {
  has_values_ = false;
  focus_.reset();
  span_ = flow_span(settings_, {vectors_->start(), vectors_->end()});
  const int n = rounds(settings_.flow.steps, loop_);
  FlowVectors vectors = flow_vectors(*vectors_, span_.start, flow_end());
  vectors.at = [this](double t, std::span<Vec3f> out) { vectors_->material_vectors(wrapped(t), out); };
  steps_in_all_ = loop_ ? settings_.flow.steps * n : span_.steps;
  pipeline_->parameters = parameters();
  pipeline_->parameters.steps = steps_in_all_;
  const double first = wrapped(span_.start + span_.frame_time);  // of the first frame
  tell(FlowMoment{first, scalar(*vectors_, first), vectors_at(*vectors_, first), nullptr, nullptr, nullptr});
  if (motion_->start(vectors)) {
    ++embeddings_;
    tell_embedded();
  }
  has_values_ = true;
  steps_made_ = 0;
  shown_time_ = wrapped(span_.start);
  dyes_.reset();
  {
    std::scoped_lock lock(mutex_);
    if (!wanted_.dye.empty()) due_.add(FlowStage::dyes);
    started_ = !due_.has(FlowStage::embed) && !due_.has(FlowStage::start) && !due_.has(FlowStage::surface) &&
               !due_.has(FlowStage::vectors);
  }
  tell(FlowStarted{span_, std::max(0, settings_.flow.steps - span_.steps)});
}

/// Dyes by the knobs from now on; those that are on the surface stay.
void FlowWorker::change_dyes() {
  StageTimers::Scope scope(pipeline_->timers(), "dye");
  if (settings_.dye.empty()) {
    dyes_.reset();
  } else if (dyes_) {
    dyes_->set(settings_);
  } else {
    const double step = steady_dye_step(*vectors_, settings_, pipeline_->flow().embedding().cell_size);
    dyes_ = std::make_unique<DyeRun>(*vectors_, settings_, shown_time_, step, &interrupt_);
  }
  tell(FlowDyed{dye_mixes()});
}

std::shared_ptr<const std::vector<DyeMix>> FlowWorker::dye_mixes() const {
  return dyes_ ? std::make_shared<const std::vector<DyeMix>>(dyes_->mixes()) : nullptr;
}

/// To the time that is shown. What does not work ends the dyes and nothing else.
void FlowWorker::carry_dyes() {
  if (!dyes_) return;
  StageTimers::Scope scope(pipeline_->timers(), "dye");
  if (shown_time_ < dyes_->time()) dyes_->come_round(std::max(span_.first, shown_time_ - span_.frame_time));
  try {
    dyes_->go_to(shown_time_);
  } catch (const Error& error) {
    dyes_.reset();
    tell(FlowFailed{with_knobs(error.what())});
  }
}

void FlowWorker::make_step() {
  const auto before = std::chrono::steady_clock::now();
  pipeline_->parameters = parameters();
  pipeline_->parameters.steps = steps_in_all_;
  if (motion_->follow()) {  // there are other values from now on: they need other memory
    ++embeddings_;
    tell_embedded();
    place_arrows();
    return tell(FlowInterrupted{});
  }
  pipeline_->flow().show_into(memory_, memory_ && means_ ? memory_ + means_ : nullptr);
  pipeline_->flow().step();
  motion_->show();
  FlowStepped told;
  ++steps_made_;
  told.focus = focus_memory_.first && step_focus(focus_memory_.first, focus_memory_.second);
  told.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  told.number = steps_made_;
  shown_time_ = wrapped(pipeline_->flow().time());
  carry_dyes();
  told.moment = moment_at(shown_time_);
  take_timers(*pipeline_);
  check_device();
  tell(std::move(told));
}

std::shared_ptr<const MovedSurface> FlowWorker::moved_surface(double time) {
  if (!vectors_->moves()) return nullptr;
  const PreparedSurface shape = vectors_->shape(time);
  auto moved = std::make_shared<MovedSurface>();
  moved->geometry = make_surface_geometry(shape.points, shape.triangles, shape.corner_normals);
  set_embedded(moved->geometry, vectors_->surface().points);
  moved->tree = TriangleTree(shape.points, shape.triangles);
  return moved;
}

void FlowWorker::answer_sample(const Vec3d& position) {
  if (has_values_) tell(FlowSampled{position, pipeline_->flow().sample_shown({&position, 1}).front()});
}

void FlowWorker::write_boxes(std::uint64_t* memory, int embedding) {
  if (embedding != embeddings_) return;
  pipeline_->flow().show_boxes(memory);
  tell(FlowBoxed{embedding});
}

void FlowWorker::write_values(const ResultFile& wanted) {
  if (!has_values_) throw Error("there is no flow to write yet", "", "wait for the texture");
  StageTimers::Scope scope(pipeline_->timers(), "write");
  write_flow_values(pipeline_->flow().values(), wanted.file, wrapped(pipeline_->flow().time()), wanted.origin);
}

double FlowWorker::wrapped(double time) const {
  const double period = span_.end - span_.first;
  if (!loop_ || !(period > 0)) return time;
  const double since = std::fmod(time - span_.first, period);
  if (!settings_.view.loop && time - span_.first > 0.5 * period &&
      (since < 1e-9 * period || since > (1 - 1e-9) * period))
    return span_.end;  // where it stops
  return since > (1 - 1e-9) * period ? span_.first : span_.first + since;
}

std::vector<float> FlowWorker::scalar(VectorsInTime& vectors, double time) {
  return vectors.colored() ? vectors.scalar(time) : std::vector<float>();
}

std::shared_ptr<const std::vector<Vec3f>> FlowWorker::vectors_at(VectorsInTime& vectors, double time) {
  auto values = std::make_shared<std::vector<Vec3f>>(vectors.surface().points.size());
  vectors.vectors(time, *values);
  return values;
}

}  // namespace nacre
