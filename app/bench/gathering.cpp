// Nacre: what it costs the red-black solver to copy every bin's neighbourhood into contiguous memory (sec. 3.3.3).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <vector>

#include "app/bench/bench.hpp"
#include "compute/particles/gathering_time.hpp"

namespace nacre {
namespace {

GatheringTime measure(const MeshParticles& particles, int threads) {
  const std::size_t n = particles.points.size();
  std::vector<Float4> position(n), direction(n);
  std::vector<std::uint32_t> interface(n);
  std::map<std::array<std::uint16_t, 4>, std::uint32_t> number;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f p(particles.points[i]), d = particles.normal[i];
    position[i] = {p.x, p.y, p.z, particles.size[i]};
    direction[i] = {d.x, d.y, d.z, particles.energy[i]};
    interface[i] = number.try_emplace(particles.materials[i], std::uint32_t(number.size())).first->second;
  }
  const std::unique_ptr<Device> device = make_cpu_device(threads);
  return time_gathering(*device, {position, direction, interface}, &interrupt_flag());
}

}  // namespace

void bench_gathering(Bench& bench) {
  BenchTable& table =
      bench.begin("gathering", "Copying neighbourhoods, of a red-black turn (sec. 3.3.3)",
                  {"source: Tesla C2070; \"less than 4%\" of the run-time", "a turn: relax, over its iterations"});
  MeshJob job;
  job.sample = "ribcage";
  job.detail = bench.detail(56);
  if (bench.device.backend() != "cpu")
    return bench.leave_out(table, "ribcage", "phantom ribcage", "measured on the CPU only; use --device cpu");
  bench.row(table, "ribcage", "phantom ribcage", [&](BenchRow& row) {
    const MeshSolve solve{"redblack", 0, true};
    const MeshRun run = bench.meshes.run(job, solve);
    const MeshParticles particles = bench.meshes.particles(job, solve);
    bench.meshes.release();
    const GatheringTime seconds = measure(particles, bench.device.threads());
    const double turn = run.relax / std::max(1, run.iterations);
    row.input += fmt::format(", {} particles", particles.points.size());
    table.add(row, "a turn, ms", 1000 * turn);
    table.add(row, "binning, ms", 1000 * seconds.binning);
    table.add(row, "copying, ms", 1000 * seconds.copying);
    table.add(row, "binning, % of a turn", ratio(100 * seconds.binning, turn));
    table.add(row, "copying, % of a turn", ratio(100 * seconds.copying, turn));
  });
}

}  // namespace nacre
