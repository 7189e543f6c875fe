// Nacre: a flow run of the library, frame by frame.
#include "include/nacre/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <mutex>
#include <set>

#include "api/arrays_read.hpp"
#include "api/shared_run.hpp"
#include "api/support.hpp"
#include "engine/picture/png.hpp"
#include "engine/run/among_ranks.hpp"
#include "engine/run/flow_painter.hpp"
#include "engine/run/flow_report.hpp"
#include "engine/run/focus.hpp"
#include "engine/run/picture_settings.hpp"
#include "engine/run/report.hpp"
#include "engine/run/write_values.hpp"
#include "engine/scene/settings/ranges.hpp"
#include "engine/scene/surface/flow_input.hpp"
#include "engine/scene/surface/flow_motion.hpp"

namespace nacre {
namespace {

Vec3d vec(const std::array<double, 3>& p) { return {p[0], p[1], p[2]}; }

void check_surface(const SurfaceFlow& surface) {
  if (surface.points.empty()) throw Error("the surface has no points");
  if (surface.triangles.empty()) throw Error("the surface has no triangles");
  if (surface.times.empty()) throw Error("the flow has no times");
  for (std::size_t k = 0; k < surface.times.size(); ++k) {
    if (!std::isfinite(surface.times[k])) throw Error(fmt::format("time {} is not finite", k));
    if (k > 0 && !(surface.times[k] > surface.times[k - 1]))
      throw Error("the times do not ascend", fmt::format("time {} is not after the one before", k));
  }
}

/// With `geometry`, points, triangles and all arrays; else only what differs between the steps of a surface that stands
/// still.
Surface step_of(const SurfaceFlow& flow, std::size_t step, bool geometry, const std::string& color, ArraysRead& read) {
  Surface surface;
  if (geometry) {
    std::vector<std::array<double, 3>> moved;
    if (flow.positions) {
      moved = flow.points;
      flow.positions(step, {moved.front().data(), 3 * moved.size()});
      read.add("positions", step, moved.data(), moved.size() * sizeof(moved[0]));
    }
    surface.points.reserve(flow.points.size());
    for (const auto& p : flow.positions ? moved : flow.points) surface.points.push_back(vec(p));
    surface.triangles.reserve(flow.triangles.size());
    for (const auto& t : flow.triangles) surface.triangles.push_back({t[0], t[1], t[2]});
  }
  const std::size_t n = flow.points.size();
  if (flow.vectors) {
    PointArray& array = surface.arrays.emplace_back(PointArray{flow.vector_name, 3, std::vector<float>(3 * n)});
    flow.vectors(step, array.values);
    read.add("vectors", step, array.values.data(), array.values.size() * sizeof(float));
  }
  for (const std::string& name : flow.scalar_names) {
    if (!geometry && name != color) continue;
    PointArray& array = surface.arrays.emplace_back(PointArray{name, 1, std::vector<float>(n)});
    flow.scalars(name, step, array.values);
    if (name == color) read.add("scalars " + name, step, array.values.data(), array.values.size() * sizeof(float));
  }
  return surface;
}

/// Knobs for which the texture is made again, and those of them for which the embedding is, too.
const std::set<std::string> embedding_knobs{"method", "octree",   "neighbour_index", "resolution",
                                            "refine", "subcells", "radius",          "texture"};
const std::set<std::string> start_knobs{"ttl", "warmup", "seed", "pattern_spacing", "pattern_stretch"};

}  // namespace

struct Flow::State {
  RunOptions options;
  std::unique_ptr<RanksOfCaller> ranks;  ///< null: this process is alone
  Session session;
  std::unique_ptr<Device> device;
  std::unique_ptr<FlowPipeline> pipeline;
  std::unique_ptr<VectorsInTime> input;
  std::unique_ptr<FlowMotion> motion;
  FlowSpan span;
  FlowVectors vectors;
  std::vector<double> seconds;
  int done = 0;   ///< frames made
  int begun = 0;  ///< the frame with which the present texture began
  bool embedded = false, started = false;
  int resolution = 0;  ///< of the embedding
  std::string color;   ///< whose numbers a step has to load
  ArraysRead arrays;
  mutable std::mutex mutex;

  Settings& settings() { return session.settings; }

