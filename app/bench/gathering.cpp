// Nacre: what it costs the red-black solver to copy every bin's neighbourhood into contiguous memory (sec. 3.3.3).
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/bench/bench.hpp"
#include "compute/device/executor_cpu.hpp"
#include "compute/particles/neighbourhoods.hpp"
#include "compute/particles/solver_state.hpp"

namespace nacre {
namespace {

/// A turn that copies every neighbourhood and then does nothing with it.
struct LeaveAlone {
  std::size_t scratch_bytes() const { return 0; }
  void operator()(Team&, const Neighbourhood&) const {}
};

struct GatherSeconds {
  double binning = 0, copying = 0;
};

ParticleSet upload(Arena& arena, const MeshParticles& particles) {
  const std::size_t n = particles.points.size();
  std::vector<Float4> place(n), direction(n);
  std::vector<std::uint32_t> interface(n);
  std::map<std::array<std::uint16_t, 4>, std::uint32_t> number;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3f p(particles.points[i]), d = particles.normal[i];
    place[i] = {p.x, p.y, p.z, particles.size[i]};
    direction[i] = {d.x, d.y, d.z, particles.energy[i]};
    interface[i] = number.try_emplace(particles.materials[i], std::uint32_t(number.size())).first->second;
  }
  ParticleSet set;
  set.count = std::int64_t(n);
  set.place = arena.permanent_copy<Float4>(place);
  set.direction = arena.permanent_copy<Float4>(direction);
  set.interface = arena.permanent_copy<std::uint32_t>(interface);
  return set;
}

/// The fastest of a few turns over all particles.
GatherSeconds measure(const MeshParticles& particles, int threads) {
  const std::unique_ptr<Device> device = make_cpu_device(threads);
  Executor<Cpu> exec(*device);
  exec.watch(&interrupt_flag());
  const ParticleSet set = upload(exec.arena(), particles);
  GatherSeconds best{1e300, 1e300};
  for (int k = 0; k < 5; ++k) {
    Arena::Scope scope(exec.arena());
    const double before = now();
    Neighbourhoods<Cpu> neighbourhoods(exec, set, SolverParameters().step);
    const double binned = now();
    neighbourhoods.for_each(LeaveAlone{});
    best.binning = std::min(best.binning, binned - before);
    best.copying = std::min(best.copying, now() - binned);
  }
  return best;
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
    const GatherSeconds seconds = measure(particles, bench.device.threads());
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
