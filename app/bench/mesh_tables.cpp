// Nacre: the thesis's Tables 3.1 to 3.4 and 4.1 to 4.3: particles and the meshes made of them.
#include <fmt/format.h>

#include <array>

#include "app/bench/bench.hpp"
#include "app/bench/thesis_figures.hpp"

namespace nacre {
namespace {

struct Solver {
  const char* word;  ///< of --solver
  const char* name;  ///< in tables
};
constexpr std::array<Solver, 3> solvers{{{"serial", "serial"}, {"redblack", "red-black"}, {"tree", "tree"}}};

/// A row's name, the sample, and its detail with --small.
struct Case {
  const char* row;
  const char* sample;
  int small_detail;
};
constexpr std::array<Case, 3> scalar_cases{
    {{"heart", "heart", 64}, {"lungs", "lungs", 64}, {"ribcage", "ribcage", 56}}};
constexpr std::array<Case, 2> material_cases{{{"torso (pig)", "torso", 28}, {"head", "head", 32}}};

MeshJob job_of(const Bench& bench, const Case& c) {
  MeshJob job;
  job.sample = c.sample;
  job.detail = bench.detail(c.small_detail);
  return job;
}

/// What a row was run on, and where its solvers did not all run on the bench's device.
std::string input_text(Bench& bench, const MeshJob& job) {
  const FieldSeconds& fields = bench.meshes.fields(job);
  const std::string materials = fields.materials > 1 ? fmt::format(", {} materials", fields.materials) : "";
  const char* serial = bench.device.backend() == "cpu" ? "" : "; serial on the CPU";
  return fmt::format("phantom {}, {}x{}x{}{}{}", job.sample, fields.dims.x, fields.dims.y, fields.dims.z, materials,
                     serial);
}

std::string same_work(const Bench& bench) {
  Settings settings;
  settings.mesh.iterations = bench_iterations;
  if (bench.meshes.turn) bench.meshes.turn(settings);
  return fmt::format(
      "same work for all solvers: {} iterations each on the same fields, the source's constants; serial and "
      "red-black begin from marching cubes, the tree from the embedding",
      settings.mesh.iterations);
}

constexpr const char* hardware_3 =
    "source: one thread of a Xeon X5650 (serial), a Tesla C2070 (red-black); scans, 268x129x177";
constexpr const char* hardware_4 =
    "source: one thread of a Xeon X5550 (serial), a Tesla K20 (red-black, tree); pig 136x136x136, head 199x250x249";

constexpr const char* own_settings =
    "own settings: nacre mesh as it comes: the tree to its end, triangles smoothed and repaired";

std::string particle_cost(const Solver& s) { return fmt::format("{}: us per particle and iteration", s.name); }

/// Seconds, particles and cost of each solver, then the ratios that --against compares.
void add_solvers(BenchTable& table, BenchRow& row, const std::array<MeshRun, 3>& runs) {
  for (std::size_t k = 0; k < solvers.size(); ++k) {
    table.add(row, fmt::format("{}: s", solvers[k].name), runs[k].seconds);
    if (table.name[0] == '3') table.add(row, fmt::format("{}: particles", solvers[k].name), double(runs[k].final));
  }
  const auto cost = [&](std::size_t k) { return ratio(1e6 * runs[k].seconds, runs[k].moves); };
  for (std::size_t k = 0; k < solvers.size(); ++k) table.add(row, particle_cost(solvers[k]), cost(k));
  table.add(row, "serial / red-black", ratio(runs[0].seconds, runs[1].seconds));
  table.add(row, "serial / tree", ratio(runs[0].seconds, runs[2].seconds));
  table.add(row, "red-black / tree", ratio(runs[1].seconds, runs[2].seconds));
  table.add(row, "per particle: serial / red-black", ratio(cost(0), cost(1)), Better::higher);
  table.add(row, "per particle: serial / tree", ratio(cost(0), cost(2)), Better::higher);
  table.add(row, "per particle: red-black / tree", ratio(cost(1), cost(2)), Better::higher);
}

std::array<MeshRun, 3> run_solvers(Bench& bench, const MeshJob& job, int particles, bool quality) {
  std::array<MeshRun, 3> runs;
  for (std::size_t k = 0; k < solvers.size(); ++k)
    runs[k] = bench.meshes.run(job, {solvers[k].word, particles, quality});
  return runs;
}

/// The thesis's figures per particle: its seconds over its final counts (Table 4.2 over Table 4.1).
void add_source_costs(BenchRow& row) {
  const auto cost = [&](const char* solver) {
    const ThesisFigure* seconds = find_thesis_figure("4.2", row.name, fmt::format("{}: s", solver));
    const ThesisFigure* particles = find_thesis_figure("4.1", row.name, fmt::format("{}: particles", solver));
    return ratio(seconds->value, particles->value);
  };
  for (BenchValue& value : row.values) {
    if (value.quantity == "per particle: serial / red-black") value.source = ratio(cost("serial"), cost("red-black"));
    if (value.quantity == "per particle: serial / tree") value.source = ratio(cost("serial"), cost("tree"));
    if (value.quantity == "per particle: red-black / tree") value.source = ratio(cost("red-black"), cost("tree"));
  }
}

template <std::size_t n>
void solver_rows(Bench& bench, BenchTable& table, const std::array<Case, n>& cases) {
  for (const Case& c : cases)
    bench.row(table, c.row, c.sample, [&](BenchRow& row) {
      const MeshJob job = job_of(bench, c);
      const std::array<MeshRun, 3> runs = run_solvers(bench, job, 0, true);
      row.input = input_text(bench, job);
      add_solvers(table, row, runs);
      if (table.name == "4.2") add_source_costs(row);
    });
}

void add_quality(BenchTable& table, BenchRow& row, const char* name, const MeshRun& run, bool counts) {
  if (counts) {
    table.add(row, fmt::format("{}: seeds", name), double(run.seeded));
    table.add(row, fmt::format("{}: particles", name), double(run.final));
  }
  table.add(row, fmt::format("{}: mean ratio", name), run.mean_ratio, Better::higher);
  table.add(row, fmt::format("{}: smallest ratio", name), run.smallest_ratio);
}

/// Radius ratios of the three solvers and of the program's own settings.
template <std::size_t n>
void quality_rows(Bench& bench, BenchTable& table, const std::array<Case, n>& cases, bool counts) {
  for (const Case& c : cases)
    bench.row(table, c.row, c.sample, [&](BenchRow& row) {
      const MeshJob job = job_of(bench, c);
      const std::array<MeshRun, 3> runs = run_solvers(bench, job, 0, true);
      const MeshRun own = bench.meshes.run(job, {"own", 0, true});
      row.input = input_text(bench, job);
      for (std::size_t k = 0; k < solvers.size(); ++k) add_quality(table, row, solvers[k].name, runs[k], counts);
      add_quality(table, row, "own settings", own, counts);
    });
}

}  // namespace

void bench_quality(Bench& bench) {
  BenchTable& table = bench.begin("3.1", "Radius ratio (2 r_in / r_circ) of the triangles",
                                  {hardware_3, same_work(bench), own_settings});
  quality_rows(bench, table, scalar_cases, false);
}

void bench_solvers(Bench& bench) {
  BenchTable& table = bench.begin("3.2", "Time to place the particles", {hardware_3, same_work(bench)});
  solver_rows(bench, table, scalar_cases);
}

void bench_synthetic(Bench& bench) {
  BenchTable& table =
      bench.begin("3.3", "Time for a given number of seeds (ribcage; none are added)", {hardware_3, same_work(bench)});
  MeshJob job = job_of(bench, scalar_cases[2]);
  constexpr int own_detail = 268;
  const double share = bench.small ? double(job.detail) * job.detail / (own_detail * own_detail) : 1;
  for (int seeds = 60000; seeds <= 300000; seeds += bench.small ? 120000 : 30000)
    bench.row(table, std::to_string(seeds), job.sample, [&](BenchRow& row) {
      const int asked = int(seeds * share);
      const std::array<MeshRun, 3> runs = run_solvers(bench, job, asked, false);
      row.input = input_text(bench, job);
      table.add(row, "seeds", double(runs[0].seeded));
      add_solvers(table, row, runs);
    });
}

void bench_sizing(Bench& bench) {
  BenchTable& table = bench.begin(
      "3.4", "Time for sizing fields of epsilon, delta (ribcage)",
      {hardware_3, same_work(bench), "sizes from 0.75 to 1 voxel, so that counts grow about as the source's do",
       "our limiter is exact: it has no number of iterations, and the source's row of 7 has no counterpart"});
  constexpr std::array<std::array<double, 2>, 6> rows{
      {{8, 2}, {2, 1}, {0.5, 0.5}, {0.25, 0.25}, {0.125, 0.125}, {0.01, 0.01}}};
  for (std::size_t k = 0; k < rows.size(); k += bench.small ? 4 : 1) {
    const std::string name = fmt::format("{:g}, {:g}", rows[k][0], rows[k][1]);
    bench.row(table, name, scalar_cases[2].sample, [&](BenchRow& row) {
      MeshJob job = job_of(bench, scalar_cases[2]);
      job.epsilon = rows[k][0];
      job.delta = rows[k][1];
      job.min_size = 0.75;
      const std::array<MeshRun, 3> runs = run_solvers(bench, job, 0, false);
      row.input = input_text(bench, job);
      add_solvers(table, row, runs);
    });
  }
}

void bench_material_quality(Bench& bench) {
  BenchTable& table = bench.begin("4.1", "Particles, and radius ratio (2 r_in / r_circ) of the triangles",
                                  {hardware_4, same_work(bench), own_settings});
  quality_rows(bench, table, material_cases, true);
}

void bench_material_solvers(Bench& bench) {
  BenchTable& table =
      bench.begin("4.2", "Time to place the particles of several materials", {hardware_4, same_work(bench)});
  solver_rows(bench, table, material_cases);
}

void bench_material_stages(Bench& bench) {
  BenchTable& table = bench.begin(
      "4.3", "Time of the stages before and after the particles",
      {hardware_4, "the source's distance volume and sizing field are BioMesh3D's, on one thread of its CPU",
       "total: distance volume, sizing field, closest point and extract; the source's leaves closest point out",
       "extract: of the tree's particles"});
  for (const Case& c : material_cases)
    bench.row(table, c.row, c.sample, [&](BenchRow& row) {
      const MeshJob job = job_of(bench, c);
      const std::array<MeshRun, 3> runs = run_solvers(bench, job, 0, true);
      const FieldSeconds& fields = bench.meshes.fields(job);
      row.input = input_text(bench, job);
      table.add(row, "distance volume, s", fields.distance);
      table.add(row, "sizing field, s", fields.sizing);
      table.add(row, "closest point, s", fields.embed);
      table.add(row, "extract, s", runs[2].extract);
      table.add(row, "total, s", fields.distance + fields.sizing + fields.embed + runs[2].extract);
      // Stages by the serial solver's particles: what two runs on different machines have in common.
      table.add(row, "serial particles / distance volume and sizing field",
                ratio(runs[0].seconds, fields.distance + fields.sizing), Better::higher);
      table.add(row, "serial particles / closest point", ratio(runs[0].seconds, fields.embed), Better::higher);
      table.add(row, "serial particles / extract", ratio(runs[0].seconds, runs[2].extract), Better::higher);
      for (std::size_t k = 0; k < solvers.size(); ++k)  // for figure 4.5; the thesis's are those of Table 4.2
        table.add(row, fmt::format("particles, {}, s", solvers[k].name), runs[k].seconds, Better::neither,
                  find_thesis_figure("4.2", c.row, fmt::format("{}: s", solvers[k].name))->value);
    });
}

}  // namespace nacre