  void open(SurfaceFlow surface) {
    check_surface(surface);
    StageTimers::Scope scope(pipeline->timers(), "read");
    SurfaceSeries series;
    series.name = surface.name;
    series.times = surface.times;
    series.moves = bool(surface.positions);
    if (!surface.positions)
      arrays.add("points", 0, surface.points.data(), surface.points.size() * sizeof(surface.points[0]));
    arrays.add("triangles", 0, surface.triangles.data(), surface.triangles.size() * sizeof(surface.triangles[0]));
    arrays.add("times", 0, surface.times.data(), surface.times.size() * sizeof(double));
    const auto shared = std::make_shared<SurfaceFlow>(std::move(surface));
    const auto first = std::make_shared<bool>(true);
    series.load = [this, shared, first](std::size_t step) {
      const Surface loaded = step_of(*shared, step, *first || shared->positions, color, arrays);
      *first = false;
      return loaded;
    };
    FlowLog log;
    log.warn = [this](const std::string& sentence) { tell(options, sentence); };
    log.note = [](const std::string&) {};  // the report has what was decided
    log.chosen = [](const VectorChoice&) {};
    color = settings().color;
    input = std::make_unique<VectorsInTime>(make_flow_input(std::move(series), settings(), log, options.stop));
    span = flow_span(settings(), {input->start(), input->end()});
    if (ranks && input->moves()) throw Error("a surface that moves needs one process");
    if (ranks) require_same_input(*ranks, *input, span.start, knob_values(settings()).dump());
    motion = std::make_unique<FlowMotion>(*pipeline, *input, log.warn);
  }

  void announce(const char* name, double fraction) {
    check_stop(options.stop);
    if (options.progress) options.progress({name, fraction, 0, 0, 0});
  }

  double time_of(int frame) const {
    return span.start + (span.end - span.start) * (double(frame) / std::max(1, span.steps));
  }

  /// Embeds the surface and starts the flow where that has not been done with the knobs as they are.
  void prepare() {
    pipeline->parameters = settings().flow;
    pipeline->parameters.resolution = resolution;
    pipeline->parameters.steps = std::max(1, span.steps - begun);
    if (!embedded) {
      announce("embed", 0);
      started = false;
      const PreparedSurface& surface = input->surface();
      const FlowView view{fit_camera("iso", triangle_corners(surface), settings().width, settings().height),
                          settings().width, settings().height};
      resolution =
          picture_resolution(view, surface, settings().flow, first_ones(ranks.get(), device->available_bytes()));
      pipeline->parameters.resolution = resolution;
      motion->embed(time_of(done));
      embedded = true;
    }
    if (!started) {
      announce("warm-up", 0.02);
      begun = done;
      vectors = flow_vectors(*input, time_of(begun), span.end);
      pipeline->parameters.steps = span.steps - begun;
      motion->start(vectors);
      started = true;
    }
  }

  bool step() {
    if (done >= span.steps) return false;
    prepare();
    const auto before = std::chrono::steady_clock::now();
    motion->follow();
    pipeline->flow().step();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count());
    motion->show();
    ++done;
    announce("step", double(done) / span.steps);
    return true;
  }

  FlowPicture picture(const PictureOptions& asked) {
    prepare();
    Session view = session;
    if (asked.width) apply_knobs(view.settings, {{"width", std::int64_t(*asked.width)}}, Job::flow);
    if (asked.height) apply_knobs(view.settings, {{"height", std::int64_t(*asked.height)}}, Job::flow);
    if (asked.view) view.settings.camera = *asked.view;
    if (asked.camera) {
      const CameraView& c = *asked.camera;
      const Vec3d eye = vec(c.eye), target = vec(c.target), up = vec(c.up);
      if (!(length(target - eye) > 0) || !(length(up) > 0) || !(c.height > 0) || !is_finite(eye) ||
          !is_finite(target) || !is_finite(up) || !std::isfinite(c.height))
        throw Error("this is not a camera", "eye and target must differ, up must not be zero, height must be positive");
      view.camera = Camera{eye, target, up, c.height, c.orthographic};
    }
    check_picture_settings(view.settings);
    Image image = FlowPainter(*pipeline, *input, view, span.frame_time).paint(std::max(0, done - 1));
    if (ranks) share(image);
    return {image.width, image.height, std::move(image.pixels), origin(view, "image")};
  }

  /// Gives all processes the picture of the first.
  void share(Image& image) const {
    const auto* from = reinterpret_cast<const std::byte*>(image.pixels.data());
    std::vector<std::byte> bytes(from, from + image.pixels.size());
    broadcast(*ranks, bytes);
    std::memcpy(image.pixels.data(), bytes.data(), bytes.size());
  }

  std::string origin(const Session& of, const std::string& output) const {
    return library_origin(of, "flow", device->backend(), arrays, output, {"frame=" + std::to_string(done)});
  }
};

Flow::Flow(SurfaceFlow surface, const KnobValues& knobs, RunOptions options) : state_(std::make_unique<State>()) {
  library_call([&] {
    State& s = *state_;
    s.options = std::move(options);
    apply_knobs(s.settings(), knobs, Job::flow);
    if (!surface.vectors) {
      if (surface.vector_name.empty() || surface.vector_name[0] != '@')
        throw Error("the flow has no vectors", "", "give them, or name an analytic field: @swirl or @rotation");
    }
    s.settings().vectors = surface.vector_name;
    check_picture_settings(s.settings());
    colormap(s.settings().colormap);
    check_color_range(s.settings());
    s.device = open_library_device(s.options);
    const Caller caller(s.mutex, s.options.threads);
    if (s.options.processes) s.ranks = std::make_unique<RanksOfCaller>(*s.options.processes);
    s.pipeline = make_flow_pipeline(*s.device);
    s.pipeline->ranks = s.ranks.get();
    s.pipeline->watch(s.options.stop);
    s.open(std::move(surface));
  });
}

