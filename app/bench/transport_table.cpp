// Nacre: what topology, flow maps and dye cost, beside a step of the texture.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "app/bench/bench.hpp"
#include "engine/run/dye_run.hpp"
#include "engine/run/flow_maps.hpp"
#include "engine/run/flow_skeleton.hpp"
#include "engine/run/flow_tracks.hpp"
#include "engine/scene/samples/samples.hpp"
#include "engine/scene/surface/extent.hpp"
#include "engine/scene/surface/flow_input.hpp"

namespace nacre {
namespace {

/// The fastest of some runs, seconds.
template <class Work>
double seconds_of(int runs, const Work& work) {
  double best = 1e300;
  for (int k = 0; k < runs; ++k) {
    const double before = now();
    work();
    best = std::min(best, now() - before);
  }
  return best;
}

/// A dye in a ball around the first point; ten steps of the time in which the reference speed goes over a cell of the
/// texture's default resolution.
double dye_step(VectorsInTime& input, Settings settings, double cell) {
  constexpr int steps = 10;
  const Vec3d at = input.surface().points[input.surface().triangles.front().a];
  settings.dye = fmt::format("{},{},{},{}", at.x, at.y, at.z, 8 * cell);
  const double duration = cell / std::max(input.statistics().percentile_98, 1e-300);
  DyeRun dye(input, settings, input.start(), duration, &interrupt_flag());
  return seconds_of(1,
                    [&] {
                      for (int k = 1; k <= steps; ++k) dye.go_to(input.start() + k * duration);
                    }) /
         steps;
}

void transport_row(Bench& bench, BenchTable& table, const std::string& sample) {
  Settings settings;
  const FlowLog silent{[](const std::string&) {}, [](const VectorChoice&) {}};
  const int detail = bench.pick(0, 100, 24);
  VectorsInTime input = make_flow_input(make_sample(sample, detail), settings, silent, &interrupt_flag());
  const std::size_t triangles = input.surface().triangles.size();
  bench.row(table, sample, fmt::format("sample {}, {} triangles, {}", sample, triangles, input.array()),
            [&](BenchRow& row) {
              const int runs = bench.pick(3, 2, 1);
              const FlowSpan span = flow_span(settings, {input.start(), input.end()});
              const double cell = Extent(input.surface().points, input.surface().triangles).longest_side() / 1024;
              table.add(row, "triangles", double(triangles));
              table.add(row, "topology, s", seconds_of(runs, [&] { flow_skeleton(input, input.start(), 0.02); }));
              table.add(row, "streamlines, s", seconds_of(runs, [&] {
                          flow_streamlines(input, input.start(), settings.line_spacing, &interrupt_flag());
                        }));
              if (input.end() > input.start())
                table.add(row, "tracks, s", seconds_of(1, [&] {
                            flow_tracks(input, {input.start(), input.end()}, 0.02, &interrupt_flag());
                          }));
              table.add(row, "flow map, s",
                        seconds_of(1, [&] { surface_flow_map(input, span, settings.ftle_time, &interrupt_flag()); }));
              table.add(row, "dye step, s", dye_step(input, settings, cell));
            });
}

}  // namespace

void bench_transport(Bench& bench) {
  BenchTable& table = bench.begin("transport", "Topology, streamlines, flow maps and dye, on the triangles of the data",
                                  {"not in the source"});
  for (const char* sample : {"train", "torus", "pulse"}) transport_row(bench, table, sample);
}

}  // namespace nacre
