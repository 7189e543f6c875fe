// Nacre: runs of the flow pipeline for `nacre bench`.
#include "app/bench/flow_runs.hpp"

#include <algorithm>
#include <vector>

#include "app/common.hpp"
#include "compute/pipeline/flow_domain.hpp"
#include "engine/picture/colormap.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/surface/flow_input.hpp"

namespace nacre {
namespace {

/// Steps of a run: as many as fit into this time, seconds, but one at least and five at most.
constexpr double min_flow_seconds = 3;

double median(std::vector<double> seconds) {
  std::nth_element(seconds.begin(), seconds.begin() + std::ptrdiff_t(seconds.size() / 2), seconds.end());
  return seconds[seconds.size() / 2];
}

}  // namespace

/// Nacre's own settings, with the user's changes.
FlowParameters FlowRuns::turned() const {
  Settings settings;
  if (turn) turn(settings);
  return settings.flow;
}

FlowParameters FlowRuns::parameters(const FlowJob& job) const {
  FlowParameters parameters = turned();
  parameters.method = job.method;
  parameters.octree = job.octree;
  parameters.neighbour_index = job.neighbour_index;
  parameters.resolution = job.resolution;
  parameters.refine = job.refine;
  parameters.radius = job.radius;
  parameters.ttl = 2;
  parameters.warmup = 1;
  return parameters;
}

VectorsInTime& FlowRuns::sample(const FlowJob& job) {
  if (sample_ && job.sample == sample_name_ && job.detail == sample_detail_) return *sample_;
  sample_.reset();
  SurfaceSeries series = make_sample(job.sample, job.detail);
  const Surface first = series.load(0);
  PreparedSurface surface = prepare(first);
  std::string array = choose_vectors(first, "").name;
  if (interrupt_flag()) throw Interrupted();
  sample_ = std::make_unique<VectorsInTime>(std::move(series), std::move(surface), std::move(array), "speed");
  sample_name_ = job.sample;
  sample_detail_ = job.detail;
  return *sample_;
}

FlowMesh FlowRuns::mesh(const FlowJob& job) {
  const PreparedSurface& surface = sample(job).surface();
  return flow_mesh(surface);
}

std::size_t FlowRuns::triangles(const FlowJob& job) { return sample(job).surface().triangles.size(); }

FlowVectors FlowRuns::vectors(const FlowJob& job) {
  VectorsInTime& all = sample(job);
  return flow_vectors(all, all.start(), all.end());
}

std::unique_ptr<FlowPipeline> FlowRuns::pipeline(const FlowJob& job) const {
  std::unique_ptr<FlowPipeline> made = make_flow_pipeline(device_);
  made->watch(&interrupt_flag());
  made->parameters = parameters(job);
  return made;
}

double FlowRuns::estimate(const FlowJob& job) {
  return job.method == EmbeddingKind::grid ? estimate_flow_bytes(mesh(job), parameters(job))
                                           : estimate_octree_bytes(mesh(job), parameters(job));
}

int FlowRuns::largest_resolution(FlowJob job) {
  const FlowMesh surface = mesh(job);
  const auto fits = [&](int resolution) {
    job.resolution = resolution;
    try {
      FlowDomain domain;
      if (job.method == EmbeddingKind::grid)
        make_domain(surface, parameters(job));
      else
        make_octree_domain(surface, parameters(job), domain);
    } catch (const Error&) {  // beyond the keys
      return false;
    }
    return estimate(job) <= available();
  };
  int low = 64, high = (1 << 20) + 1;
  while (high - low > std::max(1, low / 128)) {
    const int middle = low + (high - low) / 2;
    (fits(middle) ? low : high) = middle;
    if (interrupt_flag()) throw Interrupted();
  }
  return low;
}

const FlowRun& FlowRuns::run(const FlowJob& job) {
  const auto known = runs_.find(job);
  if (known != runs_.end()) return known->second;
  const FlowMesh surface = mesh(job);
  const std::unique_ptr<FlowPipeline> made = pipeline(job);
  const StageTimers& timers = made->timers();
  FlowRun run;
  double spent = 0;
  for (int k = 0; k == 0 || (k < repeats && spent < 1); ++k) {
    const double embedded = timers.seconds("embed"), refined = timers.seconds("refine");
    made->embed(surface);
    const double embed = timers.seconds("embed") - embedded, refine = timers.seconds("refine") - refined;
    run.embed = k == 0 ? embed : std::min(run.embed, embed);
    run.refine = k == 0 ? refine : std::min(run.refine, refine);
    spent += embed + refine;
  }
  made->flow().start(vectors(job));
  std::vector<double> steps;
  for (double from = now(); steps.size() < 5 && (steps.empty() || now() - from < min_flow_seconds);) {
    const double before = now();
    made->flow().step();
    steps.push_back(now() - before);
  }
  run.step = median(steps);
  run.embedding = made->flow().embedding();
  run.arena_bytes = made->peak_bytes();
  return runs_[job] = run;
}

double FlowRuns::embed_and_step(const FlowJob& job, bool again, int times) {
  const FlowMesh surface = mesh(job);
  const FlowVectors flow_vectors = vectors(job);
  std::unique_ptr<FlowPipeline> made;
  double best = 1e300;
  for (int k = again ? 1 : 0; k <= times; ++k) {
    const double before = now();
    if (again || !made) made = pipeline(job);
    made->parameters.warmup = 0;
    made->embed(surface);
    made->flow().start(flow_vectors);
    made->flow().step();
    if (again) made.reset();
    if (k > 0) best = std::min(best, now() - before);
  }
  return best;
}

Image FlowRuns::picture(const FlowJob& job, int steps, int width, int height) {
  VectorsInTime& all = sample(job);
  const std::unique_ptr<FlowPipeline> made = pipeline(job);
  made->parameters.ttl = turned().ttl;
  made->parameters.warmup = turned().warmup;
  made->embed(mesh(job));
  made->flow().start(vectors(job));
  for (int k = 0; k < steps; ++k) made->flow().step();
  const std::vector<float> scalar = all.scalar(made->flow().time());
  RenderOptions options;
  options.camera = fit_camera("iso", triangle_corners(all.surface()), width, height);
  options.width = width;
  options.height = height;
  options.scalar = scalar;
  options.low = all.color_spread().low;
  options.high = all.color_spread().high;
  options.colours = colormap("sea").table;
  Image image(width, height);
  image.pixels = made->flow().render(options);
  return image;
}

}  // namespace nacre