Flow::~Flow() = default;
Flow::Flow(Flow&&) noexcept = default;
Flow& Flow::operator=(Flow&&) noexcept = default;

int Flow::frames() const { return state_->span.steps; }
int Flow::frame() const { return state_->done; }

bool Flow::step() {
  return library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    return state_->step();
  });
}

double Flow::time() const { return state_->started ? state_->pipeline->flow().time() : state_->time_of(state_->done); }

void Flow::set(const std::string& knob, const KnobValue& value) {
  library_call([&] {
    State& s = *state_;
    const Caller caller(s.mutex, 0);
    Settings changed = s.settings();
    apply_knobs(changed, {{knob, value}}, Job::flow);
    for (const KnobDescription& each : describe_knobs(Job::flow))
      if (each.name == knob && !each.live)
        throw Error(fmt::format("{} cannot be changed any more", knob), "the data are prepared when a run begins",
                    "begin a new run");
    check_picture_settings(changed);
    colormap(changed.colormap);
    check_color_range(changed);
    if (changed.color != s.settings().color) {
      const std::string before = s.color;
      s.color = changed.color;
      try {
        s.input->set_color(changed.color);
      } catch (...) {
        s.color = before;
        throw;
      }
    }
    s.settings() = changed;
    if (embedding_knobs.contains(knob)) s.embedded = s.started = false;
    if (start_knobs.contains(knob)) s.started = false;
    if (s.started) {
      s.pipeline->parameters = changed.flow;
      s.pipeline->parameters.steps = s.span.steps - s.begun;
    }
  });
}

KnobValue Flow::get(const std::string& knob) const {
  return library_call([&] { return knob_value(state_->session.settings, knob, Job::flow); });
}

FlowPicture Flow::picture(const PictureOptions& options) {
  return library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    return state_->picture(options);
  });
}

FlowCells Flow::cells() const {
  return library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    state_->prepare();
    const FlowValues v = state_->pipeline->flow().values();
    FlowCells cells;
    cells.value = v.value;
    for (const Vec3d& p : v.centre) cells.centre.push_back({p.x, p.y, p.z});
    for (const Vec3d& p : v.closest_point) cells.closest_point.push_back({p.x, p.y, p.z});
    for (const Vec3f& p : v.velocity) cells.velocity.push_back({p.x, p.y, p.z});
    for (const Vec3f& p : v.normal) cells.normal.push_back({p.x, p.y, p.z});
    return cells;
  });
}

std::vector<float> Flow::sample(std::span<const std::array<double, 3>> points) {
  return library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    state_->prepare();
    std::vector<Vec3d> positions;
    for (const auto& p : points) positions.push_back(vec(p));
    for (const Vec3d& p : positions)
      if (!is_finite(p)) throw Error("a point is not finite");
    return state_->pipeline->flow().sample_shown(positions);
  });
}

void Flow::save(const std::filesystem::path& file) const {
  library_call([&] {
    const Caller caller(state_->mutex, state_->options.threads);
    state_->prepare();
    if (file.extension() != ".vtp" && file.extension() != ".pvtp")
      throw Error("cannot write " + file.string(), "", "values are written as .vtp or .pvtp");
    write_values(file, state_->pipeline->flow(), state_->ranks.get(), state_->origin(state_->session, "out"));
  });
}

std::string Flow::report() const {
  return library_call([&] {
    State& s = *state_;
    const Caller caller(s.mutex, s.options.threads);
    s.prepare();
    nlohmann::json report = report_frame("flow", *s.device, s.pipeline->timers(), s.pipeline->peak_bytes());
    add_flow_report(report, *s.input, s.vectors, s.settings(), s.pipeline->flow().embedding(), s.seconds);
    if (s.input->moves())
      report["motion"] = {{"groups", s.input->series().motion->groups}, {"rebuilds", s.motion->rebuilds()}};
    if (s.ranks) report["processes"] = ranks_report(*s.ranks, s.pipeline->flow().embedding(), report, s.seconds);
    return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  });
}

void save(const std::filesystem::path& file, const FlowPicture& picture) {
  library_call([&] {
    if (picture.width < 1 || picture.height < 1 ||
        picture.pixels.size() != std::size_t(4) * std::size_t(picture.width) * std::size_t(picture.height))
      throw Error("the picture has no pixels");
    Image image;
    image.width = picture.width;
    image.height = picture.height;
    image.pixels = picture.pixels;
    write_png(file, image, picture.origin);
  });
}

}  // namespace nacre
