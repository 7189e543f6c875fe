// Nacre: the thesis's Tables 5.1, 6.1 and 6.2: flow on the grid and on octrees.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "app/bench/bench.hpp"
#include "app/bench/thesis_figures.hpp"

namespace nacre {
namespace {

constexpr double mebibyte = 1 << 20;

/// The thesis's octrees hold the cells up to 5 from the surface.
constexpr double source_radius = 5;

/// A row of one flow run or several, left out where one does not fit the memory.
void flow_row(Bench& bench, BenchTable& table, const std::string& name, const std::vector<FlowJob>& jobs,
              const std::function<void(BenchRow&)>& fill) {
  constexpr double gibibyte = 1024 * mebibyte;
  bench.row(table, name, "sample " + jobs[0].sample, [&](BenchRow& row) {
    row.input += fmt::format(", {} triangles", bench.flows.triangles(jobs[0]));
    const double available = bench.flows.available();
    for (const FlowJob& job : jobs)
      if (const double needed = bench.flows.estimate(job); needed > available)
        throw Error(
            fmt::format("needs about {:.1f} GiB of memory, {:.1f} are free", needed / gibibyte, available / gibibyte));
    for (const FlowJob& job : jobs) bench.flows.run(job);
    fill(row);
  });
}

FlowJob octree_job(const Bench& bench, const std::string& sample, int resolution, bool index) {
  FlowJob job;
  job.sample = sample;
  job.detail = bench.small ? small_flow_detail : 0;
  job.method = EmbeddingKind::octree;
  job.octree = OctreeKind::thesis;
  job.radius = source_radius;
  job.resolution = resolution;
  job.neighbour_index = index;
  return job;
}

double sparseness(const EmbeddingInfo& embedding, int resolution) {
  return 100 * (1 - double(embedding.cells) / std::pow(double(resolution), 3));
}

/// The quantity, and how it has grown since the row before, where there is one of the same sample.
void add_growing(BenchTable& table, BenchRow& row, const BenchRow* before, const std::string& quantity,
                 const std::string& growth, double ours) {
  table.add(row, quantity, ours);
  if (before) table.add(row, growth, ratio(ours, before->ours(quantity)));
}

/// The row of `sample` with half the cells along each axis; nullptr where there is none.
const BenchRow* row_before(const BenchTable& table, const std::string& sample, int resolution) {
  for (const BenchRow& row : table.rows)
    if (row.name == fmt::format("{} {}", sample, resolution / 2) && row.left_out.empty()) return &row;
  return nullptr;
}

void octree_row(Bench& bench, BenchTable& table, const std::string& sample, int resolution) {
  const FlowJob source = octree_job(bench, sample, resolution, false);
  FlowJob brick = source;
  brick.octree = OctreeKind::brick;
  brick.radius = 0;
  flow_row(bench, table, fmt::format("{} {}", sample, resolution), {source, brick}, [&](BenchRow& row) {
    const BenchRow* before = row_before(table, sample, resolution);
    const FlowRun &s = bench.flows.run(source), &b = bench.flows.run(brick);
    add_growing(table, row, before, "build, s", "growth of build", s.embed);
    add_growing(table, row, before, "UFLIC step, s", "growth of UFLIC step", s.step);
    add_growing(table, row, before, "voxels", "growth of voxels", double(s.embedding.cells));
    table.add(row, "sparseness, %", sparseness(s.embedding, resolution));
    table.add(row, "memory, MiB", double(s.arena_bytes) / mebibyte);
    add_growing(table, row, before, "bricks: build, s", "bricks: growth of build", b.embed);
    add_growing(table, row, before, "bricks: UFLIC step, s", "bricks: growth of step", b.step);
    table.add(row, "bricks: voxels", double(b.embedding.cells));
    table.add(row, "bricks: memory, MiB", double(b.arena_bytes) / mebibyte);
    table.add(row, "build, source / bricks", ratio(s.embed, b.embed), Better::higher);
    table.add(row, "step, source / bricks", ratio(s.step, b.step), Better::higher);
  });
}

}  // namespace

void bench_grid_flow(Bench& bench) {
  BenchTable& table =
      bench.begin("5.1", "Flow on the closest-point grid, ttl 2",
                  {"source: GeForce GTX 780; simulations of a train, the F6 airliner and a combustion cylinder; under "
                   "1 GB of memory"});
  struct Case {
    const char *row, *sample;
    int resolution, refine;
  };
  constexpr std::array<Case, 3> cases{
      {{"train", "train", 2048, 4}, {"aircraft (F6)", "aircraft", 1536, 4}, {"cylinder", "cylinder", 1416, 3}}};
  for (const Case& c : cases) {
    FlowJob job;
    job.sample = c.sample;
    job.detail = bench.small ? small_flow_detail : 0;
    job.resolution = c.resolution / bench.pick(1, 4, 16);
    job.refine = c.refine;
    flow_row(bench, table, c.row, {job}, [&](BenchRow& row) {
      const FlowRun& run = bench.flows.run(job);
      const Int3 d = run.embedding.dimensions, p = run.embedding.closest_point_dimensions;
      row.input += fmt::format("; {}x{}x{} closest points, {}x{}x{} texture cells", p.x, p.y, p.z, d.x, d.y, d.z);
      table.add(row, "embed, s", run.embed);
      table.add(row, "refine, s", run.refine);
      table.add(row, "UFLIC step, s", run.step);
      table.add(row, "surface cells", double(run.embedding.surface_cells));
      table.add(row, "million surface cells / s", ratio(double(run.embedding.surface_cells) / 1e6, run.step));
      table.add(row, "memory, MiB", double(run.arena_bytes) / mebibyte);
      table.add(row, "embed and refine / step", ratio(run.embed + run.refine, run.step));
    });
  }
}

void bench_octree_flow(Bench& bench) {
  BenchTable& table = bench.begin(
      "6.1", "Flow on the sparse octree, ttl 2, without neighbour index",
      {"source: Quadro K6000, the octree built on one thread of a Xeon 5170; simulations of a train, the F6 "
       "airliner and a vortex over a delta wing",
       "voxels, build and step: the source's octree, radius 5; bricks: Nacre's own, which needs 2.24"});
  for (const char* sample : {"train", "aircraft", "delta-wing"}) {
    const int coarsest = bench.small ? 64 : 512;
    const int finest = bench.pick(std::string(sample) == "delta-wing" ? 8192 : 4096, 256, 128);
    for (int resolution = coarsest; resolution <= finest; resolution *= 2) octree_row(bench, table, sample, resolution);
  }
}

void bench_neighbour_index(Bench& bench) {
  BenchTable& table = bench.begin("6.2", "Flow on the sparse octree with neighbour index, ttl 2",
                                  {"source: Quadro K6000; simulation of a train", "source's octree, radius 5"});
  const int finest = bench.pick(2048, 512, 128);
  for (int resolution = bench.pick(512, 128, 64); resolution <= finest; resolution *= 2) {
    const FlowJob with = octree_job(bench, "train", resolution, true),
                  without = octree_job(bench, "train", resolution, false);
    flow_row(bench, table, fmt::format("train {}", resolution), {with, without}, [&](BenchRow& row) {
      const BenchRow* before = row_before(table, "train", resolution);
      const FlowRun &w = bench.flows.run(with), &o = bench.flows.run(without);
      add_growing(table, row, before, "UFLIC step, s", "growth of UFLIC step", w.step);
      add_growing(table, row, before, "voxels", "growth of voxels", double(w.embedding.cells));
      table.add(row, "sparseness, %", sparseness(w.embedding, resolution));
      table.add(row, "build, s", w.embed);
      const ThesisFigure *source_without = find_thesis_figure("6.1", row.name, "UFLIC step, s"),
                         *source_with = find_thesis_figure("6.2", row.name, "UFLIC step, s");
      table.add(row, "step, without / with index", ratio(o.step, w.step), Better::higher,
                source_with ? ratio(source_without->value, source_with->value) : std::nullopt);
    });
  }
}

}  // namespace nacre
